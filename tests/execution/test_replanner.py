"""Re-planners: each answer once, an older request forgotten, nothing that the robot can't do."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Sequence

import pytest

from polaris_nl.execution.replanner import (
    InlineReplanner,
    NoReplanner,
    Replanner,
    ThreadedReplanner,
)
from polaris_nl.execution.state import PlanAnswer, PlanRequest
from polaris_nl.model.errors import PlanningError
from polaris_nl.model.formula import Literal
from polaris_nl.model.state import State
from polaris_nl.planning.planner import Planner
from polaris_nl.planning.segments import SegmentResult
from tests.execution.story import literals

HALL = literals("(robot-at hall)")


def able(actions: object) -> bool:
    return True


def answered(replanner: Replanner) -> tuple[PlanAnswer, ...]:
    deadline = time.monotonic() + 20.0
    while time.monotonic() < deadline:
        answers = replanner.answers()
        if answers:
            return answers
        threading.Event().wait(0.005)
    raise AssertionError("no answer comes")


@pytest.mark.parametrize("kind", [InlineReplanner, ThreadedReplanner])
def test_an_answer_comes_once(care: Planner, kind: Callable[..., Replanner]) -> None:
    replanner = kind(care.segment)
    replanner.ask(PlanRequest(7, care.world.initial, HALL), 2.0, able)
    (answer,) = answered(replanner)
    assert (answer.number, [str(a) for a in answer.actions or ()]) == (7, ["(move home hall)"])
    assert replanner.answers() == ()
    replanner.close()


def test_what_the_robot_has_no_skill_for_is_no_way(care: Planner) -> None:
    replanner = InlineReplanner(care.segment)
    replanner.ask(PlanRequest(1, care.world.initial, HALL), 2.0, lambda actions: False)
    assert replanner.answers() == (PlanAnswer(1, None),)


def test_a_newer_request_takes_the_place_of_an_older_one(care: Planner) -> None:
    begun, go_on = threading.Event(), threading.Event()

    def slow(state: State, goals: Sequence[Literal], budget_s: float) -> SegmentResult:
        begun.set()
        assert go_on.wait(20.0)
        return care.segment(state, goals, budget_s)

    replanner = ThreadedReplanner(slow)
    replanner.ask(PlanRequest(1, care.world.initial, HALL), 2.0, able)
    assert begun.wait(20.0)
    assert replanner.answers() == ()  # It isn't waited for.
    replanner.ask(PlanRequest(2, care.world.initial, HALL), 2.0, able)
    go_on.set()
    assert [a.number for a in answered(replanner)] == [2]
    replanner.close()


def test_a_planner_that_breaks_says_so(care: Planner) -> None:
    def broken(state: State, goals: Sequence[Literal], budget_s: float) -> SegmentResult:
        raise PlanningError("The planner can't be started.")

    replanner = ThreadedReplanner(broken)
    replanner.ask(PlanRequest(1, care.world.initial, HALL), 2.0, able)
    with pytest.raises(PlanningError):
        answered(replanner)
    replanner.close()


def test_without_a_replanner_no_answer_ever_comes(care: Planner) -> None:
    replanner = NoReplanner()
    replanner.ask(PlanRequest(1, care.world.initial, HALL), 2.0, able)
    assert replanner.answers() == ()
    replanner.close()
