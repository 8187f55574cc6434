"""Clauses: wordings of predicates with mentions that fit. A reading that doesn't fit is none."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Literal as OneOf

from polaris_nl.language.grammar import Grammar
from polaris_nl.language.mention import ASKED, EVERYTHING, SPEAKER, SPOKEN_OF, Mention
from polaris_nl.language.mention_cost import MentionCost
from polaris_nl.language.template import NAMED, Parts, Slot, first_words, match, words_behind
from polaris_nl.language.verbs import INFLECTED, Inflection, Verbs
from polaris_nl.model.world import World

Kind = OneOf["goal", "state", "small", "wish", "told", "ellipsis"]

_KINDS: Mapping[str, tuple[Kind, bool, float]] = {
    "goals": ("goal", True, 1.0),
    "not-goals": ("goal", False, 1.0),
    "asks": ("goal", True, 1.6),
    "seeks": ("goal", True, 2.5),
    "states": ("state", True, 1.0),
    "not-states": ("state", False, 1.0),
    "wished-states": ("wish", True, 1.0),
    "wished-not-states": ("wish", False, 1.0),
    "denied-states": ("state", False, 1.0),
    "denied-not-states": ("state", True, 1.1),
    "wished-denied-states": ("wish", False, 1.0),
    "wished-denied-not-states": ("wish", True, 1.1),
    "small-states": ("small", True, 1.1),
    "small-not-states": ("small", False, 1.1),
    "told": ("told", True, 1.0),
    "ellipsis": ("ellipsis", True, 1.8),
}
"""For each list of a grammar file: what its wordings are, their sign, and what taking one costs."""


@dataclass(frozen=True, slots=True)
class Clause:
    """One predicate, said of mentions.

    Attributes:
        kind: an imperative, a state, a state without its verb ("the cup on the desk"), a state that
            is wished for, one that is only told of, or a rest that leans on the clause before.
        bindings: the parameter's name (without `?`) and what was said for it.
        cost: how much speaks against it.
        form: how the verb of an imperative stands: "fill it", "filling it", "(you have) filled it".
        seeks: asks for a thing only on the way to something else: "find it and bring it here".
        tellable: whether people tell of such states in passing; what they answer is never said so.
    """

    start: int
    end: int
    kind: Kind
    predicate: str
    positive: bool
    bindings: tuple[tuple[str, Mention], ...]
    cost: float
    form: Inflection = "base"
    tellable: bool = False
    seeks: bool = False


@dataclass(frozen=True, slots=True)
class _Form:
    key: str
    predicate: str
    kind: Kind
    positive: bool
    cost: float
    template: Parts
    types: Mapping[str, tuple[str, ...]]


_INSIDE = ("in", "there")
"""Says a container: nothing is put in a table."""
Fitting = dict[tuple[int, tuple[str, ...]], Sequence[tuple[int, object]]]
_WORDLESS: Mapping[tuple[str, ...], Mention] = {
    (EVERYTHING,): Mention(0, 0, EVERYTHING, quantifier="all"),
    (SPEAKER,): Mention(0, 0, SPEAKER, pronoun="me"),
    (ASKED,): Mention(0, 0, ASKED),
    (SPOKEN_OF,): Mention(0, 0, "it", pronoun="it"),
}
"""What slots that take no words stand for."""


class ClauseFinder:
    """Finds the clauses of one world's domain."""

    def __init__(self, world: World, grammar: Grammar) -> None:
        self._world = world
        self._cost = MentionCost(world)
        self._by_word: dict[str, list[_Form]] = {}
        self._anywhere: list[_Form] = []
        common = grammar.common
        self._determiners = {w[0] for w in common.determiners} | set(common.possessives)
        self.verbs = verbs_of(grammar)
        self.beginnings = _beginnings(grammar)
        for form in self._forms(grammar):
            words = first_words(form.template)
            if words is None:
                self._anywhere.append(form)
            for word in words or ():
                self._by_word.setdefault(word, []).append(form)

    def _forms(self, grammar: Grammar) -> Iterator[_Form]:
        for name, phrases in grammar.predicates.items():
            predicate = self._world.domain.predicates.get(name)
            if predicate is None:
                continue
            types = {p.name.lstrip("?"): p.types for p in predicate.parameters}
            for key, templates in phrases.wordings.items():
                kind, positive, cost = _KINDS[key]
                for template in templates:
                    yield _Form(key, name, kind, positive, cost, template, types)

    def at(
        self,
        tokens: Sequence[str],
        start: int,
        mentions: Sequence[Sequence[Mention]],
        known: Fitting | None = None,
    ) -> Iterator[Clause]:
        """The clauses that start at a position.

        Args:
            tokens: the utterance.
            start: the position.
            mentions: those that start at each position.
            known: what fits where, kept from one position of an utterance to the next.
        """
        known = {} if known is None else known
        forms = [*self._by_word.get(tokens[start], ()), *self._led(tokens, start, mentions[start])]
        yield from self._matched(forms, tokens, start, mentions, "base", known)
        for inflection in INFLECTED:
            for verb in self.verbs.bases(tokens[start], inflection):
                imperative = [*tokens[:start], verb, *tokens[start + 1 :]]
                goals = [f for f in self._by_word.get(verb, ()) if f.kind == "goal"]
                yield from self._matched(goals, imperative, start, mentions, inflection, known)

    def _led(
        self, tokens: Sequence[str], start: int, mentions: Sequence[Mention]
    ) -> Iterator[_Form]:
        """The wordings that may begin with a slot, and can go on with what follows a mention."""
        words = {tokens[start], *(tokens[m.end] for m in mentions if m.end < len(tokens))}
        for form, behind in self._going_on:
            if behind is None or not behind.isdisjoint(words):
                yield form

    @cached_property
    def _going_on(self) -> tuple[tuple[_Form, frozenset[str] | None], ...]:
        """Wordings that may begin with a slot, and the words they begin or go on with."""
        return tuple((form, words_behind(form.template)) for form in self._anywhere)

    def _matched(
        self,
        forms: Sequence[_Form],
        tokens: Sequence[str],
        start: int,
        mentions: Sequence[Sequence[Mention]],
        inflection: Inflection,
        known: Fitting,
    ) -> Iterator[Clause]:
        for form in forms:

            def fillers(slot: Slot, at: int, form: _Form = form) -> Sequence[tuple[int, object]]:
                types = slot.types(form.types)
                key = (at, types)
                if key not in known:
                    known[key] = self._fitting(types, at, mentions)
                if "surface" in types and (*tokens[max(at - 1, 0) : at + 1],) == _INSIDE:
                    return ()
                determined = slot.type == NAMED and self._determiners & {*tokens[at : at + 1]}
                return () if determined else known[key]

            for end, bound in match(form.template, tokens, start, fillers):
                if end > start:
                    yield self._clause(form, start, end, bound, inflection)

    def _fitting(
        self, types: tuple[str, ...], at: int, mentions: Sequence[Sequence[Mention]]
    ) -> Sequence[tuple[int, object]]:
        """What can stand at a position in a slot of some types, with its end."""
        if types in _WORDLESS:
            return ((at, replace(_WORDLESS[types], start=at, end=at)),)
        there = mentions[at] if at < len(mentions) else ()
        return tuple((m.end, m) for m in there if self.fits(m, types))

    def misfits(
        self, tokens: Sequence[str], start: int, mentions: Sequence[Sequence[Mention]]
    ) -> Iterator[tuple[int, Mention, Sequence[str]]]:
        """Goals that would start at a position if only types were right.

        Yields:
            Where each would end, the mention that doesn't fit, and the types that would.
        """

        def any_mention(slot: Slot, at: int) -> Iterator[tuple[int, object]]:
            for mention in mentions[at] if at < len(mentions) else ():
                yield mention.end, mention

        for form in self._by_word.get(tokens[start], ()):
            if form.kind != "goal":
                continue
            for end, bound in match(form.template, tokens, start, any_mention):
                wrong = [
                    (mention, form.types.get(name, ()))
                    for name, mention in bound
                    if isinstance(mention, Mention)
                    and not self.fits(mention, form.types.get(name, ()))
                ]
                if wrong and end > start:
                    yield end, *wrong[0]

    def _clause(
        self,
        form: _Form,
        start: int,
        end: int,
        bound: tuple[tuple[str, object], ...],
        inflection: Inflection,
    ) -> Clause:
        bindings = tuple((name, m) for name, m in bound if isinstance(m, Mention))
        cost = form.cost + sum(self._cost.of(m, form.types.get(n, ())) for n, m in bindings)
        return Clause(
            start,
            end,
            form.kind,
            form.predicate,
            form.positive,
            bindings,
            cost,
            inflection,
            "message" not in {kind for types in form.types.values() for kind in types},
            form.key == "seeks",
        )

    def fits(self, mention: Mention, types: Sequence[str]) -> bool:
        """Whether a mention can mean entities of some types."""
        if mention.parts:
            return all(self.fits(part, types) for part in mention.parts)
        if mention.pronoun:
            known = set(pronoun_types(mention.pronoun))
            return not types or any(t in known or self._other_thing(mention, t) for t in types)
        domain = self._world.domain
        entities = self._world.entities
        return (
            not types
            or any(
                domain.is_a(entities[c.entity].type, t) for c in mention.candidates for t in types
            )
            or self._place_of_surfaces(mention, types)
        )

    def _other_thing(self, mention: Mention, kind: str) -> bool:
        """Whether "it" can be of a type that only this domain has."""
        return mention.pronoun in _THINGS and kind not in _HOUSEHOLD

    def _place_of_surfaces(self, mention: Mention, types: Sequence[str]) -> bool:
        """A region where a surface is wanted: "bring the cup to the kitchen" asks where in the kitchen."""
        return "surface" in types and any(
            self._world.entities[c.entity].type == "region" for c in mention.candidates
        )


