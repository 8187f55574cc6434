"""Filters for events: by topic, severity, goal, entity, time or text."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Sequence

from polaris_nl.execution.events import Event, GoalSent, RunStarted
from polaris_nl.logs.schema import event_json
from polaris_nl.model.errors import UsageError

Test = Callable[[Event], bool]
LEVELS = ("debug", "info", "warning", "error")


def matcher(filters: Sequence[str], events: Sequence[Event] = ()) -> Test:
    """A test for events; all filters must hold.

    Args:
        filters: `topic=goal`, `severity=warning` (that and worse), `goal=3` or `goal=tray` (all about
            actions with that number or word), `entity=tray`, `time=12..40` (seconds since the
            run's start; either end may be missing), or any text.
        events: of the log, for goals by word and for times.

    A filter whose value makes no sense is taken for text; `check` finds those.
    """
    tests = [_test(text, events) for text in filters]
    return lambda event: all(test(event) for test in tests)


def start_of(events: Sequence[Event]) -> float:
    """The time that a log's times are counted from: of the run's start, else of the first event."""
    started = next((e for e in events if isinstance(e, RunStarted)), None)
    return started.time if started else events[0].time if events else 0.0


def _test(text: str, events: Sequence[Event]) -> Test:
    key, _, value = text.partition("=")
    wanted = value.lower()
    match key if value else "":
        case "topic":
            return lambda e: wanted in e.topic.lower()
        case "severity" if wanted in LEVELS:
            return lambda e: LEVELS.index(e.severity) >= LEVELS.index(wanted)
        case "goal":
            return _goal(wanted, events)
        case "entity":
            name = re.escape(wanted.replace(" ", "-"))
            pattern = re.compile(rf"(?<![\w-]){name}(?![\w-])")
            return lambda e: any(map(pattern.search, _literals(e)))
        case "time" if (span := _span(value)) is not None:
            low, high = (start_of(events) + x for x in span)
            return lambda e: low <= e.time <= high
    everywhere = text.lower()
    return lambda e: everywhere in json.dumps(event_json(e), ensure_ascii=False).lower()


def _goal(wanted: str, events: Sequence[Event]) -> Test:
    numbers = {
        e.goal
        for e in events
        if isinstance(e, GoalSent) and (str(e.goal) == wanted or wanted in e.action.lower())
    }
    if wanted.isdecimal():
        numbers.add(int(wanted))
    return lambda e: getattr(e, "goal", None) in numbers


def _span(value: str) -> tuple[float, float] | None:
    """A span of time in seconds; a moment is what is within half a second of it."""
    first, dots, last = value.partition("..")
    try:
        low = float(first) if first else float("-inf")
        high = float(last) if last else float("inf")
        return (low, high) if dots else (float(value) - 0.5, float(value) + 0.5)
    except ValueError:
        return None


def check(filters: Sequence[str]) -> None:
    """Finds filters that make no sense.

    Raises:
        UsageError: a severity that there is not, or a time that is none.
    """
    for text in filters:
        key, _, value = text.partition("=")
        if key == "severity" and value.lower() not in LEVELS:
            raise UsageError(f"There is no severity {value!r}; there are {', '.join(LEVELS)}.")
        if key == "time" and _span(value) is None:
            raise UsageError(
                f"{value!r} is no span of time; write for instance time=12..40, in seconds."
            )


def _literals(event: Event) -> list[str]:
    """The facts and actions of an event."""
    found: list[str] = []
    names = (
        "literals", "added", "removed", "stale", "expected", "observed", "when", "effect", "actions",
        "plan", "before", "after",
    )  # fmt: skip
    for name in names:
        value = getattr(event, name, None)
        if isinstance(value, list):
            found += [x for x in value if isinstance(x, str)]
    for conditional in getattr(event, "conditionals", ()):
        found += conditional
    return [*found, getattr(event, "action", "")]
