"""Recordings of any kind as 16 kHz mono blocks."""

from __future__ import annotations

from pathlib import Path

import numpy
import pytest
import soundfile

from polaris_nl.model.errors import SpeechError
from polaris_nl.speech.audio import BLOCK, RATE, Converter, file_blocks, level
from polaris_nl.speech.sources import source_for


def write_tone(path: Path, rate: int, channels: int, seconds: float = 1.0) -> Path:
    times = numpy.arange(int(rate * seconds)) / rate
    tone = 0.5 * numpy.sin(2 * numpy.pi * 440 * times)
    soundfile.write(path, numpy.column_stack([tone] * channels), rate)
    return path


@pytest.mark.parametrize(
    ("name", "rate", "channels"),
    [("a.wav", 44_100, 2), ("b.flac", 48_000, 1), ("c.wav", 8_000, 1), ("d.ogg", 22_050, 2)],
)
def test_any_rate_and_channels_become_16_khz_mono(
    tmp_path: Path, name: str, rate: int, channels: int
) -> None:
    blocks = list(file_blocks(write_tone(tmp_path / name, rate, channels)))
    samples = numpy.frombuffer(b"".join(blocks), dtype="<i2")
    assert all(len(block) == BLOCK * 2 for block in blocks[:-1])
    assert abs(len(samples) - RATE) <= BLOCK / 4
    loudest = numpy.abs(numpy.fft.rfft(samples[: RATE // 2])).argmax() * 2
    assert abs(int(loudest) - 440) <= 4
    assert 14_000 < numpy.abs(samples).max() < 18_500


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        (b"", "is empty"),
        (b"this is a text, not a sound\n" * 50, "is no recording that can be read"),
    ],
)
def test_what_is_no_sound_is_named(tmp_path: Path, content: bytes, reason: str) -> None:
    path = tmp_path / "x.wav"
    path.write_bytes(content)
    with pytest.raises(SpeechError, match=f"x.wav {reason}"):
        list(file_blocks(path))


def test_a_missing_file_and_a_soundless_one_are_named(tmp_path: Path) -> None:
    with pytest.raises(SpeechError, match=r"There is no recording .*nothing\.wav"):
        list(file_blocks(tmp_path / "nothing.wav"))
    silent = write_tone(tmp_path / "silent.wav", RATE, 1, 0.0)
    with pytest.raises(SpeechError, match="has no sound in it"):
        list(file_blocks(silent))


def test_a_recording_serves_as_a_microphone(tmp_path: Path) -> None:
    path = write_tone(tmp_path / "a.wav", RATE, 1)
    assert list(source_for(str(path)).sound()) == list(file_blocks(path))


def test_raw_sound_of_another_form_is_converted() -> None:
    times = numpy.arange(48_000) / 48_000
    tone = (0.5 * numpy.sin(2 * numpy.pi * 440 * times) * 2**31).astype("<i4")
    raw = numpy.column_stack([tone, tone]).tobytes()
    converter = Converter(48_000)
    size = 4_801 * 8 // 10
    parts = [
        block
        for at in range(0, len(raw), size - size % 8)
        for block in converter.push_bytes(raw[at : at + size - size % 8], 4, 2)
    ]
    samples = numpy.frombuffer(b"".join([*parts, *converter.rest()]), dtype="<i2")
    assert abs(len(samples) - RATE) <= BLOCK / 4
    assert 15_500 < numpy.abs(samples).max() < 17_000


def test_level_is_in_decibels_below_full_scale() -> None:
    assert level(b"\0\0" * BLOCK) < -85
    square = numpy.full(BLOCK, 32767, dtype="<i2")
    square[::2] = -32767
    assert abs(level(square.tobytes())) < 0.1
    assert abs(level((square // 10).astype("<i2").tobytes()) + 20) < 0.1
