"""Programs made by sentences and keys, before the real language and planner."""

from __future__ import annotations

from pathlib import Path

from polaris_nl.automaton.program import read_program
from polaris_nl.model.world import World
from polaris_nl.model.world_file import load_world
from polaris_nl.planning.planner import Planner
from tests.tui.conftest import DISHES, LUNCH, GatedPlanner, Play, Stage


def test_the_input_line_comes_first(play: Play) -> None:
    async def script(stage: Stage) -> None:
        assert stage.prompt.has_focus
        await stage.see("empty program", "Nothing yet.", "Nothing is saved without a program file")

    play(script)


def test_the_caregiving_program(play: Play, tmp_path: Path) -> None:
    async def script(stage: Stage) -> None:
        await stage.say(LUNCH)
        await stage.see("ok, 14 actions", "takes 14 actions.", "alerted: tell the resident")
        await stage.press("f2")
        await stage.see("once lunch is dismissed", "cancelled: go home")
        assert "1 go to the hall" not in stage.screen()

    file = tmp_path / "lunch.polaris.json"
    session = play(script, path=file)
    assert read_program(file).automaton == session.snapshot.automaton


def test_the_tidying_program(play: Play) -> None:
    async def script(stage: Stage) -> None:
        for sentence in DISHES:
            await stage.say(sentence)
        await stage.see("ok, ")
        assert "once the cup and the plate are on the drying rack" in stage.pane("main")
        assert "put the plate in the cupboard" in stage.pane("main")

    play(script, world=load_world("dinner-party"))


def test_a_question_is_answered_by_number(play: Play) -> None:
    async def script(stage: Stage) -> None:
        await stage.say("go to the room")
        await stage.see("? Which room do you mean?", "1. room 1", "2. room 2", "empty program")
        await stage.say("2")
        await stage.see("go to room 2")

    play(script)


def test_undo_and_redo_have_keys(play: Play) -> None:
    async def script(stage: Stage) -> None:
        await stage.say("open the fridge")
        await stage.say("go to the hall")
        first = stage.session.snapshot.automaton
        for undo, redo in (("f7", "f8"), ("ctrl+z", "ctrl+y")):
            await stage.press(undo)
            await stage.see("Undone: ", "F7 undoes: Open the fridge")
            await stage.answered()
            assert len(stage.session.snapshot.automaton.checkpoints) == 2
            await stage.press(redo)
            await stage.see("Done again: ")
            await stage.answered()
            assert stage.session.snapshot.automaton == first
        await stage.press("f8")
        await stage.see("There is nothing to redo.")

    play(script)


def test_problems_have_a_pane_with_their_ways_out(play: Play) -> None:
    async def script(stage: Stage) -> None:
        await stage.say("hold the cup and the plate")
        await stage.see("1 problem", "goals in conflict", "as the robot has one hand")
        assert "Way out: pick up the cup first" in stage.pane("trouble")
        await stage.press("tab", "tab", "end")
        await stage.see("Way out: leave out that the robot is holding the cup")
        await stage.press("f7")
        await stage.see("empty program")
        assert "1 problem" not in stage.screen()

    play(script)


def test_nobody_waits_for_a_plan(play: Play, care_home: World) -> None:
    planner = GatedPlanner(Planner(care_home))

    async def script(stage: Stage) -> None:
        await stage.say("open the fridge")
        planner.gate.clear()
        await stage.enter("go to the hall")
        await stage.see("… planning", "opened: open the fridge  ✓ 3 actions", "3 open the fridge")
        await stage.press("x", "y")
        assert stage.prompt.value == "xy"
        await stage.see("I'm still working out the plan.")
        planner.gate.set()
        await stage.see("The plan takes 4 actions.", "ok, 4 actions")

    play(script, planner=planner)


def test_views_by_key_and_by_sentence(play: Play) -> None:
    async def script(stage: Stage) -> None:
        await stage.press("f2")
        await stage.see("─ Program ─")
        await stage.press("f2")
        for key, sentence, seen in (
            ("f1", "show the help", "Type what the robot should achieve"),
            ("f3", "show the map", "Map, at the start"),
        ):
            await stage.press(key)
            await stage.see(seen)
            await stage.press(key)
            await stage.see("Program and plan")
            await stage.enter(sentence)
            await stage.see(seen)
            await stage.press("escape")
            await stage.see("Program and plan")
        await stage.press("ctrl+l")
        await stage.until(lambda: "Program and plan" not in stage.screen())
        await stage.see("Nothing is saved")

    play(script)


def test_why_is_answered_in_the_program(play: Play) -> None:
    async def script(stage: Stage) -> None:
        await stage.say("open the fridge")
        await stage.press("tab", "home", "down", "w")
        await stage.see("> why action 1?", "I go to the hall, so that I can")
        await stage.press("end", "w")
        await stage.see("> what about opened?", "The aim is that")
        await stage.press("z")
        await stage.see('"z" means nothing here.')
        await stage.press("escape")
        assert stage.prompt.has_focus

    play(script)


def test_earlier_lines_come_back(play: Play) -> None:
    async def script(stage: Stage) -> None:
        await stage.say("where is the tray?")
        await stage.press("d", "up")
        assert stage.prompt.value == "where is the tray?"
        await stage.press("down")
        assert stage.prompt.value == "d"

    play(script)


def test_a_file_that_cannot_be_saved_is_said(play: Play, tmp_path: Path) -> None:
    async def script(stage: Stage) -> None:
        await stage.say("open the fridge")
        await stage.see("! Can't")

    play(script, path=tmp_path / "missing" / "x.polaris.json")


def test_quit_by_sentence(play: Play) -> None:
    async def script(stage: Stage) -> None:
        await stage.enter("quit")
        await stage.until(lambda: not stage.app.is_running)

    play(script)
