"""Polaris NL: a goal-authoring assistant for service robots.

An utterance becomes an edit, the edit changes a goal automaton, a planner turns the automaton into
a branching plan, and an executor turns the plan into goals for a robot. `docs/architecture.md`
draws the way.
"""

__version__ = "0.1.0"
