"""Hears a stream: pieces of speech as soon as they end, and "stop" and "pause" before that."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace

from polaris_nl.speech.activity import BEFORE_S, KEPT_S, LONGEST_S, PAUSE_S, Cutter
from polaris_nl.speech.audio import RATE
from polaris_nl.speech.ears import Ears
from polaris_nl.speech.recogniser import UNKNOWN, Decoded, Spoken
from polaris_nl.speech.weight import Weigh, Weight

QUICK = {"stop": "stop", "pause": "pause"}
"""Words that act before the speaker has ended, and what they command."""
WHOLE_S, ENOUGH_S, PARTLY_S, MORE_S = 0.35, 0.35, 0.8, 1.1
"""Silence that ends a piece whose words are a short command, are a goal, would be asked about (as the first
half of a longer sentence is), or don't make sense yet."""
SHORT = 3
"""Words of a short command, at most."""
STEADY = 2
"""Blocks in a row that have to hear the same quick word."""
OPEN = frozenset(
    [
        "a",
        "an",
        "and",
        "at",
        "from",
        "if",
        "into",
        "onto",
        "or",
        "the",
        "to",
        "unless",
        "until",
        "with",
    ]
)
"""Words that hardly a sentence ends with: whoever pauses after one goes on."""
_BYTES_A_SECOND = RATE * 2


@dataclass(frozen=True, slots=True)
class Started:
    """Somebody starts to speak."""


@dataclass(frozen=True, slots=True)
class Quick:
    """A quick word was heard; its piece of speech may go on."""

    command: str


@dataclass(frozen=True, slots=True)
class Heard:
    """A piece of speech has ended.

    Attributes:
        spoken: what it may have been.
        quick: the quick word in it that was acted on already, or "".
        pause_s: the silence that was taken for its end.
        ended: when its last block came, by the clock of `perf_counter`.
        decoding_s: how long the recognisers took after that.
    """

    spoken: Spoken
    quick: str = ""
    pause_s: float = 0.0
    ended: float = 0.0
    decoding_s: float = 0.0


Happening = Started | Quick | Heard


class Hearer:
    """Hears one stream of sound, block by block.

    Args:
        ears: decoders and detector.
        weigh: whether words make sense now, to know how long to wait for more of them.
        clock: the time in seconds, for how long things took.
    """

    def __init__(
        self, ears: Ears, weigh: Weigh, clock: Callable[[], float] = time.perf_counter
    ) -> None:
        self._weigh = weigh
        self._clock = clock
        self._recent: deque[bytes] = deque(maxlen=round(BEFORE_S * 10))
        self._called = False
        self._beside = ThreadPoolExecutor(1, "hearing-freely")
        self.use(ears)

    def use(self, ears: Ears) -> None:
        """Hears with other ears from now on: the world has changed."""
        self._ears = ears
        self._cutter = Cutter(ears.activity)
        self._audio = bytearray()
        self._attentive = True
        self._drop()

    def _begin(self) -> None:
        self._audio.clear()
        self._quick, self._steady, self._acted = "", 0, ""
        self._pause_s = PAUSE_S

    def call(self) -> None:
        """Attention begins now: speech that goes on is cut, and only its last half second is kept."""
        if self._cutter.speaking:
            self._drop()
            self._called = True

    def push(self, block: bytes, attentive: bool) -> Iterator[Happening]:
        """Takes the next block.

        Args:
            block: 16 kHz mono 16-bit samples, 100 ms.
            attentive: whether what is said now is meant for the robot; quick words always are.
        """
        self._recent.append(block)
        cut = self._cutter.push(block, self._pause_s)
        if self._called and not self._audio:
            cut = replace(cut, sound=b"".join(self._recent), starts=True)
            self._cutter.forget()
        starts = not self._audio
        if starts and not cut.sound:
            return
        if starts:
            self._attentive = attentive
            self._ears.quick.finish()
            yield Started()
        self._feed(cut.sound)
        self._ears.quick.feed(
            cut.sound if starts else block
        )  # "Stop" doesn't wait for more speech.
        yield from self._quickly()
        if cut.ends or len(self._audio) >= LONGEST_S * _BYTES_A_SECOND:
            yield from self._ended(cut.pause_s)
        elif cut.pause_s >= KEPT_S and cut.sound and self._attentive:
            self._look()

    def end(self) -> Iterator[Happening]:
        """The sound has ended."""
        if self._audio:
            yield from self._ended(0.0)

    def _feed(self, sound: bytes) -> None:
        self._audio += sound
        if sound and self._attentive:
            self._ears.phrased.feed(sound)
            if self._ears.free is not None:
                self._ears.free.feed(sound)

    def _quickly(self) -> Iterator[Quick]:
        words = self._ears.quick.partial().split()
        word = words[0] if words and len(set(words)) == 1 and words[0] in QUICK else ""
        self._steady = self._steady + 1 if word and word == self._quick else 0
        self._quick = word
        if word and not self._acted and self._steady >= STEADY - 1:
            self._acted = QUICK[word]
            yield Quick(self._acted)

    def _look(self) -> None:
        """The speaker pauses: how long is waited for more, and may all be heard again meanwhile?"""
        found = [self._ears.phrased.partial()]
        if self._ears.free is not None:
            found.append(self._ears.free.partial())
        # Last words are the least certain: whichever decoder has them right counts.
        self._pause_s = min(_ending(t.split(), self._weigh(t) if t else None) for t in found)
        self._ears.expect(bytes(self._audio))

    def _ended(self, pause_s: float) -> Iterator[Heard]:
        ended = self._clock()
        audio, quick, called = bytes(self._audio), self._acted, self._called
        phrased, free = self._finished()
        self._called = False
        self._cutter.end()
        self._begin()
        if called:
            texts = tuple(t.removeprefix(UNKNOWN).strip() for t in phrased.texts)
            phrased = Decoded(texts, phrased.likelihoods)
        if phrased.texts or quick:
            spoken = Spoken.of(phrased if phrased.texts else Decoded((quick,)), free, audio)
            yield Heard(spoken, quick, pause_s, ended, self._clock() - ended)

    def _drop(self) -> None:
        self._finished()
        self._begin()

    def _finished(self) -> tuple[Decoded, Decoded | None]:
        """What was heard of the phrases, and freely; both at once, for somebody waits for the answer."""
        if not self._attentive:
            return Decoded(), None
        free = self._beside.submit(self._ears.free.finish) if self._ears.free is not None else None
        return self._ears.phrased.finish(), free.result() if free is not None else None


def _ending(words: Sequence[str], weight: Weight | None) -> float:
    """The silence that ends a piece of these words."""
    if weight is None or UNKNOWN in words or words[-1] in OPEN:
        return MORE_S
    if weight is Weight.ASKING:
        return PARTLY_S
    return WHOLE_S if len(words) <= SHORT else ENOUGH_S
