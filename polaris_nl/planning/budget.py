"""Limits on how long something may be looked for."""

from __future__ import annotations

import time
from collections.abc import Callable


def never() -> bool:
    """The answer to "is this cancelled?" where nothing cancels."""
    return False


def within(seconds: float, cancelled: Callable[[], bool]) -> Callable[[], bool]:
    """Asked now and then, it is True once some time is over, or the work is cancelled."""
    deadline = time.monotonic() + seconds
    return lambda: cancelled() or time.monotonic() > deadline
