"""Events to write, and logs of them."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from polaris_nl.execution.events import Event, GoalSent
from polaris_nl.logs.writer import LogSettings, LogWriter


def goal(number: int, text: str = "") -> GoalSent:
    return GoalSent(
        time=100.0 + number, text=text, goal=number, action="(a)", literals=[], checkpoint="c"
    )


def goals(count: int) -> list[Event]:
    return [goal(number) for number in range(count)]


def numbers(events: Sequence[Event]) -> list[int]:
    return [e.goal for e in events if isinstance(e, GoalSent)]


def write(path: Path, events: Sequence[Event], settings: LogSettings | None = None) -> Path:
    with LogWriter(path, settings=settings) as log:
        for event in events:
            assert log.write(event)
    assert log.failure == log.lost == ""
    return path
