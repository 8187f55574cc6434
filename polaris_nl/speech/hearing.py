"""From what may have been said to what was said: the reading that makes sense and that most speaks for.

Every reading of the recogniser is parsed strictly. Whether it was meant for the robot is told by the free
decoding of the same audio (`agreement`), and whether it is certain enough to be done also by the other
readings (`doubt`).
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace

from polaris_nl.speech.agreement import BREAK, difference, disagreement
from polaris_nl.speech.doubt import (
    SURE_MARGIN,
    Case,
    Means,
    Reading,
    doubts,
    is_sure,
    opposite,
)
from polaris_nl.speech.lexicon import SoundAlikes
from polaris_nl.speech.readings import ASKING_COST, Found, gain_of, placed, readings
from polaris_nl.speech.recogniser import UNKNOWN, Spoken
from polaris_nl.speech.repair import MOST_TRIED, Repairer, apart
from polaris_nl.speech.weight import Weigh, Weight

NEAR = 0.2
"""How far from the likeliest reading the free decoding may be to be one itself, where others make sense."""
LOOKED_AT, TRIED = 4, 16
"""Readings that make sense, and readings of all, after which no more are looked at."""
RANK_COST, FREE_COST = 0.02, 0.015
"""What speaks against a reading besides its difference: each place in the list, and that nothing but the
free decoding has it."""
MOST_REPAIRED = 0.3
"""How different a repaired sentence may sound from what was heard freely."""


@dataclass(frozen=True, slots=True)
class Utterance:
    """What was said.

    Attributes:
        text: the words; pieces that a pause separates are separated by ". ".
        accepted: whether it is taken for speech to the robot.
        alternatives: what else it may have been, of the first piece.
        audio_s: seconds of audio.
        free: what a recogniser that expects nothing in particular heard.
        different: how far the two are apart, from 0 to 1.
        gain: by how much the words explain the sound better than those heard freely, as a difference of
            log-likelihoods a word; None where that isn't known.
        repaired: the words before they were mended, or "".
        why_not: why it isn't accepted, for the log; or "".
        doubts: sentences to be asked about, of which one seems to have been said; or empty.
        sure: whether so much speaks for the words that they needn't be heard again.
        again: what a second recogniser heard, where it was asked; or "".
    """

    text: str
    accepted: bool
    alternatives: tuple[str, ...] = ()
    audio_s: float = 0.0
    free: str = ""
    different: float = 0.0
    gain: float | None = None
    repaired: str = ""
    why_not: str = ""
    doubts: tuple[str, ...] = ()
    sure: bool = False
    again: str = ""


@dataclass(frozen=True)
class Ways:
    """What helps to make sense of what was heard.

    Attributes:
        alikes: words that were listened for under other words.
        repairer: finds sentences near what was heard; None for none.
    """

    alikes: SoundAlikes = field(default_factory=SoundAlikes)
    repairer: Repairer | None = None

    def foreign(self, text: str, free: str) -> list[str]:
        """The words heard freely that mean nothing here; none where that isn't known."""
        return self.repairer.foreign(text, free) if self.repairer is not None else []


def utterance(
    pieces: Sequence[Spoken], weigh: Weigh, ways: Ways = Ways(), means: Means | None = None
) -> Utterance:
    """What pieces of speech said together.

    Args:
        pieces: in order; the pauses between them may be ends of sentences or hesitations.
        weigh: the strict test, and what a mistake would cost.
        ways: what helps to make sense of them.
        means: what words would do, to know which readings differ in nothing that matters; None where nobody
            can be asked about what is doubtful.
    """
    chosen: Sequence[str] = []
    repaired = ""
    gains: list[float | None] = []
    doubtful: tuple[str, ...] = ()
    sure = means is not None
    for piece in pieces:
        sensible = _sensible(chosen, piece, weigh, ways)
        found = min(sensible, key=lambda f: f.cost, default=None)
        if found is not None and means is not None:
            case = _case(found, sensible, piece, ways, weigh)
            doubtful = doubtful or doubts(case, means)
            # That it was heard freely is no second witness for what was heard only freely.
            contested = found.repaired and bool(case.rivals(means))
            sure = sure and not contested and is_sure(case, means)
        repaired = repaired or (piece.alternatives[0] if found and found.repaired else "")
        heard = ways.alikes.put_back(piece.alternatives[0])[-1]
        gains.append(gain_of(piece, found.reading if found else heard, ways.alikes))
        chosen = found.pieces if found else [*chosen, heard]
    text = BREAK.join(chosen)
    free = " ".join(piece.free for piece in pieces if piece.free)
    different = difference(text, free)
    known = [gain for gain in gains if gain is not None]
    gain = sum(known) / len(text.split()) if text and len(known) == len(pieces) else None
    why_not = disagreement(text, free, gain, weigh(text) if text else None, ways.foreign)
    if why_not:
        doubtful = ()
    elif doubtful:
        why_not = "another reading is as likely" if len(doubtful) > 1 else "little speaks for it"
    return Utterance(
        text,
        accepted=not why_not,
        alternatives=pieces[0].alternatives if pieces else (),
        audio_s=sum(piece.seconds for piece in pieces),
        free=free,
        different=different,
        gain=gain,
        repaired=repaired,
        why_not=why_not,
        doubts=doubtful,
        sure=sure and not why_not,
    )


