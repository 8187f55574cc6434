"""Phrases for a recogniser: the grammar's wordings with the world's names, as a list of what may be said.

A recogniser makes of them which word may follow which, and recombines. So what matters is that
every choice of every wording and every name occurs, between many different neighbours; not that
every combination does.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from polaris_nl.language.grammar import Grammar
from polaris_nl.language.predicate_phrases import Phrases
from polaris_nl.language.template import Choice, Part, Parts, Slot, Word
from polaris_nl.language.tokens import phrase
from polaris_nl.model.domain import Predicate
from polaris_nl.model.world import World

MOST = 20_000
PER_CHOICE = 2
"""How often each choice of a wording occurs, where there is room."""
COMPOSED = 4_000
"""Phrases of two clauses, so that the ways from one clause into the next are heard too."""

_Names = Mapping[str, Sequence[tuple[str, ...]]]

_PRONOUNS: dict[str, tuple[tuple[str, ...], ...]] = {
    "object": (("it",), ("them",), ("that",)),
    "person": (("she",), ("he",), ("her",), ("him",), ("me",), ("they",)),
    "message": (("it",), ("that",)),
}
_LEADS: dict[str, tuple[tuple[str, ...], ...]] = {
    "object": (("the",), ("a",), ("the", "full"), ("a", "full"), ("both",)),
    "surface": (("the",), ("her",), ("his",), ("my",)),
    "region": (("the",), (), ("her",)),
    "person": (("the",), ()),
    "message": ((), ("that",)),
}
_SOFTENERS: tuple[tuple[str, ...], ...] = ((), (), ("just",), ("please",), ("then",), ("and",))


def recogniser_phrases(world: World, grammar: Grammar) -> tuple[str, ...]:
    """At most 20,000 phrases in a fixed order: controls, names, clauses, then pairs of clauses."""
    maker = _Maker(world, grammar)
    found = dict.fromkeys(_text(words) for words in maker.fixed())
    clauses = maker.clauses(MOST - len(found) - COMPOSED)
    for words in itertools.chain(clauses, maker.composed()):
        found[_text(words)] = None
        if len(found) >= MOST:
            break
    found.pop("", None)
    return tuple(found)


def _text(words: Iterable[str]) -> str:
    return " ".join(words).replace(" 's", "'s").replace(" n't", "n't").replace(" 't", "'t").strip()


@dataclass
class _Source:
    """A wording that phrases are drawn from, over and over, so that every choice comes up in turn."""

    parts: Parts
    kind: str
    types: Mapping[str, Sequence[str]] = field(default_factory=dict)
    drawn: int = 0


class _Maker:
    def __init__(self, world: World, grammar: Grammar) -> None:
        self._grammar = grammar
        self._names: _Names = {
            kind: [
                words
                for e in world.of_type(kind)
                for words in dict.fromkeys(map(phrase, (e.spoken, *e.synonyms)))
            ]
            for kind in world.domain.types
        }
        self._fillers: dict[tuple[str, ...], list[tuple[str, ...]]] = {}
        self._sources = [
            source
            for phrases in grammar.predicates.values()
            if phrases.predicate in world.domain.predicates
            for source in _sources(phrases, world.domain.predicates[phrases.predicate])
        ]
        common = grammar.common
        self._ifs = common.connectives["if"][::-1]  # short ones first
        self._thens = common.connectives["then"][::-1]

    def fixed(self) -> Iterator[Sequence[str]]:
        """Commands, connectives, and every name by itself."""
        common = self._grammar.common
        for command in common.of_kind("command"):
            yield from command.phrases
        yield from common.neither
        for phrases in common.connectives.values():
            yield from phrases
        yield from (*common.fillers, *common.assure)
        for kind, names in self._names.items():
            for words in names:
                yield words
                yield from ((*lead, *words) for lead in _LEADS.get(kind, (("the",),)))
        for intent in (i for i in common.intents if i.kind != "command"):
            for template in intent.wordings:
                count = 12 if intent.kind == "correction" else 6
                yield from self._drawn(_Source(template, intent.kind), count)

    def clauses(self, room: int) -> Iterator[Sequence[str]]:
        """Goals, conditions and questions about facts, from every wording as many as it has choices."""
        wanted = [
            (source, PER_CHOICE * max(self._width(source.parts, source), 4))
            for source in self._sources
        ]
        scale = min(room / max(sum(count for _, count in wanted), 1), 1.0)
        for source, count in wanted:
            for number, words in enumerate(self._drawn(source, max(round(count * scale), 4))):
                if source.kind in ("states", "not-states"):
                    yield (*self._ifs[number % len(self._ifs)], *words)
                else:
                    yield (*_SOFTENERS[number % len(_SOFTENERS)], *words)

    def composed(self) -> Iterator[Sequence[str]]:
        """Two clauses at a time: "if E, G" and "G then G"."""
        events = [s for s in self._sources if s.kind == "states"]
        goals = [s for s in self._sources if s.kind == "goals"]
        for number in range(COMPOSED if goals else 0):
            goal = self._draw(goals[number % len(goals)])
            soft = _SOFTENERS[number // 2 % len(_SOFTENERS)]
            if number % 2 and events:
                event = self._draw(events[number // 2 % len(events)])
                mark = self._ifs[number // 2 % len(self._ifs)]
                yield (*mark, *event, *soft, *goal)
            else:
                following = self._draw(goals[number * 7 % len(goals)])
                yield (*goal, *self._thens[number // 2 % len(self._thens)], *following)

    def _drawn(self, source: _Source, count: int) -> Iterator[tuple[str, ...]]:
        return (self._draw(source) for _ in range(count))

    def _draw(self, source: _Source) -> tuple[str, ...]:
        words = self._pick(source.parts.parts, source, source.drawn)
        source.drawn += 1
        return tuple(words)

    def _pick(self, parts: Sequence[Part], source: _Source, turn: int) -> list[str]:
        words: list[str] = []
        for place, part in enumerate(parts):
            if isinstance(part, Word):
                words.append(part.text)
            elif isinstance(part, Slot):
                fillers = self._slot(part, source)
                if fillers:
                    words.extend(fillers[_turned(turn, place, len(fillers))])
            else:
                option = part.options[_turned(turn, place, len(part.options))]
                words.extend(self._pick(option.parts, source, turn // len(part.options)))
        return words

    def _width(self, part: Part | Parts, source: _Source) -> int:
        """The most choices in any one place."""
        if isinstance(part, Word):
            return 1
        if isinstance(part, Slot):
            return len(self._slot(part, source))
        if isinstance(part, Choice):
            return len(part.options) * max(
                (self._width(o, source) for o in part.options), default=1
            )
        return max((self._width(p, source) for p in part.parts), default=1)

    def _slot(self, slot: Slot, source: _Source) -> list[tuple[str, ...]]:
        kinds = (
            (slot.type,)
            if slot.type
            else tuple(source.types.get(slot.name, ())) or tuple(self._names)
        )
        if kinds not in self._fillers:
            found: list[tuple[str, ...]] = []
            for kind in kinds:
                found.extend(_PRONOUNS.get(kind, ()))
                leads = _LEADS.get(kind, (("the",),))
                for number, words in enumerate(self._names.get(kind, ())):
                    found.append((*leads[0], *words))
                    found.append((*leads[number % len(leads)], *words))
            self._fillers[kinds] = list(dict.fromkeys(found))
        return self._fillers[kinds]


def _sources(phrases: Phrases, predicate: Predicate) -> Iterator[_Source]:
    types = {p.name.lstrip("?"): p.types for p in predicate.parameters}
    for kind, templates in phrases.wordings.items():
        for template in templates:
            yield _Source(template, kind, types)


def _turned(turn: int, place: int, count: int) -> int:
    """Which of `count` choices comes up: each once a round, shifted by its place from round to round.

    Without the shift, neighbours with equally many choices would always meet the same partner.
    """
    return (turn + turn // count * (place + 1) + place) % count
