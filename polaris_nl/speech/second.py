"""What the first recogniser isn't sure of is heard again by a second one, and both decide together.

Two recognisers of different kinds go astray at different words, in noise above all. So each reading of
either is rated by both: by how likely the second finds it, given the sound, and by how much better the
first explains the sound with it than with any words. (Combining recognisers: J. G. Fiscus, "A
post-processing system to yield reduced word error rates", ASRU 1997, there by votes on words.)
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import islice
from typing import Literal as OneOf

from polaris_nl.speech.agreement import BREAK, difference, least_gain
from polaris_nl.speech.audio import contrast
from polaris_nl.speech.doubt import MOST_ASKED, Means
from polaris_nl.speech.hearing import Utterance, Ways
from polaris_nl.speech.readings import Found, gain_of, placed, readings
from polaris_nl.speech.recogniser import Opinion, Spoken
from polaris_nl.speech.weight import Weigh, Weight

QUIET_DB = 20.0
"""What stands out less of its background was said in noise."""
RATED, ALIKE = 12, 2
"""Readings that are understood, and how many of them may mean the same: each takes a hundredth of a second."""
HEARD = 12
"""Readings of the first recogniser that are rated."""
FAR = 8.0
"""What is so much less likely than the best that makes sense is no rival."""
BROKEN_OFF = 0.5
"""Less than this, a word, is what it costs to go on in the middle of what was said; behind its end it costs far
more. The second recogniser ends early too often for the likelihood of an end to show that."""
LEFT_OUT, MOSTLY_LEFT_OUT = 0.65, 0.4
"""What has fewer of the letters that both recognisers heard freely leaves something out, or most of it."""
PARTLY = 6.0
"""By how much less likely a reading is held that makes sense only in part."""
LEAST, MARGIN = -1.5, 1.0
"""The least by which a reading may be likelier than the second recogniser's own words, a word, and than what
means something else, to be done (differences of log-likelihoods)."""
WEAK = 1.5
"""What falls short of the least by this factor is left alone."""
NOT_MARGIN = 4.0
"""The margin to what has a "not" more or less."""
MOVING = -0.3
"""The least for what moves the robot."""
SHORT, SHORT_LEAST, SHORT_MARGIN = 2, -0.1, 3.0
"""The same for so few words: the second recogniser needs more of them than the first."""
UNHEARD_LEAST, UNHEARD_SHORT = -1.0, 3
"""The least for words that only the second recogniser heard, and of how many there must be more."""
REFUSED_LEAST = -0.5
"""The least for what the first recogniser refused."""

_NOT = re.compile(r"n't\b|\b(?:not|never|unless)\b")


@dataclass(frozen=True, slots=True)
class _Rated:
    """A reading of one piece, rated by both recognisers.

    Attributes:
        found: the reading in its place.
        heard: whether the first recogniser heard it, too.
        score: how likely both find it.
        surplus: how much likelier the second finds it than its own words, a word.
        means: what it would do.
    """

    found: Found
    heard: bool
    score: float
    surplus: float
    means: object

    @property
    def sensible(self) -> bool:
        """Whether it makes sense as a whole."""
        return self.found.weight is not Weight.ASKING


def wants_second(first: Utterance, pieces: Sequence[Spoken]) -> bool:
    """Whether a second recogniser should hear pieces of speech again.

    In noise also what both decodings of the first recogniser bear out: they go astray together.
    """
    return bool(pieces) and not (first.sure and not any(in_noise(piece.audio) for piece in pieces))


def in_noise(audio: bytes) -> bool:
    """Whether a piece of speech was said in noise; 16 kHz mono 16-bit samples."""
    return contrast(audio) < QUIET_DB


def heard_again(
    first: Utterance,
    pieces: Sequence[Spoken],
    opinions: Sequence[Opinion],
    weigh: Weigh,
    ways: Ways,
    means: Means,
) -> Utterance:
    """What was said, as two recognisers heard it.

    Args:
        first: what it is by the first recogniser alone.
        pieces: what that heard, in order.
        opinions: what the second one heard of each.
        weigh: the strict test, and what a mistake would cost.
        ways: what helps to make sense of the words.
        means: what words would do.
    """
    first = replace(first, again=BREAK.join(o.texts[0] for o in opinions if o.texts))
    chosen: Sequence[str] = []
    doubtful: tuple[str, ...] = ()
    for piece, opinion in zip(pieces, opinions, strict=True):
        rated = _rated(chosen, piece, opinion, weigh, ways, means)
        best = max(rated, key=lambda r: r.score, default=None)
        if best is None or not best.sensible:
            return first
        rivals = [r for r in rated if r.sensible and r.means != best.means]
        margin = best.score - max((r.score for r in rivals), default=-math.inf)
        near = [r.found.text for r in rivals if best.score - r.score < _margin(best, r)]
        kept = _kept(best, piece, opinion)
        if kept < MOSTLY_LEFT_OUT:
            return first
        contested = bool(near) or kept < LEFT_OUT
        refused = not (first.accepted or first.doubts)
        if refused and not best.heard and _is_foreign(best, piece):
            return first
        verdict = _verdict(best, margin, contested, opinion, refused)
        if verdict == "unlikely":
            return first if first.doubts else _left_alone(first, best)
        if verdict == "no witness":
            return first
        if verdict == "doubtful":
            doubtful = doubtful or (best.found.text, *near)
        chosen = best.found.pieces
    text = BREAK.join(chosen)
    return replace(
        first,
        text=text,
        accepted=not doubtful,
        different=difference(text, first.free),
        repaired="" if text == first.text else first.text,
        why_not="two recognisers don't agree" if doubtful else "",
        doubts=tuple(dict.fromkeys(doubtful))[:MOST_ASKED],
    )


def _left_alone(first: Utterance, best: _Rated) -> Utterance:
    why = f"heard again, it is likelier to be other words, by {-best.surplus:.1f} a word"
    return replace(first, accepted=False, why_not=first.why_not or why)


def _is_foreign(best: _Rated, piece: Spoken) -> bool:
    """Whether the first recogniser's phrases explain the sound so badly that others were meant."""
    words = len(piece.alternatives[0].split())
    return bool(piece.gains) and piece.gains[0] < words * least_gain(best.found.weight, words)


