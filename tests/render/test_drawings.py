"""Drawn trees, timelines, maps with little room, and text as wide as it is shown."""

from __future__ import annotations

import itertools

import pytest

from polaris_nl.automaton.automaton import START, Automaton, Checkpoint, Transition
from polaris_nl.automaton.edits import AddCheckpoint, apply
from polaris_nl.model.formula import parse_literal
from polaris_nl.model.wording import PlainWording
from polaris_nl.model.world_file import load_world
from polaris_nl.planning.planner import Planner
from polaris_nl.planning.result import BranchingPlan
from polaris_nl.render.explanation import offers, problem_rows
from polaris_nl.render.glyphs import ASCII, UNICODE, Glyphs, cells, fitting
from polaris_nl.render.layout import cut, wrapped
from polaris_nl.render.map import map_lines
from polaris_nl.render.remembered import remembered
from polaris_nl.render.timeline import branch_stops, timeline_rows
from polaris_nl.render.tree import tree_of
from tests.planning.conftest import program

WORLD = load_world("care-home")
WORDING = PlainWording(WORLD)


def grown(parents: list[int], when: str = "") -> Automaton:
    """A program in which checkpoint n comes after the one of a number before it."""
    automaton = Automaton()
    for number, parent in enumerate(parents, start=1):
        literals = (parse_literal(when),) if when else ()
        new = Checkpoint(f"c{number}", f"step {number}")
        arrow = Transition(f"t{number}", f"c{parent}", new.id, literals)
        automaton = apply(automaton, AddCheckpoint(new, arrow))
    return automaton


SHAPES = {
    "chain": list(range(40)),
    "bush": [0] * 12,
    "binary": [n // 2 for n in range(40)],
    "comb": [n - n % 2 for n in range(40)],
}


@pytest.mark.parametrize("glyphs", [UNICODE, ASCII], ids=["unicode", "ascii"])
@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("width", [60, 100, 150])
def test_every_checkpoint_is_drawn_once_inside_the_width(
    shape: str, width: int, glyphs: Glyphs
) -> None:
    automaton = grown(SHAPES[shape], "(open fridge)" if shape == "binary" else "")
    drawing = tree_of(automaton, None, WORDING, glyphs, width)
    assert set(drawing.places) == set(automaton.checkpoints)
    assert all(cells(row) <= width for row in drawing.rows)
    for id, place in drawing.places.items():
        name = automaton.checkpoints[id].name
        assert name in drawing.rows[place.row][place.start : place.end]
    if glyphs is ASCII:
        assert "\n".join(drawing.rows).isascii()
    picked = drawing.shown("c3")
    (span,) = [row for row in picked if row.span]
    assert "step 3" in span.text[slice(*span.span or ())]


def test_a_program_that_is_no_tree_is_drawn_too() -> None:
    loop = grown([0, 1]).with_transition(Transition("t9", "c2", "c1"))
    alone = loop.without(frozenset(), frozenset({"t2"}))
    for automaton in (loop, alone):
        assert set(tree_of(automaton, None, WORDING, UNICODE, 100).places) == {"c0", "c1", "c2"}


def planned(automaton: Automaton) -> BranchingPlan:
    return Planner(WORLD).compile(automaton)


def test_the_tree_says_how_each_checkpoint_is() -> None:
    automaton = program("open: (open fridge)", "both: (holding cup) (holding plate)", "then: ")
    text = "\n".join(tree_of(automaton, planned(automaton), WORDING, UNICODE, 100).rows)
    assert "● open ✓ 3" in text
    assert "● both ✗" in text
    assert "● then ·" in text


def test_stops_of_a_branch() -> None:
    automaton = program("open: (open fridge)", "hall: (robot-at hall)")
    plan = planned(automaton)
    stops = branch_stops(automaton, plan, "c2", WORDING)
    assert [s.kind for s in stops] == ["action"] * 3 + ["checkpoint", "action", "checkpoint"]
    assert [s.number for s in stops if s.kind == "action"] == [1, 2, 3, 4]
    assert stops[0].before == WORLD.initial
    assert stops[-1].after == plan.segments["c2"].after
    assert all(a.after == b.before for a, b in itertools.pairwise(stops))


@pytest.mark.parametrize("width", [30, 60, 79, 150])
def test_a_timeline_fits_and_shows_what_is_picked(width: int) -> None:
    automaton = program("open: (open fridge)", "hall: (robot-at hall)")
    plan = planned(automaton)
    stops = branch_stops(automaton, plan, "c2", WORDING)
    for picked in range(len(stops)):
        rows = timeline_rows(stops, picked, UNICODE, width, frozenset(plan.segments), picked)
        assert all(cells(row.text) <= width for row in rows)
        (row,) = [row for row in rows if row.span]
        shown = row.text[slice(*row.span or ())]
        assert shown[0] + shown[-1] == "«»"
        assert sum(r.text.count("✓") for r in rows) == picked
    assert not any(r.span for r in timeline_rows(stops, None, ASCII, width, frozenset()))


def test_a_branch_that_has_no_plan_ends_where_it_can_not_go_on() -> None:
    automaton = program("both: (holding cup) (holding plate)", "then: (robot-at hall)")
    stops = branch_stops(automaton, planned(automaton), "c2", WORDING)
    assert [s.text for s in stops] == ["both"]
    assert stops[0].after is None


def test_ways_out_are_counted_as_they_are_listed() -> None:
    automaton = program("both: (holding cup) (holding plate)")
    plan = planned(automaton)
    found = offers(plan)
    rows = problem_rows(plan, automaton, 200)
    assert len(found) > 1
    for number, (_, repair) in enumerate(found, start=1):
        (row,) = [r for r in rows if r.repair == number]
        assert repair.text in row.text


WIDE = "厨房 and the 👩 kitchen e\u0301 end"


@pytest.mark.parametrize("width", range(2, 40))
def test_wide_characters_take_two_columns(width: int) -> None:
    assert cells(cut(WIDE, width)) <= max(width, 1)
    assert cells(fitting(WIDE, width)) <= width
    if cells(WIDE) <= width:
        assert cut(WIDE, width) == WIDE
    rows = wrapped(WIDE * 3, width + 20, "> ", "  ")
    assert all(cells(row.text) <= width + 20 for row in rows)
    joined = "".join(row.text[2:] for row in rows).replace(" ", "")
    assert joined == (WIDE * 3).replace(" ", "")


def test_a_map_with_few_rows_still_names_what_is_low() -> None:
    lines = map_lines(WORLD, WORLD.initial, UNICODE, 70, 10)
    assert len(lines) <= 10
    assert "hall" in "\n".join(lines)
    assert all(cells(line) <= 70 for line in lines)


def test_words_are_said_once() -> None:
    said: list[str] = []

    class Counting(PlainWording):
        def entity(self, name: str) -> str:
            said.append(name)
            return super().entity(name)

    wording = remembered(Counting(WORLD))
    literal = parse_literal("(open fridge)")
    texts = {wording.fact(literal) for _ in range(3)} | {wording.goals([literal]) for _ in range(3)}
    assert texts == {
        PlainWording(WORLD).fact(literal),
        PlainWording(WORLD).goals([literal]),
    }
    assert said == ["fridge", "fridge"]
    assert wording.events([literal]) == PlainWording(WORLD).events([literal])


def test_the_start_is_a_place_of_its_own() -> None:
    assert set(tree_of(Automaton(), None, WORDING, UNICODE, 80).places) == {START}
