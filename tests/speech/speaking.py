"""Speech for tests, made by the voice that the program speaks with."""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache

import numpy

from polaris_nl.speech.audio import BLOCK, RATE, Converter
from polaris_nl.speech.trouble import Trouble
from polaris_nl.speech.voices import HibariVoice

SILENCE = b"\0\0" * BLOCK
FIRST_S, PAUSE_S = 0.6, 1.5


@lru_cache(maxsize=1)
def _voice() -> HibariVoice:
    return HibariVoice()


@lru_cache(maxsize=128)
def spoken(text: str) -> bytes:
    """A sentence as 16 kHz mono 16-bit samples."""
    speech = _voice().speech(text[0].upper() + text[1:] + ".")
    converter = Converter(speech.rate)
    return b"".join([*converter.push_bytes(speech.samples, 2, 1), *converter.rest()])


def blocks_of(sound: bytes) -> Iterator[bytes]:
    """Blocks of 100 ms, the last filled up with silence."""
    for at in range(0, len(sound), BLOCK * 2):
        yield sound[at : at + BLOCK * 2].ljust(BLOCK * 2, b"\0")


def silence(seconds: float) -> list[bytes]:
    """Some seconds of silence."""
    return [SILENCE] * round(seconds * RATE / BLOCK)


def in_noise(sound: bytes, decibels: float) -> bytes:
    """Sound with hiss at a ratio to the power of its speech, the same each time."""
    speech = numpy.frombuffer(sound, dtype="<i2").astype(float)
    noise = numpy.random.default_rng(1).normal(size=len(speech))
    noise = numpy.convolve(noise, numpy.ones(4) / 4, "same")
    power = numpy.mean(speech[numpy.abs(speech) > 600] ** 2) / 10 ** (decibels / 10)
    mixed = speech + noise * numpy.sqrt(power / numpy.mean(noise**2))
    return bytes(numpy.clip(mixed, -32767, 32767).astype("<i2").tobytes())


class Saying:
    """A source in which somebody says one sentence after the other, and waits for each answer.

    Args:
        sentences: what is said.
        pause_s: the silence after each.
    """

    name = "test"
    live = False

    def __init__(self, *sentences: str, pause_s: float = PAUSE_S) -> None:
        self._sentences = sentences
        self._pause_s = pause_s

    def sound(self) -> Iterator[bytes | Trouble]:
        yield from silence(FIRST_S)
        for sentence in self._sentences:
            yield from blocks_of(spoken(sentence))
            yield from silence(self._pause_s)
