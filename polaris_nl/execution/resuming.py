"""Where an interrupted run had come to, read from its events, so that nothing that is done is done again.

The log is the only record: there is no other state on disk that could disagree with it. What was
confirmed, left out or reached stays so; a goal that was under way when the run was cut off is decided
anew, from what is perceived then.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from polaris_nl.automaton.automaton import START, Automaton
from polaris_nl.automaton.program import Program, parse_action, program_json
from polaris_nl.execution.events import (
    CheckpointReached,
    Event,
    GoalConfirmed,
    GoalSent,
    Observed,
    PersonActed,
    Replanned,
    RunEnded,
    RunStarted,
    Skipped,
    TransitionTaken,
)
from polaris_nl.execution.state import ExecutorState
from polaris_nl.model.errors import FormatError, RunError
from polaris_nl.model.formula import Literal, parse_literal
from polaris_nl.model.state import State
from polaris_nl.model.world import World
from polaris_nl.planning.result import BranchingPlan


@dataclass(frozen=True, slots=True)
class ResumePoint:
    """Where a run had come to.

    Attributes:
        state: what the executor goes on from.
        beliefs: what was believed to hold at the end of the log.
        acted: what simulated people had done, each thing once.
    """

    state: ExecutorState
    beliefs: State
    acted: tuple[str, ...] = ()


def resume_point(
    events: Sequence[Event], automaton: Automaton, plan: BranchingPlan, world: World
) -> ResumePoint:
    """Where the last run in some events had come to.

    Args:
        events: of a log, in order.
        automaton: the program that is to go on; it has to be the one that ran.
        plan: its plan.
        world: its world.

    Raises:
        RunError: there is no run in the events, it is done, or it is of another program.
    """
    starts = [n for n, e in enumerate(events) if isinstance(e, RunStarted)]
    if not starts:
        raise RunError("There is no run in this log that could go on; run the program anew.")
    first = events[starts[-1]]
    assert isinstance(first, RunStarted)
    if first.program != program_json(Program(automaton, world.domain.name, world.name)):
        raise RunError(
            "This log is of another program or world, or the program has been changed since;"
            " run the program anew."
        )
    rest = events[starts[-1] + 1 :]
    if any(isinstance(e, RunEnded) and e.outcome == "done" for e in rest):
        raise RunError("The run in this log is done, so nothing is left to go on with.")
    try:
        state, literals = state_of(first.resumed, plan), _literals(first.beliefs)
        beliefs = State(frozenset(literals))
        acted, unseen = list(map(str, first.resumed.get("acted", ()))), list[str]()
        for event in rest:
            state = _after(state, event, plan)
            if isinstance(event, Observed):
                beliefs = beliefs.change(_literals(event.removed), _literals(event.added))
                # What somebody did and nobody saw is no part of the beliefs, so it is done again.
                acted, unseen = [*acted, *unseen], []
            elif isinstance(event, PersonActed):
                unseen.append(event.action)
    except (FormatError, KeyError, TypeError, ValueError) as error:
        raise RunError(
            f"This log doesn't say where the run had come to ({error}); run the program anew."
        ) from error
    return ResumePoint(state, beliefs, tuple(acted))


def resumed_json(point: ResumePoint) -> dict[str, Any]:
    """What `RunStarted.resumed` keeps, so that a run that was resumed can be resumed again."""
    state = point.state
    return {
        "checkpoint": state.checkpoint,
        "reached": list(state.reached),
        "segment": state.segment,
        "actions": [str(a) for a in state.actions],
        "done": state.done_actions,
        "served": [str(x) for x in state.served],
        "word": [str(x) for x in sorted(state.word)],
        "goal": state.goal,
        "acted": list(point.acted),
    }


def state_of(value: Mapping[str, Any], plan: BranchingPlan) -> ExecutorState:
    """What the executor went on from, from `RunStarted.resumed`; the beginning where that is empty.

    Raises:
        ValueError, KeyError, TypeError, FormatError: the record is damaged, or of another plan.
    """
    if not value:
        return ExecutorState()
    state = ExecutorState(
        checkpoint=str(value["checkpoint"]),
        reached=tuple(map(str, value["reached"])),
        segment=str(value["segment"]),
        actions=tuple(map(parse_action, value["actions"])),
        done_actions=int(value["done"]),
        served=_literals(value["served"]),
        word=frozenset(_literals(value["word"])),
        goal=int(value["goal"]),
    )
    known = {START, *plan.segments}
    unknown = {
        state.checkpoint,
        *state.reached,
        *([state.segment] if state.segment else []),
    } - known
    if unknown:
        raise ValueError(f"there is no checkpoint {min(unknown)}")
    return state


def _after(state: ExecutorState, event: Event, plan: BranchingPlan) -> ExecutorState:
    match event:
        case TransitionTaken():
            return state.towards(plan.segments[event.target], _literals(event.when))
        case GoalSent():
            # The plan that was carried out, which needn't be the one that is made of the program now.
            state = state.on_another_way(tuple(map(parse_action, event.plan)))
            return replace(state, goal=event.goal, goal_literals=_literals(event.literals))
        case GoalConfirmed():
            return state.after_actions(1, state.goal_literals, plan.segments[state.segment])
        case Skipped():
            saved = tuple(map(parse_action, event.actions))
            rest = state.actions[state.done_actions + len(saved) :]
            state = state.on_another_way(saved + rest)
            segment = plan.segments[state.segment]
            return state.after_actions(len(saved), _literals(event.literals), segment)
        case Replanned() if event.segment:
            return state.on_another_way(tuple(map(parse_action, event.after)))
        case CheckpointReached():
            return state.at_checkpoint(plan.segments[event.checkpoint])
    return state


def _literals(texts: Iterable[str]) -> tuple[Literal, ...]:
    return tuple(map(parse_literal, texts))
