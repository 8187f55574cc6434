"""Speaking back: a queue in which the newest wins, and a player that can be interrupted."""

from __future__ import annotations

import subprocess
import threading
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Protocol

from polaris_nl.model.errors import SpeechError
from polaris_nl.speech.voices import Speech, Voice

SLICE_S = 0.05
"""How often a player looks whether it is interrupted."""
MOST_WAITING = 3


class Player(Protocol):
    """Plays sound."""

    def play(self, speech: Speech, stop: threading.Event) -> None:
        """Plays to the end, or until `stop` is set."""
        ...


class SoundPlayer:
    """The machine's loudspeaker.

    Raises:
        SpeechError: there is none.
    """

    def __init__(self) -> None:
        try:
            import sounddevice
        except (ImportError, OSError) as error:
            raise SpeechError("To speak, a sound device is needed; leave --aloud out.") from error
        self._library: Any = sounddevice
        if not any(d["max_output_channels"] > 0 for d in sounddevice.query_devices()):
            raise SpeechError("There is no loudspeaker here; leave --aloud out.")

    def play(self, speech: Speech, stop: threading.Event) -> None:
        """Plays to the end, or until `stop` is set."""
        size = int(speech.rate * SLICE_S) * 2
        try:
            with self._library.RawOutputStream(
                samplerate=speech.rate, channels=1, dtype="int16"
            ) as stream:
                for at in range(0, len(speech.samples), size):
                    if stop.is_set():
                        stream.abort()
                        return
                    stream.write(speech.samples[at : at + size])
        except self._library.PortAudioError:
            return  # Words that can't be heard are on the screen, too.


@dataclass(frozen=True, slots=True)
class _Saying:
    text: str
    about: str
    sound: Speech | None = None


class Speaker:
    """Says one thing after the other, in a thread of its own.

    Args:
        voice: turns text into sound.
        player: plays it.
        changed: is told when speaking starts (True) and when nothing is left to say (False).
    """

    def __init__(
        self, voice: Voice, player: Player, changed: Callable[[bool], None] = lambda speaking: None
    ) -> None:
        self._voice = voice
        self._player = player
        self.changed = changed
        self._lock = threading.Condition()
        self._waiting: list[_Saying] = []
        self._saying: _Saying | None = None
        self._stop = threading.Event()
        self._closed = False
        self._thread = threading.Thread(target=self._work, name="speaking", daemon=True)
        self._thread.start()

    @property
    def saying(self) -> str:
        """The text that is being spoken, or ""."""
        saying = self._saying
        return saying.text if saying else ""

    def say(self, text: str, about: str = "answer") -> None:
        """Says a text after what is being said.

        Args:
            text: short sentences.
            about: what it is about; what waits to be said about the same is dropped, for it is outdated.
        """
        self._add(_Saying(text, about))

    def play(self, sound: Speech) -> None:
        """Plays a chime, as soon as what is being said is over."""
        if sound.samples:
            self._add(_Saying("", "chime", sound))

    def interrupt(self) -> None:
        """Falls silent at once; what waits is dropped as well."""
        with self._lock:
            self._waiting.clear()
            self._stop.set()

    def wait(self, seconds: float) -> bool:
        """Waits until everything is said; False if it takes longer."""
        with self._lock:
            return self._lock.wait_for(lambda: not self._waiting and self._saying is None, seconds)

    def close(self) -> None:
        """Falls silent and ends the thread."""
        with self._lock:
            self._closed = True
            self._waiting.clear()
            self._stop.set()
            self._lock.notify_all()
        self._thread.join()

    def _add(self, saying: _Saying) -> None:
        with self._lock:
            self._waiting = [s for s in self._waiting if s.about != saying.about]
            self._waiting = [*self._waiting, saying][-MOST_WAITING:]
            self._lock.notify_all()

    def _work(self) -> None:
        while True:
            with self._lock:
                self._lock.wait_for(lambda: bool(self._waiting) or self._closed)
                if self._closed:
                    return
                self._saying = self._waiting.pop(0)
                self._stop.clear()
            self.changed(True)
            self._say(self._saying)
            with self._lock:
                self._saying = None
                over = not self._waiting
                self._lock.notify_all()
            if over:
                self.changed(False)

    def _say(self, saying: _Saying) -> None:
        try:
            sound = saying.sound or self._voice.speech(saying.text)
        except (SpeechError, OSError, ValueError, subprocess.SubprocessError):
            return  # Words that can't be spoken are on the screen, too.
        if not self._stop.is_set():
            self._player.play(sound, self._stop)
