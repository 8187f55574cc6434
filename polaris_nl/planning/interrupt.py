"""Ends work of this process's own that takes too long or that nobody wants any more.

The translator is Python code in this process, which can't be killed as the search can. So a second
thread watches it, and makes the working thread raise where it is. Python promises that for its own
code only: a call that never returns to it can't be ended so.
"""

from __future__ import annotations

import ctypes
import threading
import time
from collections.abc import Callable
from typing import TypeVar

from polaris_nl.model.errors import PlanningError

POLL_S = 0.05
"""How often work is looked at."""

T = TypeVar("T")


class Cancelled(PlanningError):
    """Nobody wants the result any more."""


class _Ended(BaseException):
    """Raised in the working thread; nothing that catches ordinary errors catches it."""


def limited(
    work: Callable[[], T], seconds: float, cancelled: Callable[[], bool], too_long: str
) -> T:
    """The result of some work.

    Args:
        work: Python code that leaves nothing half done behind where it is interrupted.
        seconds: how long it may take.
        cancelled: asked now and then; True ends it.
        too_long: what to say, in one sentence, where it takes longer.

    Raises:
        PlanningError: it took too long.
        Cancelled: `cancelled` said so.
    """
    working = threading.get_ident()
    deadline = time.monotonic() + seconds
    over = threading.Event()
    ended: list[PlanningError] = []

    def watch() -> None:
        while not over.wait(POLL_S):
            unwanted = cancelled()
            if unwanted or time.monotonic() > deadline:
                ended.append(Cancelled("It isn't wanted.") if unwanted else PlanningError(too_long))
                ctypes.pythonapi.PyThreadState_SetAsyncExc(
                    ctypes.c_ulong(working), ctypes.py_object(_Ended)
                )
                return

    watcher = threading.Thread(target=watch, name="planning-watch", daemon=True)
    watcher.start()
    try:
        try:
            return work()
        finally:
            over.set()
            watcher.join()
            for _ in range(2 if ended else 0):
                pass  # What was raised just before the end arrives at a jump back, at the latest.
    except _Ended:
        raise ended[0] from None
