"""Which facts exclude each other: found from the operators, and stated in the domain.

Invariants are synthesised by Fast Downward's translator (Helmert, "Concise finite-domain
representations for PDDL planning tasks", Artificial Intelligence 173, 2009).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence

from polaris_nl.model.domain import Domain
from polaris_nl.model.formula import Literal
from polaris_nl.model.state import ANY, Mutexes, MutexGroup, State
from polaris_nl.model.world import World
from polaris_nl.planning.pddl_text import domain_text, problem_text
from polaris_nl.planning.translate import invariants

Part = tuple[str, tuple[int | None, ...]]


def find_mutexes(world: World) -> Mutexes:
    """The mutex groups of a world's domain that hold at its start.

    Raises:
        PlanningError: the planner can't read the domain.
    """
    candidates = invariants(domain_text(world.domain), problem_text(world, world.initial, ()))
    found = [_group(parts, world.domain) for parts in candidates]
    kept = tuple(
        _largest(
            [g for g in found if _at_most_one(g, world.initial) and not _supplied(g, world.domain)]
        )
    )
    groups = (*kept, *world.domain.mutexes)
    return Mutexes(groups, frozenset(_defaults(kept, world.initial)))


def _largest(groups: Sequence[MutexGroup]) -> Iterable[MutexGroup]:
    """Leaves out groups that are part of another one."""
    for group in groups:
        others = (set(other.patterns) for other in groups if other is not group)
        if not any(set(group.patterns) < other for other in others):
            yield group


def _supplied(group: MutexGroup, domain: Domain) -> bool:
    """Whether a group counts something that the robot only uses up, such as coins.

    That there is at most one is then an accident of the start, and people may bring another.
    """
    return any(ANY in p.args and not domain.achievers(p) for p in group.patterns)


def _group(parts: Sequence[Part], domain: Domain) -> MutexGroup:
    patterns = []
    for predicate, positions in parts:
        args = tuple(ANY if p is None else f"?v{p}" for p in positions)
        if predicate in domain.predicates:
            patterns.append(Literal(predicate, args))
    return MutexGroup(tuple(patterns))


def _at_most_one(group: MutexGroup, state: State) -> bool:
    counts = Counter(key for fact in state.facts for key in set(group.keys(fact)))
    return bool(group.patterns) and all(count <= 1 for count in counts.values())


def _defaults(groups: Iterable[MutexGroup], state: State) -> Iterable[str]:
    """Atoms without arguments that fill their group when nothing else does, such as `(hand-empty)`."""
    for group in groups:
        bare = [p for p in group.patterns if not p.args]
        if len(bare) == 1 and len(group.patterns) > 1 and any(group.keys(f) for f in state.facts):
            yield bare[0].predicate
