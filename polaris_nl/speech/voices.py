"""Voices to speak back with: text to samples."""

from __future__ import annotations

import math
import shutil
import struct
import subprocess
import wave
from array import array
from dataclasses import dataclass
from io import BytesIO
from typing import Protocol

from polaris_nl.model.errors import SpeechError
from polaris_nl.speech.modes import Cue

LOUDNESS = 0.4
"""The peak of what is said, of full scale; chimes are a quarter of it."""
SLOWEST_S = 20.0


@dataclass(frozen=True, slots=True)
class Speech:
    """Sound to be played.

    Attributes:
        samples: 16-bit mono, of this machine's byte order.
        rate: samples a second.
    """

    samples: bytes
    rate: int

    @property
    def seconds(self) -> float:
        """How long it takes."""
        return len(self.samples) / 2 / self.rate


class Voice(Protocol):
    """Turns text into sound."""

    name: str

    def speech(self, text: str) -> Speech:
        """A sentence as sound."""
        ...


class HibariVoice:
    """A natural voice that comes with its package (hibari-tts, Apache-2.0).

    Raises:
        SpeechError: the package is missing.
    """

    name = "hibari"

    def __init__(self) -> None:
        try:
            from hibari import SAMPLE_RATE, Hibari
        except ImportError as error:
            raise SpeechError("The natural voice needs hibari-tts.") from error
        self._voice = Hibari()
        self._rate = SAMPLE_RATE

    def speech(self, text: str) -> Speech:
        """A sentence as sound, the same each time."""
        found = self._voice(text, seed=0)
        peak = max(float(abs(found).max()), 1e-6) if len(found) else 1.0
        return Speech((found / peak * LOUDNESS * 32767).astype("int16").tobytes(), self._rate)


class EspeakVoice:
    """The voice of the program espeak-ng, where the natural one isn't installed.

    Raises:
        SpeechError: the program is missing.
    """

    name = "espeak-ng"

    def __init__(self) -> None:
        program = shutil.which("espeak-ng")
        if program is None:
            raise SpeechError(
                "To speak, a voice is needed: pip install hibari-tts, or install espeak-ng."
            )
        self._program = program

    def speech(self, text: str) -> Speech:
        """A sentence as sound."""
        done = subprocess.run(
            [self._program, "--stdout", "-s", "150", "--", text],
            check=True, capture_output=True, timeout=SLOWEST_S,
        )  # fmt: skip
        with wave.open(BytesIO(_closed(done.stdout))) as file:
            samples = array("h", file.readframes(file.getnframes()))
            peak = max(map(abs, samples), default=1) or 1
            scaled = array("h", (round(s * LOUDNESS * 32767 / peak) for s in samples))
            return Speech(scaled.tobytes(), file.getframerate())


def find_voice() -> Voice:
    """The best voice there is.

    Raises:
        SpeechError: there is none.
    """
    try:
        return HibariVoice()
    except SpeechError:
        return EspeakVoice()


_TONES: dict[Cue, tuple[float, ...]] = {
    "listening": (660.0, 880.0), "waiting": (880.0, 660.0), "asleep": (660.0, 440.0),
}  # fmt: skip
_TONE_S = 0.08


def chime(cue: Cue, rate: int = 24_000) -> Speech:
    """Two short tones, rising when listening starts and falling when it ends."""
    samples = array("h")
    for tone in _TONES.get(cue, ()):
        count = int(_TONE_S * rate)
        for n in range(count):
            fade = math.sin(math.pi * n / count)
            wave_ = math.sin(2 * math.pi * tone * n / rate)
            samples.append(round(LOUDNESS / 4 * 32767 * fade * wave_))
    return Speech(samples.tobytes(), rate)


def _closed(sound: bytes) -> bytes:
    """A WAV with its true length: what is written to a pipe says it is endless."""
    if len(sound) < 44 or sound[:4] != b"RIFF":
        raise SpeechError("The voice of espeak-ng gave no sound; leave --aloud out.")
    at = sound.find(b"data")
    data = sound[at + 8 :]
    head = sound[:4] + struct.pack("<I", at + len(data)) + sound[8 : at + 4]
    return head + struct.pack("<I", len(data)) + data