def verbs_of(grammar: Grammar) -> Verbs:
    """The forms of the verbs that a grammar's imperatives start with."""
    return Verbs(_beginnings(grammar), grammar.common.irregular)


def _beginnings(grammar: Grammar) -> frozenset[str]:
    """The words that imperatives start with, nearly all of them verbs."""
    return frozenset(
        word
        for phrases in grammar.predicates.values()
        for key in ("goals", "not-goals", "asks")
        for template in phrases.wordings.get(key, ())
        for word in first_words(template) or ()
    )


_PRONOUN_TYPES: Mapping[str, tuple[str, ...]] = {
    "it": ("object", "container", "message"),
    "that": ("object", "container", "message"),
    "this": ("object", "container", "message"),
    "one": ("object", "surface", "container"),
    "she": ("person",),
    "he": ("person",),
    "her": ("person",),
    "him": ("person",),
    "me": ("person",),
    "there": ("region", "surface", "container"),
}


_HOUSEHOLD = ("object", "container", "surface", "region", "person", "message")
_THINGS = ("it", "that", "this", "one", "them", "they", "these", "those", "both")


def pronoun_types(pronoun: str) -> tuple[str, ...]:
    """The types of what a pronoun can stand for."""
    return _PRONOUN_TYPES.get(pronoun, ("object", "container", "person"))
