"""What a log says: summary, filters, differences. Pure functions of events."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from polaris_nl.execution.events import (
    CheckpointReached,
    CommandGiven,
    Deviated,
    Event,
    Failed,
    GoalConfirmed,
    GoalSent,
    Halted,
    Heard,
    Planned,
    Replanned,
    RunEnded,
    RunStarted,
    Skipped,
    TransitionTaken,
    Understood,
    Waiting,
)
from polaris_nl.logs.filters import matcher as matcher
from polaris_nl.logs.sayings import said
from polaris_nl.model.wording import Wording

PROBLEMS = (Deviated, Halted, Failed)


@dataclass(frozen=True, slots=True)
class Summary:
    """A log in short.

    Attributes:
        said: what people said or typed.
        understood: what was answered, in order.
        plan: status of the last plan, or "".
        outcome, reason: how the run ended; "" where it has no end.
        checkpoints: the names reached, in order.
        goals_sent, goals_done: how many actions were sent as goals, and were perceived as done.
        problems: the texts of deviations, halts and failures, with their event numbers.
        transitions: what was decided where there was a choice, in words.
        waited: what was waited for.
        started, seconds: when the run started, and how long it took.
    """

    said: tuple[str, ...]
    understood: tuple[str, ...]
    plan: str
    robot: str
    outcome: str
    reason: str
    checkpoints: tuple[str, ...]
    transitions: tuple[str, ...]
    goals_sent: int
    goals_done: int
    problems: tuple[tuple[int, str], ...]
    waited: tuple[str, ...]
    commands: tuple[str, ...]
    started: float
    seconds: float
    events: int


def summary(events: Sequence[Event]) -> Summary:
    """What was asked, understood, planned and done, how long it took, and what went wrong."""
    ended = _last(events, RunEnded)
    started = _last(events, RunStarted)
    planned = _last(events, Planned)
    first = started.time if started else (events[0].time if events else 0.0)
    last = ended.time if ended else (events[-1].time if events else first)
    return Summary(
        said=tuple(e.utterance for e in events if isinstance(e, Heard)),
        understood=tuple(e.text for e in events if isinstance(e, Understood)),
        plan=planned.status if planned else "",
        robot=started.robot if started else "",
        outcome=ended.outcome if ended else "",
        reason=ended.reason if ended else "",
        checkpoints=tuple(e.name for e in events if isinstance(e, CheckpointReached)),
        transitions=tuple(_decisions(events)),
        goals_sent=sum(isinstance(e, GoalSent) for e in events),
        goals_done=sum(isinstance(e, GoalConfirmed) for e in events),
        problems=tuple(
            (e.id or n, e.text) for n, e in enumerate(events, 1) if isinstance(e, PROBLEMS)
        ),
        waited=tuple(e.text for e in events if isinstance(e, Waiting)),
        commands=tuple(e.command for e in events if isinstance(e, CommandGiven)),
        started=first,
        seconds=last - first,
        events=len(events),
    )


def _decisions(events: Sequence[Event]) -> Iterator[str]:
    """The transitions taken where there was a choice, in words."""
    choices: set[str] = set()
    for event in events:
        if isinstance(event, RunStarted):
            choices = {t["from"] for t in event.program.get("transitions", ()) if t.get("when")}
        elif isinstance(event, TransitionTaken):
            if event.when:
                yield event.text
            elif event.source in choices:
                yield f"{event.text.rstrip('.')}, the else branch."


def next_problem(events: Sequence[Event], after: int = 0) -> int | None:
    """The number of the first problem after an event, or None."""
    found = (e.id or n for n, e in enumerate(events, 1) if isinstance(e, PROBLEMS))
    return next((n for n in found if n > after), None)


def story(events: Sequence[Event]) -> Sequence[tuple[str, Event]]:
    """A run as comparable lines: what was done and decided, without words and times, each with its event."""
    lines = []
    for event in events:
        match event:
            case GoalSent():
                line = f"goal {event.action}"
            case Skipped():
                line = f"saved {' '.join(event.actions)}"
            case Replanned():
                line = f"planned anew: {' '.join(event.after)}"
            case TransitionTaken():
                line = (
                    f"transition {event.source} to {event.target} {' '.join(event.when)}".rstrip()
                )
            case CheckpointReached():
                line = f"checkpoint {event.name}"
            case Deviated():
                line = f"deviation: expected {' '.join(event.expected)}, saw {' '.join(event.observed)}"
            case RunEnded():
                line = f"end: {event.outcome}. {event.reason}"
            case _:
                continue
        lines.append((line, event))
    return lines


def rows(
    events: Sequence[Event], start: float = 0.0, wording: Wording | None = None
) -> list[dict[str, Any]]:
    """Events as flat rows for export.

    Args:
        events: to be exported.
        start: what `seconds` are counted from, in seconds since the epoch.
        wording: how facts are put into words.
    """
    return [
        {
            "number": event.id or number,
            "time": event.time,
            "seconds": round(event.time - start, 3),
            "kind": type(event).__name__,
            "topic": event.topic,
            "severity": event.severity,
            "text": said(event, wording),
            "causes": " ".join(map(str, event.causes)),
        }
        for number, event in enumerate(events, 1)
    ]


def _last(events: Sequence[Event], kind: type[Any]) -> Any:
    return next((e for e in reversed(events) if isinstance(e, kind)), None)
