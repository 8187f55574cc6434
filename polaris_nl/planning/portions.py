"""Parts of a checkpoint's goals: what is left of them when some of their literals are given up.

A goal for all of a kind stays one, with an exception ("every dish but the cup"), so that it still
follows the world; only where little of it is left does it become the literals that are.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass, replace

from polaris_nl.model.domain import conjuncts
from polaris_nl.model.evaluate import instances_of
from polaris_nl.model.formula import (
    And,
    Equal,
    Formula,
    Goal,
    Imply,
    Literal,
    Not,
    Quantified,
)
from polaris_nl.model.goals import choices, leaves_a_choice
from polaris_nl.model.state import State
from polaris_nl.model.world import Entity, World


@dataclass(frozen=True)
class Portions:
    """The goals of a checkpoint, and the literals that each of them asks for.

    Attributes:
        literals: what is planned for.
        parts: each goal with its literals among them, in the goals' order.
    """

    world: World
    literals: tuple[Literal, ...]
    parts: tuple[tuple[Goal, tuple[Literal, ...]], ...]

    @classmethod
    def of(
        cls, goals: Sequence[Goal], literals: tuple[Literal, ...], state: State, world: World
    ) -> Portions:
        """Finds which goal asks for which of the literals that are planned for."""
        wanted = set(literals)
        parts = []
        for goal in (part for whole in goals for part in conjuncts(whole)):
            ways = choices((goal,), state, world)
            found = next((way for way in ways if wanted.issuperset(way)), ())
            parts.append((goal, found))
        return cls(world, literals, tuple(parts))

    def only(self, wanted: Collection[Literal]) -> tuple[Goal, ...]:
        """Goals that ask for some of the literals and for no others."""
        found: dict[Goal, None] = {}
        for goal, literals in self.parts:
            kept = [x for x in literals if x in wanted]
            gone = [x for x in literals if x not in wanted]
            if not gone:
                found[goal] = None
                continue
            whole = self._but(goal, gone) if len(kept) > len(gone) else None
            found.update(dict.fromkeys(kept if whole is None else (whole,)))
        return tuple(found)

    def said(self, wanted: Collection[Literal]) -> tuple[Goal, ...]:
        """The same goals for putting into words: the things that were chosen, where there was a choice."""
        found: dict[Goal, None] = {}
        for goal in self.only(wanted):
            chosen = next((some for part, some in self.parts if part == goal), ())
            found.update(dict.fromkeys(chosen if leaves_a_choice(goal) else (goal,)))
        return tuple(found)

    def changed(self, old: Literal, new: Literal) -> tuple[Goal, ...] | None:
        """The goals with another literal in the place of one; None where no goal is that literal."""
        goals = [goal for goal, _ in self.parts]
        if old not in goals or new in goals:
            return None
        return tuple(new if goal == old else goal for goal in goals)

    def _but(self, goal: Goal, gone: Sequence[Literal]) -> Goal | None:
        """A goal for all of a kind, with exceptions; None where it has another form."""
        if not isinstance(goal, Quantified) or goal.quantifier != "forall":
            return None
        if len(goal.variables) != 1:
            return None
        name = goal.variables[0].name
        entities = [e.name for e in self.world.of_type(*goal.variables[0].types)]
        excepted = [
            entity
            for entity, body in zip(entities, instances_of(goal, self.world), strict=True)
            if not _literals(body).isdisjoint(gone)
        ]
        body = goal.body if isinstance(goal.body, Imply) else Imply(And(()), goal.body)
        but = (Not(Equal(name, entity)) for entity in excepted)
        condition = And((*conjuncts(body.condition), *but))
        return replace(goal, body=Imply(condition, body.conclusion))


def _literals(body: Formula) -> set[Literal]:
    conclusion = body.conclusion if isinstance(body, Imply) else body
    return {part for part in conjuncts(conclusion) if isinstance(part, Literal)}


def with_entity(goal: Literal, old: str, new: str) -> Literal:
    """A literal about another entity."""
    return replace(goal, args=tuple(new if a == old else a for a in goal.args))


PLACES = ("surface", "container")
"""Types of which one may stand for any other: something can be put there as well."""


def near(name: str, world: World, state: State) -> Iterator[str]:
    """What a person may take in the place of an entity: one of a kind or noun with it, or another place.

    Yields:
        Names, those with most in common first, and of these the ones in the same region.
    """
    entity = world.entities.get(name)
    if entity is None:
        return
    region = world.place_of(name, state)
    kinds = {*entity.kinds, entity.noun or entity.name}

    def shared(other: Entity) -> int:
        return len(kinds & {*other.kinds, other.noun or other.name})

    others = [e for e in world.of_type(entity.type) if e.name != name]
    alike = [e for e in others if entity.type in PLACES or shared(e)]
    alike.sort(key=lambda e: (-shared(e), world.place_of(e.name, state) != region))
    yield from (e.name for e in alike)
