"""Goals and conditionals that no plan could be about, found before planning."""

from __future__ import annotations

from collections.abc import Iterator

from polaris_nl.automaton.automaton import Automaton
from polaris_nl.model.domain import KIND
from polaris_nl.model.formula import And, Formula, Imply, Literal, Quantified
from polaris_nl.planning.result import Problem


def no_goals(automaton: Automaton) -> Iterator[Problem]:
    """The problems of goals that ask for no fact, and of conditionals that never change."""
    for checkpoint in automaton.checkpoints.values():
        for goal in checkpoint.goals:
            part = _no_goal(goal)
            if part is None:
                continue
            why = "a goal is a fact, or one for all of a kind; ask for one of the facts in it"
            if isinstance(part, Literal):
                why = "the world's file says what kind a thing is, and no action changes it"
            text = f"In {checkpoint.name}: {part} is no goal, as {why}."
            yield Problem("invalid", text, checkpoint.id)
    for transition in automaton.transitions.values():
        for literal in transition.when:
            if literal.predicate == KIND:
                text = f"{literal} is no conditional, as what kind a thing is never changes."
                yield Problem("invalid", text, transition.target, transition.id)


def _no_goal(goal: Formula) -> Formula | None:
    """The first part of a goal that asks for no fact, such as an `or`; None where all of it does."""
    if isinstance(goal, Literal):
        return goal if goal.predicate == KIND else None
    if isinstance(goal, And):
        return next((p for p in map(_no_goal, goal.parts) if p is not None), None)
    if isinstance(goal, Imply):
        return _no_goal(goal.conclusion)
    if isinstance(goal, Quantified) and goal.quantifier == "forall":
        return _no_goal(goal.body)
    return goal
