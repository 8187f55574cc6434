"""What is legal and may still not be meant: conditionals, elses, and goals of nothing."""

from __future__ import annotations

import pytest

from polaris_nl.automaton.edits import SetGoals
from polaris_nl.language.understanding import Understanding
from polaris_nl.model.world_file import load_world
from polaris_nl.planning.planner import Planner
from tests.golden.files import check_golden

from .conftest import LUNCH, program

EMPTY = "(forall (?d - object) (imply (and (kind ?d dish) (not (is-clean ?d))) (at ?d countertop)))"
PROGRAMS = {
    "care-home": {
        "waits for what holds already": [
            "held: (holding tray)",
            "go [(holding tray)]: (robot-at home)",
        ],
        "an else that can't be taken": [
            "held: (holding tray)",
            "held -> go [(holding tray)]: (robot-at home)",
            "held -> otherwise: (robot-at kitchen)",
        ],
        "excludes itself": [
            "start -> sent [(acknowledged lunchtime) (dismissed lunchtime)]: (robot-at hall)",
        ],
        "in two places": ["start -> brought [(at cup table) (in cup fridge)]: (robot-at hall)"],
        "walls don't move": ["start -> wall [(connected home kitchen)]: (robot-at hall)"],
        "waits for itself": ["start -> full [(is-full tray)]: (robot-at hall)"],
        "waits for itself to go": ["start -> kitchen [(robot-at kitchen)]: (robot-at hall)"],
        "the second asks for more": [
            LUNCH,
            "alerted -> one [(acknowledged lunchtime)]: (robot-at hall)",
            "alerted -> two [(acknowledged lunchtime) (acknowledged bingo)]: (robot-at kitchen)",
        ],
        "the first asks for more": [
            LUNCH,
            "alerted -> one [(acknowledged lunchtime) (acknowledged bingo)]: (robot-at hall)",
            "alerted -> two [(acknowledged lunchtime)]: (robot-at kitchen)",
        ],
        "both ask for one thing and another": [
            "start -> one [(acknowledged lunchtime) (open fridge)]: (robot-at hall)",
            "start -> two [(acknowledged lunchtime) (open wardrobe)]: (robot-at kitchen)",
        ],
        "the same, as the rest holds already": [
            "start -> one [(acknowledged lunchtime) (open laundry-basket)]: (robot-at hall)",
            "start -> two [(acknowledged lunchtime)]: (robot-at kitchen)",
        ],
        "none of a kind": [
            "none: (forall (?d - object) (imply (kind ?d cutlery) (at ?d table)))",
        ],
        "nothing there": [
            "clear: (forall (?d - object) (imply (at ?d dining-table) (at ?d worktop)))",
        ],
    },
    "dinner-party": {
        "none is dirty by then": [f"start -> later [(is-clean cup) (is-clean plate)]: {EMPTY}"],
    },
}


@pytest.fixture(scope="module")
def planners() -> dict[str, Planner]:
    worlds = [load_world(name) for name in PROGRAMS]
    return {world.name: Planner(world, Understanding(world).wording) for world in worlds}


def test_each_is_said_once_and_reads_well(planners: dict[str, Planner]) -> None:
    lines: list[str] = []
    for world, programs in PROGRAMS.items():
        for name, program_lines in programs.items():
            plan = planners[world].compile(program(*program_lines))
            assert plan.status == "ok"
            assert len(plan.warnings) == 1, (name, [w.text for w in plan.warnings])
            assert plan.warnings[0].transition is not None
            lines += [name, *(f"    {x}" for x in program_lines), plan.warnings[0].text, ""]
    check_golden("planning/warnings.txt", "\n".join(lines))


@pytest.mark.parametrize(
    "lines",
    [
        # People may empty the hand, take the tray, close the fridge.
        ["held: (holding tray)", "free [(hand-empty)]: (robot-at home)"],
        ["held: (holding tray)", "taken [(not (holding tray))]: (robot-at home)"],
        ["held: (open fridge)", "shut [(not (open fridge))]: (robot-at home)"],
        # Different events, of which either may come first.
        ["start -> a [(acknowledged lunchtime)]: (robot-at hall)", "start -> b [(open fridge)]:"],
        # All dishes of which there are some, and what is there already.
        ["all: (forall (?d - object) (imply (kind ?d dish) (at ?d worktop)))"],
        ["all: (forall (?d - object) (imply (at ?d worktop) (at ?d worktop)))"],
        ["some: (exists (?d - object) (and (kind ?d dish) (at ?d worktop)))"],
    ],
)
def test_nothing_is_said_of_what_may_be_meant(
    planners: dict[str, Planner], lines: list[str]
) -> None:
    plan = planners["care-home"].compile(program(*lines))
    assert plan.status == "ok"
    assert [w.text for w in plan.warnings] == []


def test_an_empty_set_is_noticed_where_the_robot_is_then(planners: dict[str, Planner]) -> None:
    plan = planners["dinner-party"].compile(
        program(
            f"start -> now: {EMPTY}", f"start -> later [(is-clean cup) (is-clean plate)]: {EMPTY}"
        )
    )
    assert [w.transition for w in plan.warnings] == ["t2"]
    assert plan.warnings[0].text.startswith("There is no dish that is dirty, so")
    assert plan.segments["c1"].actions
    assert not plan.segments["c2"].actions


def test_an_offer_names_the_step_that_could_be_seen_to_on_the_way(
    planners: dict[str, Planner],
) -> None:
    lines = (
        "laid: (at cup countertop) (at plate countertop)",
        "out [(at cup drying-rack) (at plate drying-rack)]: (robot-at pantry)",
        "opened: (open cupboard) (in cup cupboard) (in plate cupboard)",
    )
    (offer,) = planners["dinner-party"].compile(program(*lines)).warnings
    assert offer.text == (
        "If the step out also asked for all of the step opened, that would save 2 actions."
    )
    assert [repair.text for repair in offer.repairs] == [
        "also ask in out for all of the step opened"
    ]
    (edit,) = offer.repairs[0].edits
    assert isinstance(edit, SetGoals)
    assert {str(goal) for goal in edit.goals} == {
        "(robot-at pantry)", "(open cupboard)", "(in cup cupboard)", "(in plate cupboard)",
    }  # fmt: skip
