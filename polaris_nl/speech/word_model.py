"""How likely words are to follow each other, learnt from phrases: what a search through speech is guided by."""

from __future__ import annotations

import math
from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping
from functools import lru_cache

START, END = "<s>", "</s>"
ORDER = 3
_REMEMBERED = 20_000
_NEVER = 1e-6
"""How likely a word is that no phrase has."""


class WordModel:
    """A trigram model of phrases that backs off by what may follow.

    How often a word follows others is mixed with how often it follows fewer of them, the more the more
    different words do. (I. H. Witten and T. C. Bell, "The zero-frequency problem", IEEE Transactions on
    Information Theory 37, 1991, method C.)

    Args:
        phrases: what may be said, in words; one that stands there n times counts as the root of n.
    """

    def __init__(self, phrases: Iterable[str]) -> None:
        followers: list[dict[tuple[str, ...], dict[str, float]]] = [
            defaultdict(lambda: defaultdict(float)) for _ in range(ORDER)
        ]
        for phrase, times in Counter(phrases).items():
            words, weight = (START, *phrase.split(), END), math.sqrt(times)
            for at in range(1, len(words)):
                for order in range(min(ORDER, at + 1)):
                    followers[order][words[at - order : at]][words[at]] += weight
        self._followers: list[Mapping[tuple[str, ...], Mapping[str, float]]] = [*followers]
        self._counts = [
            {before: (sum(found.values()), len(found)) for before, found in table.items()}
            for table in followers
        ]
        self._likely = lru_cache(_REMEMBERED)(self._found)
        self.words = frozenset(followers[0].get((), {})) - {END}
        self.beginnings = frozenset(w[:size] for w in self.words for size in range(len(w) + 1))
        """What words begin with, and the words."""

    def log_probability(self, word: str, before: tuple[str, ...]) -> float:
        """The natural logarithm of how likely a word (or END) is behind others, the first of them START."""
        return self._likely(word, before[-(ORDER - 1) :])

    def _found(self, word: str, before: tuple[str, ...]) -> float:
        total, _ = self._counts[0].get((), (1.0, 0))
        likely = self._followers[0].get((), {}).get(word, 0.0) / total or _NEVER
        for order in range(1, len(before) + 1):
            last = before[len(before) - order :]
            if last not in self._counts[order]:
                break
            total, kinds = self._counts[order][last]
            found = self._followers[order][last].get(word, 0.0)
            likely = (found + kinds * likely) / (total + kinds)
        return math.log(likely)
