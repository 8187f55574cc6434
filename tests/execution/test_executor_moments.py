"""The executor's core in single moments: conditions that flicker, lost answers, what is out of sight."""

from __future__ import annotations

from dataclasses import replace

import pytest

from polaris_nl.execution.backend import (
    CancelGoal,
    SendGoal,
    StopRobot,
    ZeroVelocity,
)
from polaris_nl.execution.events import (
    CheckpointReached,
    Event,
    GoalConfirmed,
    Halted,
    Recovered,
    TransitionTaken,
    Waiting,
)
from polaris_nl.execution.settings import RunSettings
from polaris_nl.execution.state import (
    TERMINAL,
    HumanCommand,
)
from tests.execution.programs import (
    ACKNOWLEDGED,
    DISMISSED,
)
from tests.execution.story import Case, literal, literals
from tests.execution.surroundings import GOING_ON, Moment, Surroundings, surroundings

OBEYS = Moment(dt=0.4, obeys=True, reports=((0, "accepted"),))


def until_alerted(case: Case, **patience: float | None) -> Surroundings:
    """As far as the checkpoint where the ways part is one action away."""
    around = surroundings(case, **patience)
    while around.state.done_actions < 2:
        around.pass_by(OBEYS)
    around.pass_by(replace(OBEYS, dt=0.1))
    assert around.state.phase in ("pursuing", "confirming")
    return around


def branch(around: Surroundings, moment: Moment) -> list[Event]:
    """What comes of the step in which the checkpoint is reached, and of a second one after it."""
    events: list[Event] = []
    while not any(isinstance(e, CheckpointReached) for e in events):
        events += around.pass_by(moment)[2]
    return [*events, *around.pass_by(moment)[2]]


def taken(events: list[Event]) -> list[tuple[str, ...]]:
    return [tuple(e.when) for e in events if isinstance(e, TransitionTaken)]


def test_the_else_is_taken_at_once_where_no_condition_holds(programs: dict[str, Case]) -> None:
    around = until_alerted(programs["otherwise"])
    events = branch(around, replace(OBEYS, dt=0.1))
    assert taken(events) == [()]
    reached = next(e for e in events if isinstance(e, CheckpointReached))
    took = next(e for e in events if isinstance(e, TransitionTaken))
    assert took.time == reached.time
    assert not any(isinstance(e, Waiting) for e in events)


def test_a_condition_that_holds_goes_before_the_else(programs: dict[str, Case]) -> None:
    around = until_alerted(programs["otherwise"])
    events = branch(around, replace(OBEYS, dt=0.4, change=(ACKNOWLEDGED,)))
    assert taken(events) == [(str(ACKNOWLEDGED),)]


def test_a_condition_that_flickers_leaves_the_else(programs: dict[str, Case]) -> None:
    around = until_alerted(programs["otherwise"])
    events = []
    while not any(isinstance(e, CheckpointReached) for e in events):
        events += around.pass_by(replace(OBEYS, dt=0.1, change=(ACKNOWLEDGED,)))[2]
    assert taken(events) == []
    gone = Moment(change=(ACKNOWLEDGED.negation,))
    assert taken(list(around.pass_by(gone)[2])) == [()]


def test_what_is_unknown_is_not_false_so_the_else_waits_for_it(programs: dict[str, Case]) -> None:
    around = until_alerted(programs["otherwise"])
    events = branch(around, replace(OBEYS, dt=0.1, lost=(ACKNOWLEDGED,)))
    assert taken(events) == []
    known = around.pass_by(Moment(dt=5.0))[2]
    assert taken(list(known)) == [()]


def test_with_conditions_only_it_waits_however_long(programs: dict[str, Case]) -> None:
    around = until_alerted(programs["labelled"], wait_s=None)
    events = branch(around, replace(OBEYS, dt=0.1))
    assert taken(events) == []
    (waiting,) = (e for e in events if isinstance(e, Waiting))
    assert waiting.conditionals == [[str(ACKNOWLEDGED)], [str(DISMISSED)]]
    for _ in range(50):
        _, commands, later = around.pass_by(Moment(dt=1000.0))
        assert (commands, later) == ((), ())
    assert around.state.phase == "waiting"
    come = [
        *around.pass_by(Moment(change=(DISMISSED,)))[2],
        *around.pass_by(Moment(dt=RunSettings().condition_s))[2],
    ]
    assert taken(come) == [(str(DISMISSED),)]


