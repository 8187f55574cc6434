"""Mends typing slips and recognisers' sound-alikes, carefully: only where one known word is clearly meant."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from rapidfuzz.distance import OSA

from polaris_nl.automaton.automaton import Automaton
from polaris_nl.language.grammar import Grammar
from polaris_nl.language.lexicon import Lexicon
from polaris_nl.language.ordinary import is_ordinary
from polaris_nl.language.template import vocabulary
from polaris_nl.language.tokens import BREAK, COMMA, phrase

SHORTEST = 4
SAFE = 6
"""Letters from which a word with one other letter is taken for a slip rather than another word."""
LONG = 8
"""Letters from which two slips are mended."""


class Spelling:
    """The vocabulary of a grammar and a world, for finding what a misspelt word was meant to be."""

    def __init__(self, grammar: Grammar, lexicon: Lexicon) -> None:
        self._names = frozenset(w for w in lexicon.vocabulary if len(w) >= SHORTEST)
        known = set(lexicon.vocabulary)
        for phrases in grammar.predicates.values():
            for templates in phrases.wordings.values():
                known.update(word for t in templates for word in vocabulary(t))
            known.update((*phrases.adjectives, *phrases.not_adjectives))
        known.update(grammar.common.vocabulary)
        self.known = frozenset(known)
        self._words = frozenset(w for w in known - self._names if len(w) >= SHORTEST)
        self._language = grammar.common.language

    def mended(self, tokens: Sequence[str], program: Automaton) -> list[str]:
        """Tokens with clear slips mended; words of checkpoint names count as known."""
        names = {w for c in program.checkpoints.values() for w in phrase(c.name)}
        return [self._mended(token, names) for token in self._joined(tokens)]

    def _joined(self, tokens: Sequence[str]) -> Iterator[str]:
        """Tokens with names written as one word that were written as two: "night stand"."""
        at = 0
        while at < len(tokens):
            pair = "".join(tokens[at : at + 2])
            if len(pair) >= LONG and pair in self._names and pair not in tokens[at : at + 1]:
                yield pair
                at += 2
            else:
                yield tokens[at]
                at += 1

    def _mended(self, token: str, names: set[str]) -> str:
        if (
            token in self.known
            or token in names
            or token in (BREAK, COMMA)
            or len(token) < SHORTEST
        ):
            return token
        if not token.isalpha() or is_ordinary(token, self._language):
            return token
        slips = 2 if len(token) >= LONG else 1
        return _nearest(token, self._names, slips) or _nearest(token, self._words, 1) or token


def _nearest(token: str, words: Iterable[str], allowed: int) -> str:
    """The one word that is nearest to a token with a slip in it, or ""."""
    near: dict[int, list[str]] = {}
    for word in words:
        if word[:1] == token[:1] and abs(len(word) - len(token)) <= allowed:
            distance = OSA.distance(token, word, score_cutoff=allowed)
            if distance <= allowed and not _another(token, word):
                near.setdefault(distance, []).append(word)
    nearest = near[min(near)] if near else []
    return nearest[0] if len(nearest) == 1 else ""


def _another(token: str, word: str) -> bool:
    """Whether two words differ as words do more often than slips: wash and wish, load and loader."""
    if len(token) == len(word):
        return len(token) < SAFE and sorted(token) != sorted(word)
    return token.startswith(word) and token[-1] != word[-1]
