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
SURE_DIFFERENT, SURE_GAIN, SURE_MARGIN = 0.3, -0.5, 3.0
"""What is no more different from what was heard freely, gains at least so much a word over it, and is likelier
by so much than all that means something else, is sure."""

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


@dataclass(frozen=True, slots=True)
class Case:
    """A reading, and all that makes it certain or doubtful.

    Attributes:
        chosen: the reading that most speaks for.
        others: further ones that make sense.
        free: what was heard freely.
        different: how far the chosen words are from that, from 0 to 1.
        weight: what a mistake would cost.
    """

    chosen: Reading
    others: Sequence[Reading]
    free: str
    different: float
    weight: Weight

    def rivals(self, means: Means) -> list[Reading]:
        """The others that mean something else."""
        meant = means(self.chosen.text)
        return [o for o in self.others if o.gain is not None and means(o.text) != meant]


def doubts(case: Case, means: Means) -> tuple[str, ...]:
    """The sentences of which one may have been meant, the chosen first; empty where it can be done.

    Only what changes something is asked about.

    Args:
        case: the reading.
        means: what words would do.
    """
    chosen = case.chosen
    if case.weight < Weight.CHANGING or chosen.gain is None or not case.free:
        return ()
    rivals = [(other, opposite(other.text, chosen.text)) for other in case.rivals(means)]
    near = [o.text for o, flips in rivals if _is_near(chosen, o, OPPOSITE if flips else NARROW)]
    if means(case.free) == means(chosen.text):
        near = [o.text for o, flips in rivals if flips and o.text in near]
    elif not near and len(chosen.text.split()) > SHORT and _weak(chosen, case.different):
        return (chosen.text,)
    return tuple(dict.fromkeys((chosen.text, *near)))[:MOST_ASKED] if near else ()


def is_sure(case: Case, means: Means) -> bool:
    """Whether both decodings bear a reading out, so that it needn't be heard again.

    Args:
        case: the reading.
        means: what words would do.
    """
    chosen = case.chosen
    if case.weight is Weight.ASKING or chosen.gain is None:
        return False
    if means(case.free) == means(chosen.text):
        return True
    if case.different > SURE_DIFFERENT or chosen.gain < SURE_GAIN * len(chosen.text.split()):
        return False
    return not any(_is_near(chosen, rival, SURE_MARGIN) for rival in case.rivals(means))


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
