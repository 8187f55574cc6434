"""Time for runs: real, or virtual and as fast as it can be."""

from __future__ import annotations

import time
from typing import Protocol


class Clock(Protocol):
    """What tells a run the time."""

    def now(self) -> float:
        """Seconds since the epoch."""
        ...

    def sleep(self, seconds: float) -> None:
        """Waits."""
        ...


class RealClock:
    """The time of day; it never runs backwards, whatever is done to the system's clock."""

    def __init__(self) -> None:
        self._offset = time.time() - time.monotonic()

    def now(self) -> float:
        """Seconds since the epoch."""
        return time.monotonic() + self._offset

    def sleep(self, seconds: float) -> None:
        """Waits."""
        time.sleep(max(0.0, seconds))


class VirtualClock:
    """Time that passes only when it is slept."""

    def __init__(self, start: float = 0.0) -> None:
        self._now = start

    def now(self) -> float:
        """Seconds since the epoch."""
        return self._now

    def sleep(self, seconds: float) -> None:
        """Lets time pass at once."""
        self._now += max(0.0, seconds)
