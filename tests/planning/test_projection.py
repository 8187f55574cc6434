"""Leaving out what can't matter changes neither the length of a plan nor whether there is one."""

from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from polaris_nl.model.evaluate import after, applicable
from polaris_nl.model.formula import Literal, parse_formula, parse_literal
from polaris_nl.model.pddl import parse_domain
from polaris_nl.model.state import State
from polaris_nl.model.world import Entity, World
from polaris_nl.model.world_file import load_world
from polaris_nl.planning.mutexes import find_mutexes
from polaris_nl.planning.projection import Projection
from polaris_nl.planning.segments import SegmentResult, Segments

WORLDS = {name: load_world(name) for name in ("care-home", "dinner-party")}
WHOLE = {name: Segments(world) for name, world in WORLDS.items()}
PROJECTED = {name: Segments(world, find_mutexes(world)) for name, world in WORLDS.items()}


def carried_out(world: World, state: State, result: SegmentResult) -> State:
    for action in result.actions:
        operator = world.domain.operators[action.operator]
        assert applicable(action, operator, state, world)
        state = after(action, operator, state, world)
    return state


@settings(max_examples=25)
@given(st.data())
def test_projected_plans_are_as_short_and_valid_in_the_whole_world(data: st.DataObject) -> None:
    name = data.draw(st.sampled_from(sorted(WORLDS)))
    world = WORLDS[name]

    def one(kind: str) -> str:
        return data.draw(st.sampled_from([e.name for e in world.of_type(kind)]))

    def goal() -> Literal:
        thing = one("object")
        return data.draw(
            st.sampled_from(
                [
                    Literal("at", (thing, one("surface"))),
                    Literal("in", (thing, one("container"))),
                    Literal("has", (one("person"), thing)),
                    Literal("holding", (thing,)),
                    Literal("hand-empty", ()),
                    Literal("hand-empty", (), False),
                    Literal("robot-at", (one("region"),)),
                ]
            )
        )

    goals = tuple({goal() for _ in range(data.draw(st.integers(1, 2)))})
    state = world.initial
    if data.draw(st.booleans()):  # something is in the hand at the start
        held = one("object")
        taken = [f for f in state.facts if held in f.args and f.predicate in ("at", "in", "has")]
        state = state.change((*taken, Literal("hand-empty", ())), (Literal("holding", (held,)),))
    whole = WHOLE[name].solve(state, goals, 30.0)
    short = PROJECTED[name].solve(state, goals, 30.0)
    assert short.status == whole.status
    if short.status == "solved":
        assert len(short.actions) == len(whole.actions)
        assert short.optimal == whole.optimal
        end = carried_out(world, state, short)
        assert all(end.holds(g) for g in goals)


def test_what_is_left_out_and_what_stays() -> None:
    world = WORLDS["care-home"]
    projection = Projection(world, find_mutexes(world))
    small, state = projection.of(world.initial, (parse_literal("(at cup desk)"),))
    assert [e.name for e in small.of_type("object")] == ["cup"]
    assert list(small.of_type("message")) == []
    for kind in ("region", "surface", "container", "person"):
        assert list(small.of_type(kind)) == list(world.of_type(kind))
    assert all(set(f.args) <= set(small.entities) for f in state.facts)
    held = world.initial.change(
        (parse_literal("(at plate worktop)"), parse_literal("(hand-empty)")),
        (parse_literal("(holding plate)"),),
    )
    small, _ = projection.of(held, (parse_literal("(at cup desk)"),))
    assert {e.name for e in small.of_type("object")} == {"cup", "plate"}


@pytest.mark.parametrize(
    "goal",
    [
        "(not (hand-empty))",
        "(forall (?o - object) (at ?o desk))",
        "(exists (?o - object) (holding ?o))",
    ],
)
def test_goals_that_anything_could_serve_keep_everything(goal: str) -> None:
    world = WORLDS["care-home"]
    small, _ = Projection(world, find_mutexes(world)).of(world.initial, (parse_formula(goal),))
    assert [e.name for e in small.of_type("object")] == [e.name for e in world.of_type("object")]


DOMAIN = """(define (domain d) (:types thing spot)
  (:predicates (at ?t - thing ?s - spot) (hand-empty) (holding ?t - thing) (lit) (joined ?a ?b - thing))
  (:action pick :parameters (?t - thing ?s - spot) :precondition (and (hand-empty) (at ?t ?s))
    :effect (and (holding ?t) (not (hand-empty)) (not (at ?t ?s))))
  (:action put :parameters (?t - thing ?s - spot) :precondition (holding ?t)
    :effect (and (at ?t ?s) (hand-empty) (not (holding ?t))))
  EXTRA)"""


@pytest.mark.parametrize(
    ("extra", "left"),
    [
        ("", {"a"}),
        (
            "(:action light :parameters (?t - thing) :precondition (holding ?t) :effect (lit))",
            {"a", "b", "c"},
        ),
        (
            "(:action press :parameters () :precondition (not (hand-empty)) :effect (lit))",
            {"a", "b", "c"},
        ),
        (
            "(:action join :parameters (?x ?y - thing) :precondition (holding ?x) :effect (joined ?x ?y))",
            {"a", "b", "c"},
        ),
        (
            "(:action look :parameters () :precondition (forall (?t - thing) (not (holding ?t)))"
            " :effect (lit))",
            {"a", "b", "c"},
        ),
        (
            "(:action shine :parameters (?t - thing) :precondition (holding ?t) :effect"
            " (when (hand-empty) (lit)))",
            {"a", "b", "c"},
        ),
    ],
)
def test_a_domain_in_which_things_matter_to_each_other_keeps_them(
    extra: str, left: set[str]
) -> None:
    domain = parse_domain(DOMAIN.replace("EXTRA", extra))
    entities = {n: Entity(n, "spot" if n in "xy" else "thing") for n in "abcxy"}
    facts = frozenset(
        parse_literal(f) for f in ("(hand-empty)", "(at a x)", "(at b x)", "(at c y)")
    )
    world = World("w", domain, entities, facts)
    small, _ = Projection(world, find_mutexes(world)).of(
        world.initial, (parse_literal("(at a y)"),)
    )
    assert {e.name for e in small.of_type("thing")} == left


def test_a_thousand_entities_take_no_bigger_task_than_forty() -> None:
    world = WORLDS["care-home"]
    extra = {f"thing-{n}": Entity(f"thing-{n}", "object") for n in range(960)}
    facts = {Literal("at", (name, "desk")) for name in extra}
    large = replace(world, entities={**world.entities, **extra}, facts=world.facts | facts)
    small, state = Projection(large, find_mutexes(world)).of(
        large.initial, (parse_literal("(at cup desk)"),)
    )
    assert len(small.entities) < 40
    assert len(state.facts) < 80