def _case(found: Found, sensible: Sequence[Found], piece: Spoken, ways: Ways, weigh: Weigh) -> Case:
    """A reading of a piece, and all that makes it certain or doubtful."""
    chosen, *others = (
        Reading(f.text, gain_of(piece, f.reading, ways.alikes), f.rank)
        for f in (found, *sensible, *_opposites(found, piece, ways, weigh))
        if f is found or f.weight is not Weight.ASKING
    )
    apart_by = difference(found.reading, piece.free)
    return Case(chosen, others, piece.free, apart_by, found.weight)


def _opposites(found: Found, piece: Spoken, ways: Ways, weigh: Weigh) -> Iterator[Found]:
    """The readings that differ from the one found by a "not", however few were looked at."""
    for reading in readings(piece, ways.alikes):
        if opposite(reading, found.reading):
            last = found.pieces[-1].removesuffix(found.reading) + reading
            pieces = [*found.pieces[:-1], last]
            weight = weigh(BREAK.join(pieces))
            if weight is not None:
                yield replace(found, pieces=pieces, reading=reading, weight=weight)


def _sensible(chosen: Sequence[str], piece: Spoken, weigh: Weigh, ways: Ways) -> list[Found]:
    """Readings that make sense, as many as are looked at."""
    found: list[Found] = []
    for rank, reading in enumerate(itertools.islice(readings(piece, ways.alikes), TRIED)):
        if not _matters(reading, rank, found, piece, ways):
            continue
        if one := placed(chosen, reading, piece.free, RANK_COST * rank, weigh):
            found.append(replace(one, rank=rank))
        whole = bool(found) and found[-1].pieces[-1] == piece.free and found[-1].cost < ASKING_COST
        if len(found) >= LOOKED_AT or whole:
            break
    if not found:
        rest = itertools.islice(readings(piece, ways.alikes), TRIED, None)
        for reading in rest:
            if one := placed(chosen, reading, piece.free, 0.0, weigh):
                found = [replace(one, rank=TRIED)]
                break
    heard_so = piece.free and difference(piece.alternatives[0], piece.free) <= NEAR
    wanted = piece.free and ways.repairer is not None and (heard_so or not found)
    if wanted and (one := placed(chosen, piece.free, piece.free, FREE_COST, weigh)):
        found.append(replace(one, repaired=True))
    if not found and ways.repairer is not None:
        mended = _repaired(chosen, piece, weigh, ways.repairer)
        return [mended] if mended is not None else []
    return found


def _matters(reading: str, rank: int, found: Sequence[Found], piece: Spoken, ways: Ways) -> bool:
    """Whether a reading could still be the one that most speaks for, or cast a doubt on those that make sense.

    To understand a long sentence takes longer than all else here, and most readings are far behind.
    """
    if not found or RANK_COST * rank + difference(reading, piece.free) < min(f.cost for f in found):
        return True
    gain, *gains = (
        gain_of(piece, text, ways.alikes) for text in (reading, *(f.reading for f in found))
    )
    return gain is None or any(other is None or other - gain < SURE_MARGIN for other in gains)


def _repaired(
    chosen: Sequence[str], piece: Spoken, weigh: Weigh, repairer: Repairer
) -> Found | None:
    """The nearest repair that makes sense as a whole: nobody is asked about words that nobody said."""
    for text in _repairs(piece, repairer):
        found = placed(chosen, text, "", 0.0, weigh)
        if found is not None and found.weight is not Weight.ASKING:
            return replace(found, repaired=True)
    return None


def near(pieces: Sequence[Spoken], weigh: Weigh, ways: Ways = Ways(), most: int = 3) -> list[str]:
    """Sentences that make sense and are near what was heard, for a question about which was meant."""
    found: dict[str, None] = {}
    for piece in pieces:
        repairs = _repairs(piece, ways.repairer) if ways.repairer is not None else iter(())
        for text in itertools.chain(readings(piece, ways.alikes), repairs):
            if weigh(text) is not None:
                found[text] = None
            if len(found) == most:
                return list(found)
    return list(found)


def _repairs(piece: Spoken, repairer: Repairer) -> Iterator[str]:
    heard = [text for text in (piece.free, piece.alternatives[0]) if text and UNKNOWN not in text]
    near = (r.text for r in repairer.candidates(heard))
    for text in itertools.islice(near, MOST_TRIED):
        if not piece.free or apart(text, piece.free) <= MOST_REPAIRED:
            yield text
