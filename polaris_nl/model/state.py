"""States of the world, what excludes what in them, and what actions and events make of them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from polaris_nl.model.formula import Literal

ANY = "_"
"""In a mutex pattern: any entity, counted over all of them."""


@dataclass(frozen=True, slots=True)
class MutexGroup:
    """At most one of the atoms that match these patterns holds, for each value of the variables.

    `(at ?o _) (in ?o _) (holding ?o)` says that an object is in one place: `?o` is shared by the
    patterns, `_` is counted over. `(hand-empty) (holding _)` says that the hand holds one thing.
    """

    patterns: tuple[Literal, ...]

    def __str__(self) -> str:
        return " ".join(map(str, self.patterns))

    def keys(self, atom: Literal) -> Iterator[tuple[tuple[str, str], ...]]:
        """The instances of this group that an atom belongs to, as sorted bindings of the variables."""
        for pattern in self.patterns:
            key = _match(pattern, atom)
            if key is not None:
                yield key


@dataclass(frozen=True, slots=True)
class Mutexes:
    """All mutex groups of a domain.

    Attributes:
        groups: what excludes what.
        defaults: atoms that hold exactly where no other atom of their group does, such as
            `(hand-empty)`: taking an object from the hand leaves the hand empty.
    """

    groups: tuple[MutexGroup, ...] = ()
    defaults: frozenset[str] = frozenset()

    def excluded(self, state: State, atom: Literal) -> frozenset[Literal]:
        """The facts of a state that can't hold beside an atom."""
        gone = set()
        for group in self.groups:
            keys = set(group.keys(atom))
            if keys:
                gone |= {f for f in state.facts if f != atom and not keys.isdisjoint(group.keys(f))}
        return frozenset(gone)

    def exclusive(self, a: Literal, b: Literal) -> MutexGroup | None:
        """The group in which two different atoms exclude each other, or None."""
        if a == b:
            return None
        for group in self.groups:
            if not set(group.keys(a)).isdisjoint(group.keys(b)):
                return group
        return None

    def pairs(self, literals: Sequence[Literal]) -> Iterator[tuple[Literal, Literal]]:
        """The pairs of different positive literals that exclude each other, in their order, one by one."""
        members: dict[object, list[int]] = {}
        for at, literal in enumerate(literals):
            if literal.positive:
                for number, group in enumerate(self.groups):
                    for key in set(group.keys(literal)):
                        members.setdefault((number, key), []).append(at)
        shared: dict[int, list[list[int]]] = {}
        for group_members in members.values():
            for at in group_members if len(group_members) > 1 else ():
                shared.setdefault(at, []).append(group_members)
        for at in sorted(shared):
            for other in sorted({x for some in shared[at] for x in some if x > at}):
                if literals[at] != literals[other]:
                    yield literals[at], literals[other]


@dataclass(frozen=True, slots=True)
class State:
    """The facts that hold; every other atom is false (closed world)."""

    facts: frozenset[Literal]

    def __contains__(self, atom: object) -> bool:
        return atom in self.facts

    def holds(self, literal: Literal) -> bool:
        """Whether a ground literal is true here."""
        return (literal.atom in self.facts) is literal.positive

    def change(self, removed: Iterable[Literal], added: Iterable[Literal]) -> State:
        """Removes atoms, then adds atoms (PDDL's order)."""
        return State((self.facts - frozenset(removed)) | frozenset(added))

    def after_event(self, literals: Iterable[Literal], mutexes: Mutexes) -> State:
        """The state after somebody made literals true; each new fact displaces what it excludes.

        This is how a conditional is made true (DESIGN section 5 point 2): negative literals are
        removed, positive ones are added, what they exclude goes, and a group that is left with none
        of its members gets its default back (the hand is empty again).
        """
        literals = tuple(literals)
        state = self.change((x.atom for x in literals if not x.positive), ())
        for atom in sorted(x for x in literals if x.positive):
            state = state.change(mutexes.excluded(state, atom), (atom,))
        return state.change((), self._defaults_left(state, mutexes))

    def _defaults_left(self, after: State, mutexes: Mutexes) -> Iterator[Literal]:
        gone = self.facts - after.facts
        for group in mutexes.groups:
            for pattern in group.patterns:
                if pattern.predicate not in mutexes.defaults or pattern.args:
                    continue
                lost = any(True for fact in gone for _ in group.keys(fact))
                left = any(True for fact in after.facts for _ in group.keys(fact))
                if lost and not left:
                    yield pattern

    def difference(self, later: State) -> tuple[tuple[Literal, ...], tuple[Literal, ...]]:
        """What a later state has lost and gained, each sorted: (removed, added)."""
        return (
            tuple(sorted(self.facts - later.facts)),
            tuple(sorted(later.facts - self.facts)),
        )


def _match(pattern: Literal, atom: Literal) -> tuple[tuple[str, str], ...] | None:
    if pattern.predicate != atom.predicate or len(pattern.args) != len(atom.args):
        return None
    binding: dict[str, str] = {}
    for wanted, found in zip(pattern.args, atom.args, strict=True):
        if wanted == ANY:
            continue
        if wanted.startswith("?"):
            if binding.setdefault(wanted, found) != found:
                return None
        elif wanted != found:
            return None
    return tuple(sorted(binding.items()))
