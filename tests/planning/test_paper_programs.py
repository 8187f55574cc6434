"""The programs of the paper: their plans are right by an independent check, and shortest by another."""

from __future__ import annotations

import importlib
import itertools
from collections.abc import Container, Iterator, Sequence
from dataclasses import dataclass, replace

import pytest

from polaris_nl.automaton.automaton import Automaton
from polaris_nl.model.domain import Action
from polaris_nl.model.evaluate import after, applicable
from polaris_nl.model.formula import Literal
from polaris_nl.model.state import State
from polaris_nl.model.world import World
from polaris_nl.planning.planner import Planner
from polaris_nl.planning.result import BranchingPlan
from polaris_nl.planning.up_model import is_valid

from .conftest import LUNCH, actions, facts, program

CAREGIVING = program(
    LUNCH,
    "fetched [(acknowledged lunchtime)]: (holding tray) (is-full tray)",
    "home: (robot-at home)",
    "alerted -> cancelled [(dismissed lunchtime)]: (robot-at home)",
)
SERVING = program(
    LUNCH,
    "fetched [(acknowledged lunchtime)]: (at tray table) (is-full tray)",
    "home: (robot-at home)",
    "alerted -> cancelled [(dismissed lunchtime)]: (robot-at home)",
)
TIDYING = program(
    "delivered: (at cup countertop) (at plate countertop)",
    "tidied [(at cup drying-rack) (at plate drying-rack)]:"
    " (open cupboard) (in cup cupboard) (in plate cupboard)",
)
CARE_ENTITIES = "home hall cafeteria recreation-area room-1 empty-trays food-station table tray"
PARTY_ENTITIES = "home hall dining-area kitchen countertop drying-rack dining-table cupboard"


@dataclass(frozen=True)
class Paper:
    """A program, its planner, what of the world it needs, and the lengths of its segments."""

    program: Automaton
    planner: str
    entities: str
    lengths: dict[str, int]


PAPER = {
    "caregiving": Paper(
        CAREGIVING,
        "care_home",
        f"{CARE_ENTITIES} resident lunchtime",
        {"c1": 3, "c2": 4, "c3": 2, "c4": 2},
    ),
    "serving": Paper(
        SERVING,
        "care_home",
        f"{CARE_ENTITIES} resident lunchtime",
        {"c1": 3, "c2": 7, "c3": 2, "c4": 2},
    ),
    "tidying": Paper(
        TIDYING, "dinner_party", f"{PARTY_ENTITIES} cup plate host", {"c1": 9, "c2": 5}
    ),
}


@dataclass(frozen=True)
class Made:
    """A compiled paper program."""

    paper: Paper
    world: World
    plan: BranchingPlan


@pytest.fixture(params=PAPER)
def made(request: pytest.FixtureRequest) -> Made:
    paper = PAPER[request.param]
    planner: Planner = request.getfixturevalue(paper.planner)
    return Made(paper, planner.world, planner.compile(paper.program))


@pytest.fixture(scope="session")
def unified_planning() -> None:
    """Its import takes two seconds, which are no test's."""
    importlib.import_module("unified_planning.engines")


def reduced(world: World, names: Sequence[str]) -> World:
    """A world with some of the entities, and the facts about them alone."""
    entities = {name: world.entities[name] for name in names}
    return replace(world, entities=entities, facts=about(world.facts, entities))


def about(facts: frozenset[Literal], names: Container[str]) -> frozenset[Literal]:
    return frozenset(f for f in facts if all(arg in names for arg in f.args))


def grounded(world: World) -> Iterator[Action]:
    for operator in world.domain.operators.values():
        choices = [[e.name for e in world.of_type(*p.types)] for p in operator.parameters]
        yield from (Action(operator.name, args) for args in itertools.product(*choices))


