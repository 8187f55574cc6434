"""The speech set's audio: sentences in several voices, clean and with noise added, the same every time."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy
import soundfile
import yaml

from bench.speech_voices import sound_file, voices_of
from polaris_nl.speech.audio import RATE

SET = Path(__file__).parent / "speech_set"
CONDITIONS = ("clean", "kitchen 20 dB", "babble 20 dB", "kitchen 10 dB", "babble 10 dB")
PARTS = {
    "tuned on": ("sentences.yaml", "foreign.txt"),
    "set aside": ("aside.yaml", "foreign_aside.txt"),
}
"""The set's parts, with what is said to the robot and what isn't: settings were chosen by the first."""
BABBLED = 83
"""The babble is of the first part's foreign lines that were there at first, so that it stays the same."""


@dataclass(frozen=True, slots=True)
class Sentence:
    """One sentence of the set; `world` is "" for speech that isn't meant for the robot."""

    text: str
    part: str
    world: str = ""
    after: tuple[str, ...] = ()
    expect: str = "refused"


@cache
def sentences(part: str) -> tuple[Sentence, ...]:
    """What is said to the robot, in a part of the set."""
    groups = yaml.safe_load((SET / PARTS[part][0]).read_text(encoding="utf-8"))
    return tuple(
        Sentence(text, part, group["world"], tuple(group.get("after", ())), expect)
        for group in groups
        for text, expect in group["say"].items()
    )


@cache
def foreign(part: str) -> tuple[Sentence, ...]:
    """What is said to other people, in a part of the set."""
    lines = (SET / PARTS[part][1]).read_text(encoding="utf-8").splitlines()
    return tuple(Sentence(text, part) for text in lines)


def audio(text: str, voice: str, condition: str) -> bytes:
    """A sentence as 16 kHz mono 16-bit samples.

    Args:
        text: the sentence.
        voice: one of those that say it.
        condition: one of CONDITIONS.
    """
    samples = _samples(sound_file(text, voice))
    kind, _, rest = condition.partition(" ")
    if rest:
        seed = int(hashlib.sha256(f"{voice} {text} {condition}".encode()).hexdigest()[:8], 16)
        samples = _with_noise(samples, kind, float(rest.split()[0]), seed)
    data: bytes = (numpy.clip(samples, -1, 1) * 32767).astype("<i2").tobytes()
    return data


def blocks(data: bytes) -> Iterator[bytes]:
    """Audio in blocks of 100 ms."""
    size = RATE // 10 * 2
    return (data[at : at + size] for at in range(0, len(data), size))


def _samples(path: Path) -> Any:
    samples, rate = soundfile.read(path, dtype="float32")
    assert rate == RATE
    return samples


def _with_noise(samples: Any, kind: str, decibels: float, seed: int) -> Any:
    """Noise at a ratio to the power of the speech, pauses left out of account."""
    random = numpy.random.default_rng(seed)
    noise = (_kitchen if kind == "kitchen" else _babble)(len(samples), random)
    loud = samples[numpy.abs(samples) > 0.02]
    power = float(numpy.mean(loud**2)) if len(loud) else 0.01
    scale = numpy.sqrt(power / 10 ** (decibels / 10) / max(float(numpy.mean(noise**2)), 1e-12))
    mixed = samples + noise * scale
    return mixed / max(1.0, float(numpy.abs(mixed).max()))


def _kitchen(length: int, random: numpy.random.Generator) -> Any:
    """A fan or a tap (pink noise), and dishes: short ringing sounds of a few high tones."""
    spectrum = numpy.fft.rfft(random.normal(size=length))
    noise = numpy.fft.irfft(spectrum / numpy.sqrt(numpy.arange(len(spectrum)) + 1.0), length)
    noise /= numpy.std(noise)
    time = numpy.arange(RATE // 4) / RATE
    for _ in range(max(1, round(length / RATE * 2))):
        tones = random.uniform(1500, 6000, 4)
        clink = sum(numpy.sin(2 * numpy.pi * f * time) for f in tones) * numpy.exp(-time * 30)
        at = int(random.integers(0, length))
        piece = clink[: length - at]
        noise[at : at + len(piece)] += piece * random.uniform(0.5, 2)
    return noise


def _babble(length: int, random: numpy.random.Generator) -> Any:
    """Six people talking about something else."""
    said = [s.text for s in foreign(next(iter(PARTS)))[:BABBLED]]
    total = numpy.zeros(length, dtype="float64")
    for who in range(6):
        own = numpy.zeros(0, dtype="float32")
        while len(own) < length + RATE:
            text = said[int(random.integers(len(said)))]
            voice = voices_of(text)[who % len(voices_of(text))]
            own = numpy.concatenate([own, _samples(sound_file(text, voice))])
        start = int(random.integers(0, len(own) - length))
        total += own[start : start + length]
    return total
