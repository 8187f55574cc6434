"""What led to a moment of a run: the events behind it, by the causes that the log keeps."""

from __future__ import annotations

from collections.abc import Sequence

from polaris_nl.execution.events import (
    CheckpointReached,
    Edited,
    Event,
    GoalConfirmed,
    GoalSent,
    Heard,
    Interpreted,
    Observed,
    RobotReported,
    RunStarted,
    Skipped,
    StateChanged,
    TransitionTaken,
    Understood,
)

_PASSING = (GoalConfirmed, Skipped, StateChanged, Interpreted, Understood)
"""Steps that say nothing new to a person: what they follow from does."""


def chain(events: Sequence[Event], number: int, whole: bool = False) -> list[Event]:
    """What led to an event, oldest first, itself last.

    Args:
        events: of the log.
        number: of the event.
        whole: with every step. Otherwise actions of segments that are over, and what says nothing
            new, are left out.
    """
    known = {event.id: event for event in events}
    if number not in known:
        return []
    found: dict[int, Event] = {}
    waiting = [number]
    while waiting:
        at = waiting.pop()
        event = known.get(at)
        if event is None or at in found:
            continue
        found[at] = event
        if whole or not isinstance(event, RunStarted) or at == number:
            waiting += event.causes  # Before a run, everything that was said led to it.
    ordered = [found[n] for n in sorted(found)]
    return ordered if whole else _told(ordered, number)


def _told(events: Sequence[Event], number: int) -> list[Event]:
    """The events that a person wants to hear of."""
    decided = max((e.id for e in events if isinstance(e, TransitionTaken)), default=0)
    passing = {n for e in events if isinstance(e, GoalConfirmed) for n in e.causes}
    told = []
    for event in events:
        if event.id == number:
            told.append(event)
        elif isinstance(event, _PASSING):
            continue
        elif isinstance(event, GoalSent | RobotReported):
            if event.id > decided and _is_last(event, events):
                told.append(event)
        elif not (isinstance(event, Observed) and event.id in passing):
            told.append(event)
    return told


def _is_last(event: Event, events: Sequence[Event]) -> bool:
    """Whether no later event of the kind is among some."""
    return not any(type(e) is type(event) and e.id > event.id for e in events)


def origin(events: Sequence[Event], number: int) -> list[Event]:
    """What somebody said or changed that an event goes back to."""
    return [e for e in chain(events, number, whole=True) if isinstance(e, Heard | Edited)]


def last_checkpoint(events: Sequence[Event], number: int) -> CheckpointReached | None:
    """The checkpoint that had been reached when an event came."""
    reached = [e for e in events if isinstance(e, CheckpointReached) and e.id < number]
    return reached[-1] if reached else None
