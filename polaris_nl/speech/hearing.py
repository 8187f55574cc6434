"""From what may have been said to what was said: the first reading that makes sense.

Vosk with phrases turns any speech into phrases. So every reading is parsed strictly, and the same
audio is decoded
freely: where the two differ too much, the words were not meant for the robot.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

from polaris_nl.speech.recogniser import UNKNOWN, Spoken

MOST_DIFFERENT = 0.65
"""The most that free decoding may differ, in characters of the longer text. Measured: true commands stay below
0.18 (clean, 95 %) and 0.50 (10 dB of noise), chatter that passed for a command is above 0.76."""

SHORT = 5
"""Words up to which a second opinion is asked. What chatter passes for is a short command amid other words;
a longer sentence that parses strictly was meant, and decoding it again would keep the speaker waiting."""

BREAK = ". "

Parses = Callable[[str], bool]
"""Whether words, in their place after what was said before, are understood."""


@dataclass(frozen=True, slots=True)
class Utterance:
    """What was said.

    Attributes:
        text: the words; pieces that a pause separates are separated by ". ".
        accepted: whether it is taken for speech to the robot.
        alternatives: what else it may have been, of the first piece.
        audio_s: seconds of audio.
    """

    text: str
    accepted: bool
    alternatives: tuple[str, ...] = ()
    audio_s: float = 0.0


def utterance(
    pieces: Sequence[Spoken], parses: Parses, freely: Callable[[bytes], str] | None = None
) -> Utterance:
    """What pieces of speech said together.

    Args:
        pieces: in order; the pauses between them may be ends of sentences or hesitations.
        parses: the strict test.
        freely: decodes the audio without phrases, for the second opinion.
    """
    chosen: list[str] = []
    for piece in pieces:
        chosen = _with(chosen, _readable(piece), parses) or [*chosen, piece.alternatives[0]]
    text = BREAK.join(chosen)
    accepted = bool(text) and UNKNOWN not in text and parses(text)
    if accepted and freely is not None and len(text.split()) <= SHORT:
        accepted = _borne_out(text, " ".join(freely(piece.audio) for piece in pieces))
    alternatives = pieces[0].alternatives if pieces else ()
    return Utterance(text, accepted, alternatives, sum(piece.seconds for piece in pieces))


def _readable(piece: Spoken) -> tuple[str, ...]:
    return tuple(text for text in piece.alternatives if UNKNOWN not in text)


def _with(chosen: list[str], readings: Iterable[str], parses: Parses) -> list[str] | None:
    """The pieces with the first reading that makes sense as a new sentence or as more of the last."""
    readings = tuple(readings)
    for reading in readings:
        if parses(BREAK.join([*chosen, reading])):
            return [*chosen, reading]
    if chosen:
        for reading in readings:
            joined = [*chosen[:-1], f"{chosen[-1]} {reading}"]
            if parses(BREAK.join(joined)):
                return joined
    return None


def _borne_out(text: str, free: str) -> bool:
    from rapidfuzz.distance import Levenshtein

    plain = text.replace(BREAK, " ")
    return bool(Levenshtein.normalized_distance(plain, free) <= MOST_DIFFERENT)
