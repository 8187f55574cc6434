"""Goals that leave a choice: one of a kind, two of a kind, and what they cost."""

from __future__ import annotations

from dataclasses import replace

import pytest

from polaris_nl.automaton.edits import apply_all
from polaris_nl.model.evaluate import holds
from polaris_nl.model.formula import Literal, parse_formula
from polaris_nl.model.goals import choices
from polaris_nl.planning.planner import Planner

from .conftest import actions, facts, only_problem, program

CUP = "(exists (?c - object) (and (kind ?c dish) (at ?c {})))"
TWO = "(exists (?a ?b - object) (and (kind ?a dish) (kind ?b dish) (not (= ?a ?b)) (at ?a {0}) (at ?b {0})))"


def test_the_nearest_of_a_kind_is_taken(care_home: Planner) -> None:
    plan = care_home.compile(
        program(
            f"start -> room [(open fridge)]: {CUP.format('nightstand')}",
            f"start -> lounge [(robot-at recreation-area)]: {CUP.format('desk')}",
        )
    )
    assert plan.status == "ok"
    for segment, place in zip(plan.segments.values(), ("nightstand", "desk"), strict=True):
        costs = {}
        for dish in ("cup", "blue-cup", "red-cup", "plate"):
            result = care_home.segment(segment.before, facts(f"(at {dish} {place})"))
            costs[dish] = len(result.actions)
        (chosen,) = segment.goals
        assert len(segment.actions) == costs[chosen.args[0]] == min(costs.values())
        assert segment.optimal


def test_what_is_there_already_costs_nothing(care_home: Planner) -> None:
    plan = care_home.compile(program(f"laid: {CUP.format('table')}"))
    assert plan.segments["c1"].goals == facts("(at blue-cup table)")
    assert plan.segments["c1"].actions == ()


def test_two_of_a_kind_are_two(care_home: Planner) -> None:
    goal = TWO.format("table")
    plan = care_home.compile(program(f"laid: {goal}"))
    segment = plan.segments["c1"]
    things = {g.args[0] for g in segment.goals}
    assert "blue-cup" in things
    assert len(things) == 2
    assert holds(parse_formula(goal), segment.after, care_home.world)
    assert "(place blue-cup table)" not in actions(segment)


def test_each_choice_is_made_once(care_home: Planner) -> None:
    world = care_home.world
    dishes = sum("dish" in e.kinds for e in world.entities.values())
    ways = list(choices([parse_formula(TWO.format("desk"))], world.initial, world))
    assert len(ways) == dishes * (dishes - 1) // 2
    assert len({frozenset(way) for way in ways}) == len(ways)


def test_what_never_changes_picks_the_place(care_home: Planner) -> None:
    goal = "(exists (?s - surface) (and (food-station ?s) (at tray ?s)))"
    plan = care_home.compile(program(f"there: {goal}"))
    assert plan.segments["c1"].goals == facts("(at tray food-station)")


def test_some_for_each(care_home: Planner) -> None:
    goal = (
        "(forall (?p - person) (imply (not (person-in ?p office))"
        " (exists (?c - object) (and (kind ?c dish) (has ?p ?c)))))"
    )
    ways = list(choices([parse_formula(goal)], care_home.world.initial, care_home.world))
    assert len(ways) == 16
    assert all({x.args[0] for x in way} == {"resident", "mr-brown"} for way in ways)


def test_a_choice_follows_the_world(care_home: Planner) -> None:
    world = care_home.world
    bowl = replace(world.entities["cup"], name="soup-bowl", kinds=("cutlery",))
    more = replace(
        world,
        entities={**world.entities, "soup-bowl": bowl},
        facts=world.facts | {Literal("at", ("soup-bowl", "table"))},
    )
    asked = program("laid: (exists (?d - object) (and (kind ?d cutlery) (at ?d table)))")
    problem = only_problem(care_home.compile(asked))
    assert (problem.cause, problem.checkpoint) == ("unreachable", "c1")
    assert "there is no cutlery" in problem.text
    assert Planner(more).compile(asked).segments["c1"].goals == facts("(at soup-bowl table)")


def test_a_choice_that_is_gone_leaves_the_others(care_home: Planner) -> None:
    plan = care_home.compile(
        program("taken [(not (at blue-cup table))]:", f"laid: {CUP.format('table')}")
    )
    assert plan.status == "ok"
    assert plan.segments["c2"].goals != facts("(at blue-cup table)")


def test_more_than_there_are(care_home: Planner) -> None:
    goal = (
        "(exists (?a ?b ?c - object) (and (kind ?a laundry) (kind ?b laundry) (kind ?c laundry)"
        " (not (= ?a ?b)) (not (= ?b ?c)) (not (= ?a ?c)) (at ?a desk) (at ?b desk) (at ?c desk)))"
    )
    problem = only_problem(care_home.compile(program(f"x: {goal}")))
    assert problem.cause == "unreachable"
    assert 'fewer than three things of the kind "laundry"' in problem.text


def test_no_choice_will_do(care_home: Planner) -> None:
    goal = "(exists (?m - message) (and (acknowledged ?m) (dismissed ?m)))"
    problem = only_problem(care_home.compile(program(f"x: {goal}")))
    assert problem.cause == "conflict"
    assert "whichever I take" in problem.text


@pytest.mark.parametrize(
    "goal",
    [
        "(forall (?d - object) (imply (kind ?d laundry) (holding ?d)))",
        "(and (holding cup) (holding tray))",
        TWO.replace("at ?a {0}", "holding ?a").replace("at ?b {0}", "holding ?b"),
    ],
)
def test_ways_out_of_quantified_goals_lead_out(care_home: Planner, goal: str) -> None:
    broken = program(f"x: {goal}", "y: (robot-at kitchen)")
    problem = care_home.compile(broken).problems[0]
    assert {r.kind for r in problem.repairs} == {"split", "drop"}
    for repair in problem.repairs:
        assert care_home.compile(apply_all(broken, repair.edits)).status == "ok", repair.text


def test_all_but_one_stays_a_goal_for_all(care_home: Planner) -> None:
    goal = "(forall (?d - object) (imply (kind ?d dish) (at ?d worktop)))"
    broken = program(f"x: {goal} (holding cup)")
    problem = only_problem(care_home.compile(broken))
    texts = {
        str(g)
        for r in problem.repairs
        if r.kind == "drop"
        for g in apply_all(broken, r.edits).checkpoints["c1"].goals
    }
    but = "(forall (?d - object) (imply (and (kind ?d dish) (not (= ?d cup))) (at ?d worktop)))"
    assert but in texts
    assert goal in texts