def shortest(world: World, start: State, goals: Sequence[Literal]) -> int | None:
    """The length of a shortest plan, breadth first and by the model's own semantics alone."""
    every = [(action, world.domain.operators[action.operator]) for action in grounded(world)]
    layer, seen, depth = [start], {start}, 0
    while layer:
        if any(all(state.holds(goal) for goal in goals) for state in layer):
            return depth
        following = []
        for state in layer:
            for action, operator in every:
                if applicable(action, operator, state, world):
                    reached = after(action, operator, state, world)
                    if reached not in seen:
                        seen.add(reached)
                        following.append(reached)
        layer, depth = following, depth + 1
    return None


def test_the_whole_program_has_a_plan(made: Made) -> None:
    assert made.plan.status == "ok"
    assert (made.plan.problems, made.plan.warnings) == ((), ())
    lengths = {c: len(s.actions) for c, s in made.plan.segments.items()}
    assert lengths == made.paper.lengths


@pytest.mark.usefixtures("unified_planning")
def test_every_segment_is_valid_for_an_independent_validator(made: Made) -> None:
    for segment in made.plan.segments.values():
        assert is_valid(made.world, segment.before, segment.goals, segment.actions)
        # The validator is no rubber stamp: one action less, and it says no.
        assert not is_valid(made.world, segment.before, segment.goals, segment.actions[:-1])


def test_every_segment_is_as_short_as_breadth_first_search_finds(made: Made) -> None:
    world = reduced(made.world, made.paper.entities.split())
    for checkpoint, segment in made.plan.segments.items():
        start = State(about(segment.before.facts, world.entities))
        assert segment.optimal, checkpoint
        assert len(segment.actions) == shortest(world, start, segment.goals), checkpoint


def test_a_segment_is_shortest_where_greedy_search_takes_a_detour(dinner_party: Planner) -> None:
    goals = facts("(in cup cupboard) (open cupboard) (has host plate)")
    world = reduced(dinner_party.world, PAPER["tidying"].entities.split())
    found = dinner_party.segment(dinner_party.world.initial, goals)
    assert found.optimal
    assert len(found.actions) == shortest(world, world.initial, goals) == 10


def test_breadth_first_search_knows_when_there_is_no_plan(dinner_party: Planner) -> None:
    world = reduced(dinner_party.world, PAPER["tidying"].entities.split())
    goals = facts("(is-clean cup)")
    assert shortest(world, world.initial, goals) is None
    assert dinner_party.segment(dinner_party.world.initial, goals).status == "unsolvable"


def test_the_robot_fills_the_tray_after_the_resident_acknowledged(care_home: Planner) -> None:
    plan = care_home.compile(CAREGIVING)
    assert actions(plan.segments["c1"]) == [
        "(move home hall)",
        "(move hall recreation-area)",
        "(alert resident lunchtime recreation-area)",
    ]
    assert actions(plan.segments["c2"]) == [
        "(move recreation-area hall)",
        "(move hall cafeteria)",
        "(pick tray empty-trays)",
        "(fill tray food-station)",
    ]
    assert plan.segments["c2"].when == facts("(acknowledged lunchtime)")
    assert plan.segments["c4"].before.holds(facts("(dismissed lunchtime)")[0])


def test_the_dishes_are_put_away_from_the_rack(dinner_party: Planner) -> None:
    plan = dinner_party.compile(TIDYING)
    away = actions(plan.segments["c2"])
    assert away[0] == "(open-container cupboard)"
    assert {"(pick cup drying-rack)", "(pick plate drying-rack)"} < set(away)
    end = plan.segments["c2"].after
    assert all(end.holds(goal) for goal in facts("(in cup cupboard) (in plate cupboard)"))


def test_without_waiting_for_the_host_the_dishes_come_from_the_countertop(
    dinner_party: Planner,
) -> None:
    # The paper's most frequent mistake: it compiles, and what is put away is dirty.
    plan = dinner_party.compile(
        program(
            "delivered: (at cup countertop) (at plate countertop)",
            "tidied: (in cup cupboard) (in plate cupboard)",
        )
    )
    assert plan.status == "ok"
    assert "(pick cup countertop)" in actions(plan.segments["c2"])
    assert not plan.segments["c2"].after.holds(facts("(is-clean cup)")[0])
