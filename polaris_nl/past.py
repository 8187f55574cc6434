"""What led to a session's present program, remembered for the logs of its runs.

A run's log has to answer "why" down to the words, so it begins with what was heard, understood and changed
before it.
"""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Iterable, Sequence

from polaris_nl.execution.events import Edited, Event, Heard, Interpreted, Planned, Understood

WORDS: tuple[type[Event], ...] = (Heard, Interpreted, Understood, Edited)
LIMIT = 5000
"""Events that are remembered; what a day-long session had before them is in its own log, where it keeps one."""


class Past:
    """The events of a session, as they come. Safe to use from several threads."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._events: deque[Event] = deque(maxlen=LIMIT)

    def add(self, event: Event) -> None:
        """Remembers an event, if it can have led to the program or its plan."""
        if isinstance(event, (*WORDS, Planned)):
            with self._lock:
                self._events.append(event)

    def events(self) -> tuple[Event, ...]:
        """What led to the program now."""
        with self._lock:
            return authored(tuple(self._events))


def authored(events: Sequence[Event]) -> tuple[Event, ...]:
    """Of events, those that led to a program: words, changes, and the plan of the last revision.

    Plans of earlier revisions say nothing about the program that is run, and are large.
    """
    kept = _last(events)
    return tuple(e for e in events if isinstance(e, WORDS) or e is kept)


def _last(events: Iterable[Event]) -> Planned | None:
    found = None
    for event in events:
        if isinstance(event, Edited):
            found = None  # Planned again, or not planned yet.
        elif isinstance(event, Planned):
            found = event
    return found
