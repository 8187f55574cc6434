"""The eleven corner cases that naive code gets wrong, one test for each."""

from __future__ import annotations

import pytest

from polaris_nl.model.evaluate import after, effects, holds
from polaris_nl.model.formula import Literal, parse_literal
from polaris_nl.planning import search
from polaris_nl.planning.planner import Planner
from polaris_nl.planning.search import Found

from .conftest import (
    LUNCH,
    SHOPPING,
    MakeWorld,
    actions,
    balls_world,
    core_texts,
    facts,
    only_problem,
    program,
)

PLACES = ("at", "in", "holding", "has")


def places_of(thing: str, state: frozenset[Literal]) -> list[str]:
    return sorted(str(f) for f in state if f.predicate in PLACES and thing in f.args)


def test_1_a_conditionals_fact_displaces_where_the_thing_was(dinner_party: Planner) -> None:
    plan = dinner_party.compile(
        program("waited [(at plate drying-rack) (at cup sink)]:", "held: (holding plate)")
    )
    before = plan.segments["c1"].before.facts
    assert places_of("plate", before) == ["(at plate drying-rack)"]
    assert places_of("cup", before) == ["(at cup sink)"]
    assert actions(plan.segments["c2"])[-1] == "(pick plate drying-rack)"


@pytest.mark.parametrize(
    "taken", ["(has resident tray)", "(at tray table)", "(not (holding tray))"]
)
def test_2_what_is_taken_from_the_hand_leaves_it_empty(care_home: Planner, taken: str) -> None:
    plan = care_home.compile(
        program("held: (holding tray)", f"taken [{taken}]:", "next: (holding red-cup)")
    )
    assert plan.status == "ok"
    assert not plan.segments["c1"].after.holds(parse_literal("(hand-empty)"))
    state = plan.segments["c2"].before
    assert state.holds(parse_literal("(hand-empty)"))
    assert not state.holds(parse_literal("(holding tray)"))
    # A hand that were still busy would have to place something before it picks the cup up.
    assert [a.operator for a in plan.segments["c3"].actions if a.operator != "move"] == ["pick"]


@pytest.mark.parametrize(
    "second",
    [
        "(at cup table) (acknowledged lunchtime)",
        "(acknowledged lunchtime) (at cup table) (acknowledged lunchtime)",
    ],
)
def test_3_conditionals_are_compared_as_sets(care_home: Planner, second: str) -> None:
    plan = care_home.compile(
        program(
            LUNCH,
            "alerted -> one [(acknowledged lunchtime) (at cup table)]: (robot-at home)",
            f"alerted -> two [{second}]: (robot-at kitchen)",
        )
    )
    assert plan.status == "underspecified"
    assert only_problem(plan).transition == "t3"
    subset = care_home.compile(
        program(
            LUNCH,
            "alerted -> one [(acknowledged lunchtime) (at cup table)]: (robot-at home)",
            "alerted -> two [(acknowledged lunchtime)]: (robot-at kitchen)",
        )
    )
    assert subset.status == "ok"


def test_4_underspecification_inside_an_omitted_subtree_is_found(care_home: Planner) -> None:
    impossible = "both: (holding cup) (holding tray)"
    plan = care_home.compile(
        program(
            "start -> home: (robot-at hall)",
            impossible,
            "both -> one: (robot-at home)",
            "both -> two: (robot-at kitchen)",
        )
    )
    assert plan.status == "underspecified"
    assert plan.root is None
    assert not plan.segments
    assert [p.cause for p in plan.problems] == ["underspecified"]
    assert "From both, both one and two come next" in plan.problems[0].text


def test_5_checkpoints_that_cost_nothing_keep_their_plan_node(care_home: Planner) -> None:
    plan = care_home.compile(
        program(
            "empty:",
            "already: (robot-at home) (at tray empty-trays)",
            "empty again:",
            "moved: (robot-at hall)",
            "still: (robot-at hall)",
        )
    )
    nodes = [n for n in plan.nodes() if n.checkpoint]
    assert [n.checkpoint for n in nodes] == ["c0", "c1", "c2", "c3", "c4", "c5"]
    assert len({n.id for n in nodes}) == 6
    assert [n.action is None for n in nodes] == [True, True, True, True, False, True]
    assert plan.action_count == 1


def shop(make_world: MakeWorld, *ways_back: str) -> Planner:
    """Tea is sold left and right, and only some of the two have a way back home."""
    ways = ["(way home left)", "(way home right)", *(f"(way {back} home)" for back in ways_back)]
    at_first = ["(robot-at home)", "(sells left)", "(sells right)", *ways]
    entities = ["home region", "left region", "right region"]
    return Planner(make_world(SHOPPING, entities, at_first))


