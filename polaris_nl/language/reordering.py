"""Steps that are there, asked for in another order: "fill the tray first and tell her afterwards"."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from itertools import pairwise

from polaris_nl.automaton.automaton import Automaton
from polaris_nl.automaton.edits import Edit, apply_all
from polaris_nl.language.reshaping import Reshaped, moved_before, moved_behind
from polaris_nl.model.formula import Goal

ORDERING = frozenset((
    "first", "before", "beforehand", "after", "afterwards", "afterward", "only"
))  # fmt: skip
"""Words that say in which order; "then" alone goes on with something new."""
ANEW = frozenset(("again", "another", "second", "too", "also", "twice"))
"""Words that ask for what is there a second time."""


def says_order(words: Collection[str]) -> bool:
    """Whether words put what is there in order, rather than ask for it anew."""
    return bool(ORDERING.intersection(words)) and not asked_anew(words)


def asked_anew(words: Collection[str]) -> bool:
    """Whether words ask for something a second time."""
    return bool(ANEW.intersection(words))


def there_already(program: Automaton, wanted: Sequence[Collection[Goal]]) -> tuple[str, ...] | None:
    """The checkpoints with these goals, where each is there once, and they stand in a row.

    In a row are those on one way, without a choice or a condition between them: only there does another
    order ask for the same.

    Args:
        program: what is there.
        wanted: goals, by step.
    """
    found: list[str] = []
    for goals in wanted:
        same = [c.id for c in program.checkpoints.values() if goals and set(c.goals) == set(goals)]
        if len(same) != 1 or same[0] in found:
            return None
        found += same
    if len(found) < 2:
        return None
    way = [t.target for t in program.path(max(found, key=lambda c: len(program.path(c))))]
    if not set(found) <= set(way):
        return None
    between = way[min(way.index(c) for c in found) : -1]
    straight = all(
        len(program.outgoing(c)) == 1 and not program.outgoing(c)[0].when for c in between
    )
    return tuple(found) if straight else None


def put_in_order(program: Automaton, order: Sequence[str]) -> list[Edit]:
    """Each checkpoint in front of the next one, where it isn't there somewhere already."""
    edits: list[Edit] = []
    for this, other in reversed(list(pairwise(order))):
        changed = apply_all(program, edits)
        if other not in changed.subtree(this):
            edits += moved_before(changed, this, other)[0]
    return edits


def moved(program: Automaton, this: str, other: str, behind: bool) -> Reshaped:
    """A checkpoint in front of, or behind, another one in the same row.

    Raises:
        EditError: it can't be.
    """
    first, second = (other, this) if behind else (this, other)
    if second in program.subtree(first):
        return [], "", []
    if behind and not any(t.when for t in program.outgoing(other)):
        return moved_behind(program, this, other)
    return moved_before(program, first, second)


def in_front_of(
    program: Automaton, wanted: Sequence[Collection[Goal]], here: str, says_before: bool
) -> str | None:
    """The checkpoint in front of which new steps belong that lead up to what is there; None if they don't.

    After "put the cup in the cupboard, then close it", "put the plate in and then close it" is about the
    same closing; so is "fill the cup before she gets it", wherever she gets it.

    Args:
        program: what is there.
        wanted: goals, by step; the last are there already.
        here: where the program has come to.
        says_before: it was said what comes before what.
    """
    *new, last = wanted
    same = [c.id for c in program.checkpoints.values() if last and set(c.goals) == set(last)]
    there = [set(c.goals) for c in program.checkpoints.values()]
    if not new or len(same) != 1 or any(set(goals) in there for goals in new):
        return None
    at_the_end = same[0] == here and not program.outgoing(here)
    return same[0] if at_the_end or says_before else None
