"""Publishes snapshots: the newest one for whoever asks, every one in order for whoever subscribes."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable
from dataclasses import replace
from typing import Any

from polaris_nl.snapshot import Snapshot

Subscriber = Callable[[Snapshot], None]


class Publisher:
    """The present snapshot, and who is told of new ones. Safe to use from several threads."""

    def __init__(self, snapshot: Snapshot) -> None:
        self.snapshot = snapshot
        self._subscribers: list[Subscriber] = []
        self._untold: deque[Snapshot] = deque()
        self._telling = False
        self._changed = threading.Condition()

    def subscribe(self, subscriber: Subscriber) -> Callable[[], None]:
        """Calls back with every new snapshot; returns a function that ends that."""
        self._subscribers.append(subscriber)
        return lambda: self._subscribers.remove(subscriber)

    def next_revision(self, **changes: Any) -> Snapshot:
        """Makes the snapshot of a changed program; `tell` makes it known."""
        with self._changed:
            return self._set(revision=self.snapshot.revision + 1, **changes)

    def of_revision(self, revision: int, **changes: Any) -> Snapshot | None:
        """Adds to the snapshot of a revision; None where there is a newer one by now."""
        with self._changed:
            return self._set(**changes) if revision == self.snapshot.revision else None

    def wait(self, done: Callable[[Snapshot], bool], seconds: float) -> Snapshot:
        """Waits until the snapshot is as wanted, or for some seconds; returns the snapshot then."""
        with self._changed:
            self._changed.wait_for(lambda: done(self.snapshot), seconds)
            return self.snapshot

    def tell(self) -> None:
        """Tells the snapshots in the order they were made: one thread at a time, holding no lock."""
        with self._changed:
            if self._telling:
                return  # Whoever is telling now goes on with them.
            self._telling = True
        while True:
            with self._changed:
                if not self._untold:
                    self._telling = False
                    return
                snapshot = self._untold.popleft()
            try:
                for subscriber in tuple(self._subscribers):
                    subscriber(snapshot)
            except BaseException:
                self._telling = False
                raise

    def _set(self, **changes: Any) -> Snapshot:
        self.snapshot = replace(self.snapshot, **changes)
        self._untold.append(self.snapshot)
        self._changed.notify_all()
        return self.snapshot
