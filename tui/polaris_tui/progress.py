"""How far a run is, from its events: what the status, the plan's mark and the map show."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Literal as OneOf

from polaris_nl.automaton.automaton import START
from polaris_nl.execution.events import (
    CheckpointReached,
    CommandGiven,
    Deviated,
    Event,
    GoalConfirmed,
    GoalSent,
    Halted,
    Observed,
    Recovered,
    RunEnded,
    RunStarted,
    StateChanged,
    TransitionTaken,
    Waiting,
)
from polaris_nl.model.formula import Literal, parse_formula
from polaris_nl.model.state import State
from polaris_nl.planning.result import BranchingPlan
from polaris_nl.render.program import first_numbers

Activity = OneOf[
    "", "loading", "connecting", "running", "waiting", "paused", "deviating", "stopping"
]

RUNS: tuple[Activity, ...] = ("connecting", "running", "waiting", "paused", "deviating", "stopping")
"""What goes on while a run does."""

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
        last: where it was last, also when the run is over.
        reached: the checkpoint reached last.
        heading: the checkpoint that is aimed for, or "".
        expected: what the action that is under way is to bring about.
        waiting: the conditionals that are waited for.
        told: what people said came true.
        missed: what was expected and isn't perceived, while that is so.
        outcome: how the run ended, and why; "" while it goes on.
    """

    state: State
    started: float | None = None
    activity: Activity = ""
    at: Place | None = None
    last: Place | None = None
    reached: str = START
    heading: str = ""
    expected: tuple[Literal, ...] = ()
    waiting: tuple[tuple[Literal, ...], ...] = ()
    told: tuple[Literal, ...] = ()
    missed: tuple[Literal, ...] = ()
    outcome: str = ""


def advanced(progress: Progress, event: Event, plan: BranchingPlan) -> Progress:
    """The progress after an event of a run of this plan."""
    match event:
        case RunStarted():
            # A stop that was said before the robot had answered is still on its way.
            activity: Activity = "stopping" if progress.activity == "stopping" else "running"
            return Progress(State(frozenset(_literals(event.beliefs))), event.time, activity)
        case Observed():
            state = progress.state.change(_literals(event.removed), _literals(event.added))
            return replace(progress, state=state)
        case GoalSent():
            at = (event.checkpoint, _number(event, plan))
            return replace(
                progress,
                at=at,
                last=at,
                heading=event.checkpoint,
                expected=tuple(_literals(event.literals)),
                waiting=(),
                missed=(),
            )
        case GoalConfirmed():
            return replace(progress, expected=(), missed=())
        case CheckpointReached():
            return replace(
                progress,
                at=(event.checkpoint, None),
                last=(event.checkpoint, None),
                reached=event.checkpoint,
                heading="",
                expected=(),
            )
        case Waiting():
            waits = tuple(tuple(_literals(when)) for when in event.conditionals)
            return replace(progress, waiting=waits, expected=())
        case TransitionTaken():
            return replace(progress, waiting=(), heading=event.target)
        case CommandGiven() if event.literals:
            return replace(progress, told=(*progress.told, *_literals(event.literals)))
        case Deviated():
            return replace(progress, missed=tuple(_literals(event.expected)))
        case Recovered():
            return replace(progress, missed=())
        case Halted():
            return replace(progress, missed=tuple(_literals(event.expected)))
        case StateChanged() if progress.activity != "stopping":
            return replace(progress, activity=_ACTIVITIES.get(event.after, "running"))
        case RunEnded():
            outcome = f"{event.outcome}: {event.reason or event.text}".strip(": ")
            return replace(progress, activity="", at=None, waiting=(), expected=(), outcome=outcome)
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
