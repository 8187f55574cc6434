"""Words that sound alike put in place of words that make no sense, toward sentences that the parser accepts.

A candidate is never taken from a list of sentences: each is tried on the parser, the nearest first.
"""

from __future__ import annotations

import heapq
import itertools
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import lru_cache

MOST_TRIED = 24
"""Candidates that are tried; each takes the parser some milliseconds."""
ALIKE = 0.34
"""How different two words may sound: 0 is alike, 1 has no sound in common."""
CHOICES = 3
"""Words that may stand for one that was heard."""
FILLERS = frozenset(["um", "uh", "er", "erm", "ah", "oh", "hm", "well", "so", "like"])


@dataclass(frozen=True, slots=True)
class Repair:
    """A sentence that may have been said.

    Attributes:
        text: the words.
        cost: how far it is from what was heard; 0 is what was heard.
    """

    text: str
    cost: float


class Repairer:
    """Finds sentences near what was heard.

    Args:
        vocabulary: the words that can mean something; others are candidates for being replaced.
    """

    def __init__(self, vocabulary: Iterable[str]) -> None:
        self._known = frozenset(vocabulary)
        self._by_sound: Mapping[str, list[str]] = _by_first_sound(self._known)
        self._near = lru_cache(maxsize=4096)(self._find)

    def candidates(self, heard: Iterable[str]) -> Iterator[Repair]:
        """Sentences near any of some readings, the nearest first; never the readings themselves."""
        heard = list(dict.fromkeys(heard))
        found = heapq.merge(*(self._of(text) for text in heard), key=lambda r: r.cost)
        seen = set(heard)
        for repair in found:
            if repair.text not in seen:
                seen.add(repair.text)
                yield repair

    def foreign(self, text: str, free: str) -> list[str]:
        """The words heard freely that mean nothing here, and that sound like no word of a text."""
        words = text.split()
        return [
            word
            for word in free.split()
            if word not in self._known and all(apart(word, other) > ALIKE for other in words)
        ]

    def _of(self, text: str) -> list[Repair]:
        words = [w for w in text.split() if w not in FILLERS]
        choices = [self._choices(word) for word in words]
        doubtful = [i for i, found in enumerate(choices) if len(found) > 1]
        if not doubtful or len(doubtful) > 4:
            return [Repair(" ".join(words), 0.05)] if len(words) < len(text.split()) else []
        repairs = []
        for chosen in itertools.product(*choices):
            cost = sum(cost for _, cost in chosen)
            repairs.append(Repair(" ".join(w for w, _ in chosen if w), cost))
        return sorted(repairs, key=lambda r: r.cost)[: MOST_TRIED + 1]

    def _choices(self, word: str) -> list[tuple[str, float]]:
        if word in self._known:
            return [(word, 0.0)]
        return [(word, 0.5), *self._near(word), ("", 0.6)]

    def _find(self, word: str) -> tuple[tuple[str, float], ...]:
        key = sound(word)
        rated = ((other, _apart(word, key, other)) for other in self._by_sound.get(key[:1], ()))
        near = [(other, cost) for other, cost in rated if cost <= ALIKE]
        return tuple(heapq.nsmallest(CHOICES, near, key=lambda found: (found[1], found[0])))


@lru_cache(maxsize=20_000)
def sound(word: str) -> str:
    """How a word sounds, roughly: the Metaphone key, in which vowels hardly count."""
    from jellyfish import metaphone

    return str(metaphone(word)) or word.upper()


def apart(one: str, other: str) -> float:
    """How different two texts sound, from 0 to 1: by their sounds, and by their letters as well."""
    from rapidfuzz.distance import Levenshtein

    sounds = ("".join(map(sound, one.split())), "".join(map(sound, other.split())))
    by_sound = Levenshtein.normalized_distance(*sounds)
    by_letter = Levenshtein.normalized_distance(one, other)
    return float(by_sound + by_letter) / 2


def _apart(word: str, key: str, other: str) -> float:
    if abs(len(word) - len(other)) > 3:
        return 1.0
    return apart(word, other)


def _by_first_sound(words: Collection[str]) -> Mapping[str, list[str]]:
    found: dict[str, list[str]] = {}
    for word in sorted(words):
        found.setdefault(sound(word)[:1], []).append(word)
    return found
