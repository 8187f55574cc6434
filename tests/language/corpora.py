"""Sentences by people, kept beside the checkout: their worlds, and what was annotated.

Nothing of the sentences is in the repository. The folder is `../shared/corpora` as seen from the
checkout, or what `POLARIS_NL_CORPORA` names.
"""

from __future__ import annotations

import json
import os
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any

from polaris_nl.language.ordinary import is_ordinary
from polaris_nl.model.domain import Domain
from polaris_nl.model.formula import Literal
from polaris_nl.model.pddl import read_domain
from polaris_nl.model.world import Entity, World

ROOT = Path(__file__).parents[2]
VARIABLE = "POLARIS_NL_CORPORA"
LARGER = ("huric", "lanmp", "gpsr2018_generated", "lang2ltl_lifted", "clinc_refusal")
EVERY = 3
"""How many there are of a kind that a sentence wants all of."""


def folder() -> Path:
    """Where the corpora are, whether or not they are there."""
    return Path(os.environ.get(VARIABLE) or ROOT.parent / "shared" / "corpora")


def missing() -> str:
    """Why the corpora can't be read, as a sentence; "" where they can."""
    if (folder() / "world.json").is_file() and (folder() / "annotated_goals.jsonl").is_file():
        return ""
    return f"There are no corpora at {folder()}; {VARIABLE} names another folder."


def spoken(text: str) -> str:
    """A text in speech form: lower case, and no punctuation but apostrophes."""
    return " ".join(re.sub(r"[^a-z0-9' ]+", " ", text.lower().replace("’", "'")).split())


# Sentences


@dataclass(frozen=True)
class Sentence:
    """A sentence of a corpus.

    Attributes:
        expected: what the corpus itself says of it.
    """

    id: str
    text: str
    source: str
    expected: Mapping[str, Any] = field(default_factory=dict, hash=False, compare=False)


@dataclass(frozen=True)
class Wanted:
    """A goal that was annotated.

    Attributes:
        literal: the goal, with `?x` for what is counted.
        kind: what is counted, or "".
        number: how many of the kind, 0 for all of them.
        others: goals of which one is as good ("via green or yellow").
    """

    literal: Literal
    kind: str = ""
    number: int = 0
    others: tuple[Literal, ...] = ()


@dataclass(frozen=True)
class Step:
    """Goals that were annotated as one step, and the condition they wait for."""

    goals: tuple[Wanted, ...]
    when: frozenset[Literal] = frozenset()


@dataclass(frozen=True)
class Annotated:
    """A sentence with the goals that it asks for.

    Attributes:
        outcome: `parse`, `clarify` or `refuse`.
        steps: in order, unless `unordered`.
        instead: goal sets that the notes say are as good as the steps'.
        entities: the entities of the master list that it needs, as they are called there.
        notes: what the annotator remarked.
    """

    id: str
    text: str
    outcome: str
    steps: tuple[Step, ...]
    unordered: bool
    instead: tuple[tuple[Wanted, ...], ...]
    entities: tuple[str, ...]
    notes: str

    @property
    def goals(self) -> tuple[Wanted, ...]:
        """The goals of all steps."""
        return tuple(goal for step in self.steps for goal in step.goals)


def annotated() -> list[Annotated]:
    """The annotated sentences."""
    return [_annotated(item) for item in _lines("annotated_goals")]


def sentences(corpus: str) -> list[Sentence]:
    """The sentences of one of the larger corpora; propositions are rooms."""
    found = []
    for item in _lines(corpus):
        expected = item["expected"]
        text = _with_rooms(item["text"], expected) if "rooms" in expected else item["text"]
        found.append(Sentence(item["id"], text, corpus, expected))
    return found


def _lines(corpus: str) -> Iterator[dict[str, Any]]:
    path = folder() / f"{corpus}.jsonl"
    for line in path.read_text(encoding="utf-8").splitlines() if path.is_file() else ():
        if line.strip():
            yield json.loads(line)


_AFTER_ARTICLE = (
    "specific", "particular", "certain", "single", "time", "way", "row", "moment", "point", "minimum",
    "maximum", "total", "location", "place", "future", "later", "different", "given",
)  # fmt: skip


