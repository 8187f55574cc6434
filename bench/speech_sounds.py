"""What is said in the benches of speech."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy

from bench.speech_audio import active_power, kitchen
from polaris_nl.speech.audio import BLOCK, RATE, Converter, level
from polaris_nl.speech.voices import HibariVoice

SENTENCES = (
    "tell the resident that lunch is ready",
    "once she acknowledges bring a full tray to her table and then go home",
    "if she dismisses it just go home",
    "what will you do if she dismisses it",
    "put the blue cup in the cupboard",
    "undo that",
    "take the newspaper to the office desk",
    "read me the program",
)
SILENCE = b"\0\0" * BLOCK
_QUIET_DB = -45.0
_LOOP_S = 60


def spoken(text: str) -> list[bytes]:
    """A sentence in blocks of 100 ms, to its last sound: time counts from there."""
    speech = HibariVoice().speech(text)
    converter = Converter(speech.rate)
    sound = b"".join([*converter.push_bytes(speech.samples, 2, 1), *converter.rest()])
    blocks = [sound[at : at + BLOCK * 2] for at in range(0, len(sound), BLOCK * 2)]
    while level(blocks[-1]) < _QUIET_DB:
        blocks.pop()
    return [*blocks[:-1], blocks[-1].ljust(BLOCK * 2, b"\0")]


@dataclass
class Room:
    """What is heard beside the speech: a kitchen's noise, over and over.

    Attributes:
        noise: 16 kHz mono samples between -1 and 1.
    """

    noise: numpy.ndarray

    def __post_init__(self) -> None:
        self._at = 0

    @classmethod
    def kitchen(cls, sounds: Sequence[Sequence[bytes]], decibels: float) -> Room:
        """A kitchen whose noise is so far below the active level of some speech, on average."""
        samples = numpy.concatenate([_samples(b"".join(blocks)) for blocks in sounds])
        return cls(kitchen(_LOOP_S * RATE, active_power(samples) / 10 ** (decibels / 10), seed=1))

    def heard(self, block: bytes) -> bytes:
        """A block with the noise that comes next."""
        size = len(block) // 2
        noise = numpy.take(self.noise, range(self._at, self._at + size), mode="wrap")
        self._at = (self._at + size) % len(self.noise)
        mixed = numpy.clip(_samples(block) + noise, -1, 1)
        data: bytes = (mixed * 32767).astype("<i2").tobytes()
        return data


def _samples(data: bytes) -> numpy.ndarray:
    return numpy.frombuffer(data, dtype="<i2").astype("float32") / 32768