def _kept(best: _Rated, piece: Spoken, opinion: Opinion) -> float:
    """How much of what both recognisers heard freely a reading has: "... and then go home" may be lost."""
    heard = min(map(_letters, (piece.free, opinion.texts[0])))
    return _letters(best.found.reading) / heard if heard else 1.0


def _letters(text: str) -> int:
    return len(text.replace(" ", ""))


_Verdict = OneOf["certain", "doubtful", "unlikely", "no witness"]


def _nots(text: str) -> int:
    return len(_NOT.findall(text))


def _margin(best: _Rated, rival: _Rated) -> float:
    """By how much a reading must be likelier than one that means something else."""
    return MARGIN if _nots(rival.found.reading) == _nots(best.found.reading) else NOT_MARGIN


def _verdict(
    best: _Rated, margin: float, contested: bool, opinion: Opinion, refused: bool
) -> _Verdict:
    """What both recognisers together make of the reading that they find likeliest.

    Args:
        best: the reading.
        margin: by how much it is likelier than all that means something else.
        contested: whether that is too little beside one of them, or much of what was said may be missing.
        opinion: what the second one heard.
        refused: whether the first one would have left the words alone.
    """
    reading, weight, surplus = best.found.reading, best.found.weight, best.surplus
    words = len(reading.split())
    if len(best.found.text.split()) <= SHORT:
        if surplus < SHORT_LEAST or margin < SHORT_MARGIN or (refused and not best.heard):
            return "no witness"
        return "certain" if best.heard else "doubtful"
    if surplus < LEAST * WEAK:
        return "unlikely"
    # Nobody is asked about what may well be other people's talk, which passes for short questions most.
    short_question = weight is Weight.HARMLESS and words <= UNHEARD_SHORT
    if refused and (surplus < REFUSED_LEAST or (short_question and not best.heard)):
        return "no witness"
    if weight is Weight.HARMLESS:
        return "certain" if surplus >= LEAST else "doubtful"
    least = MOVING if weight is Weight.MOVING else LEAST
    if not best.heard:
        least = math.inf if words <= UNHEARD_SHORT else max(least, UNHEARD_LEAST)
    if _nots(reading) != _nots(opinion.texts[0]):
        least = max(least, 0.0)  # A "not" is easily lost, and nothing is more wrong.
    return "certain" if surplus >= least and not contested else "doubtful"


def _rated(
    chosen: Sequence[str], piece: Spoken, opinion: Opinion, weigh: Weigh, ways: Ways, means: Means
) -> list[_Rated]:
    """The likeliest readings of either recogniser that make sense, rated by both."""
    known = tuple(islice(readings(piece, ways.alikes), HEARD))
    texts = list(dict.fromkeys(filter(None, (*opinion.texts, *known, piece.free))))
    found: list[_Rated] = []
    if not opinion.texts:
        return found
    likelihoods = dict(zip(texts, opinion.likelihoods(texts), strict=True))
    own = likelihoods[opinion.texts[0]]
    lowest = min(piece.gains, default=0.0)
    gains = {t: (gain_of(piece, t, ways.alikes) or 0.0) if t in known else lowest for t in texts}
    scores = {t: likelihoods[t] + gains[t] for t in texts if not _breaks_off(t, likelihoods)}
    alike: dict[object, int] = {}
    for text in sorted(scores, key=lambda t: -scores[t]):
        if len(found) >= RATED or (found and scores[text] < max(r.score for r in found) - FAR):
            break
        one = placed(chosen, text, piece.free, 0.0, weigh)
        if one is None:
            continue
        meant = means(one.text)
        alike[meant] = alike.get(meant, 0) + 1
        if alike[meant] > ALIKE:
            continue
        score = scores[text] - (PARTLY if one.weight is Weight.ASKING else 0)
        surplus = (likelihoods[text] - own) / len(one.reading.split())
        found.append(_Rated(one, text in known, score, surplus, meant))
    return found


def _breaks_off(text: str, likelihoods: Mapping[str, float]) -> bool:
    """Whether one of the others goes on where a text ends, at hardly any cost."""
    words = len(text.split())
    return any(
        likely > likelihoods[text] - BROKEN_OFF * (len(other.split()) - words)
        for other, likely in likelihoods.items()
        if other.startswith(f"{text} ")
    )
