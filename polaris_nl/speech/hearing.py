"""From what may have been said to what was said: the first reading that makes sense.

Vosk with phrases turns any speech into phrases. So every reading is parsed strictly, and the same
audio is decoded freely: where the two differ too much, the words were not meant for the robot. The
more a mistake would cost, the better the two must agree.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from polaris_nl.speech.lexicon import SoundAlikes
from polaris_nl.speech.recogniser import UNKNOWN, Spoken
from polaris_nl.speech.repair import MOST_TRIED, Repairer, apart
from polaris_nl.speech.weight import Weigh, Weight

MOST_DIFFERENT: Mapping[Weight, float] = {
    Weight.HARMLESS: 0.65, Weight.CHANGING: 0.6, Weight.MOVING: 0.5,
}  # fmt: skip
"""The most that free decoding may differ, in characters of the longer text."""
MOST_REPAIRED = 0.3
"""How different a repaired sentence may sound from what was heard freely."""

BREAK = ". "


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
        repaired: the words before they were mended, or "".
        why_not: why it isn't accepted, for the log; or "".
    """

    text: str
    accepted: bool
    alternatives: tuple[str, ...] = ()
    audio_s: float = 0.0
    free: str = ""
    different: float = 0.0
    repaired: str = ""
    why_not: str = ""


@dataclass(frozen=True)
class Ways:
    """What helps to make sense of what was heard.

    Attributes:
        alikes: words that were listened for under other words.
        repairer: finds sentences near what was heard; None for none.
    """

    alikes: SoundAlikes = field(default_factory=SoundAlikes)
    repairer: Repairer | None = None


def utterance(pieces: Sequence[Spoken], weigh: Weigh, ways: Ways = Ways()) -> Utterance:
    """What pieces of speech said together.

    Args:
        pieces: in order; the pauses between them may be ends of sentences or hesitations.
        weigh: the strict test, and what a mistake would cost.
        ways: what helps to make sense of them.
    """
    chosen: list[str] = []
    repaired = ""
    for piece in pieces:
        found = _with(chosen, _readings(piece, ways.alikes), weigh)
        if found is None and ways.repairer is not None:
            found = _with(chosen, _repairs(piece, ways.repairer), weigh)
            repaired = repaired or (piece.alternatives[0] if found is not None else "")
        chosen = found or [*chosen, ways.alikes.put_back(piece.alternatives[0])[-1]]
    text = BREAK.join(chosen)
    free = " ".join(piece.free for piece in pieces if piece.free)
    different = difference(text, free)
    why_not = _why_not(text, different, weigh)
    return Utterance(
        text,
        accepted=not why_not,
        alternatives=pieces[0].alternatives if pieces else (),
        audio_s=sum(piece.seconds for piece in pieces),
        free=free,
        different=different,
        repaired=repaired,
        why_not=why_not,
    )


def _why_not(text: str, different: float, weigh: Weigh) -> str:
    if not text:
        return "no words"
    if UNKNOWN in text:
        return "unknown words"
    weight = weigh(text)
    if weight is None:
        return "not understood"
    if different > MOST_DIFFERENT[weight]:
        return f"heard freely it is {different:.2f} different"
    return ""


def difference(text: str, free: str) -> float:
    """How far the two decodings are apart, in characters of the longer one; 0 without a second one."""
    from rapidfuzz.distance import Levenshtein

    plain = text.replace(BREAK, " ")
    return float(Levenshtein.normalized_distance(plain, free)) if free else 0.0


def near(pieces: Sequence[Spoken], weigh: Weigh, ways: Ways = Ways(), most: int = 3) -> list[str]:
    """Sentences that make sense and are near what was heard, for a question about which was meant."""
    found: dict[str, None] = {}
    for piece in pieces:
        repairs = _repairs(piece, ways.repairer) if ways.repairer is not None else iter(())
        for text in itertools.chain(_readings(piece, ways.alikes), repairs):
            if weigh(text) is not None:
                found[text] = None
            if len(found) == most:
                return list(found)
    return list(found)


def _readings(piece: Spoken, alikes: SoundAlikes) -> Iterator[str]:
    seen = set()
    for text in piece.alternatives:
        for reading in alikes.put_back(text):
            if UNKNOWN not in reading and reading not in seen:
                seen.add(reading)
                yield reading


def _repairs(piece: Spoken, repairer: Repairer) -> Iterator[str]:
    heard = [text for text in (piece.free, piece.alternatives[0]) if text and UNKNOWN not in text]
    if piece.free:
        yield piece.free
    near = (r.text for r in repairer.candidates(heard))
    for text in itertools.islice(near, MOST_TRIED):
        if not piece.free or apart(text, piece.free) <= MOST_REPAIRED:
            yield text


def _with(chosen: list[str], readings: Iterable[str], weigh: Weigh) -> list[str] | None:
    """The pieces with the first reading that makes sense as a new sentence or as more of the last."""
    readings = tuple(readings)
    for reading in readings:
        if weigh(BREAK.join([*chosen, reading])) is not None:
            return [*chosen, reading]
    if chosen:
        for reading in readings:
            joined = [*chosen[:-1], f"{chosen[-1]} {reading}"]
            if weigh(BREAK.join(joined)) is not None:
                return joined
    return None
