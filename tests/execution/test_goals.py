"""The robot's own way to a goal: the action itself, a short way planned anew, or none, with the reason."""

from __future__ import annotations

from collections.abc import Sequence

from polaris_nl.automaton.program import parse_action
from polaris_nl.execution.backend import Observation, SendGoal
from polaris_nl.execution.goals import Act, Arrived, GoalLimits, Lost, Pursuit
from polaris_nl.execution.shortcuts import seen_shortcut, shortcut
from polaris_nl.model.evaluate import effects
from polaris_nl.model.formula import Literal
from polaris_nl.model.state import State
from polaris_nl.planning.planner import Planner
from polaris_nl.planning.segments import SegmentResult
from polaris_nl.planning.simulate import Simulator
from tests.execution.story import FULL_TRAY, Case, literal, literals


def goal(planner: Planner, text: str) -> SendGoal:
    action = parse_action(text)
    operator = planner.world.domain.operators[action.operator]
    made = effects(action, operator, planner.world.initial, planner.world)
    return SendGoal(1, action, made)


class CountingPlanner:
    """A planner that counts how often and with what budget it is asked."""

    def __init__(self, planner: Planner, answer: SegmentResult | None = None) -> None:
        self._planner = planner
        self._answer = answer
        self.budgets: list[float] = []

    def __call__(self, state: State, goals: Sequence[Literal], budget_s: float) -> SegmentResult:
        self.budgets.append(budget_s)
        return self._answer or self._planner.segment(state, goals, budget_s)


def test_an_action_that_can_be_done_needs_no_plan(care: Planner) -> None:
    plan = CountingPlanner(care)
    found = Pursuit(goal(care, "(move home hall)"), plan, care.world).next(care.world.initial)
    assert found == Act((parse_action("(move home hall)"),))
    assert plan.budgets == []


def test_a_goal_that_is_so_already_needs_no_action(care: Planner) -> None:
    there = care.world.initial.after_event(literals("(robot-at hall)"), care.mutexes)
    pursuit = Pursuit(goal(care, "(move home hall)"), care.segment, care.world)
    assert isinstance(pursuit.next(there), Arrived)


def test_from_elsewhere_the_way_is_planned_within_the_budget(care: Planner) -> None:
    plan = CountingPlanner(care)
    asked = goal(care, "(move hall cafeteria)")
    found = Pursuit(asked, plan, care.world, GoalLimits(plan_s=0.75)).next(care.world.initial)
    assert isinstance(found, Act)
    assert [str(a) for a in found.way] == ["(move home hall)", "(move hall cafeteria)"]
    assert found.before == (asked.action,)
    assert plan.budgets == [0.75]


def test_negative_effects_are_part_of_the_goal(care: Planner) -> None:
    # It holds the tray already, and so it must not be on the table any more either.
    asked = goal(care, "(pick tray empty-trays)")
    held = care.world.initial.change((), literals("(holding tray)"))
    found = Pursuit(asked, care.segment, care.world).next(held)
    assert not isinstance(found, Arrived)


def test_what_the_action_names_out_of_place_is_given_up(care: Planner) -> None:
    moved = care.world.initial.after_event(literals("(at tray desk)"), care.mutexes)
    found = Pursuit(goal(care, "(pick tray empty-trays)"), care.segment, care.world).next(moved)
    assert found == Lost("something isn't in its place any more")


def test_a_way_that_is_too_long_or_not_found_is_given_up_with_the_reason(care: Planner) -> None:
    asked, start = goal(care, "(place tray table)"), care.world.initial
    short = Pursuit(asked, care.segment, care.world, GoalLimits(actions=2)).next(start)
    assert isinstance(short, Lost)
    assert "too long" in short.reason
    late = CountingPlanner(care, SegmentResult("undecided"))
    assert Pursuit(asked, late, care.world).next(start) == Lost("it found no way in time")
    never = CountingPlanner(care, SegmentResult("unsolvable"))
    assert Pursuit(asked, never, care.world).next(start) == Lost("it found no way")


def test_the_budget_of_plans_is_kept(care: Planner) -> None:
    plan = CountingPlanner(care)
    pursuit = Pursuit(goal(care, "(move hall cafeteria)"), plan, care.world, GoalLimits(plans=3))
    rooms = ("home", "kitchen", "office", "room-1", "recreation-area")
    found = [
        pursuit.next(care.world.initial.after_event(literals(f"(robot-at {r})"), care.mutexes))
        for r in rooms
    ]
    assert len(plan.budgets) <= 3
    assert found[-1] == Lost("things change faster than it can plan")


# Where a plan can be taken up


def test_a_plan_is_taken_up_where_the_rest_of_it_works(serve: Case) -> None:
    segment, world = serve.plan.segments["c1"], serve.world
    simulator, goals = Simulator(world), literals(*FULL_TRAY)
    states = [segment.before, *(s.state for s in segment.steps)]
    for number, state in enumerate(states):
        assert shortcut(simulator, state, segment.actions, goals) == number
    nowhere = segment.before.after_event(literals("(at tray desk)"), serve.planner.mutexes)
    assert shortcut(simulator, nowhere, segment.actions, goals) is None


def test_what_is_unknown_saves_no_work(serve: Case) -> None:
    segment, simulator = serve.plan.segments["c1"], Simulator(serve.world)
    goals, state = literals(*FULL_TRAY), segment.after
    count = len(segment.actions)

    def saved(seen: Observation) -> int:
        return seen_shortcut(simulator, seen, segment.actions, goals)

    assert saved(Observation(state)) == count
    assert saved(Observation(state, unknown=frozenset({literal("(is-full tray)")}))) < count
    assert saved(Observation(state, blind=frozenset({"is-full"}))) == 0
