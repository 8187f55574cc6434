"""Goals that something isn't so, many at once: each can be met in many ways, which must not be counted out."""

from __future__ import annotations

from polaris_nl.planning.planner import Planner

from .conftest import MakeWorld, actions, balls_world, program

CLEAR = "(forall (?x - object) (not (at ?x dining-table)))"


def test_a_table_is_cleared_in_as_few_actions_as_can_be(dinner_party: Planner) -> None:
    there = [x for x in dinner_party.world.initial.facts if x.args[1:] == ("dining-table",)]
    plan = dinner_party.compile(program(f"cleared: {CLEAR}"))
    (segment,) = plan.segments.values()
    assert not any(x in segment.after.facts for x in there)
    on_table = sum(x.predicate == "at" for x in there)
    assert on_table > 1
    # Each is picked up, all but the last are put somewhere else, and the robot goes there first.
    moves = sum(text.startswith("(move") for text in actions(segment))
    assert segment.optimal
    assert len(segment.actions) - moves == 2 * on_table - 1


def test_what_comes_after_a_cleared_table_is_planned_too(dinner_party: Planner) -> None:
    plan = dinner_party.compile(program(f"cleared: {CLEAR}", "home: (robot-at home)"))
    assert plan.status == "ok"
    assert list(plan.segments) == ["c1", "c2"]


def test_a_negative_goal_beside_a_positive_one_of_the_same_thing(make_world: MakeWorld) -> None:
    planner = Planner(balls_world(make_world, 3))
    nowhere = "(not (on-floor b1)) (not (in b1 left)) (not (in b1 right))"
    plan = planner.compile(program(f"held: (held b0) {nowhere}"))
    (problem,) = plan.problems
    assert problem.cause in ("conflict", "unreachable")
    plan = planner.compile(program("held: (held b0) (not (in b0 left)) (not (on-floor b1))"))
    (segment,) = plan.segments.values()
    assert actions(segment) == ["(grab b0 right)", "(grab b1 left)"] or actions(segment) == [
        "(grab b1 left)",
        "(grab b0 right)",
    ]
