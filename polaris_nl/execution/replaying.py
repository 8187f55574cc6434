"""Carries a logged run out once more without its robot, from what the executor was given then.

The executor's core is pure, so the same inputs have to lead to the same decisions; where they don't, the
program has changed since, or the log isn't what happened.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from polaris_nl.automaton.automaton import Automaton
from polaris_nl.automaton.program import parse_action
from polaris_nl.execution.events import (
    CheckpointReached,
    CommandGiven,
    Deviated,
    Event,
    GoalConfirmed,
    GoalSent,
    Halted,
    Recovered,
    Replanned,
    RobotReported,
    RunEnded,
    RunStarted,
    Skipped,
    StateChanged,
    Stepped,
    TransitionTaken,
    Waiting,
)
from polaris_nl.execution.executor import step
from polaris_nl.execution.inputs import Inverse
from polaris_nl.execution.resuming import state_of
from polaris_nl.execution.state import TERMINAL, RunPlan
from polaris_nl.model.formula import parse_literal
from polaris_nl.model.state import State
from polaris_nl.planning.result import BranchingPlan, Segment

DECISIONS: tuple[type[Event], ...] = (
    StateChanged, CheckpointReached, GoalSent, GoalConfirmed, Skipped, RobotReported, Waiting,
    TransitionTaken, Deviated, Recovered, Replanned, Halted, CommandGiven, RunEnded,
)  # fmt: skip
"""What comes from the executor's core."""


@dataclass(frozen=True, slots=True)
class Difference:
    """The first decision that a replay made otherwise: the logged event and the replayed one.

    Attributes:
        number: of the logged event, or of the last one where it has no counterpart.
    """

    number: int
    logged: Event | None
    replayed: Event | None


def replay(run: RunPlan, started: RunStarted, inputs: Iterable[Stepped]) -> list[Event]:
    """The executor's decisions on logged inputs.

    Args:
        run: program, plan, world, words and settings of the run.
        started: the run's first event.
        inputs: of its steps, in order.

    Raises:
        ValueError, KeyError, TypeError, FormatError: the records are damaged.
    """
    beliefs = State(frozenset(map(parse_literal, started.beliefs)))
    inverse = Inverse(beliefs)
    state = replace(state_of(started.resumed, run.plan), now=started.time, since=started.time)
    found: list[Event] = []
    for record in inputs:
        if state.phase in TERMINAL:
            break
        state, _, events = step(run, state, record.time, inverse.inputs(record))
        found += events
    return found


def first_difference(logged: Sequence[Event], replayed: Sequence[Event]) -> Difference | None:
    """Where a replay went another way, whatever the words; None where it is the same.

    Args:
        logged: the events of the run, others than decisions included.
        replayed: what the replay made. Where the log was cut off, either may be longer by what
            the last step did.
    """
    decided = [e for e in logged if isinstance(e, DECISIONS)]
    for ours, theirs in zip(decided, replayed, strict=False):
        if _bare(ours) != _bare(theirs):
            return Difference(ours.id, ours, theirs)
    ended = any(isinstance(e, RunEnded) for e in decided)
    if ended and len(decided) != len(replayed):
        last = decided[-1]
        rest = (*decided[len(replayed) :], None)[0], (*replayed[len(decided) :], None)[0]
        return Difference(last.id, *rest)
    return None


def plan_of(segments: Iterable[Mapping[str, Any]], automaton: Automaton) -> BranchingPlan:
    """The plan that a run followed, from `RunStarted.segments`; without the states between.

    Raises:
        ValueError, KeyError, TypeError, FormatError: the record is damaged.
    """
    nothing = State(frozenset())
    found = {}
    for value in segments:
        transition = automaton.transitions[value["transition"]]
        found[transition.target] = Segment(
            transition.id,
            transition.source,
            transition.target,
            transition.when,
            tuple(map(parse_literal, value["goals"])),
            tuple(map(parse_action, value["actions"])),
            False,
            nothing,
            nothing,
        )
    return BranchingPlan("ok", found, None)


def segments_json(plan: BranchingPlan) -> list[dict[str, Any]]:
    """What `plan_of` makes a plan of."""
    return [
        {
            "transition": s.transition,
            "goals": [str(x) for x in s.goals],
            "actions": [str(a) for a in s.actions],
        }
        for s in plan.segments.values()
    ]


def _bare(event: Event) -> Event:
    """An event without its words, and without a run's length, which is measured outside the core."""
    words = {"text": "", "reason": "", "seconds": 0.0}
    if not isinstance(event, RunEnded):
        del words["seconds"]
    return replace(event, **{name: x for name, x in words.items() if hasattr(event, name)})  # type: ignore[arg-type] # fields by their names
