"""Remembering results within a bound."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Hashable
from threading import Lock
from typing import Generic, TypeVar

K = TypeVar("K", bound=Hashable)
V = TypeVar("V")


class Memory(Generic[K, V]):
    """What was used last, up to a total weight. Safe to use from several threads.

    Args:
        limit: the total weight that is kept.
        weigh: the weight of a key with its value; the same each time it is asked.
    """

    def __init__(self, limit: int, weigh: Callable[[K, V], int] = lambda key, value: 1) -> None:
        self._limit = limit
        self._weigh = weigh
        self._kept: OrderedDict[K, V] = OrderedDict()
        self._lock = Lock()
        self.weight = 0

    def get(self, key: K) -> V | None:
        """What is remembered for a key, or None."""
        with self._lock:
            value = self._kept.get(key)
            if value is not None:
                self._kept.move_to_end(key)
            return value

    def put(self, key: K, value: V) -> None:
        """Remembers a value, and forgets those that were used longest ago where it gets too much."""
        with self._lock:
            before = self._kept.pop(key, None)
            if before is not None:
                self.weight -= self._weigh(key, before)
            self._kept[key] = value
            self.weight += self._weigh(key, value)
            while self.weight > self._limit and self._kept:
                self.weight -= self._weigh(*self._kept.popitem(last=False))

    def __len__(self) -> int:
        return len(self._kept)
