"""Whether what two decoders heard agrees enough for what a mistake would cost.

Vosk with phrases turns any speech into phrases, so the same audio is decoded freely: where the two differ
too much, the words were not meant for the robot.

With noise, the free decoding is the first to go astray. So the two are compared by likelihood, too, as
in utterance verification with a filler model: phrases that explain the sound better than any words
could are right whatever was heard freely, and those that explain it far worse are other people's talk.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence

from polaris_nl.speech.recogniser import UNKNOWN
from polaris_nl.speech.repair import apart
from polaris_nl.speech.weight import Weight

BREAK = ". "
"""Between pieces of speech that a pause separates."""
MOST_DIFFERENT: Mapping[Weight, float] = {
    Weight.ASKING: 0.0, Weight.HARMLESS: 0.5, Weight.CHANGING: 0.5, Weight.MOVING: 0.45,
}  # fmt: skip
"""The most that free decoding may differ, in characters of the longer text."""
SHORT, MORE_FOR_SHORT = 2, 0.15
"""A few words are heard freely as others that sound alike: so many words may differ by so much more."""
LONG, LONG_HARMLESS = 5, 0.2
"""A question of so many words may differ by no more: there is much that other people's talk can pass for."""
FOREIGN_WORDS, FEW_DIFFERENT = 2, 0.25
"""So many words that mean nothing here, and sound like none of those heard, are other people's talk, unless
the two decodings differ by no more than this."""
SURE, UNLIKELY_HARMLESS = -0.5, -0.8
"""The gain in log-likelihood a word from which phrases are believed whatever was heard freely, and that below
which long questions aren't, which other people's talk most often passes for."""
UNLIKELY: Sequence[tuple[float, float]] = ((3, -3.5), (5, -2.5), (math.inf, -1.5))
"""The same for all else, for up to so many words: the more they are, the surer it is that others were meant."""


def disagreement(
    text: str,
    free: str,
    gain: float | None,
    weight: Weight | None,
    foreign: Callable[[str, str], Sequence[str]],
) -> str:
    """Why words aren't taken for speech to the robot, or "".

    Args:
        text: the words.
        free: what was heard freely.
        gain: by how much the words explain the sound better, as a difference of log-likelihoods a word;
            None where that isn't known.
        weight: what a mistake would cost; None for words that aren't understood.
        foreign: the words heard freely that mean nothing here, and that sound like none of the words.
    """
    if not text:
        return "no words"
    if UNKNOWN in text:
        return "unknown words"
    if weight is None:
        return "not understood"
    words, different = len(text.split()), difference(text, free)
    if gain is not None and words > SHORT and gain < least_gain(weight, words):
        return f"it is likelier to be what was heard freely, by {-gain:.1f} a word"
    if weight is Weight.ASKING and different > MOST_DIFFERENT[weight]:
        return f"it makes no whole sense, and heard freely it is {different:.2f} different"
    if gain is not None and gain >= SURE and weight is not Weight.MOVING:
        return ""
    if different > _allowed(weight, words):
        return f"heard freely it is {different:.2f} different"
    if different > FEW_DIFFERENT and len(about := foreign(text, free)) >= FOREIGN_WORDS:
        return f"it is about {', '.join(about)}"
    return ""


def least_gain(weight: Weight, words: int) -> float:
    """The least that so many words must gain in likelihood, a word."""
    if weight is Weight.HARMLESS and words >= LONG:
        return UNLIKELY_HARMLESS
    return next(least for most, least in UNLIKELY if words <= most)


def _allowed(weight: Weight, words: int) -> float:
    """How far the two decodings of so many words may be apart."""
    if weight is Weight.HARMLESS and words >= LONG:
        return LONG_HARMLESS
    short = words <= SHORT and weight in (Weight.HARMLESS, Weight.MOVING)
    return MOST_DIFFERENT[weight] + (MORE_FOR_SHORT if short else 0.0)


def difference(text: str, free: str) -> float:
    """How far the two decodings are apart, in characters of the longer one; 0 without a second one.

    A few words are compared by their sound as well: freely, they are heard as others that sound alike.
    """
    from rapidfuzz.distance import Levenshtein

    plain = text.replace(BREAK, " ")
    if not free:
        return 0.0
    by_letter = float(Levenshtein.normalized_distance(plain, free))
    return min(by_letter, apart(plain, free)) if len(plain.split()) <= SHORT else by_letter
