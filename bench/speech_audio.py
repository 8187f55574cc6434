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

SMOOTHED_S, HELD_S, MARGIN_DB = 0.03, 0.2, 15.9
"""The constants of ITU-T P.56."""
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


def kitchen(length: int, power: float, seed: int) -> Any:
    """So many samples of a kitchen's noise with a mean square."""
    noise = _kitchen(length, numpy.random.default_rng(seed))
    return noise * numpy.sqrt(power / float(numpy.mean(noise**2)))


def _with_noise(samples: Any, kind: str, decibels: float, seed: int) -> Any:
    """Noise at a ratio to the active level of the speech."""
    random = numpy.random.default_rng(seed)
    noise = (_kitchen if kind == "kitchen" else _babble)(len(samples), random)
    power = active_power(samples) / 10 ** (decibels / 10)
    scale = numpy.sqrt(power / max(float(numpy.mean(noise**2)), 1e-12))
    mixed = samples + noise * scale
    return mixed / max(1.0, float(numpy.abs(mixed).max()))


def active_power(samples: Any) -> float:
    """The mean square of speech while somebody speaks: its active level by ITU-T P.56, method B, unlogged.

    An envelope (twice smoothed with 30 ms) is compared with thresholds a factor of two apart, and what lies up
    to 200 ms behind one that is reached counts as active; the level is that at which the active part's own
    exceeds the threshold by 15.9 dB.
    """
    fall, times = numpy.exp(-1 / (RATE * SMOOTHED_S)), numpy.arange(RATE // 2)
    answer = (1 - fall) ** 2 * (times + 1) * fall**times  # of both smoothings together
    size = len(samples) + len(answer)
    spectra = numpy.fft.rfft(numpy.abs(samples), size) * numpy.fft.rfft(answer, size)
    envelope = numpy.fft.irfft(spectra, size)[: len(samples)]
    total = float(numpy.sum(samples.astype("float64") ** 2))
    levels, margins = list[float](), list[float]()
    for threshold in (2.0**-bit for bit in range(15, 0, -1)):
        reached = numpy.flatnonzero(envelope >= threshold)
        if not len(reached):
            break
        held = numpy.minimum(numpy.diff(reached, append=len(samples)), round(RATE * HELD_S))
        levels.append(10 * numpy.log10(total / float(numpy.sum(held))))
        margins.append(levels[-1] - 20 * numpy.log10(threshold))
    if not levels:
        return 0.01
    return 10 ** float(numpy.interp(-MARGIN_DB, [-m for m in margins], levels) / 10)


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
