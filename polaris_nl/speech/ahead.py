"""Hears again before it is asked to: while it is still waited whether the speaker goes on."""

from __future__ import annotations

from concurrent.futures import Future, ThreadPoolExecutor
from threading import Lock

from polaris_nl.speech.recogniser import Opinion, SecondRecogniser


class Ahead:
    """A second recogniser that may begin early. What it hears is the same, only sooner.

    Args:
        inner: hears.
    """

    def __init__(self, inner: SecondRecogniser) -> None:
        self._inner = inner
        self._worker = ThreadPoolExecutor(1, "hearing-again")
        self._lock = Lock()
        self._begun: tuple[bytes, Future[Opinion]] | None = None

    def begin(self, sound: bytes) -> None:
        """Begins with a piece of speech that may be whole; what was begun with before is given up."""
        begun = self._worker.submit(self._heard, sound)
        with self._lock:
            before, self._begun = self._begun, (sound, begun)
        if before is not None:
            before[1].cancel()

    def opinion(self, sound: bytes) -> Opinion:
        """What a piece of speech may have been: from what was begun, if that was this piece."""
        with self._lock:
            begun, self._begun = self._begun, None
        if begun is not None and begun[0] == sound:
            return begun[1].result()
        return self._inner.opinion(sound)

    def _heard(self, sound: bytes) -> Opinion:
        opinion = self._inner.opinion(sound)
        _ = opinion.likelihoods(opinion.texts)  # An opinion is formed when it is asked for.
        return opinion
