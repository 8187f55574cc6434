"""Leaving out of a planning task what can't matter to it, without changing its shortest plans.

A world may have a thousand things of which a goal needs one. A thing may be left out if every plan
stays a plan when all actions on that thing are deleted from it. `Projection` finds, once for a
domain, the types of which that is true: every operator takes at most one entity of the type, and
what its actions change besides facts about that entity is only a place
in a mutex group that the entity takes and gives back, such as the hand: picking the thing up makes
it not empty, putting it down makes it empty again, and nothing asks for it not to be empty. Then
the task without the thing has the same shortest plans, and is unsolvable exactly when the whole one
is.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from polaris_nl.model.domain import Domain, Operator, conjuncts
from polaris_nl.model.formula import (
    And,
    Formula,
    Imply,
    Literal,
    Not,
    Or,
    Quantified,
    When,
    literals_in,
)
from polaris_nl.model.state import ANY, Mutexes, MutexGroup, State
from polaris_nl.model.world import World


class Projection:
    """Projects planning tasks of one world.

    Args:
        world: the whole world.
        mutexes: its mutex groups; those that the domain only declares are not relied on.
    """

    def __init__(self, world: World, mutexes: Mutexes) -> None:
        self._world = world
        domain = world.domain
        self._groups = [g for g in mutexes.groups if g not in domain.mutexes]
        self._negative = set(_negative_predicates(domain))
        self._lent: dict[str, frozenset[str]] = {}
        for kind in domain.types:
            lent = self._lent_by(kind)
            if lent is not None:
                self._lent[kind] = lent

    def of(self, state: State, goals: Sequence[Formula]) -> tuple[World, State]:
        """The world and the state without the entities that can't matter to some goals."""
        if any(_has_quantifier(goal) for goal in goals):
            return self._world, state
        wanted = [literal for goal in goals for literal in literals_in(goal)]
        asked_not = {x.predicate for goal in goals for x in _negative(goal)}
        named = {arg for literal in wanted for arg in literal.args}
        free = {kind for kind, lent in self._lent.items() if lent.isdisjoint(asked_not)}
        held = self._holders(state)
        entities = {
            name: entity
            for name, entity in self._world.entities.items()
            if entity.type not in free
            or name in named
            or name in held
            or name in self._world.domain.constants
        }
        if len(entities) == len(self._world.entities):
            return self._world, state
        gone = self._world.entities.keys() - entities.keys()
        facts = frozenset(f for f in state.facts if gone.isdisjoint(f.args))
        return replace(self._world, entities=entities), State(facts)

    def _holders(self, state: State) -> set[str]:
        """Entities that have taken a place in a lent group just now: what is in the hand."""
        lent = frozenset().union(*self._lent.values())
        groups = [g for g in self._groups if any(p.predicate in lent for p in g.patterns)]
        return {
            arg
            for fact in state.facts
            for group in groups
            if fact.predicate not in lent and any(True for _ in group.keys(fact))
            for arg in fact.args
        }

    def _lent_by(self, kind: str) -> frozenset[str] | None:
        """The predicates that entities of a type take and give back; None where they can't be left out."""
        domain = self._world.domain
        if any(kind in parents for other, parents in domain.parents.items() if other != kind):
            return None
        lent: set[str] = set()
        for operator in domain.operators.values():
            if _ranges_over(operator, kind, domain):
                return None
            own = [p.name for p in operator.parameters if domain.fits(kind, p)]
            if len(own) > 1:
                return None
            if own:
                found = self._side_effects(operator, own[0])
                if found is None:
                    return None
                lent |= found
        return frozenset(lent)

    def _side_effects(self, operator: Operator, own: str) -> set[str] | None:
        """The predicates that an operator changes besides facts about its entity, if all are lent."""
        changes = list(conjuncts(operator.effect))
        if not all(isinstance(e, Literal) for e in changes):
            return None
        literals = [e for e in changes if isinstance(e, Literal)]
        about = [e for e in literals if own in e.args]
        found: set[str] = set()
        for effect in literals:
            if own in effect.args:
                continue
            partners = [a for a in about if a.positive is not effect.positive]
            if effect.predicate in self._negative or not self._is_lent(effect, partners):
                return None
            found.add(effect.predicate)
        return found

    def _is_lent(self, effect: Literal, partners: Sequence[Literal]) -> bool:
        """Whether an entity takes (or gives back) the place of a fact in a mutex group."""
        for group in self._groups:
            keys = set(group.keys(effect.atom))
            if not keys or not _is_only_other(effect.predicate, group, partners):
                continue
            if any(not keys.isdisjoint(group.keys(p.atom)) for p in partners):
                return True
        return False


def _is_only_other(predicate: str, group: MutexGroup, partners: Sequence[Literal]) -> bool:
    """Whether a group's value, when no entity has its place, can only be the one fact."""
    taken = {p.predicate for p in partners}
    others = [p for p in group.patterns if p.predicate not in taken]
    return [p.predicate for p in others] == [predicate] and ANY not in others[0].args


def _ranges_over(operator: Operator, kind: str, domain: Domain) -> bool:
    """Whether a quantifier of an operator runs over a type."""
    waiting: list[Formula] = [operator.precondition, operator.effect]
    while waiting:
        formula = waiting.pop()
        if isinstance(formula, Quantified) and any(domain.fits(kind, v) for v in formula.variables):
            return True
        waiting.extend(_parts(formula))
    return False


def _has_quantifier(formula: Formula) -> bool:
    return isinstance(formula, Quantified) or any(_has_quantifier(p) for p in _parts(formula))


def _parts(formula: Formula) -> tuple[Formula, ...]:
    if isinstance(formula, And | Or):
        return formula.parts
    if isinstance(formula, Not):
        return (formula.part,)
    if isinstance(formula, Imply):
        return (formula.condition, formula.conclusion)
    if isinstance(formula, When):
        return (formula.condition, formula.effect)
    if isinstance(formula, Quantified):
        return (formula.body,)
    return ()


def _negative_predicates(domain: Domain) -> Iterator[str]:
    """Predicates that some precondition or condition asks to be false."""
    for operator in domain.operators.values():
        yield from (x.predicate for x in _negative(operator.precondition))
        waiting = [operator.effect]
        while waiting:
            formula = waiting.pop()
            if isinstance(formula, When):
                yield from (x.predicate for x in _negative(formula.condition))
            waiting.extend(_parts(formula))


def _negative(formula: Formula) -> Iterator[Literal]:
    """The literals of a condition that make it true by being false; all of them inside `not` and `imply`."""
    if isinstance(formula, Literal):
        if not formula.positive:
            yield formula
    elif isinstance(formula, Not | Imply):
        yield from literals_in(formula)
    else:
        for part in _parts(formula):
            yield from _negative(part)
