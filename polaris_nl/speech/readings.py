"""Readings of a piece of speech: what it may say where that makes sense, and how well that explains it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from polaris_nl.speech.agreement import BREAK, difference
from polaris_nl.speech.lexicon import SoundAlikes
from polaris_nl.speech.recogniser import UNKNOWN, Spoken
from polaris_nl.speech.weight import Weigh, Weight

UNHEARD = 8.0
"""By how much less a reading gains that none of the alternatives is."""
ASKING_COST = 0.3
"""What speaks against a reading that makes sense only in part."""


@dataclass(frozen=True, slots=True)
class Found:
    """The pieces so far with a reading of the next one that makes sense there.

    Attributes:
        pieces: all pieces so far; the last one may have been taken for more of the one before.
        cost: what speaks against it.
        reading: the words of the next piece alone.
        weight: what acting on all of them would cost.
        repaired: whether no alternative is those words.
        rank: its place among the readings.
    """

    pieces: Sequence[str]
    cost: float
    reading: str
    weight: Weight
    repaired: bool = False
    rank: int = 0

    @property
    def text(self) -> str:
        """All words so far."""
        return BREAK.join(self.pieces)


def readings(piece: Spoken, alikes: SoundAlikes) -> Iterator[str]:
    """What a piece may say, the likeliest first, in words of the world, each once."""
    seen = set()
    for text in piece.alternatives:
        for reading in alikes.put_back(text):
            if UNKNOWN not in reading and reading not in seen:
                seen.add(reading)
                yield reading


def placed(
    chosen: Sequence[str], reading: str, free: str, cost: float, weigh: Weigh
) -> Found | None:
    """A reading as a new sentence, or as more of the last; None where it makes no sense."""
    ways_on = [[*chosen, reading]]
    if chosen:
        ways_on.append([*chosen[:-1], f"{chosen[-1]} {reading}"])
    for pieces in ways_on:
        weight = weigh(BREAK.join(pieces))
        if weight is not None:
            asking = ASKING_COST if weight is Weight.ASKING else 0.0
            cost += asking + difference(reading, free)
            return Found(pieces, cost, reading, weight)
    return None


def gain_of(piece: Spoken, reading: str, alikes: SoundAlikes) -> float | None:
    """By how much a reading explains a piece better than what was heard freely; None if unknown."""
    if not piece.gains:
        return None
    for text, gain in zip(piece.alternatives, piece.gains, strict=True):
        if reading in alikes.put_back(text):
            return gain
    return piece.gains[0] - UNHEARD
