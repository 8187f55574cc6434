"""The paper's two scenarios, said in words and run in virtual time by the simulated robot."""

from __future__ import annotations

import pytest

from polaris_nl.execution.events import (
    CheckpointReached,
    Deviated,
    GoalSent,
    Halted,
    TransitionTaken,
    Waiting,
)
from polaris_nl.execution.runner import objectives_met
from polaris_nl.execution.settings import RunSettings
from tests.execution.story import FULL_TRAY, Case, Told, carry_out, literal


def met(told: Told, case: Case) -> dict[str, bool]:
    return {o.name: yes for o, yes in objectives_met(case.world, told.result.beliefs)}


def test_she_acknowledges_so_lunch_is_served_and_the_robot_goes_home(lunch: Case) -> None:
    told = carry_out(lunch)
    assert (told.result.outcome, told.result.reason) == ("done", "The program is done.")
    assert told.result.checkpoints == ("alerted", "fetched", "home")
    assert all(told.result.beliefs.holds(literal(x)) for x in (*FULL_TRAY, "(robot-at home)"))
    assert all(met(told, lunch).values())
    assert [t.when for t in told.of(TransitionTaken)] == [[], ["(acknowledged lunchtime)"], []]


def test_she_dismisses_so_the_robot_just_goes_home(lunch: Case) -> None:
    told = carry_out(lunch, people=("dismiss",))
    assert told.result.outcome == "done"
    assert told.result.checkpoints == ("alerted", "cancelled")
    assert told.result.beliefs.holds(literal("(robot-at home)"))
    assert not any("tray" in action for action in told.robot.sent)
    assert met(told, lunch) == {
        "resident told of lunch": True,
        "lunch served": False,
        "robot back home": True,
    }


def test_the_actions_sent_are_the_planned_ones(lunch: Case) -> None:
    told = carry_out(lunch)
    planned = [str(a) for c in ("c1", "c2", "c3") for a in lunch.plan.segments[c].actions]
    assert told.robot.sent == planned
    assert [str(action) for _, action in told.robot.motions] == planned
    assert [e.action for e in told.of(GoalSent)] == planned


def test_nothing_of_either_branch_is_sent_before_she_answers(lunch: Case) -> None:
    told = carry_out(lunch, human_s=(40.0, 40.0))
    waits = told.one(Waiting)
    answered = next(e for e in told.of(TransitionTaken) if e.when)
    assert answered.time - waits.time == pytest.approx(40.0, abs=1.0)
    assert not [e for e in told.of(GoalSent) if waits.time <= e.time < answered.time]


def test_nobody_answers_so_it_halts_after_the_wait_and_says_for_what(lunch: Case) -> None:
    told = carry_out(lunch, people=(), wait_s=30.0)
    assert told.result.outcome == "halted"
    assert told.result.checkpoints == ("alerted",)
    assert told.result.reason == (
        "I waited 30 seconds, but it didn't happen that lunch is acknowledged or "
        "lunch is dismissed."
    )
    halt = told.one(Halted)
    assert halt.expected == ["(acknowledged lunchtime)", "(dismissed lunchtime)"]
    assert halt.time - told.one(Waiting).time == pytest.approx(30.0, abs=0.2)
    assert told.robot.stopped


def test_without_a_limit_it_waits_as_long_as_it_takes(lunch: Case) -> None:
    far_beyond = (RunSettings().wait_s or 0.0) * 2
    told = carry_out(lunch, human_s=(far_beyond, far_beyond), wait_s=None)
    assert told.result.checkpoints == ("alerted", "fetched", "home")
    assert told.result.seconds > far_beyond


def test_the_dishes_are_washed_and_put_away_four_of_four(dishes: Case) -> None:
    told = carry_out(dishes)
    assert told.result.outcome == "done"
    assert met(told, dishes) == {
        "cup clean": True,
        "plate clean": True,
        "clean cup in the cupboard": True,
        "clean plate in the cupboard": True,
    }
    waits = told.one(Waiting)
    assert waits.conditionals == [["(at cup drying-rack)", "(at plate drying-rack)"]]


def test_a_cup_that_is_washed_before_the_plate_comes_has_served_its_goal(dishes: Case) -> None:
    told = carry_out(dishes, human_s=(0.5, 0.5))
    washed = next(
        i for i, e in enumerate(told.events) if getattr(e, "action", "") == "wash the cup"
    )
    first = told.of(CheckpointReached)[0]
    assert washed < told.events.index(first)
    assert told.result.outcome == "done"


def test_without_the_wait_it_halts_and_says_what_it_expected_and_saw(hasty_dishes: Case) -> None:
    told = carry_out(hasty_dishes)
    assert told.result.outcome == "halted"
    assert told.result.reason == (
        "I expected that the cup is on the countertop, but I see that the cup is on the "
        "drying rack. Put that right and resume the run, or let the program wait until the cup "
        "is on the drying rack."
    )
    deviated, halt = told.one(Deviated), told.one(Halted)
    assert deviated.expected == halt.expected == ["(at cup countertop)"]
    assert deviated.observed == halt.observed == ["(at cup drying-rack)"]
    assert halt.time - deviated.time == pytest.approx(RunSettings().grace_s, abs=0.2)
    assert not met(told, hasty_dishes)["clean cup in the cupboard"]
