"""Words that the recogniser doesn't have, and words it has that sound like them.

Vosk drops a word that its lexicon lacks from a phrase, and hears a different, shorter sentence. So
such a word is listened for under other words ("zorblax" as "zor blacks"), and put back in what was
heard.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from polaris_nl.speech.repair import apart, sound

Knows = Callable[[str], bool]
"""Whether the recogniser has a word."""
SHORTEST_PART = 2
MOST_APART = 0.4
COMMON = 200
"""How often a word has to occur in the dictionary's texts to stand for another."""


@dataclass(frozen=True)
class SoundAlikes:
    """The table of words that are listened for under other words.

    Attributes:
        inward: for each word that is missing, the known words that stand for it.
        gaps: the missing words that nothing stands for: phrases with them are never heard.
    """

    inward: Mapping[str, str] = field(default_factory=dict)
    gaps: tuple[str, ...] = ()

    def listened_for(self, phrases: Iterable[str]) -> list[str]:
        """Phrases in words that the recogniser has; those with gaps are left out."""
        gaps = set(self.gaps)
        return [
            " ".join(self.inward.get(word, word) for word in phrase.split())
            for phrase in phrases
            if gaps.isdisjoint(phrase.split())
        ]

    def put_back(self, heard: str) -> tuple[str, ...]:
        """What words that were heard may be: as they are, or with the missing words put back."""
        found = heard
        for missing, known in self.inward.items():
            found = f" {found} ".replace(f" {known} ", f" {missing} ").strip()
        return (heard, found) if found != heard else (heard,)


def common_words() -> Sequence[str]:
    """The commoner words of the language, for standing in."""
    from spellchecker import SpellChecker

    counted = SpellChecker().word_frequency.items()
    return [word for word, count in sorted(counted) if count >= COMMON and word.isalpha()]


def sound_alikes(
    words: Iterable[str], knows: Knows, others: Callable[[], Sequence[str]] = common_words
) -> SoundAlikes:
    """A table for the words that are missing.

    Args:
        words: the words that may be said.
        knows: the recogniser's lexicon.
        others: words of the language that may stand for a missing one, besides those of its own letters.
    """
    missing = [w for w in sorted(set(words)) if not knows(w)]
    hard = any(not w.endswith("'s") for w in missing)
    usable = [w for w in others() if knows(w)] if hard else []
    inward = {w: alike for w in missing if (alike := _alike(w, knows, usable))}
    return SoundAlikes(inward, tuple(w for w in missing if w not in inward))


def _alike(word: str, knows: Knows, others: Sequence[str]) -> str:
    """Known words that sound like a missing one, or "": its plural form, its two parts, or its likest."""
    if word.endswith("'s"):
        plural = word.replace("'s", "s")
        if knows(
            plural
        ):  # "the icebox's" sounds like "the iceboxs"; "the tray's" like "the trays".
            return plural
        if knows(word[:-2]):
            return f"{word[:-2]} is"
    plain = word.replace("'", "").replace("-", "")
    parts = [pair for pair in _parts(plain) if all(map(knows, pair))]
    if parts:
        return " ".join(max(parts, key=lambda pair: min(map(len, pair))))
    key = sound(plain)
    candidates = [(apart(plain, other), other) for other in others if sound(other) == key]
    for first, last in _parts(plain):
        for known, rest, order in ((first, last, 1), (last, first, -1)):
            if knows(known):
                likest = _likest(rest, others)
                if likest:
                    pair = (known, likest)[::order]
                    candidates.append((apart(plain, "".join(pair)), " ".join(pair)))
    near = [found for found in candidates if found[0] <= MOST_APART]
    return min(near)[1] if near else ""


def _likest(word: str, others: Sequence[str]) -> str:
    key = sound(word)
    found = [(apart(word, o), o) for o in others if sound(o) == key and o[0] == word[0]]
    return min(found)[1] if found else ""


def _parts(word: str) -> Iterator[tuple[str, str]]:
    for at in range(SHORTEST_PART, len(word) - SHORTEST_PART + 1):
        yield word[:at], word[at:]
