"""Programs, plans, maps and states as text; whole screens are golden files."""

from __future__ import annotations

from pathlib import Path

import pytest

from polaris_nl.automaton.automaton import START, Automaton
from polaris_nl.model.world_file import load_world
from polaris_nl.planning.planner import Planner
from polaris_nl.render.explanation import branches_in_words, problem_rows
from polaris_nl.render.glyphs import ASCII, UNICODE, Glyphs, plain
from polaris_nl.render.layout import cut, text_of, wrapped
from polaris_nl.render.log import event_rows
from polaris_nl.render.map import map_lines
from polaris_nl.render.program import first_numbers, program_rows
from polaris_nl.render.state import state_rows
from polaris_nl.session import Session
from tests.golden.files import check_golden

PROGRAM = (
    "Tell the resident that lunch is ready.",
    "Once she acknowledges, bring a full tray to her table and then go home.",
    "If she dismisses it, just go home.",
)


@pytest.fixture(scope="module")
def lunch() -> tuple[Session, Automaton]:
    session = Session(load_world("care-home"))
    for sentence in PROGRAM:
        session.say(sentence)
    automaton = session.snapshot.automaton
    session.close()
    return session, automaton


@pytest.mark.parametrize(("name", "glyphs"), [("unicode", UNICODE), ("ascii", ASCII)])
def test_the_outline_with_its_actions(
    lunch: tuple[Session, Automaton], name: str, glyphs: Glyphs
) -> None:
    session, automaton = lunch
    plan = session.planner.compile(automaton)
    rows = program_rows(automaton, plan, session.wording, glyphs, 80, actions=True)
    check_golden(f"render/lunch-{name}.txt", text_of(rows))
    assert all(len(row.text) <= 80 for row in rows)
    numbers = [row.action for row in rows if row.action is not None]
    assert numbers == list(range(1, plan.action_count + 1))
    assert list(first_numbers(plan)) == ["c1", "c2", "c3", "c4"]
    if glyphs is ASCII:
        assert text_of(rows).isascii()


def test_the_branches_in_words(lunch: tuple[Session, Automaton]) -> None:
    session, automaton = lunch
    plan = session.planner.compile(automaton)
    check_golden(
        "render/lunch-words.txt", "\n".join(branches_in_words(automaton, plan, session.wording))
    )


def test_a_narrow_terminal_and_a_program_without_a_plan(lunch: tuple[Session, Automaton]) -> None:
    session, automaton = lunch
    rows = program_rows(automaton, None, session.wording, UNICODE, 40)
    assert all(len(row.text) <= 40 for row in rows)
    assert sum("planning" in row.text for row in rows) == 4
    assert {row.checkpoint for row in rows} == set(automaton.checkpoints)


def test_problems_come_with_their_ways_out() -> None:
    with Session(load_world("care-home")) as session:
        session.say("Make sure that the resident has acknowledged lunch.")
        session.say("Then hold the cup and the plate.")
        automaton = session.snapshot.automaton
        plan = session.planner.compile(automaton)
        rows = problem_rows(plan, automaton, 80)
        outline = text_of(program_rows(automaton, plan, session.wording, UNICODE, 80))
    assert "Way out: " in text_of(rows)
    assert "✗" in outline
    assert rows[0].tone == "bad"


def test_an_empty_program_says_what_to_do() -> None:
    planner = Planner(load_world("care-home"))
    rows = program_rows(Automaton(), planner.compile(Automaton()), planner.wording, UNICODE, 80)
    assert [row.checkpoint for row in rows] == [START, None]
    assert "Say what the robot should achieve" in rows[1].text


@pytest.mark.parametrize("name", ["care-home", "dinner-party"])
def test_the_map(name: str) -> None:
    world = load_world(name)
    lines = map_lines(world, world.initial, ASCII, 78, 22)
    check_golden(f"render/map-{name}.txt", "\n".join(lines))
    assert len(lines) <= 22
    assert all(len(line) <= 78 for line in lines)
    assert sum(line.count("ROBOT") for line in lines) == 1


def test_a_small_map_and_one_without_areas() -> None:
    world = load_world("care-home")
    lines = map_lines(world, world.initial, UNICODE, 38, 9)
    assert 0 < len(lines) <= 9
    assert all(len(line) <= 38 for line in lines)


def test_the_state_leaves_out_what_never_changes() -> None:
    world = load_world("dinner-party")
    planner = Planner(world)
    text = text_of(state_rows(world.initial, world, planner.wording, 80))
    assert "cup" in text
    assert "connected" not in text
    assert "located" not in text


def test_an_event() -> None:
    rows = event_rows(3.25, "error", "I halt: the cup is gone.", ASCII, 80, 12)
    assert rows[0].text == "  12     3.2 s ! I halt: the cup is gone."
    assert rows[0].tone == "bad"


@pytest.mark.parametrize(
    "text", ["\x1b[2Jgone", "a\nb", "x\u202ey", "\ud800", "nul\0", "[/red]", "café 食"]
)
def test_foreign_text_can_do_no_harm(text: str) -> None:
    shown = plain(text)
    assert "\x1b" not in shown
    assert "\n" not in shown
    assert "\u202e" not in shown
    assert "\0" not in shown
    assert wrapped(text, 20)
    if text.isprintable():
        assert shown == text


def test_cutting() -> None:
    assert cut("abcdef", 4) == "abc…"
    assert cut("abc", 4) == "abc"
    long = wrapped("word " * 50, 30, "> ")
    assert all(len(row.text) <= 30 for row in long)
    assert long[0].text.startswith("> word")
    assert long[1].text.startswith("  word")


def test_a_world_without_a_grammar_is_drawn_too(tmp_path: Path) -> None:
    world = load_world("care-home")
    planner = Planner(world)
    assert text_of(state_rows(world.initial, world, planner.wording, 80))
