"""What was heard, but by too narrow a margin to be done: it is asked about.

In noise, a wrong reading gets as likely as the right one long before nothing is understood. What gives it
away is that the free decoding doesn't mean the same, and that another reading is as likely, that its words
explain the sound no better than any words could, or that many readings were likelier. "Should" and
"shouldn't" are so alike that even the free decoding is no witness.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from polaris_nl.speech.weight import Weight

NARROW = 1.0
"""By how much a reading must be likelier than one that means something else (difference of log-likelihoods)."""
OPPOSITE = 3.0
"""The same for one that says the opposite: a "not" is easily lost, and nothing is more wrong."""
DIFFERENT, FAR_DOWN = 0.2, 8
"""What is so different from what was heard freely has to gain in likelihood over it; so far down the list
of readings, it is doubtful in any case."""
SHORT = 2
"""Words of which the free decoding often gets none right; for them only other readings count."""
MOST_ASKED = 3

Means = Callable[[str], object]
"""What words would do: two that do the same are equal."""


@dataclass(frozen=True, slots=True)
class Reading:
    """A reading that makes sense.

    Attributes:
        text: all words so far, with it.
        gain: by how much it explains the sound better than what was heard freely, as a difference of
            log-likelihoods; None where that isn't known.
        rank: its place in the list of readings.
    """

    text: str
    gain: float | None
    rank: int = 0


def doubts(
    chosen: Reading,
    others: Sequence[Reading],
    free: str,
    different: float,
    weight: Weight | None,
    means: Means,
) -> tuple[str, ...]:
    """The sentences of which one may have been meant, the chosen first; empty where it can be done.

    Args:
        chosen: the reading that most speaks for.
        others: further ones that make sense.
        free: what was heard freely.
        different: how far the chosen words are from that, from 0 to 1.
        weight: what a mistake would cost; only what changes something is asked about.
        means: what words would do.
    """
    if weight is None or weight < Weight.CHANGING or chosen.gain is None or not free:
        return ()
    meant = means(chosen.text)
    rivals = [
        (other, opposite(other.text, chosen.text))
        for other in others
        if other.gain is not None and means(other.text) != meant
    ]
    near = [o.text for o, flips in rivals if _is_near(chosen, o, OPPOSITE if flips else NARROW)]
    if means(free) == meant:
        near = [o.text for o, flips in rivals if flips and o.text in near]
    elif not near and len(chosen.text.split()) > SHORT and _weak(chosen, different):
        return (chosen.text,)
    return tuple(dict.fromkeys((chosen.text, *near)))[:MOST_ASKED] if near else ()


def opposite(one: str, other: str) -> bool:
    """Whether two texts differ in nothing but a "not"."""
    return one != other and _NOT.sub("", one).split() == _NOT.sub("", other).split()


_NOT = re.compile(r"n't\b|\bnot\b")


def _is_near(chosen: Reading, other: Reading, margin: float) -> bool:
    return chosen.gain is not None and other.gain is not None and chosen.gain - other.gain < margin


def _weak(chosen: Reading, different: float) -> bool:
    """Whether little speaks for a reading."""
    if different <= DIFFERENT:
        return False
    return chosen.rank >= FAR_DOWN or (chosen.gain is not None and chosen.gain < 0)
