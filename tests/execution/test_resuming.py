"""Runs that are cut off at every event, and go on from what their log holds."""

from __future__ import annotations

from dataclasses import replace

import pytest

from polaris_nl.execution.clock import VirtualClock
from polaris_nl.execution.events import (
    CheckpointReached,
    Deviated,
    Event,
    GoalConfirmed,
    GoalSent,
    Planned,
    RunEnded,
    RunStarted,
    Skipped,
)
from polaris_nl.execution.replanner import InlineReplanner
from polaris_nl.execution.resuming import resume_point, resumed_json
from polaris_nl.execution.runner import RunResult, run
from polaris_nl.execution.simulation import SimulatedRobot
from polaris_nl.model.errors import RunError
from tests.execution.story import Case, carry_out, literals
from tests.execution.test_faults import moved


def gone_on(case: Case, events: list[Event]) -> tuple[RunResult, list[Event]]:
    """A run resumed in a world that is as the log says."""
    point = resume_point(events, case.automaton, case.plan, case.world)
    planner, sunk = case.planner, list[Event]()
    robot = SimulatedRobot(
        planner.world,
        planner.mutexes,
        planner.segment,
        sink=sunk.append,
        state=point.beliefs,
        acted=point.acted,
    )
    clock = VirtualClock()
    result = run(
        case.run_plan(),
        robot,
        clock,
        confirmed=True,
        sink=sunk.append,
        resume=point,
        replanner=InlineReplanner(planner.segment),
    )
    return result, sunk


def done_in(events: list[Event]) -> list[str]:
    found = [[e.action] if isinstance(e, GoalConfirmed) else e.actions
             for e in events if isinstance(e, GoalConfirmed | Skipped)]  # fmt: skip
    return [action for actions in found for action in actions]


def test_cut_off_after_any_event_it_ends_the_same_and_repeats_nothing(lunch: Case) -> None:
    whole = carry_out(lunch)
    end = whole.events.index(whole.one(RunEnded))
    for cut in range(1, end):
        before = whole.events[:cut]
        result, after = gone_on(lunch, before)
        assert result.checkpoints == whole.result.checkpoints, cut
        assert result.outcome == "done", cut
        done = [*done_in(before), *done_in(after)]
        assert done == done_in(whole.events), cut
        reached = [e.name for e in (*before, *after) if isinstance(e, CheckpointReached)]
        assert reached == list(whole.result.checkpoints), cut
        numbers = [e.goal for e in (*before, *after) if isinstance(e, GoalSent)]
        assert numbers == sorted(set(numbers)), cut


def test_a_run_that_was_resumed_can_be_resumed_again(lunch: Case) -> None:
    whole = carry_out(lunch)
    first = whole.events[: whole.events.index(whole.of(GoalConfirmed)[1]) + 1]
    _, second = gone_on(lunch, first)
    cut = second[: second.index(next(e for e in second if isinstance(e, CheckpointReached))) + 1]
    result, third = gone_on(lunch, cut)
    assert result.checkpoints == whole.result.checkpoints
    assert [*done_in(first), *done_in(cut), *done_in(third)] == done_in(whole.events)
    assert next(e for e in second if isinstance(e, RunStarted)).text == (
        "The run goes on where it was interrupted: on the way to alerted, 2 of 3 actions done."
    )


def test_a_new_way_and_work_that_was_saved_are_kept(serve: Case) -> None:
    told = carry_out(serve, moved(5.0, "(at tray dining-table)"), moved(10.0, "(is-full tray)"))
    assert told.of(Skipped)
    found = next(e for e in told.events if isinstance(e, Deviated))
    end = told.events.index(told.one(RunEnded))
    for cut in range(told.events.index(found), end):
        result, after = gone_on(serve, told.events[:cut])
        assert result.outcome == "done", cut
        done = [*done_in(told.events[:cut]), *done_in(after)]
        assert done.count("(pick tray dining-table)") == 1, cut


def test_a_halted_run_goes_on_once_things_are_put_right(hasty_dishes: Case) -> None:
    told = carry_out(hasty_dishes)
    assert told.result.outcome == "halted"
    point = resume_point(told.events, hasty_dishes.automaton, hasty_dishes.plan, hasty_dishes.world)
    assert point.beliefs == told.result.beliefs
    back = literals("(at cup countertop)", "(at plate countertop)")
    planner = hasty_dishes.planner
    robot = SimulatedRobot(
        planner.world,
        planner.mutexes,
        planner.segment,
        state=point.beliefs.after_event(back, planner.mutexes),
        acted=point.acted,
    )
    result = run(
        hasty_dishes.run_plan(),
        robot,
        VirtualClock(),
        confirmed=True,
        sink=lambda event: None,
        resume=point,
    )
    assert result.outcome == "done"
    assert result.checkpoints[: len(told.result.checkpoints)] == told.result.checkpoints


def test_what_was_carried_out_counts_and_not_what_is_planned_now(serve: Case) -> None:
    told = carry_out(serve, moved(5.0, "(is-full tray)"))
    segment = serve.plan.segments["c1"]
    other = replace(segment, actions=segment.actions[:0:-2])
    plan = replace(serve.plan, segments={"c1": other})
    for number, event in enumerate(told.events, 1):
        if isinstance(event, GoalSent | GoalConfirmed):
            before = told.events[:number]
            state = resume_point(before, serve.automaton, plan, serve.world).state
            assert [str(a) for a in state.actions[: state.done_actions]] == done_in(before)
            if isinstance(event, GoalSent):
                assert str(state.action) == event.action


def test_what_can_not_go_on_is_refused_with_the_reason(lunch: Case, serve: Case) -> None:
    whole = carry_out(lunch).events

    def refused(events: list[Event], case: Case = lunch) -> str:
        with pytest.raises(RunError) as error:
            resume_point(events, case.automaton, case.plan, case.world)
        return str(error.value)

    assert "no run in this log" in refused([Planned(time=0.0, revision=0, status="ok")])
    assert "is done" in refused(whole)
    assert "another program" in refused(whole[:20], serve)
    start = whole[0]
    assert isinstance(start, RunStarted)
    point = resume_point(whole[:30], lunch.automaton, lunch.plan, lunch.world)
    broken = {**resumed_json(point), "checkpoint": "c99"}
    assert "c99" in refused([replace(start, resumed=broken)])
    assert "run the program anew" in refused([replace(start, resumed={"reached": []})])
