"""Worlds: the entities a robot knows, where they are, what they are called and what is true at the start."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

from polaris_nl.model.domain import KIND, Domain
from polaris_nl.model.formula import Formula, Literal
from polaris_nl.model.state import State

Point = tuple[float, float]
"""x and y on the map, in metres."""


@dataclass(frozen=True, slots=True)
class Entity:
    """A thing, place, person or message.

    Attributes:
        name: unique; hyphens are spoken as spaces.
        type: a type of the domain.
        synonyms: other names, in lower case words.
        noun, adjectives: what "the blue one" goes by.
        kinds: what "all the dishes" goes by.
        owner: the person whose it is ("her table").
        gender: `female`, `male`, or "" (unknown).
        user: this person is the one who speaks ("me").
        area: two opposite corners of a region, in metres.
        pose: x and y in metres and the heading in radians.
    """

    name: str
    type: str
    synonyms: tuple[str, ...] = ()
    noun: str = ""
    adjectives: tuple[str, ...] = ()
    kinds: tuple[str, ...] = ()
    owner: str = ""
    gender: str = ""
    user: bool = False
    area: tuple[Point, Point] | None = None
    pose: tuple[float, float, float] | None = None

    @property
    def spoken(self) -> str:
        """The name as it is said: `blue-cup` is "blue cup"."""
        return self.name.replace("-", " ").replace("_", " ")


@dataclass(frozen=True, slots=True)
class Objective:
    """One of the outcomes that `score` counts."""

    name: str
    goal: Formula


@dataclass(frozen=True, slots=True)
class HumanAction:
    """What a person in this world may do: `effect` once everything in `when` holds."""

    name: str
    effect: tuple[Literal, ...]
    when: tuple[Literal, ...] = ()


@dataclass(frozen=True, slots=True)
class Scenario:
    """What a program in this world is measured by, and what its people do."""

    objectives: tuple[Objective, ...] = ()
    human_actions: tuple[HumanAction, ...] = ()


@dataclass(frozen=True)
class World:
    """A world of a domain.

    Attributes:
        entities: by name, in file order.
        facts: the atoms true at the start.
        map: the ROS map_server YAML file, or None.
        source: the YAML text, as it was read.
    """

    name: str
    domain: Domain
    entities: Mapping[str, Entity]
    facts: frozenset[Literal]
    scenario: Scenario = Scenario()
    map: Path | None = None
    source: str = field(default="", repr=False)
    path: Path | None = None

    @property
    def initial(self) -> State:
        """The state at the start."""
        return State(self.facts)

    def of_type(self, *types: str) -> Iterator[Entity]:
        """The entities of any of some types, in file order; of all types where none is named."""
        found = self._by_types.get(types)
        if found is None:
            # Quantifiers ask for the same few again and again.
            found = self._by_types[types] = tuple(
                entity
                for entity in self.entities.values()
                if not types or any(self.domain.is_a(entity.type, wanted) for wanted in types)
            )
        return iter(found)

    @cached_property
    def _by_types(self) -> dict[tuple[str, ...], tuple[Entity, ...]]:
        """What has been asked for before."""
        return {}

    @cached_property
    def kinds(self) -> Mapping[str, frozenset[str]]:
        """Each kind's members: the `kinds` of entities, and synonyms that several of them share."""
        shared = Counter(s for e in self.entities.values() for s in set(e.synonyms))
        found: dict[str, set[str]] = {}
        for entity in self.entities.values():
            names = {
                *entity.kinds,
                *(s.replace(" ", "-") for s in entity.synonyms if shared[s] > 1),
            }
            for kind in names:
                found.setdefault(kind, set()).add(entity.name)
        return {kind: frozenset(members) for kind, members in found.items()}

    def is_kind(self, entity: str, kind: str) -> bool:
        """Whether `(kind entity kind)` holds: by its kinds, its type, its noun or its name."""
        if entity in self.kinds.get(kind, ()):
            return True
        known = self.entities.get(entity)
        return known is not None and kind in (known.type, known.noun, known.name)

    def holds(self, atom: Literal, state: State) -> bool:
        """Whether a ground atom is true in a state of this world, `kind` included."""
        if atom.predicate == KIND and len(atom.args) == 2:
            return self.is_kind(*atom.args)
        return atom in state

    @property
    def user(self) -> Entity | None:
        """The person who speaks, or None where the world doesn't say."""
        return next((e for e in self.entities.values() if e.user), None)

    def place_of(self, name: str, state: State) -> str | None:
        """The region where an entity is, through surface, container, hand or person; None if unknown."""
        seen = {name}
        while True:
            if name in self.entities and self.entities[name].type == "region":
                return name
            upper = next((t for t in self._holders(name, state) if t not in seen), None)
            if upper is None:
                return None
            seen.add(upper)
            name = upper

    def _holders(self, name: str, state: State) -> Iterator[str]:
        for fact in sorted(state.facts):
            if fact.predicate in ("at", "in", "located", "person-in") and fact.args[:1] == (name,):
                yield fact.args[1]
            elif fact.predicate == "has" and fact.args[1:] == (name,):
                yield fact.args[0]
            elif fact == Literal("holding", (name,)):
                yield from (f.args[0] for f in sorted(state.facts) if f.predicate == "robot-at")