def _with_rooms(text: str, expected: Mapping[str, Any]) -> str:
    """A lifted sentence with rooms for its letters; "a" may be an article, too."""
    if expected.get("text_with_rooms"):
        return str(expected["text_with_rooms"])
    rooms: Mapping[str, str] = expected["rooms"]
    words = text.split()
    for at, following in enumerate([*words[1:], ""]):
        if words[at] in rooms and not (words[at] == "a" and following in _AFTER_ARTICLE):
            words[at] = rooms[words[at]]
    return " ".join(words)


# What was annotated

_PREDICATES = {
    "robot_at": "robot-at", "alerted": "alerted-to", "clean": "is-clean", "full": "is-full",
    "hot": "is-hot", "cold": "is-cold", "sliced": "is-sliced",
}  # fmt: skip
_NEGATIONS = {"closed": "open", "off": "on", "empty": "is-full", "dirty": "is-clean"}
_INSTEAD = re.compile(r"accept (\w+\([^()]*\))|(\w+\([^()]*\)) equally right")


def _annotated(item: Mapping[str, Any]) -> Annotated:
    notes = str(item["notes"])
    named = item["world"]
    return Annotated(
        item["id"],
        item["text"],
        item["outcome"],
        tuple(_step(step) for step in item["steps"]) or _one_step(item["goals"]),
        item["structure"] == "unordered",
        tuple((_wanted(a or b),) for a, b in _INSTEAD.findall(notes) if "..." not in (a or b)),
        tuple(
            dict.fromkeys(
                e for kind, names in named.items() if kind != "unresolvable" for e in names
            )
        ),
        notes,
    )


def _one_step(goals: Sequence[str]) -> tuple[Step, ...]:
    return (Step(tuple(_wanted(goal) for goal in goals)),) if goals else ()


def _step(item: Mapping[str, Any]) -> Step:
    goals = [_wanted(goal) for goal in item.get("goals", ())]
    if "any_of" in item:
        first, *others = (_wanted(goal).literal for goal in item["any_of"])
        goals.append(Wanted(first, others=tuple(others)))
    when = item["when"]
    conditions = [when] if isinstance(when, str) else when or []
    return Step(tuple(goals), frozenset(_wanted(c).literal for c in conditions))


def _wanted(text: str) -> Wanted:
    text = text.strip()
    if text.startswith("not "):
        return Wanted(_wanted(text[4:]).literal.negation)
    name, _, rest = text.partition("(")
    inner = rest.rsplit(")", 1)[0]
    if name == "count":
        number, kind, goal = inner.split(",", 2)
        return Wanted(_wanted(goal).literal, _named(kind), int(number))
    if name == "forall":
        kind, goal = inner.split(",", 1)
        return Wanted(_wanted(goal).literal, _named(kind))
    args = tuple(_named(arg) for arg in inner.split(",") if arg.strip())
    if name == "at" and args[1] in _regions():
        return Wanted(Literal("in-room", args))
    if name in _NEGATIONS:
        return Wanted(Literal(_NEGATIONS[name], args, False))
    return Wanted(Literal(_PREDICATES.get(name, name.replace("_", "-")), args))


def _named(name: str) -> str:
    return name.strip().replace("_", "-")


# Worlds


@cache
def _master() -> Mapping[str, Any]:
    loaded: Mapping[str, Any] = json.loads((folder() / "world.json").read_text(encoding="utf-8"))
    return loaded


@cache
def _regions() -> frozenset[str]:
    return frozenset(_named(name) for name in _master()["regions"])


@cache
def house() -> Domain:
    """The domain of the tests that has a predicate for everything that is annotated."""
    return read_domain(Path(__file__).parent / "household" / "domain.pddl")


_TYPES = {
    ("object", ""): "object", ("container", "object"): "vessel", ("container", "surface"): "unit",
    ("container", ""): "container", ("surface", "object"): "dish", ("surface", ""): "surface",
    ("region", ""): "region", ("person", ""): "person",
}  # fmt: skip
_PRONOUNS = ("me", "my", "us", "i", "you", "robot")


