"""Phrases for a recogniser: the grammar's wordings with the world's names, as a list of what may be said.

A recogniser makes of them which word may follow which, so every pair of neighbours has to occur somewhere; not
every combination has to.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence

from polaris_nl.language.grammar import Grammar, Phrases
from polaris_nl.language.template import Choice, Part, Sequence_, Slot, Word
from polaris_nl.language.tokens import phrase
from polaris_nl.model.domain import Predicate
from polaris_nl.model.world import World

MOST = 20_000
_SPOKEN = {"'s": "'s", "not": "not"}


def recogniser_phrases(world: World, grammar: Grammar) -> tuple[str, ...]:
    """At most 20,000 phrases in a fixed order: controls first, then goals, conditions and names."""
    found: dict[str, None] = {}
    for text in itertools.islice(_all(world, grammar), MOST * 3):
        joined = " ".join(text).replace(" 's", "'s").strip()
        if joined:
            found[joined] = None
        if len(found) >= MOST:
            break
    return tuple(found)


def _all(world: World, grammar: Grammar) -> Iterator[Sequence[str]]:
    common = grammar.common
    for command in common.mapping("commands"):
        yield from common.words("commands", command)
    yield from common.words("neither")
    for mark in common.mapping("connectives"):
        yield from common.words("connectives", mark)
    names = {kind: [words for e in world.of_type(kind) for words in _names(e.spoken, e.synonyms)]
             for kind in world.domain.types}
    for kind in names:
        for words in names[kind]:
            yield ("the", *words)
            yield words
    for phrases in grammar.predicates.values():
        predicate = world.domain.predicates.get(phrases.predicate)
        if predicate is not None:
            yield from _predicate(phrases, predicate, names, common.words("connectives", "if")[-12:])
    for section in ("corrections",):
        for template in common.templates(section):
            yield from _sampled(template.parts, {}, names, 30)


def _names(spoken: str, synonyms: Sequence[str]) -> Iterator[tuple[str, ...]]:
    yield phrase(spoken)
    for synonym in synonyms:
        yield phrase(synonym)


def _predicate(
    phrases: Phrases, predicate: Predicate, names: dict[str, list[tuple[str, ...]]], ifs: Sequence[tuple[str, ...]]
) -> Iterator[Sequence[str]]:
    types = {p.name.lstrip("?"): p.types for p in predicate.parameters}
    for kind, templates in phrases.wordings.items():
        for template in templates:
            for number, words in enumerate(_sampled(template.parts, types, names, 240)):
                yield words
                if kind in ("states", "not-states"):
                    yield (*ifs[number % len(ifs)], *words)
                elif kind == "goals":
                    yield (("then", "and", "and then")[number % 3], *words)


def _sampled(
    parts: Sequence[Part], types: dict[str, Sequence[str]], names: dict[str, list[tuple[str, ...]]], count: int
) -> Iterator[tuple[str, ...]]:
    """Some expansions of a wording in which every choice and every name occurs, as far as the count goes."""
    widest = max((_width(part, types, names) for part in parts), default=1)
    for turn in range(min(count, max(widest * 2, 8))):
        words: list[str] = []
        for place, part in enumerate(parts):
            words.extend(_pick(part, turn * (place + 1) + place, types, names))
        yield tuple(words)


def _width(part: Part, types: dict[str, Sequence[str]], names: dict[str, list[tuple[str, ...]]]) -> int:
    if isinstance(part, Word):
        return 1
    if isinstance(part, Slot):
        return len(_fillers(part, types, names))
    return sum(max((_width(p, types, names) for p in option.parts), default=1) for option in part.options)


def _pick(
    part: Part | Sequence_, turn: int, types: dict[str, Sequence[str]], names: dict[str, list[tuple[str, ...]]]
) -> tuple[str, ...]:
    if isinstance(part, Word):
        return (part.text,)
    if isinstance(part, Slot):
        fillers = _fillers(part, types, names)
        return fillers[turn % len(fillers)] if fillers else ()
    if isinstance(part, Choice):
        option = part.options[turn % len(part.options)]
        return _pick(option, turn // len(part.options), types, names)
    return tuple(w for p in part.parts for w in _pick(p, turn, types, names))


_PRONOUNS = {
    "object": (("it",), ("them",)),
    "person": (("she",), ("he",), ("her",), ("him",), ("me",)),
    "message": (("it",),),
}
_LEADS: dict[str, tuple[tuple[str, ...], ...]] = {
    "object": (("the",), ("a",), ("the", "full"), ("a", "full")),
    "surface": (("the",), ("her",), ("his",), ("my",)),
    "region": (("the",), (), ("her",)),
    "person": (("the",), ()),
    "container": (("the",),),
    "message": ((),),
}


def _fillers(
    slot: Slot, types: dict[str, Sequence[str]], names: dict[str, list[tuple[str, ...]]]
) -> list[tuple[str, ...]]:
    kinds = (slot.type,) if slot.type else types.get(slot.name) or tuple(names)
    found: list[tuple[str, ...]] = []
    for kind in kinds:
        found.extend(_PRONOUNS.get(kind, ()))
        leads = _LEADS.get(kind, (("the",),))
        for number, words in enumerate(names.get(kind, ())):
            found.append((*leads[0], *words))
            found.append((*leads[number % len(leads)], *words))
    return list(dict.fromkeys(found))
