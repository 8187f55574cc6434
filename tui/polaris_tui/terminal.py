"""The terminal belongs to the screen alone: what libraries write to it would damage what is drawn."""

from __future__ import annotations

import contextlib
import os
import sys
from collections.abc import Iterator
from pathlib import Path

STDERR = 2


@contextlib.contextmanager
def alone_on_the_terminal(messages: Path) -> Iterator[None]:
    """Sends what libraries write to the error output (ROS, audio drivers) to a file meanwhile.

    The screen is drawn on Python's own error stream, which goes on reaching the terminal.

    Args:
        messages: the file, which is begun anew; where it can't be made, what is written is lost.
    """
    real, ours = os.dup(STDERR), (sys.stderr, sys.__stderr__)
    # Line by line, as the real one; the screen flushes what it draws. A path can't open a descriptor (PTH123),
    # and it stays open for as long as the application has the terminal (SIM115).
    screen = open(os.dup(real), "w", encoding="utf-8", errors="replace", buffering=1)  # noqa: PTH123, SIM115
    try:
        os.dup2(_opened(messages), STDERR)
        sys.stderr = sys.__stderr__ = screen  # type: ignore[misc]  # final by convention, not by nature
        yield
    finally:
        sys.stderr, sys.__stderr__ = ours  # type: ignore[misc]
        os.dup2(real, STDERR)
        os.close(real)
        with contextlib.suppress(OSError):  # The terminal may be gone.
            screen.close()


def _opened(messages: Path) -> int:
    try:
        messages.parent.mkdir(parents=True, exist_ok=True)
        return os.open(messages, os.O_WRONLY | os.O_CREAT | os.O_TRUNC | os.O_APPEND, 0o600)
    except OSError:
        return os.open(os.devnull, os.O_WRONLY)
