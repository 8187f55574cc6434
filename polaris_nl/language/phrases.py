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
from polaris_nl.language.said import Open
from polaris_nl.language.template import NAMED, Choice, Part, Parts, Slot, Word
from polaris_nl.language.tokens import phrase
from polaris_nl.model.domain import Predicate
from polaris_nl.model.text import plural_of
from polaris_nl.model.world import Entity, World

MOST, PLAIN = 28_000, 7_000
"""Phrases of all, and of plain ones."""
PER_CHOICE = 2
"""How often each choice of a wording occurs, where there is room."""
OFTEN = 4
"""After so many names comes a pronoun again: no name is said as often."""
SAID, MOST_SAID = 50, 40_000
"""How often each of the requests comes up that people have made, and how often all of them at most."""
COMPOSED = 5_000
"""Phrases of two clauses, so that the ways from one clause into the next are heard too."""

_Names = Mapping[str, Sequence[tuple[str, ...]]]

_PRONOUNS: dict[str, tuple[tuple[str, ...], ...]] = {
    "object": (("it",), ("them",), ("that",)),
    "person": (("she",), ("he",), ("her",), ("him",), ("me",), ("they",)),
    "message": (("it",), ("that",)),
}
_LEADS: dict[str, tuple[tuple[str, ...], ...]] = {
    "object": (
        ("the",),
        ("a",),
        ("her",),
        ("his",),
        ("some",),
        ("the", "full"),
        ("a", "full"),
        ("both",),
    ),
    "surface": (("the",), ("her",), ("his",), ("my",)),
    "region": (("the",), (), ("her",)),
    "person": (("the",), ()),
    "message": ((), ("that",)),
}
_SOFTENERS: tuple[tuple[str, ...], ...] = ((), (), ("just",), ("please",), ("then",), ("and",))


def recogniser_phrases(world: World, grammar: Grammar) -> tuple[str, ...]:
    """At most MOST phrases in a fixed order: controls, names, plain clauses, all, rare words, pairs.

    After these comes how people say things, each request SAID times: what is said most is heard best. Those
    without a name are repeated, which a recogniser takes as how often they are said.
    """
    maker = _Maker(world, grammar)
    found = dict.fromkeys(_text(words) for words in maker.fixed())
    clauses = maker.clauses(MOST - len(found) - COMPOSED - PLAIN)
    for words in itertools.chain(maker.plain(), clauses):
        found[_text(words)] = None
    for words in itertools.chain(maker.rare(found), maker.composed()):
        found[_text(words)] = None
        if len(found) >= MOST:
            break
    found.pop("", None)
    return (*found, *(_text(words) for words in maker.said()))


def _text(words: Iterable[str]) -> str:
    return " ".join(words).replace(" 's", "'s").replace(" n't", "n't").replace(" 't", "'t").strip()


@dataclass
class _Source:
    """A wording that phrases are drawn from, over and over, so that every choice comes up in turn."""

    parts: Parts
    kind: str
    types: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    plain: bool = False
    drawn: int = 0


_NOTHING = _Source(Parts(()), "")


