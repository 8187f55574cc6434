"""Recordings of any kind as 16 kHz mono blocks."""

from __future__ import annotations

from pathlib import Path

import numpy
import pytest
import soundfile

from polaris_nl.model.errors import SpeechError, UsageError
from polaris_nl.speech.audio import BLOCK, RATE, file_blocks, source_blocks


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


def test_a_network_microphone_is_said_to_come_later() -> None:
    with pytest.raises(UsageError, match="isn't there yet"):
        source_blocks("tcp://localhost:1")


def test_a_recording_serves_as_a_microphone(tmp_path: Path) -> None:
    path = write_tone(tmp_path / "a.wav", RATE, 1)
    assert b"".join(source_blocks(str(path))) == b"".join(file_blocks(path))
