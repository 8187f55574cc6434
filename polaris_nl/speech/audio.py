"""Sound as the recogniser takes it: blocks of 16 kHz mono 16-bit samples, from recordings of any kind."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

from polaris_nl.model.errors import SpeechError

RATE = 16_000
"""Samples a second that the recogniser takes."""
BLOCK = RATE // 10
_FRAME = RATE // 50
"""Samples a block: 100 ms."""
INSTALL = 'Install the voice packages with: pip install "polaris-nl[voice]"'


def file_blocks(path: Path) -> Iterator[bytes]:
    """The blocks of a recording (WAV, FLAC, OGG and others), whatever its rate and channels.

    Reads as it goes, so that a long recording takes no more memory than a short one.

    Raises:
        SpeechError: the file is missing, empty, or no recording.
    """
    try:
        import soundfile
    except (ImportError, OSError) as error:
        raise SpeechError(f"Reading a recording needs soundfile. {INSTALL}") from error
    if not path.is_file():
        raise SpeechError(f"There is no recording {path}. Check the path.")
    if path.stat().st_size == 0:
        raise SpeechError(f"The recording {path} is empty; record it again.")
    try:
        with soundfile.SoundFile(path) as file:
            if file.frames == 0:
                raise SpeechError(f"The recording {path} has no sound in it; record it again.")
            converter = Converter(file.samplerate)
            size = max(file.samplerate // 10, 1)
            for block in file.blocks(size, dtype="float32", always_2d=True):
                yield from converter.push(block)
            yield from converter.rest()
    except soundfile.LibsndfileError as error:
        raise SpeechError(
            f"{path} is no recording that can be read ({str(error.error_string).rstrip('.')}); "
            "give a WAV or FLAC file."
        ) from error


class Converter:
    """Turns samples of any rate and channels into blocks, as they come.

    Args:
        rate: samples a second of what comes.

    Raises:
        SpeechError: a package is missing.
    """

    def __init__(self, rate: int) -> None:
        try:
            import numpy
            import soxr
        except ImportError as error:
            raise SpeechError(f"Listening needs {error.name}. {INSTALL}") from error
        self._numpy = numpy
        self._resampler = soxr.ResampleStream(rate, RATE, 1, dtype="float32")
        self._rest = numpy.zeros(0, dtype="float32")

    def push(self, samples: Any) -> Iterator[bytes]:
        """The whole blocks that samples complete.

        Args:
            samples: floats from -1 to 1, one column a channel.
        """
        mono = self._numpy.ascontiguousarray(samples.mean(axis=1), dtype="float32")
        self._rest = self._numpy.concatenate((self._rest, self._resampler.resample_chunk(mono)))
        while len(self._rest) >= BLOCK:
            yield _int16(self._rest[:BLOCK])
            self._rest = self._rest[BLOCK:]

    def rest(self) -> Iterator[bytes]:
        """The last block, which may be shorter."""
        last = self._resampler.resample_chunk(self._rest[:0], last=True)
        rest, self._rest = self._numpy.concatenate((self._rest, last)), self._rest[:0]
        while len(rest):
            yield _int16(rest[:BLOCK])
            rest = rest[BLOCK:]

    def push_bytes(self, sound: bytes, width: int, channels: int) -> Iterator[bytes]:
        """The whole blocks that raw little-endian samples complete.

        Args:
            sound: interleaved samples.
            width: bytes a sample: 2 or 4.
            channels: how many are interleaved.
        """
        whole = len(sound) // (width * channels) * width * channels
        samples = self._numpy.frombuffer(sound[:whole], dtype=f"<i{width}")
        scaled = samples.astype("float32") / float(1 << (8 * width - 1))
        return self.push(scaled.reshape(-1, channels))


def level(block: bytes) -> float:
    """How loud a block is, in decibels below full scale: 0 is the loudest, silence is -90 or so."""
    import numpy

    samples = numpy.frombuffer(block, dtype="<i2").astype("float64")
    power = float(numpy.mean(samples**2)) if len(samples) else 0.0
    return 10 * float(numpy.log10(max(power, 1.0) / 32768.0**2))


def contrast(sound: bytes) -> float:
    """How far speech stands out of what is heard between its words, in decibels: 40 in a quiet room."""
    import numpy

    samples = numpy.frombuffer(sound, dtype="<i2").astype("float64")
    frames = samples[: len(samples) // _FRAME * _FRAME].reshape(-1, _FRAME)
    if not len(frames):
        return 0.0
    loudness = 10 * numpy.log10(numpy.maximum((frames**2).mean(axis=1), 1.0))
    quiet, loud = numpy.percentile(loudness, (10, 90))
    return float(loud - quiet)


def _int16(samples: Any) -> bytes:
    data: bytes = (samples * 32768).round().clip(-32768, 32767).astype("<i2").tobytes()
    return data
