"""Foils are planned, never guessed: what is said of them is compared with an exhaustive search."""

from __future__ import annotations

from collections.abc import Sequence

import pytest
from hypothesis import given
from hypothesis import strategies as st

from polaris_nl.automaton.automaton import Automaton
from polaris_nl.model.domain import Action
from polaris_nl.model.evaluate import after, applicable, instances_of
from polaris_nl.model.formula import Literal, Quantified
from polaris_nl.model.state import State
from polaris_nl.model.world import World
from polaris_nl.planning.barred import barred
from polaris_nl.planning.contrast import achieved, contrast
from polaris_nl.planning.foils import Contrast, Foil, Way
from polaris_nl.planning.forgone import earlier_place
from polaris_nl.planning.planner import Planner
from polaris_nl.planning.reasons import Step
from polaris_nl.planning.up_model import is_valid
from polaris_nl.planning.waiting import waits

from .conftest import BALLS, LUNCH, MakeWorld, facts, program

LUNCH_PROGRAM = program(
    LUNCH,
    "alerted -> fetched [(acknowledged lunchtime)]: (at tray table) (is-full tray)",
    "fetched -> home: (robot-at home)",
    "alerted -> cancelled [(dismissed lunchtime)]: (robot-at office)",
)
TIDY = program(
    "start -> fetched: (at cup countertop) (at plate countertop)", "stowed: (in cup cupboard)"
)


def tried(
    planner: Planner, automaton: Automaton, way: Way, wanted: str, fact: str = ""
) -> Contrast:
    plan = planner.compile(automaton)
    assert plan.status == "ok"
    return contrast(planner, automaton, plan, Foil(way, facts(wanted), facts(fact)))


def reach(world: World, state: State, actions: Sequence[Action], literal: Literal) -> int | None:
    """After how many actions a literal holds; every action must be applicable."""
    found = 0 if state.holds(literal) else None
    for number, action in enumerate(actions, 1):
        operator = world.domain.operators[action.operator]
        assert applicable(action, operator, state, world), action
        state = after(action, operator, state, world)
        if found is None and state.holds(literal):
            found = number
    return found


# The care home: figures counted on the map by hand (every room is one move from the hall)


@pytest.mark.parametrize(
    ("way", "wanted", "fact", "outcome", "extra"),
    [
        # To a side room and back to the hall.
        ("first", "(robot-at kitchen)", "", "possible", 2),
        ("first", "(robot-at hall)", "", "already", 0),
        ("first", "(robot-at home)", "", "holds", 0),
        ("first", "(acknowledged lunchtime)", "", "impossible", 0),
        # To the cafeteria and back, the tray taken, filled and put down: 4 moves fewer later, but on
        # the branch where it is dismissed all of it is extra.
        ("before", "(robot-at room-1)", "(robot-at cafeteria)", "possible", 2),
        ("before", "(robot-at cafeteria)", "(robot-at room-1)", "already", 0),
        ("before", "(is-full tray)", "(holding tray)", "needed", 0),
        ("before", "(at tray table)", "(holding tray)", "needed", 0),
        ("before", "(robot-at kitchen)", "(holding cup)", "absent", 0),
        ("before", "(dismissed lunchtime)", "(holding tray)", "impossible", 0),
        ("instead", "(robot-at kitchen)", "(robot-at cafeteria)", "possible", 2),
        ("instead", "(at tray desk)", "(at tray table)", "asked", 0),
        ("instead", "(is-full tray)", "(holding tray)", "needed", 0),
    ],
)  # fmt: skip
def test_outcomes(
    care_home: Planner, way: Way, wanted: str, fact: str, outcome: str, extra: int
) -> None:
    found = tried(care_home, LUNCH_PROGRAM, way, wanted, fact)
    assert (found.outcome, found.extra) == (outcome, extra)


def test_the_foil_is_a_plan_in_which_it_is_so(dinner_party: Planner) -> None:
    cup, plate = facts("(holding cup) (holding plate)")
    found = tried(dinner_party, TIDY, "before", str(plate), str(cup))
    assert (found.outcome, found.extra, found.lost) == ("possible", 0, ())
    world = dinner_party.world
    first, second = (reach(world, world.initial, found.prefix, x) for x in (plate, cup))
    assert first is not None
    assert second is not None
    assert first < second
    goals = dinner_party.compile(TIDY).segments["c1"].goals
    assert is_valid(world, world.initial, goals, found.prefix)  # by another planner's own check