class _Maker:
    def __init__(self, world: World, grammar: Grammar) -> None:
        self._world = world
        self._grammar = grammar
        self._names: _Names = {
            kind: [words for e in world.of_type(kind) for words in _called(e)]
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
        yield from (("go", *words) for words in self._names.get("region", ()))  # "go home"
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

    def plain(self) -> Iterator[Sequence[str]]:
        """What is said most: the program's own wordings, and all without what can be left out."""
        phrases = [
            (p, self._world.domain.predicates[p.predicate])
            for p in self._grammar.predicates.values()
            if p.predicate in self._world.domain.predicates
        ]
        sources = [s for p, predicate in phrases for s in _own(p, predicate)]
        sources += [
            _Source(s.parts, s.kind, s.types, plain=True)
            for s in self._sources
            if s.kind in ("goals", "states")
        ]
        each = PLAIN // max(len(sources), 1)
        for source in sources:
            for number, words in enumerate(self._drawn(source, each)):
                lead = self._ifs[number % len(self._ifs)] if source.kind == "states" else ()
                yield (*lead, *words)

    def rare(self, found: Iterable[str]) -> Iterator[Sequence[str]]:
        """A phrase for every word of a wording that hasn't come up."""
        known = {word for text in found for word in text.split()}
        for source in self._sources:
            for word in sorted(_words_in(source.parts) - known):
                known.add(word)
                words = self._through(source.parts.parts, source, word)
                yield (*self._ifs[0], *words) if source.kind in ("states", "not-states") else words

    def _through(self, parts: Sequence[Part], source: _Source, word: str) -> list[str]:
        """A phrase of a wording that has a certain word."""
        words: list[str] = []
        for part in parts:
            if isinstance(part, Choice):
                option = next((o for o in part.options if word in _words_in(o)), part.options[0])
                words.extend(self._through(option.parts, source, word))
            else:
                words.extend(self._pick([part], source, len(words)))
        return words

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

    def said(self) -> Iterator[Sequence[str]]:
        """How people say things, with the world's names in turn."""
        often = min(SAID, MOST_SAID // max(len(self._grammar.said), 1))
        for number, request in enumerate(self._grammar.said):
            for turn in range(number, number + often):
                yield [
                    word
                    for place, part in enumerate(request)
                    for word in (
                        [part] if isinstance(part, str) else self._named(part, turn, place)
                    )
                ]

    def _named(self, place: Open, turn: int, at: int) -> Sequence[str]:
        """What is named in an open place: a name alone, or one with its article or a pronoun."""
        names = self._names.get(place.type, ())
        choices = self._slot(Slot("", place.type), _NOTHING) if place.whole else names
        return choices[_turned(turn, at, len(choices))] if choices else ()

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
            elif not (source.plain and any(not option.parts for option in part.options)):
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
        if slot.type == NAMED:
            return [words for kind in slot.types(source.types) for words in self._names[kind]]
        kinds = slot.types(source.types) or tuple(self._names)
        if kinds not in self._fillers:
            found: list[tuple[str, ...]] = []
            for kind in kinds:
                pronouns = _PRONOUNS.get(kind, ())
                found.extend(pronouns)
                leads = _LEADS.get(kind, (("the",),))
                for number, words in enumerate(self._names.get(kind, ())):
                    found.append((*leads[0], *words))
                    found.append((*leads[number % len(leads)], *words))
                    if () in leads:
                        found.append(tuple(words))
                    if pronouns and number % OFTEN == 0:
                        found.append(pronouns[number // OFTEN % len(pronouns)])
            self._fillers[kinds] = found
        return self._fillers[kinds]


def _words_in(parts: Parts) -> set[str]:
    """All words of a wording, whatever is chosen."""
    found: set[str] = set()
    for part in parts.parts:
        if isinstance(part, Word):
            found.add(part.text)
        elif isinstance(part, Choice):
            found = found.union(*(_words_in(option) for option in part.options))
    return found


def _called(entity: Entity) -> Iterator[tuple[str, ...]]:
    """The ways to name an entity: by name, synonyms, and its noun with each of its adjectives."""
    noun = phrase(entity.noun) if entity.noun else phrase(entity.spoken)
    kinds = [
        phrase(plural_of(kind)) for kind in (*entity.kinds, *([entity.noun] if entity.noun else []))
    ]
    described = [(*phrase(adjective), *noun) for adjective in entity.adjectives]
    yield from dict.fromkeys((*map(phrase, (entity.spoken, *entity.synonyms)), *described, *kinds))


def _sources(phrases: Phrases, predicate: Predicate) -> Iterator[_Source]:
    types = {p.name.lstrip("?"): p.types for p in predicate.parameters}
    for kind, templates in phrases.wordings.items():
        for template in templates:
            yield _Source(template, kind, types)


def _own(phrases: Phrases, predicate: Predicate) -> Iterator[_Source]:
    """The wordings in which the program itself speaks of a predicate."""
    types = {p.name.lstrip("?"): p.types for p in predicate.parameters}
    for kind in ("goal", "not-goal", "event", "fact"):
        if kind in phrases.texts:
            words = phrases.texts[kind].split()
            parts = Parts(tuple(Slot(w[1:-1], "") if w[0] == "{" else Word(w) for w in words))
            yield _Source(parts, "goals" if kind.endswith("goal") else "states", types)


def _turned(turn: int, place: int, count: int) -> int:
    """Which of `count` choices comes up: each once a round, shifted by its place from round to round.

    Without the shift, neighbours with equally many choices would always meet the same partner.
    """
    return (turn + turn // count * (place + 1) + place) % count
