"""What was said, changed and planned since the program was opened, for the logs of its runs."""

from __future__ import annotations

import threading
from collections import deque

from polaris_nl.execution.events import Event, Planned

MOST = 400
"""Events that are kept: a log says how its program came to be, and needn't hold a week of edits."""


class Minutes:
    """Takes a session's events from any thread; of all its plans, only the newest is kept."""

    def __init__(self) -> None:
        self._events: deque[Event] = deque(maxlen=MOST)
        self._planned: Planned | None = None
        self._lock = threading.Lock()

    def take(self, event: Event) -> None:
        """Keeps an event."""
        with self._lock:
            if isinstance(event, Planned):
                self._planned = event
            else:
                self._events.append(event)

    def events(self) -> tuple[Event, ...]:
        """All that is kept, in the order of time."""
        with self._lock:
            found = (*self._events, *((self._planned,) if self._planned else ()))
        return tuple(sorted(found, key=lambda event: event.time))
