"""Ends a translation that takes too long or that nobody wants any more.

The translator is a library in this process, so it can't be killed as the search can. What can take
for ever in it is counting out combinations of things: each that it finds goes through its queue, its
`Action.instantiate` and its `translate_strips_operator`. These three are made to look at the time.
Everything else that it does is small beside their results.
"""

from __future__ import annotations

import functools
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from types import ModuleType
from typing import Any

from polaris_nl.model.errors import PlanningError

LIMIT_S = 10.0
"""How long one translation may take."""
EVERY = 500
"""Combinations between two looks at the time: some milliseconds."""
_TOO_LONG = (
    "There are too many ways to combine the things that this may need; ask for less at once, or use a "
    "smaller world."
)


class Cancelled(PlanningError):
    """Nobody wants the result any more."""


class _Watch:
    """What is looked at now and then; the translator does one thing at a time, so there is one."""

    def __init__(self) -> None:
        self._left = EVERY
        self._look: Callable[[], None] = lambda: None

    @contextmanager
    def limited(self, seconds: float, cancelled: Callable[[], bool]) -> Iterator[None]:
        deadline = time.monotonic() + seconds

        def look() -> None:
            if cancelled():
                raise Cancelled("It isn't wanted any more.")
            if time.monotonic() > deadline:
                raise PlanningError(_TOO_LONG)

        before, self._look = self._look, look
        try:
            yield
        finally:
            self._look = before

    def count(self) -> None:
        self._left -= 1
        if self._left <= 0:
            self._left = EVERY
            self._look()


_WATCH = _Watch()
limited = _WATCH.limited
"""A context in which the translator raises `PlanningError` after some seconds, or `Cancelled`."""


def watch(parts: Mapping[str, ModuleType]) -> None:
    """Makes the translator's modules look at the time; once is enough."""
    plain_queue: Any = parts["build_model"].__dict__["Queue"]

    class Queue(plain_queue):  # type: ignore[misc] # known at run time only
        """The translator's queue of what it has found."""

        def push(self, predicate: Any, args: Any) -> None:
            _WATCH.count()
            super().push(predicate, args)

        def pop(self) -> Any:
            _WATCH.count()
            return super().pop()

    replace: dict[str, tuple[Any, Any]] = {
        "Queue": (parts["build_model"], Queue),
        "instantiate": (parts["pddl"].Action, None),
        "translate_strips_operator": (parts["main"], None),
    }
    for name, (owner, new) in replace.items():
        setattr(owner, name, new or _counted(getattr(owner, name)))


def _counted(function: Callable[..., Any]) -> Callable[..., Any]:
    @functools.wraps(function)
    def counted(*args: Any, **named: Any) -> Any:
        _WATCH.count()
        return function(*args, **named)

    return counted
