"""Where in a program a correction belongs, and goals that are taken back."""

from __future__ import annotations

from collections.abc import Sequence

from polaris_nl.automaton.automaton import START, Automaton
from polaris_nl.automaton.edits import Edit, RemoveCheckpoint, SetGoals
from polaris_nl.language.goal_relations import flat, says_a_place, thing_placed
from polaris_nl.model.formula import Goal, Literal


def place_of(goals: Sequence[Goal], touched: Sequence[str], program: Automaton) -> str | None:
    """The checkpoint that goals are a correction of, or None where they are new.

    Args:
        goals: what is said to be wanted.
        touched: the checkpoints of the latest edit: there, goals of the same kind are enough.
        program: elsewhere in it, the same thing must be brought somewhere else.
    """
    new = flat(goals)
    moved = {thing_placed(g) for g in new if g.positive and says_a_place(g)}
    predicates = {g.predicate for g in new}

    def moves(checkpoint: str) -> bool:
        there = flat(program.checkpoints[checkpoint].goals)
        return any(says_a_place(g) and thing_placed(g) in moved for g in there)

    def is_alike(checkpoint: str) -> bool:
        there = flat(program.checkpoints[checkpoint].goals)
        return any(g.predicate in predicates for g in there)

    made = [c for c in reversed(list(program.checkpoints)) if c != START]
    same = (c for c in (*reversed(touched), *made) if moves(c))
    near = (c for c in reversed(touched) if is_alike(c))
    return next(same, None) or next(near, None)


def negated(
    goals: Sequence[Goal], touched: Sequence[str], program: Automaton
) -> tuple[list[Edit], str] | None:
    """Goals that were asked for are taken back: "no, don't open the drawer".

    Returns:
        The edits and what they do in words; None where none of the goals was asked for.
    """
    wrong = {g.negation for g in goals if isinstance(g, Literal)}
    for checkpoint in reversed(touched):
        there = program.checkpoints[checkpoint].goals
        kept = tuple(g for g in there if g not in wrong)
        name = program.checkpoints[checkpoint].name
        if kept and kept != there:
            return [SetGoals(checkpoint, kept)], f"{name} is without that now"
        if kept != there:
            return [RemoveCheckpoint(checkpoint)], f"{name} is gone"
    return None


def waits(program: Automaton, checkpoint: str, when: Sequence[Literal]) -> bool:
    """Whether a step is done only where something holds."""
    return any(set(when) <= arrow.conditional for arrow in program.path(checkpoint))


def never_then(program: Automaton, checkpoint: str, when: Sequence[Literal]) -> bool:
    """Whether a step isn't on the way that is taken where something holds."""
    path = program.path(checkpoint)
    for arrow in path:
        for beside in program.outgoing(arrow.source):
            if beside.id != arrow.id and beside.conditional == set(when):
                return True
    return False