def test_what_people_did_before_is_not_done_again(dinner_party: Planner) -> None:
    rack = "(at cup drying-rack) (at plate drying-rack)"
    automaton = program(
        "start -> there: (robot-at kitchen)",
        f"there -> stowed [{rack}]: (in cup cupboard) (in plate cupboard)",
    )
    actions = [str(a) for a in dinner_party.compile(automaton).segments["c2"].actions]
    order = sorted(("cup", "plate"), key=lambda thing: actions.index(f"(pick {thing} drying-rack)"))
    first, second = (f"(holding {thing})" for thing in order)
    found = tried(dinner_party, automaton, "before", second, first)
    # First the cupboard, then the one thing, then the other: it takes no more.
    assert (found.outcome, found.checkpoint, found.extra) == ("possible", "c2", 0)
    assert found.exact


@pytest.mark.parametrize(
    ("wanted", "offered"),
    [
        ("(holding plate)", True),
        # On the way back from the countertop it costs nothing; as a step of its own it is a detour.
        ("(open cupboard)", False),
    ],
)
def test_only_what_has_been_tried_is_offered(
    dinner_party: Planner, wanted: str, offered: bool
) -> None:
    found = tried(dinner_party, TIDY, "before", wanted, "(holding cup)")
    assert (found.outcome, found.extra, found.offered) == ("possible", 0, offered)


def test_what_cannot_be_avoided_is_said(care_home: Planner) -> None:
    found = tried(care_home, LUNCH_PROGRAM, "instead", "(robot-at kitchen)", "(robot-at cafeteria)")
    assert found.still
    plan = care_home.compile(LUNCH_PROGRAM)
    assert achieved(care_home, LUNCH_PROGRAM, plan, facts("(robot-at cafeteria)")) == Step("c2", 1)


def test_the_program_is_left_alone(care_home: Planner) -> None:
    before = care_home.compile(LUNCH_PROGRAM)
    tried(care_home, LUNCH_PROGRAM, "first", "(robot-at kitchen)")
    assert care_home.compile(LUNCH_PROGRAM) == before


def test_a_foil_can_cost_a_later_step(make_world: MakeWorld) -> None:
    domain = """(define (domain sweets)
      (:requirements :strips :typing :negative-preconditions)
      (:types shop)
      (:predicates (coin) (tea) (cake) (seen ?s - shop))
      (:action look :parameters (?s - shop) :precondition (and) :effect (seen ?s))
      (:action buy-tea :parameters () :precondition (coin) :effect (and (tea) (not (coin))))
      (:action buy-cake :parameters () :precondition (coin) :effect (and (cake) (not (coin)))))"""
    planner = Planner(make_world(domain, ["corner shop"], ["(coin)"]))
    automaton = program("start -> drunk: (tea)")
    found = tried(planner, automaton, "first", "(cake)")
    assert (found.outcome, found.lost) == ("possible", ("c1",))
    plan = planner.compile(automaton)
    earlier = earlier_place(planner, automaton, plan, facts("(cake)"), "c1")
    assert earlier is not None
    assert (earlier.checkpoint, earlier.lost) == ("c0", ("c1",))
    assert earlier_place(planner, automaton, plan, facts("(not (seen corner))"), "c0") is None


# Small worlds: what is said to be needed is what an exhaustive search can't do without

THINGS = (
    "(held a)",
    "(held b)",
    "(in a left)",
    "(in a right)",
    "(in b left)",
    "(free left)",
    "(on-floor a)",
)


@pytest.fixture(scope="module")
def balls(make_world: MakeWorld) -> Planner:
    entities = ["a ball", "b ball", "left hand", "right hand"]
    return Planner(
        make_world(BALLS, entities, ["(on-floor a)", "(on-floor b)", "(free left)", "(free right)"])
    )


def test_a_step_that_would_go_the_same_way_is_not_offered(balls: Planner) -> None:
    automaton = program("start -> c: (held b)")
    (grab,) = balls.compile(automaton).segments["c1"].actions
    hand = grab.args[1]
    found = tried(balls, automaton, "before", "(held b)", f"(in b {hand})")
    assert (found.outcome, found.extra, found.offered) == ("possible", 0, False)
    assert [a.args for a in found.prefix] == [("b", "right" if hand == "left" else "left")]