TEA = program("bought: (tea)", "home: (robot-at home)")


def test_6_a_greedy_dead_end_is_avoided_and_said(make_world: MakeWorld) -> None:
    # Whichever shop is nearer to the planner, the trap is behind one of the two doors.
    plans = [shop(make_world, way_back).compile(TEA) for way_back in ("left", "right")]
    assert [plan.status for plan in plans] == ["ok", "ok"]
    assert [actions(plan.segments["c1"]) for plan in plans] == [
        ["(go home left)", "(buy left)"],
        ["(go home right)", "(buy right)"],
    ]
    # As short as the way into the trap, and so still a shortest one.
    assert all(plan.segments["c1"].optimal for plan in plans)
    (note,) = [w for plan in plans for w in plan.warnings]
    assert note.transition == "t1"
    assert note.text.startswith("On the way to bought I plan ahead")
    assert "kept me from home" in note.text


def test_6_no_way_around_a_dead_end_is_not_called_a_conflict(make_world: MakeWorld) -> None:
    plan = shop(make_world).compile(TEA)
    assert plan.status == "partial"
    assert list(plan.segments) == ["c1"]
    assert (only_problem(plan).checkpoint, only_problem(plan).cause) == ("c2", "unreachable")
    assert plan.warnings == ()


def test_6_an_action_the_user_insists_on_is_never_planned_around(make_world: MakeWorld) -> None:
    plan = shop(make_world, "right").compile(
        program("bought: !(buy left)", "home: (robot-at home)")
    )
    assert actions(plan.segments["c1"]) == ["(go home left)", "(buy left)"]
    assert (only_problem(plan).checkpoint, only_problem(plan).cause) == ("c2", "unreachable")


def test_6_planning_ahead_breaks_nothing_beside_it(make_world: MakeWorld) -> None:
    for way_back in ("left", "right"):
        plan = shop(make_world, way_back).compile(
            program(
                "bought: (tea)",
                "bought -> home [(sells home)]: (robot-at home)",
                "again: (robot-at left)",
                "bought -> stay: (tea)",
            )
        )
        assert plan.status == "ok"
        before = {"c0": plan.root.state if plan.root else None}
        for checkpoint, segment in plan.segments.items():
            assert segment.before.facts >= before[segment.source].facts
            before[checkpoint] = segment.after
        assert len([n for n in plan.nodes() if n.checkpoint]) == 5


COINS = """(define (domain coins)
  (:requirements :strips :typing)
  (:types coin thing)
  ; EXOGENOUS: have
  (:predicates (have ?c - coin) (bought ?t - thing))
  (:action buy
    :parameters (?t - thing ?c - coin)
    :precondition (have ?c)
    :effect (and (bought ?t) (not (have ?c)))))
"""


def test_7_the_same_goals_conflict_in_one_branch_and_not_in_another(make_world: MakeWorld) -> None:
    entities = ["tea thing", "cake thing", "penny coin", "dime coin"]
    planner = Planner(make_world(COINS, entities, ["(have penny)"]))
    both = "(bought tea) (bought cake)"
    plan = planner.compile(
        program(
            f"start -> rich [(have dime)]: {both}",
            f"start -> poor: {both}",
            f"start -> robbed [(not (have penny))]: {both}",
            "start -> saved [(bought tea)]: (bought cake)",
        )
    )
    assert plan.status == "partial"
    assert set(plan.segments) == {"c1", "c4"}
    assert [(p.checkpoint, p.cause) for p in plan.problems] == [
        ("c2", "conflict"),
        ("c3", "unreachable"),
    ]
    assert core_texts(plan.problems[0]) == {frozenset({"(bought tea)", "(bought cake)"})}


def test_8_conflict_unreachable_timeout_and_crash_are_told_apart(
    care_home: Planner, monkeypatch: pytest.MonkeyPatch
) -> None:
    def told(planner: Planner, goals: str) -> tuple[str, str]:
        problem = only_problem(planner.compile(program(f"step: {goals}")))
        return problem.cause, problem.text

    world = care_home.world
    found = [
        told(care_home, "(holding cup) (holding tray)"),
        told(care_home, "(person-in resident room-1)"),
        told(care_home, "(holding resident)"),
    ]
    monkeypatch.setattr("polaris_nl.planning.segments.search", lambda *_: Found("undecided"))
    found.append(told(Planner(world), "(holding cup)"))
    monkeypatch.undo()
    monkeypatch.setattr("polaris_nl.planning.segments.search", lambda *_: search._outcome(-9, ""))
    found.append(told(Planner(world), "(holding cup)"))
    causes = [cause for cause, _ in found]
    assert causes == ["conflict", "unreachable", "invalid", "undecided", "undecided"]
    assert len({text for _, text in found}) == 5
    assert "none was ruled out" in found[3][1]
    assert "signal 9" in found[4][1]
    for _, text in found[1:]:
        assert "can't be that" not in text


