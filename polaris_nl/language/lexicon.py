"""The words of a world: every phrase that an entity goes by, found in an utterance."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from polaris_nl.language.mention import Candidate
from polaris_nl.language.tokens import phrase
from polaris_nl.model.world import Entity, World

_IRREGULAR = {
    "people": "person",
    "knives": "knife",
    "shelves": "shelf",
    "children": "child",
    "glasses": "glass",
}
_TYPE_NOUNS = {
    "region": ("room", "place", "area"),
    "person": (
        "person",
        "somebody",
        "someone",
        "anybody",
        "anyone",
        "everybody",
        "everyone",
        "nobody",
    ),
    "object": (
        "object",
        "thing",
        "item",
        "everything",
        "whatever",
        "anything",
        "something",
        "nothing",
    ),
    "container": ("container", "everything"),
    "surface": ("surface",),
    "message": ("message",),
}


@dataclass(frozen=True, slots=True)
class Entry:
    """What a phrase can mean.

    Attributes:
        candidates: by entity, the best rank.
        plural: the phrase is a plural.
        kind: the kind, noun or type it names, or "".
    """

    candidates: tuple[Candidate, ...]
    plural: bool = False
    kind: str = ""


@dataclass
class _Draft:
    ranks: dict[str, int] = field(default_factory=dict)
    plural: bool = False
    kind: str = ""


class Lexicon:
    """The phrases of a world, in a trie of words."""

    def __init__(self, world: World) -> None:
        self.places = frozenset(
            e.name for e in world.entities.values() if e.type in ("surface", "container")
        )
        """Where things can be."""
        self.regions = frozenset(e.name for e in world.entities.values() if e.type == "region")
        """Where the robot can be."""
        drafts: dict[tuple[str, ...], _Draft] = {}
        for entity in world.entities.values():
            for words, rank, kind in _phrases(entity):
                _add(drafts, words, entity.name, rank, kind)
        for words, name in _by_region(world):
            _add(drafts, words, name, 1, "")
        for kind, members in world.kinds.items():
            for name in sorted(members):
                _add(drafts, phrase(kind), name, 2, kind)
        for kind, nouns in _TYPE_NOUNS.items():
            known = kind in world.domain.types
            typed = sorted(e.name for e in world.of_type(kind)) if known else []
            for noun, name in itertools.product(nouns, typed):
                _add(drafts, (noun,), name, 3, kind)
        for words, draft in list(drafts.items()):
            for plural in _plurals(words):
                if plural not in drafts:
                    drafts[plural] = _Draft(dict(draft.ranks), True, draft.kind or "-".join(words))
        self._entries: Mapping[tuple[str, ...], Entry] = {
            words: Entry(
                tuple(
                    Candidate(e, r)
                    for e, r in sorted(draft.ranks.items(), key=lambda i: (i[1], i[0]))
                ),
                draft.plural,
                draft.kind,
            )
            for words, draft in drafts.items()
        }
        self.longest = max((len(words) for words in self._entries), default=0)
        self.vocabulary = frozenset(w for words in self._entries for w in words)
        self._starts = frozenset(words[0] for words in self._entries)

    def at(self, tokens: Sequence[str], start: int) -> Iterator[tuple[int, Entry]]:
        """The phrases that start at a position, the longest first: (end, entry)."""
        if start >= len(tokens) or tokens[start] not in self._starts:
            return
        for end in range(min(len(tokens), start + self.longest), start, -1):
            entry = self._entries.get(tuple(tokens[start:end]))
            if entry is not None:
                yield end, entry

    def phrases(self) -> Iterable[tuple[str, ...]]:
        """All phrases."""
        return self._entries


def _phrases(entity: Entity) -> Iterator[tuple[tuple[str, ...], int, str]]:
    """Every phrase of an entity with its rank and the kind it names."""
    yield phrase(entity.spoken), 0, ""
    for synonym in entity.synonyms:
        yield phrase(synonym), 1, ""
    noun = phrase(entity.noun) if entity.noun else ()
    if not noun:
        return
    for synonym in entity.synonyms:  # "Blue mug" makes it a mug.
        first, *rest = phrase(synonym)
        if rest and first in entity.adjectives:
            yield tuple(rest), 2, entity.noun
    yield noun, 2, entity.noun
    for size in range(1, len(entity.adjectives) + 1):
        for some in itertools.permutations(entity.adjectives, size):
            adjectives = tuple(w for a in some for w in phrase(a))
            yield (*adjectives, *noun), 1, ""
            yield (*adjectives, "one"), 2, ""


def _by_region(world: World) -> Iterator[tuple[tuple[str, ...], str]]:
    """`kitchen worktop`, `pantry shelf`: what stands somewhere, by the name of the room before its own."""
    for fact in sorted(world.facts):
        if fact.predicate != "located":
            continue
        thing, region = (world.entities[name] for name in fact.args)
        for name in filter(None, (thing.spoken, thing.noun, *thing.synonyms)):
            for room in (region.spoken, *region.synonyms):
                if not {*phrase(room)} & {*phrase(name)}:
                    yield (*phrase(room), *phrase(name)), thing.name


def _add(
    drafts: dict[tuple[str, ...], _Draft], words: tuple[str, ...], entity: str, rank: int, kind: str
) -> None:
    if words:
        draft = drafts.setdefault(words, _Draft())
        draft.ranks[entity] = min(rank, draft.ranks.get(entity, rank))
        draft.kind = draft.kind or kind


def _plurals(words: tuple[str, ...]) -> Iterator[tuple[str, ...]]:
    last = words[-1]
    for plural, singular in _IRREGULAR.items():
        if singular == last:
            yield (*words[:-1], plural)
    if last.endswith(("s", "x", "ch", "sh")):
        yield (*words[:-1], last + "es")
    elif last.endswith("y") and last[-2:-1] not in "aeiou":
        yield (*words[:-1], last[:-1] + "ies")
    elif last not in ("everything",):
        yield (*words[:-1], last + "s")