def _entities(names: Iterable[str]) -> dict[str, Entity]:
    """Entities of the master list."""
    found = {}
    for name in dict.fromkeys(names):
        item = _master()["entities"][name]
        found[_named(name)] = Entity(
            _named(name),
            _TYPES[item["category"], item.get("also", "")],
            tuple(s.lower() for s in item["synonyms"] if s not in _PRONOUNS),
            user=name == "user",
        )
    for name, texts in _master()["topics"].items():
        if name == "message":  # It stands for one that nobody knows: "this message".
            continue
        found[_named(name)] = Entity(_named(name), "message", tuple(texts))
    return found


def _world(name: str, entities: Mapping[str, Entity]) -> World:
    facts = [Literal("hand-empty"), *(Literal("robot-at", (e,)) for e in entities if e == "home")]
    return World(name, house(), entities, frozenset(facts))


def world_of(sentence: Annotated, whole: bool = False) -> World:
    """The world of an annotated sentence: the entities that it lists, or all there are.

    Where it counts things of a kind there are as many as it wants; where it wants all, a few.
    """
    names = list(_master()["entities"]) if whole else ["user", "home", *sentence.entities]
    entities = _entities(names)
    for goal in sentence.goals:
        if goal.kind in entities:
            one = entities.pop(goal.kind)
            entities.update((e.name, e) for e in _several(one, goal.number or EVERY))
    return _world("annotated", entities)


def _several(one: Entity, number: int) -> Iterator[Entity]:
    plurals = (f"{one.spoken}s", f"{one.spoken}es")
    kinds = (one.name, *(s.replace(" ", "-") for s in one.synonyms if s not in plurals))
    for at in range(1, number + 1):
        yield Entity(f"{one.name}-{at}", one.type, noun=one.spoken, kinds=kinds)


_NOUNS = {
    "region": "kitchen bathroom bedroom room hall corridor hallway garden pantry studio house building stairs "
    "office lounge garage cellar laundry",
    "surface": "table desk bed couch sofa chair armchair shelf bookshelf counter bench stand bedstand rack "
    "dresser fireplace stove window door wall corner floor television tv mirror drawers shelves deck bar",
    "unit": "sink drawer cabinet cupboard closet wardrobe nightstand microwave oven bathtub freezer furniture "
    "shower toilet",
    "container": "fridge dishwasher machine bin can",
    "vessel": "bottle cup mug glass bowl jar box bag pot pan kettle case tray",
    "dish": "plate dish",
    "person": "person man woman boy girl",
    "message": "message",
}
_TYPE_OF_NOUN = {noun: kind for kind, nouns in _NOUNS.items() for noun in nouns.split()}


def world_for(corpus: str, found: Iterable[Sentence]) -> World:
    """One world for all sentences of a corpus: the master list, and what the corpus names besides."""
    entities = _entities(_master()["entities"])
    taken = {name for e in entities.values() for name in (e.spoken, *e.synonyms)}
    for sentence in found:
        for names, kind in _mentioned(sentence):
            fresh = [n for n in dict.fromkeys(names) if n not in taken and n not in _PRONOUNS]
            if not fresh or (len(fresh) < len(names) and names[0] in taken):
                continue
            taken.update(fresh)
            entity = Entity(
                fresh[0].replace(" ", "-"),
                kind or _TYPE_OF_NOUN.get(fresh[0].split()[-1], "object"),
                tuple(fresh[1:]),
            )
            entities.setdefault(entity.name, entity)
    return _world(corpus, entities)


def _mentioned(sentence: Sentence) -> Iterator[tuple[list[str], str]]:
    """What a corpus says is in the world of a sentence: names, and the type where it is told."""
    expected = sentence.expected
    for item in expected.get("map_entities", ()):
        if item["type"] != "Robot":
            kind = "person" if item["type"] == "Person" else ""
            yield [n.lower().replace("_", " ") for n in item["names"]], kind
    for key in ("object", "receptacle"):
        words = str(expected.get(key) or "").split("_")
        if all(is_ordinary(word) for word in words):
            yield [" ".join(words)], ""
    for what, name in re.findall(
        r'\( (\w+) (?:\$\d )?" ([^"]+) "', expected.get("logical_form", "")
    ):
        if what in ("is_a", "at", "name", "say"):
            yield [name.lower()], {"name": "person", "say": "message"}.get(what, "")
