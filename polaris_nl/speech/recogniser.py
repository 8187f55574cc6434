"""Audio to words: the recogniser's protocol, and what it hears in a recording."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Protocol

from polaris_nl.speech.activity import Activity, Cutter
from polaris_nl.speech.audio import RATE

UNKNOWN = "[unk]"
_BYTES_A_SECOND = RATE * 2


@dataclass(frozen=True, slots=True)
class Spoken:
    """A piece of speech between two pauses.

    Attributes:
        alternatives: what it may have been, the likeliest first; lower case, no punctuation.
        audio: its samples, 16 kHz mono 16 bit.
        free: what a recogniser that expects nothing in particular heard, or "".
    """

    alternatives: tuple[str, ...]
    audio: bytes
    free: str = ""

    @property
    def seconds(self) -> float:
        """How long it is."""
        return len(self.audio) / _BYTES_A_SECOND


class Decoder(Protocol):
    """Hears one piece of speech after the other."""

    def feed(self, sound: bytes) -> None:
        """Takes more of the piece."""
        ...

    def partial(self) -> str:
        """The likeliest words so far."""
        ...

    def finish(self) -> tuple[str, ...]:
        """What the piece may have been, the likeliest first; empty if no words. The next one can follow."""
        ...


class Recogniser(Protocol):
    """Makes decoders."""

    def decoder(self) -> Decoder:
        """A decoder for one stream of sound."""
        ...


def pieces(
    blocks: Iterable[bytes], activity: Activity, phrased: Decoder, free: Decoder | None = None
) -> Iterator[Spoken]:
    """Each piece of speech of a recording, as soon as its pause is heard; pieces without words are left out.

    Args:
        blocks: the sound.
        activity: where speech is.
        phrased: hears what it expects.
        free: hears whatever is said, for a second opinion.
    """
    cutter = Cutter(activity)
    cutter.begin()
    audio = bytearray()
    for block in blocks:
        cut = cutter.push(block)
        if cut.sound:
            audio += cut.sound
            phrased.feed(cut.sound)
            if free is not None:
                free.feed(cut.sound)
        if cut.ends:
            yield from _finished(bytes(audio), phrased, free)
            audio.clear()
    if audio:
        yield from _finished(bytes(audio), phrased, free)


def _finished(audio: bytes, phrased: Decoder, free: Decoder | None) -> Iterator[Spoken]:
    found = phrased.finish()
    freely = free.finish() if free is not None else ()
    if found:
        yield Spoken(found, audio, freely[0] if freely else "")
