"""The runner: no run without a yes, everything reported in order, the same seed the same story."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise

import pytest

from polaris_nl.automaton.automaton import Automaton, Checkpoint
from polaris_nl.automaton.program import Program, program_json
from polaris_nl.execution.backend import SendGoal, StopRobot
from polaris_nl.execution.clock import RealClock, VirtualClock
from polaris_nl.execution.events import (
    CheckpointReached,
    CommandGiven,
    Event,
    Failed,
    GoalSent,
    Observed,
    PersonActed,
    RunEnded,
    RunStarted,
    StateChanged,
)
from polaris_nl.execution.faults import Fault
from polaris_nl.execution.runner import run
from polaris_nl.execution.state import HumanCommand
from polaris_nl.logs.review import story
from polaris_nl.model.errors import RunError
from polaris_nl.planning.planner import Planner
from tests.execution.story import T0, BoundedClock, Case, SpiedRobot, carry_out, literals


def refused(case: Case, confirmed: bool) -> tuple[str, SpiedRobot, list[Event]]:
    robot, events = SpiedRobot(case), list[Event]()
    with pytest.raises(RunError) as error:
        run(case.run_plan(), robot, BoundedClock(T0), confirmed=confirmed, sink=events.append)
    return str(error.value), robot, events


def test_without_a_yes_nothing_runs(serve: Case) -> None:
    reason, robot, events = refused(serve, confirmed=False)
    assert "yes" in reason
    assert (robot.commanded, events) == ([], [])


def test_an_empty_program_and_one_without_a_plan_are_named(care: Planner, serve: Case) -> None:
    empty = Case(Automaton(), care.compile(Automaton()), care)
    reason, robot, events = refused(empty, confirmed=True)
    assert reason == "There is nothing to run. The program is empty."
    wrong = Checkpoint("c1", "no", literals("(at home table)"))
    impossible = serve.automaton.with_checkpoint(wrong)
    reason, *_ = refused(Case(impossible, care.compile(impossible), care), confirmed=True)
    assert "home" in reason
    assert (robot.commanded, events) == ([], [])


def test_events_are_ordered_in_time_and_framed_by_start_and_end(lunch: Case) -> None:
    told = carry_out(lunch)
    times = [e.time for e in told.events]
    assert times == sorted(times)
    assert isinstance(told.events[0], RunStarted)
    after_end = told.events[told.events.index(told.one(RunEnded)) + 1 :]
    assert [type(e) for e in after_end] == [StateChanged]
    assert times[0] == T0
    assert times[-1] == pytest.approx(T0 + told.result.seconds)


def test_the_start_tells_the_program_and_what_is_believed(lunch: Case) -> None:
    start = carry_out(lunch).one(RunStarted)
    assert start.program == program_json(Program(lunch.automaton, "caregiving", "care-home"))
    assert sorted(start.beliefs) == sorted(map(str, lunch.world.facts))


def test_the_end_says_how_long_it_took_and_what_was_reached(lunch: Case) -> None:
    told = carry_out(lunch)
    end = told.one(RunEnded)
    assert (end.outcome, end.reason) == (told.result.outcome, told.result.reason)
    assert end.checkpoints == list(told.result.checkpoints)
    assert end.checkpoints == [e.name for e in told.of(CheckpointReached)]
    assert end.seconds == pytest.approx(told.result.seconds, abs=0.001)
    assert end.seconds > 10.0


def test_the_sink_gets_everything(lunch: Case) -> None:
    given = [HumanCommand("pause", source="voice"), HumanCommand("resume", source="voice")]
    told = carry_out(lunch, commands=lambda seconds: given if 5.0 <= seconds < 5.05 else ())
    # What was commanded, what the robot was sent, what people did, and every phase.
    assert [(e.command, e.source) for e in told.of(CommandGiven)] == [
        ("pause", "voice"),
        ("resume", "voice"),
    ]
    sent = [c for _, c in told.robot.commanded if isinstance(c, SendGoal)]
    assert [(e.goal, e.action, e.literals) for e in told.of(GoalSent)] == [
        (c.goal, str(c.action), [str(x) for x in c.literals]) for c in sent
    ]
    assert [e.action for e in told.of(PersonActed)] == ["acknowledge", "walk to her room"]
    phases = told.of(StateChanged)
    assert phases[0].before == "idle"
    assert phases[-1].after == "done"
    assert all(a.after == b.before for a, b in pairwise(phases))
    # From the beliefs at the start, the changes observed lead to the beliefs at the end.
    beliefs = set(told.one(RunStarted).beliefs)
    for change in told.of(Observed):
        assert beliefs >= set(change.removed)
        beliefs = beliefs - set(change.removed) | set(change.added)
    assert beliefs == set(map(str, told.result.beliefs.facts))


def test_what_grows_stale_is_reported_once(serve: Case) -> None:
    told = carry_out(serve, Fault(2.0, "blind", seconds=1.0))
    stale = [e for e in told.of(Observed) if e.stale]
    assert [set(e.stale) for e in stale] == [set(map(str, serve.world.facts))]


def lines(events: Sequence[Event]) -> list[str]:
    return [line for line, _ in story(events)]


def test_the_same_seed_gives_the_same_story(lunch: Case) -> None:
    faults = [Fault(2.0, "fail"), Fault(15.0, "blind", seconds=3.0)]
    first, second = carry_out(lunch, *faults, seed=7), carry_out(lunch, *faults, seed=7)
    assert lines(first.events) == lines(second.events)
    assert first.events == second.events
    assert first.result == second.result


def test_another_seed_gives_people_other_times(lunch: Case) -> None:
    first, second = carry_out(lunch, seed=7), carry_out(lunch, seed=8)
    assert lines(first.events) == lines(second.events)
    assert [e.time for e in first.of(PersonActed)] != [e.time for e in second.of(PersonActed)]


def test_the_story_tells_goals_transitions_and_the_end(serve: Case) -> None:
    told = carry_out(serve)
    assert lines(told.events) == [
        "transition c0 to c1",
        *(f"goal {action}" for action in told.robot.sent),
        "checkpoint fetched",
        "end: done. The program is done.",
    ]


@pytest.mark.parametrize("error", [KeyboardInterrupt, OSError])
@pytest.mark.parametrize("where", ["sink", "commands"])
def test_whatever_breaks_the_run_leaves_the_robot_standing(
    serve: Case, error: type[BaseException], where: str
) -> None:
    robot, clock = SpiedRobot(serve), BoundedClock(T0)

    def late(result: Callable[[], tuple[()]]) -> tuple[()]:
        if clock.now() >= T0 + 6.0:
            raise error
        return result()

    def sink(event: Event) -> None:
        if where == "sink":
            late(tuple)

    def commands() -> tuple[()]:
        return late(tuple) if where == "commands" else ()

    with pytest.raises(error):
        run(serve.run_plan(), robot, clock, confirmed=True, sink=sink, commands=commands)
    assert robot.sent
    assert isinstance(robot.commanded[-1][1], StopRobot)
    moves = len(robot.motions)
    robot.advance(T0 + 500.0)
    assert len(robot.motions) == moves


def test_a_failure_event_is_no_part_of_a_good_run(lunch: Case) -> None:
    assert carry_out(lunch).of(Failed) == []


def test_the_clocks_never_run_backwards() -> None:
    virtual, real = VirtualClock(5.0), RealClock()
    virtual.sleep(-1.0)
    assert virtual.now() == 5.0
    virtual.sleep(0.25)
    assert virtual.now() == 5.25
    readings = [real.now() for _ in range(100)]
    real.sleep(-1.0)
    assert readings == sorted(readings)
    assert real.now() >= readings[-1]