def test_a_condition_must_hold_for_a_while(programs: dict[str, Case]) -> None:
    around = until_alerted(programs["labelled"])
    branch(around, replace(OBEYS, dt=0.1))
    for _ in range(20):
        flicker = [
            *around.pass_by(Moment(dt=0.2, change=(ACKNOWLEDGED,)))[2],
            *around.pass_by(Moment(dt=0.2, change=(ACKNOWLEDGED.negation,)))[2],
        ]
        assert taken(flicker) == []


def test_a_person_may_tell_that_a_condition_came_true(programs: dict[str, Case]) -> None:
    around = until_alerted(programs["labelled"])
    branch(around, replace(OBEYS, dt=0.1))
    said = HumanCommand("happened", (DISMISSED,))
    around.pass_by(Moment(commands=(said,)))
    assert taken(list(around.pass_by(Moment(dt=0.4))[2])) == [(str(DISMISSED),)]


def test_reports_alone_confirm_nothing(programs: dict[str, Case]) -> None:
    around = surroundings(programs["labelled"], report_s=1000.0)
    reported = Moment(dt=0.5, reports=((0, "accepted"), (0, "succeeded")))
    events = [e for _ in range(100) for e in around.pass_by(reported)[2]]
    assert not any(isinstance(e, GoalConfirmed) for e in events)
    assert around.state.phase == "pursuing"


def test_a_goal_that_is_seen_is_confirmed_without_a_word_of_success(
    programs: dict[str, Case],
) -> None:
    around = surroundings(programs["labelled"])
    around.pass_by(Moment())
    around.pass_by(OBEYS)
    (confirmed,) = (e for e in around.pass_by(Moment(dt=0.4))[2] if isinstance(e, GoalConfirmed))
    assert confirmed.reported == ""


def test_a_goal_that_flickers_for_ever_runs_into_the_limit(programs: dict[str, Case]) -> None:
    around = surroundings(programs["labelled"], goal_s=20.0)
    around.pass_by(Moment())
    (there, back) = literals("(robot-at hall)", "(robot-at home)")
    for n in range(1000):
        come_and_gone = there if n % 2 else back
        around.pass_by(Moment(change=(come_and_gone,), reports=((0, "accepted"),)))
        if around.state.phase in TERMINAL:
            break
    assert around.state.outcome == "halted"
    assert around.now == pytest.approx(20.0, abs=1.0)


def test_an_action_that_is_only_glimpsed_as_done_is_sent(programs: dict[str, Case]) -> None:
    around = surroundings(programs["labelled"])
    glimpse = Moment(change=(literal("(robot-at hall)"),))
    _, commands, _ = around.pass_by(glimpse)
    assert commands == ()
    _, commands, _ = around.pass_by(Moment(change=(literal("(robot-at home)"),)))
    assert [str(c.action) for c in commands if isinstance(c, SendGoal)] == ["(move home hall)"]


def test_a_success_whose_acceptance_was_lost_is_no_silence(programs: dict[str, Case]) -> None:
    around = surroundings(programs["labelled"])
    around.pass_by(Moment())
    around.pass_by(Moment(obeys=True, reports=((0, "succeeded"),)))
    events = around.pass_by(Moment(dt=2.5))[2]
    (confirmed,) = (e for e in events if isinstance(e, GoalConfirmed))
    assert confirmed.reported == "succeeded"


def test_a_robot_that_never_answers_halts_the_run(programs: dict[str, Case]) -> None:
    around = surroundings(programs["labelled"])
    around.pass_by(Moment())
    assert around.pass_by(Moment(dt=2.0))[1] == ()
    _, commands, events = around.pass_by(Moment(dt=0.1))
    assert commands == (CancelGoal(1), ZeroVelocity(), StopRobot())
    assert any(isinstance(e, Halted) for e in events)


def test_what_is_only_out_of_sight_is_waited_for_and_not_planned_around(
    programs: dict[str, Case],
) -> None:
    around = surroundings(programs["labelled"], grace_s=30.0)
    while str(around.state.action) != "(pick tray empty-trays)":
        around.pass_by(GOING_ON)
    unseen = Moment(dt=0.4, lost=literals("(at tray empty-trays)"))
    while around.state.phase != "deviating":
        around.pass_by(replace(unseen, reports=((0, "failed"),)))
    for _ in range(20):
        around.pass_by(unseen)
        assert around.state.request is None
    assert around.state.phase == "deviating"
    assert any(isinstance(e, Recovered) for e in around.pass_by(Moment())[2])
