"""Mends typing slips and recognisers' sound-alikes, carefully: only where one known word is clearly meant."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from rapidfuzz.distance import OSA

from polaris_nl.automaton.automaton import Automaton
from polaris_nl.language.grammar import Grammar
from polaris_nl.language.lexicon import Lexicon
from polaris_nl.language.template import vocabulary
from polaris_nl.language.tokens import BREAK, COMMA, phrase

SHORTEST = 4
LONG = 8


class Spelling:
    """The vocabulary of a grammar and a world, for finding what a misspelt word was meant to be."""

    def __init__(self, grammar: Grammar, lexicon: Lexicon) -> None:
        known = set(lexicon.vocabulary)
        common = grammar.common
        for phrases in grammar.predicates.values():
            for templates in phrases.wordings.values():
                known.update(word for t in templates for word in vocabulary(t))
            known.update((*phrases.adjectives, *phrases.not_adjectives))
        for section in ("queries", "edits"):
            for intent in common.mapping(section):
                known.update(w for t in common.templates(section, intent) for w in vocabulary(t))
        known.update(w for t in common.templates("corrections") for w in vocabulary(t))
        known.update(_all_words(common.values))
        self.known = frozenset(known)

    def mended(self, tokens: Sequence[str], program: Automaton) -> list[str]:
        """Tokens with clear slips mended; words of checkpoint names count as known."""
        names = {w for c in program.checkpoints.values() for w in phrase(c.name)}
        return [self._mended(token, names) for token in tokens]

    def _mended(self, token: str, names: set[str]) -> str:
        if (
            token in self.known
            or token in names
            or token in (BREAK, COMMA)
            or len(token) < SHORTEST
        ):
            return token
        if not token.isalpha():
            return token
        allowed = 2 if len(token) >= LONG else 1
        near = [
            word
            for word in self.known
            if word[:1] == token[:1]
            and len(word) >= SHORTEST
            and abs(len(word) - len(token)) <= allowed
            and OSA.distance(token, word, score_cutoff=allowed) <= allowed
        ]
        return near[0] if len(near) == 1 else token


def _all_words(value: object) -> set[str]:
    """Every word in the plain phrases of a grammar file."""
    if isinstance(value, str):
        return set(phrase(value)) if not any(c in value for c in "{<(|[") else set()
    if isinstance(value, Mapping):
        return {w for k, v in value.items() for w in (*_all_words(v), *_all_words(str(k)))}
    if isinstance(value, list):
        return {w for item in value for w in _all_words(item)}
    return set()
