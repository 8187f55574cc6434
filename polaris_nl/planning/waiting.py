"""Where a program waits for somebody, and what it does if nothing comes (DESIGN section 5 point 8)."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass

from polaris_nl.automaton.automaton import START, Automaton, Transition
from polaris_nl.model.formula import Literal


@dataclass(frozen=True, slots=True)
class Waiting:
    """A checkpoint that is left on a condition.

    Attributes:
        checkpoint: where the robot is then.
        missing: the ways whose condition never comes.
        others: the other ways with a condition: one of them may still be taken.
        otherwise: the way that is taken at once where no condition holds; without it the robot
            waits.
    """

    checkpoint: str
    missing: tuple[Transition, ...]
    others: tuple[Transition, ...]
    otherwise: Transition | None


def waits(automaton: Automaton, never: Collection[Literal] = ()) -> tuple[Waiting, ...]:
    """Where it matters that facts never come about, from the start on.

    Args:
        automaton: the program.
        never: the facts; none means that nobody ever does anything.
    """
    found = []
    for checkpoint in automaton.subtree(START):
        labelled = [t for t in automaton.outgoing(checkpoint) if t.when]
        missing = [t for t in labelled if not never or not t.conditional.isdisjoint(never)]
        if missing:
            others = tuple(t for t in labelled if t not in missing)
            unlabelled = (t for t in automaton.outgoing(checkpoint) if not t.when)
            otherwise = next(unlabelled, None)
            found.append(Waiting(checkpoint, tuple(missing), others, otherwise))
    return tuple(found)
