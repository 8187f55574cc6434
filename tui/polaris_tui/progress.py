"""How far a run is, from its events: what the status, the plan's mark and the map show."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Literal as OneOf

from polaris_nl.execution.events import (
    CheckpointReached,
    Event,
    GoalSent,
    Observed,
    RunEnded,
    RunStarted,
    StateChanged,
)
from polaris_nl.model.formula import Literal, parse_formula
from polaris_nl.model.state import State
from polaris_nl.planning.result import BranchingPlan
from polaris_nl.render.program import first_numbers

Activity = OneOf["", "loading", "running", "waiting", "paused", "deviating", "stopping"]

Place = tuple[str, int | None]

_ACTIVITIES: Mapping[str, Activity] = {
    "waiting": "waiting",
    "paused": "paused",
    "deviating": "deviating",
    "halting": "stopping",
}


@dataclass(frozen=True, slots=True)
class Progress:
    """A run at one moment; without a run, how the last one ended.

    Attributes:
        state: what is believed to be true.
        started: the time of the run's first event, or None where there was no run yet.
        activity: what goes on, "" where nothing does.
        at: what the robot is at, as rows of the outline have it: a checkpoint's id and the number of
            an action on the way to it, or None where it has been reached.
    """

    state: State
    started: float | None = None
    activity: Activity = ""
    at: Place | None = None


def advanced(progress: Progress, event: Event, plan: BranchingPlan) -> Progress:
    """The progress after an event of a run of this plan."""
    match event:
        case RunStarted():
            return Progress(State(frozenset(_literals(event.beliefs))), event.time, "running")
        case Observed():
            state = progress.state.change(_literals(event.removed), _literals(event.added))
            return replace(progress, state=state)
        case GoalSent():
            return replace(progress, at=(event.checkpoint, _number(event, plan)))
        case CheckpointReached():
            return replace(progress, at=(event.checkpoint, None))
        case StateChanged() if progress.activity != "stopping":
            return replace(progress, activity=_ACTIVITIES.get(event.after, "running"))
        case RunEnded():
            return replace(progress, activity="", at=None)
    return progress


def _number(event: GoalSent, plan: BranchingPlan) -> int | None:
    """None for an action that only the newest way to the goal has."""
    segment = plan.segments.get(event.checkpoint)
    actions = [str(action) for action in segment.actions] if segment else []
    if event.action not in actions:
        return None
    return first_numbers(plan)[event.checkpoint] + actions.index(event.action)


def _literals(texts: Iterable[str]) -> list[Literal]:
    return [x for text in texts if isinstance(x := parse_formula(text), Literal)]
