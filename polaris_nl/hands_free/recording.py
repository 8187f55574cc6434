"""The sound of what was said, kept in a log, and read from it again sample for sample."""

from __future__ import annotations

import io
import time
import wave
from collections.abc import Callable, Iterator, Mapping

from polaris_nl.logs.writer import LogWriter
from polaris_nl.model.errors import LogError
from polaris_nl.speech.audio import RATE

KIND = "audio/wav"


class AudioKeeper:
    """Keeps pieces of speech as attachments of a log.

    Args:
        log: the open log.
        now: the time in seconds since the epoch.
    """

    def __init__(self, log: LogWriter, now: Callable[[], float] = time.time) -> None:
        self._log = log
        self._now = now
        self._count = 0

    def keep(self, audio: bytes) -> str:
        """Keeps 16 kHz mono 16-bit samples; returns the attachment's name, or "" if the log is full."""
        self._count += 1
        name = f"speech-{self._count:04}.wav"
        return name if self._log.attach(name, KIND, wav(audio), self._now()) else ""


def wav(audio: bytes) -> bytes:
    """16 kHz mono 16-bit samples as a WAV file."""
    out = io.BytesIO()
    with wave.open(out, "wb") as file:
        file.setnchannels(1)
        file.setsampwidth(2)
        file.setframerate(RATE)
        file.writeframes(audio)
    return out.getvalue()


def kept(sounds: Mapping[str, bytes]) -> Iterator[tuple[str, bytes]]:
    """The pieces of speech in a log, in the order they were said: names and samples.

    Raises:
        LogError: one is no sound of this program's.
    """
    for name, data in sorted(sounds.items()):
        try:
            with wave.open(io.BytesIO(data)) as file:
                if (file.getframerate(), file.getnchannels(), file.getsampwidth()) != (RATE, 1, 2):
                    raise wave.Error("another form")
                yield name, file.readframes(file.getnframes())
        except (wave.Error, EOFError) as error:
            raise LogError(f"The sound {name} in the log can't be read ({error}).") from error