@given(
    wanted=st.sampled_from(THINGS), fact=st.sampled_from(THINGS), goal=st.sampled_from(THINGS[:5])
)
def test_needed_and_possible_are_what_a_blind_search_finds(
    balls: Planner, wanted: str, fact: str, goal: str
) -> None:
    automaton = program(f"start -> c: {goal}", "d: (on-floor a) (on-floor b)")
    plan = balls.compile(automaton)
    (w,), (f,) = facts(wanted), facts(fact)
    found = contrast(balls, automaton, plan, Foil("before", (w,), (f,)))
    step = achieved(balls, automaton, plan, (f,))
    assert (found.outcome == "absent") == (step is None)
    if step is None or found.outcome in ("holds", "already"):
        return
    segment = plan.segments[step.checkpoint]
    start = segment.before
    ways = blind(balls.world, start, (w,), never=f)
    assert (found.outcome == "possible") == (ways is not None)
    if ways is not None:
        first, own = (reach(balls.world, start, found.prefix, x) for x in (w, f))
        assert first is not None
        assert own is None or first < own
        assert found.exact
        assert len(found.prefix) == blind(balls.world, start, segment.goals, never=f, before=w)
    elif found.outcome == "needed":
        assert blind(balls.world, start, (w,)) is not None


def blind(
    world: World,
    start: State,
    goals: Sequence[Literal],
    never: Literal | None = None,
    before: Literal | None = None,
) -> int | None:
    """The least number of actions to goals on which a fact doesn't come about, or not before another."""
    layer = [(start, before is None)]
    seen, depth = set(layer), 0
    moves = list(all_actions(world))
    while layer:
        if any(free and all(map(state.holds, goals)) for state, free in layer):
            return depth
        onward = []
        for state, free in layer:
            for action in moves:
                operator = world.domain.operators[action.operator]
                if not applicable(action, operator, state, world):
                    continue
                new = after(action, operator, state, world)
                comes = never is not None and new.holds(never) and not state.holds(never)
                if comes and not (free and before is not None):
                    continue
                node = (new, free or (before is not None and new.holds(before)))
                if node not in seen:
                    seen.add(node)
                    onward.append(node)
        layer, depth = onward, depth + 1
    return None


def all_actions(world: World) -> list[Action]:
    found = []
    for operator in world.domain.operators.values():
        names = Literal("args", tuple(p.name for p in operator.parameters))
        every = Quantified("exists", operator.parameters, names)
        for body in instances_of(every, world):
            assert isinstance(body, Literal)
            found.append(Action(operator.name, body.args))
    return found


def test_a_fact_that_comes_only_with_others_cannot_be_barred(make_world: MakeWorld) -> None:
    domain = """(define (domain alarm)
      (:requirements :adl) (:types lamp)
      (:predicates (lit ?l - lamp) (rung))
      (:action ring :parameters () :precondition (and)
        :effect (and (rung) (forall (?l - lamp) (lit ?l)))))"""
    world = make_world(domain, ["desk lamp"], [])
    assert barred(world, Literal("lit", ("desk",))) is None
    assert barred(world, Literal("rung")) is not None
    planner = Planner(world)
    found = tried(planner, program("start -> on: (lit desk)"), "before", "(rung)", "(lit desk)")
    assert found.outcome == "undecided"


# Waiting


def test_waits() -> None:
    here, *others = waits(LUNCH_PROGRAM, facts("(acknowledged lunchtime)"))
    assert others == []
    assert (here.checkpoint, [t.id for t in here.missing]) == ("c1", ["t2"])
    assert ([t.id for t in here.others], here.otherwise) == (["t4"], None)
    (everything,) = waits(LUNCH_PROGRAM)
    assert ([t.id for t in everything.missing], everything.others) == (["t2", "t4"], ())
    assert waits(LUNCH_PROGRAM, facts("(open fridge)")) == ()


def test_an_else_is_no_wait() -> None:
    automaton = program(LUNCH, "alerted -> a [(acknowledged lunchtime)]:", "alerted -> b:")
    (here,) = waits(automaton)
    assert here.otherwise is not None
    assert here.otherwise.target == "c3"