def test_9_an_else_that_can_never_be_taken_gets_a_warning(care_home: Planner) -> None:
    plan = care_home.compile(
        program(
            "held: (holding tray)",
            "held -> go [(holding tray)]: (robot-at home)",
            "held -> otherwise: (robot-at kitchen)",
            "otherwise -> a [(acknowledged lunchtime)]: (robot-at home)",
            "otherwise -> b: (robot-at hall)",
        )
    )
    assert plan.status == "ok"
    assert [w.transition for w in plan.warnings] == ["t2"]
    assert "Otherwise will never come" in plan.warnings[0].text


def test_9_a_wait_for_what_holds_already_gets_another_warning(care_home: Planner) -> None:
    plan = care_home.compile(
        program("held: (holding tray)", "go [(holding tray)]: (robot-at home)")
    )
    assert [w.text.startswith("The robot won't wait before go") for w in plan.warnings] == [True]


def test_10_people_are_never_moved_by_the_planner(care_home: Planner) -> None:
    def people(state: frozenset[Literal]) -> set[Literal]:
        return {f for f in state if f.predicate == "person-in"}

    plan = care_home.compile(
        program(
            "told: (alerted-to resident lunchtime) (alerted-to mr-brown bingo)",
            "cup: (has resident cup)",
            "walked [(person-in resident room-1) (acknowledged lunchtime)]: (alerted-to resident pill-time)",
            "cup -> room: (person-in resident room-1)",
        )
    )
    for segment in plan.segments.values():
        assert people(segment.before.facts) == people(segment.after.facts)
    assert "(alert resident pill-time room-1)" in actions(plan.segments["c3"])
    problem = only_problem(plan)
    assert (problem.cause, problem.checkpoint) == ("unreachable", "c4")
    assert "only a person can" in problem.text
    assert [r.text.startswith("wait until") for r in problem.repairs] == [True]


@pytest.mark.parametrize(
    ("at_first", "action"),
    [
        ("", "(move home hall)"),
        ("(robot-at kitchen) (open fridge)", "(close-container fridge)"),
        ("(robot-at kitchen)", "(pick cup worktop)"),
        ("(robot-at kitchen) (open fridge)", "(take-out water-bottle fridge)"),
        ("(holding tray) (robot-at room-1)", "(place tray table)"),
        ("(holding tray) (robot-at recreation-area)", "(hand-over tray resident)"),
    ],
)
def test_11_negative_effects_are_goals_too_when_an_action_becomes_a_goal(
    care_home: Planner, at_first: str, action: str
) -> None:
    world = care_home.world
    plan = care_home.compile(program(f"there [{at_first}]:", f"done: !{action}"))
    (done,) = plan.segments["c2"].actions
    operator = world.domain.operators[done.operator]
    state = plan.segments["c2"].before
    goals = effects(done, operator, state, world)
    found = care_home.segment(state, goals)
    assert (found.status, found.optimal) == ("solved", True)
    assert len(found.actions) == 1
    reached = after(
        found.actions[0], world.domain.operators[found.actions[0].operator], state, world
    )
    assert all(holds(goal, reached, world) for goal in goals)


def test_11_negative_goals_are_achieved(care_home: Planner) -> None:
    plan = care_home.compile(
        program(
            "shut [(open fridge)]: (not (open fridge)) (not (robot-at home)) (not (hand-empty))"
        )
    )
    end = plan.segments["c1"].after
    assert all(end.holds(g) for g in facts("(not (open fridge)) (not (hand-empty))"))
    assert "(close-container fridge)" in actions(plan.segments["c1"])
    both = care_home.compile(program("odd: (open fridge) (not (open fridge))"))
    assert core_texts(only_problem(both)) == {frozenset({"(open fridge)", "(not (open fridge))"})}


def test_8_a_conflict_of_three_goals_has_no_pair_to_blame(make_world: MakeWorld) -> None:
    planner = Planner(balls_world(make_world, 4))
    plan = planner.compile(program("all: (held b0) (held b1) (held b2) (held b3)"))
    problem = only_problem(plan)
    assert problem.cause == "conflict"
    assert {len(core) for core in problem.cores} == {3}
    assert len(core_texts(problem)) == 4
