"""Audio sources: files of any rate and a microphone, as blocks of 16 kHz mono 16-bit samples."""

from __future__ import annotations

import queue
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from polaris_nl.model.errors import SpeechError, UsageError

RATE = 16_000
"""Samples a second that the recogniser takes."""
BLOCK = RATE // 10
"""Samples a block: 100 ms."""
INSTALL = 'Install the voice packages with: pip install "polaris-nl[voice]"'


def file_blocks(path: Path) -> Iterator[bytes]:
    """The blocks of a recording (WAV, FLAC, OGG and others), whatever its rate and channels.

    Reads as it goes, so that a long recording takes no more memory than a short one.

    Raises:
        SpeechError: the file is missing, empty, or no recording.
    """
    try:
        import numpy
        import soundfile
        import soxr
    except ImportError as error:
        raise SpeechError(f"Reading a recording needs {error.name}. {INSTALL}") from error
    if not path.is_file():
        raise SpeechError(f"There is no recording {path}. Check the path.")
    if path.stat().st_size == 0:
        raise SpeechError(f"The recording {path} is empty; record it again.")
    try:
        with soundfile.SoundFile(path) as file:
            if file.frames == 0:
                raise SpeechError(f"The recording {path} has no sound in it; record it again.")
            resampler = soxr.ResampleStream(file.samplerate, RATE, 1, dtype="float32")
            size = max(file.samplerate // 10, 1)
            rest = numpy.zeros(0, dtype="float32")
            for block in file.blocks(size, dtype="float32", always_2d=True):
                mono = resampler.resample_chunk(numpy.ascontiguousarray(block.mean(axis=1)))
                rest = numpy.concatenate((rest, mono))
                while len(rest) >= BLOCK:
                    yield _int16(rest[:BLOCK])
                    rest = rest[BLOCK:]
            rest = numpy.concatenate((rest, resampler.resample_chunk(rest[:0], last=True)))
            if len(rest):
                yield _int16(rest)
    except soundfile.LibsndfileError as error:
        raise SpeechError(
            f"{path} is no recording that can be read ({str(error.error_string).rstrip('.')}); "
            "give a WAV or FLAC file."
        ) from error


def _int16(samples: Any) -> bytes:
    data: bytes = (samples.clip(-1.0, 1.0) * 32767).astype("<i2").tobytes()
    return data


def source_blocks(source: str | None) -> Iterator[bytes]:
    """The blocks of whatever `--mic` names: a file, or a microphone by name, number or default.

    Raises:
        SpeechError: the source can't be used.
        UsageError: the source is of a kind that isn't there yet.
    """
    if source and source.startswith("tcp://"):
        raise UsageError(
            "A microphone over the network isn't there yet; give a recording's path or a microphone's name."
        )
    if source and (
        Path(source).suffix.lower() in (".wav", ".flac", ".ogg") or Path(source).is_file()
    ):
        return file_blocks(Path(source))
    return microphone_blocks(source)


def microphone_blocks(device: str | None = None) -> Iterator[bytes]:
    """Blocks from a microphone, without end.

    Args:
        device: its name or number; the system's default if None.

    Raises:
        SpeechError: there is no microphone, or the audio packages are missing.
    """
    with _input(device) as blocks:
        while True:
            yield blocks.get()


def microphones() -> list[str]:
    """The names of the microphones there are; empty where there is no sound at all."""
    try:
        import sounddevice
    except (ImportError, OSError):
        return []
    return [d["name"] for d in sounddevice.query_devices() if d["max_input_channels"] > 0]


@contextmanager
def _input(device: str | None) -> Iterator[queue.Queue[bytes]]:
    try:
        import sounddevice
    except ImportError as error:
        raise SpeechError(f"A microphone needs sounddevice. {INSTALL}") from error
    except OSError as error:
        raise SpeechError(
            "A microphone needs the PortAudio library; install it with: sudo scripts/install-system voice"
        ) from error
    blocks: queue.Queue[bytes] = queue.Queue()

    def keep(data: Any, frames: int, time: Any, status: Any) -> None:
        blocks.put(bytes(data))

    name = int(device) if device and device.isdigit() else device
    try:
        stream = sounddevice.RawInputStream(
            samplerate=RATE, blocksize=BLOCK, channels=1, dtype="int16", device=name, callback=keep
        )
    except (sounddevice.PortAudioError, ValueError) as error:
        known = ", ".join(microphones()) or "none"
        raise SpeechError(
            f"The microphone {device or '(default)'} can't be used. Microphones here: {known}. "
            "A recording can be given instead: --mic FILE.wav"
        ) from error
    with stream:
        yield blocks
