"""The plan in words: what the robot will do on each branch, and why not where it can't."""

from __future__ import annotations

from polaris_nl.automaton.automaton import START, Automaton
from polaris_nl.model.text import listed, sentence
from polaris_nl.model.wording import Wording
from polaris_nl.planning.result import BranchingPlan, Problem, Segment
from polaris_nl.render.layout import Row, wrapped

SPOKEN_ACTIONS = 8
"""Actions of a segment that are said one by one; more are summed up."""


def branches_in_words(
    automaton: Automaton, plan: BranchingPlan, wording: Wording, start: str = START
) -> list[str]:
    """What happens after a checkpoint: a sentence a segment, and each way named where they part."""
    said: list[str] = []
    waiting = [(segment, "") for segment in reversed(_ways(automaton, plan, start))]
    several = len(waiting) > 1
    waiting = [(s, _way(s, wording, several)) for s, _ in waiting]
    while waiting:
        segment, lead = waiting.pop()
        said.append(segment_in_words(segment, wording, lead))
        ways = _ways(automaton, plan, segment.target)
        several = len(ways) > 1
        waiting.extend((way, _way(way, wording, several) or "then ") for way in reversed(ways))
    return said


def _ways(automaton: Automaton, plan: BranchingPlan, checkpoint: str) -> list[Segment]:
    found = [
        plan.segments[t.target] for t in automaton.outgoing(checkpoint) if t.target in plan.segments
    ]
    return sorted(found, key=lambda s: not s.when)


def _way(segment: Segment, wording: Wording, several: bool) -> str:
    if segment.when:
        return f"once {wording.events(segment.when)}, "
    return "otherwise " if several else ""


def segment_in_words(segment: Segment, wording: Wording, lead: str = "") -> str:
    """One segment as a sentence."""
    steps = f"I {steps_in_words(segment, wording)}" if segment.actions else "there is nothing to do"
    return sentence(f"{lead}{steps}")


def steps_in_words(segment: Segment, wording: Wording) -> str:
    """The actions of a segment, as a list of imperatives."""
    actions = [wording.action(a) for a in segment.actions]
    if len(actions) > SPOKEN_ACTIONS:
        middle = len(actions) - SPOKEN_ACTIONS + 1
        actions = [*actions[: SPOKEN_ACTIONS - 2], f"do {middle} more things", actions[-1]]
    return listed(actions) or "do nothing"


def problem_rows(plan: BranchingPlan, automaton: Automaton, width: int) -> list[Row]:
    """Every problem with its ways out, then every warning."""
    rows: list[Row] = []
    for problem in plan.problems:
        rows.extend(_problem(problem, automaton, width))
    for warning in plan.warnings:
        rows.extend(wrapped(warning.text, width, "Note: "))
    return rows


def _problem(problem: Problem, automaton: Automaton, width: int) -> list[Row]:
    checkpoint = automaton.checkpoints.get(problem.checkpoint or "")
    lead = f"{checkpoint.name}: " if checkpoint else ""
    rows = wrapped(f"{lead}{problem.text}", width, "", "  ", "bad", problem.checkpoint)
    for repair in problem.repairs:
        rows.extend(wrapped(repair.text, width, "  Way out: ", checkpoint=problem.checkpoint))
    return rows
