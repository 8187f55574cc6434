"""A run as spans of time: what was done from when to when, for timelines and statistics."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal as OneOf

from polaris_nl.execution.events import (
    CheckpointReached,
    Deviated,
    Event,
    GoalConfirmed,
    GoalSent,
    Halted,
    Recovered,
    Replanned,
    RunEnded,
    RunStarted,
    StateChanged,
    TransitionTaken,
    Waiting,
)

SpanKind = OneOf["segment", "action", "wait", "deviation", "pause"]


@dataclass(frozen=True, slots=True)
class Span:
    """Something that took time.

    Attributes:
        label: what it was: a checkpoint's name, an action in words, what was waited for.
        start, end: seconds since the run's start.
        done: whether it came to the end that it was to come to.
        number: of the event that begins it.
        action: for actions, in PDDL.
    """

    kind: SpanKind
    label: str
    start: float
    end: float
    done: bool
    number: int
    action: str = ""

    @property
    def seconds(self) -> float:
        """How long it took."""
        return self.end - self.start


@dataclass(slots=True)
class _Open:
    kind: SpanKind
    label: str
    at: float
    number: int
    action: str = ""


class _Spans:
    def __init__(self, start: float, names: Mapping[str, str]) -> None:
        self.start = start
        self.names = names
        self.found: list[Span] = []
        self._open: dict[SpanKind, _Open] = {}

    def begin(self, kind: SpanKind, label: str, event: Event, action: str = "") -> None:
        self.end(kind, event.time, False)
        self._open[kind] = _Open(kind, label, event.time, event.id, action)

    def end(self, kind: SpanKind, time: float, done: bool, label: str = "") -> None:
        begun = self._open.pop(kind, None)
        if begun is not None:
            self.found.append(
                Span(
                    kind,
                    label or begun.label,
                    begun.at - self.start,
                    time - self.start,
                    done,
                    begun.number,
                    begun.action,
                )
            )

    def end_all(self, time: float) -> None:
        for kind in list(self._open):
            self.end(kind, time, False)


def spans(events: Sequence[Event]) -> list[Span]:
    """The spans of the last run in a log, in the order in which they began."""
    starts = [n for n, e in enumerate(events) if isinstance(e, RunStarted)]
    if not starts:
        return []
    run = events[starts[-1] :]
    found = _Spans(run[0].time, _names(run[0]))
    for event in run:
        _take(found, event)
        if isinstance(event, RunEnded):
            break
    found.end_all(run[-1].time)
    order = {"segment": 0, "action": 1, "wait": 1, "deviation": 2, "pause": 2}
    return sorted(found.found, key=lambda s: (s.start, order[s.kind]))


def _names(started: Event) -> dict[str, str]:
    """The checkpoints' names by their ids."""
    program = started.program if isinstance(started, RunStarted) else {}
    return {c["id"]: c["name"] for c in program.get("checkpoints", ())}


def _take(found: _Spans, event: Event) -> None:
    time = event.time
    match event:
        case TransitionTaken():
            found.end("wait", time, True)
            found.begin("segment", found.names.get(event.target, event.target), event)
        case CheckpointReached():
            found.end("segment", time, True, event.name)
        case GoalSent():
            found.begin("action", words_of(event), event, event.action)
        case GoalConfirmed():
            found.end("action", time, True)
        case Waiting():
            found.begin("wait", _clause(event.text, "I "), event)
        case Deviated():
            found.end("action", time, False)
            found.begin("deviation", "not as expected", event)
        case Recovered() | Replanned():
            found.end("deviation", time, True)
        case StateChanged(after="paused"):
            found.begin("pause", "paused", event)
        case StateChanged(before="paused"):
            found.end("pause", time, True)
        case Halted() | RunEnded():
            found.end_all(time)


def words_of(goal: GoalSent) -> str:
    """An action in words, as an imperative; PDDL where the log has no words."""
    return _clause(goal.text, "I ") or goal.action


def _clause(text: str, lead: str) -> str:
    return text.removeprefix(lead).rstrip(".")
