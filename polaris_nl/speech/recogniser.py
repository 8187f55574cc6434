"""Audio to words: the recogniser's protocol, and what it hears in a recording."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Protocol

from polaris_nl.speech.activity import Activity, Cutter
from polaris_nl.speech.audio import RATE

UNKNOWN = "[unk]"
_BYTES_A_SECOND = RATE * 2


@dataclass(frozen=True, slots=True)
class Decoded:
    """What a decoder makes of a piece of speech.

    Attributes:
        texts: what it may have been, the likeliest first; lower case, no punctuation; empty if no words.
        likelihoods: the natural logarithm of the likelihood of each, of sound and language together;
            empty where the recogniser doesn't tell.
    """

    texts: tuple[str, ...] = ()
    likelihoods: tuple[float, ...] = ()


@dataclass(frozen=True, slots=True)
class Spoken:
    """A piece of speech between two pauses.

    Attributes:
        alternatives: what it may have been, the likeliest first; lower case, no punctuation.
        audio: its samples, 16 kHz mono 16 bit.
        free: what a recogniser that expects nothing in particular heard, or "".
        gains: by how much each alternative explains the sound better than what was heard freely, as a
            difference of log-likelihoods; empty where that isn't known.
    """

    alternatives: tuple[str, ...]
    audio: bytes
    free: str = ""
    gains: tuple[float, ...] = ()

    @classmethod
    def of(cls, phrased: Decoded, free: Decoded | None, audio: bytes) -> Spoken:
        """A piece as two decoders heard it."""
        free = free or Decoded()
        known = bool(free.likelihoods) and len(phrased.likelihoods) == len(phrased.texts)
        gains = tuple(x - free.likelihoods[0] for x in phrased.likelihoods) if known else ()
        return cls(phrased.texts, audio, free.texts[0] if free.texts else "", gains)

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

    def finish(self) -> Decoded:
        """What the piece may have been. The next one can follow."""
        ...


class Recogniser(Protocol):
    """Makes decoders."""

    def decoder(self) -> Decoder:
        """A decoder for one stream of sound."""
        ...


class Opinion(Protocol):
    """What a second recogniser makes of one piece of speech, heard whole."""

    @property
    def texts(self) -> Sequence[str]:
        """What it may have been, the likeliest first; lower case, no punctuation."""
        ...

    def likelihoods(self, texts: Sequence[str]) -> Sequence[float]:
        """The natural logarithms of the likelihoods of any words, given the sound."""
        ...


class SecondRecogniser(Protocol):
    """Hears again what the first recogniser isn't sure of."""

    def opinion(self, sound: bytes) -> Opinion:
        """What a piece of speech may have been; 16 kHz mono 16-bit samples."""
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
    freely = free.finish() if free is not None else None
    if found.texts:
        yield Spoken.of(found, freely, audio)
