"""Editing by keys: every menu, what it does to the program, and why some of it can't be done."""

from __future__ import annotations

import contextlib
from pathlib import Path

import pytest

from polaris_nl.automaton.automaton import Automaton
from polaris_tui.completion import completions, names_of
from tests.tui.conftest import LUNCH, Play, Stage


def names(stage: Stage) -> list[str]:
    return [c.name for c in stage.session.snapshot.automaton.checkpoints.values()]


def program(stage: Stage) -> Automaton:
    return stage.session.snapshot.automaton


async def choose(stage: Stage, *texts: str) -> None:
    """Filters the menus that come one after the other."""
    for text in texts:
        await stage.until(lambda: stage.app.state.choosing.last is not None)
        await stage.press(*[{" ": "space", "'": "apostrophe"}.get(c, c) for c in text])
        await stage.press("enter")


async def to(stage: Stage, checkpoint: str) -> None:
    """Goes to a checkpoint by its name."""
    stage.app.board.main.focus()
    await stage.press("slash")
    await choose(stage, checkpoint)
    await stage.until(lambda: stage.app.desk().here.name == checkpoint)


def test_every_edit_by_keys(play: Play) -> None:
    async def script(stage: Stage) -> None:
        await stage.press("tab", "a")
        await choose(stage, "open some", "fridge", "1")
        await stage.answered()
        assert names(stage) == ["start", "opened"]
        assert stage.app.desk().here.name == "opened"
        await stage.press("b")
        await choose(stage, "go to some", "kitchen")
        await stage.answered()
        assert program(stage).parent("c1") == "c2"
        await to(stage, "kitchen")
        await stage.press("e")
        await choose(stage, "something else", "go to some", "hall")
        await stage.answered()
        assert names(stage) == ["start", "opened", "hall"]  # its name was automatic
        await stage.press("r")
        await stage.until(lambda: stage.prompt.value == "hall")
        await stage.press("ctrl+u", *"corridor", "enter")
        await stage.answered()
        await stage.press("e")
        await choose(stage, "opposite")
        await stage.answered()
        assert names(stage) == ["start", "opened", "corridor"]
        assert [str(g) for g in program(stage).checkpoints["c2"].goals] == ["(not (robot-at hall))"]
        await stage.press("c")
        await choose(stage, "once something", "acknowledged", "lunch")
        await stage.answered()
        way = program(stage).incoming("c2")
        assert way is not None
        assert [str(x) for x in way.when] == ["(acknowledged lunchtime)"]
        await stage.press("c")
        await choose(stage, "no condition")
        await stage.answered()
        assert not program(stage).transitions[way.id].when
        await to(stage, "opened")
        await stage.press("m")
        await choose(stage, "after start")
        await stage.answered()
        assert program(stage).parent("c1") == "c0"
        await stage.press("X")
        await stage.answered()
        assert program(stage).incoming("c1") is None
        await to(stage, "corridor")
        await stage.press("x")
        await choose(stage, "opened")
        await stage.answered()
        assert program(stage).parent("c1") == "c2"
        await to(stage, "corridor")
        await stage.press("d")
        await choose(stage, "alone")
        await stage.answered()
        assert names(stage) == ["start", "opened"]
        count = len(stage.session.snapshot.undoable)
        await stage.press("h")
        await choose(stage, "beginning")
        await stage.until(lambda: len(stage.session.snapshot.redoable) == count)
        assert names(stage) == ["start"]
        await stage.press("h")
        await choose(stage, "redo 1")
        await stage.until(lambda: len(stage.session.snapshot.redoable) < count)

    play(script)


def test_a_repair_is_one_key_away(play: Play) -> None:
    async def script(stage: Stage) -> None:
        await stage.say("hold the cup and the plate")
        await stage.press("ctrl+r")
        await choose(stage, "1")
        await stage.answered()
        await stage.see("ok, ")
        await stage.press("f7")
        await stage.see("1 problem")
        await stage.answered()
        await stage.press("tab", "tab", "end", "up")
        row = stage.app.board.trouble.row
        assert row is not None
        assert row.repair
        await stage.press("enter")
        await stage.answered()
        await stage.see("ok, ")

    play(script, size=(100, 40))


def test_what_can_not_be_done_says_why(play: Play) -> None:
    async def script(stage: Stage) -> None:
        await stage.press("tab")
        for key, why in (
            ("r", "There is no checkpoint yet"),
            ("f", "The plan has no problem that has a way out."),
            ("t", "There is no run."),
            ("u", "There is nothing to undo."),
            ("p", "There is no plan to step through yet."),
        ):
            await stage.press(key)
            await stage.see(why)
        await stage.press("f10")
        await stage.see("Actions")
        await stage.press(*"rename")
        await stage.see("rename: rename it  (There is no checkpoint yet")
        await stage.press("enter")
        assert stage.app.state.choosing.last is not None
        await stage.press("escape", "escape")
        await stage.enter(":nonsense")
        await stage.see("Actions")

    play(script)


def test_a_menu_takes_a_sentence_too(play: Play) -> None:
    async def script(stage: Stage) -> None:
        stage.prompt.value = "begun"
        await stage.press("f10")
        await stage.see("Actions")
        await stage.press("ctrl+u", *"open", "space", *"the", "space", *"fridge", "enter")
        await stage.see("opened: open the fridge")
        assert stage.prompt.value == "begun"

    play(script)


def test_the_focus_comes_back_from_menus(play: Play) -> None:
    async def script(stage: Stage) -> None:
        main = stage.app.board.main
        await stage.press("tab", "enter", "enter")
        await stage.see("What should be so after start?")
        await stage.press("escape")
        await stage.see("─ start ─")
        await stage.press("escape")
        await stage.until(lambda: main.has_focus)
        await stage.press("enter", "enter", "escape")
        await stage.see("─ start ─")
        await choose(stage, "add", "open some", "fridge", "add it")
        await stage.answered()
        await stage.until(lambda: main.has_focus)
        await stage.press("f10")
        await choose(stage, "help")
        await stage.see("Help (")
        await stage.until(lambda: main.has_focus)
        await stage.press("escape", "escape", "f10")
        await choose(stage, "theme", "light")
        await stage.see("To keep it, put theme")
        await stage.until(lambda: stage.prompt.has_focus)

    play(script)


def test_the_tree_is_walked_with_arrows(play: Play) -> None:
    async def script(stage: Stage) -> None:
        await stage.say(LUNCH)
        await stage.press("tab", "g")
        seen = []
        for key in ("left", "left", "right", "right", "down", "up", "right"):
            await stage.press(key)
            seen.append(stage.app.desk().here.name)
        assert seen == ["alerted", "start", "alerted", "fetched", "cancelled", "fetched", "home"]
        assert stage.app.board.main.row is not None
        assert stage.app.board.main.row.span is not None
        await stage.press("g")
        await stage.see("1 go to the hall")

    play(script)


def test_the_plan_step_by_step(play: Play) -> None:
    async def script(stage: Stage) -> None:
        await stage.say(LUNCH)
        await stage.press("f4", "home")
        await stage.see("Step 1 of", "Why: I go to the hall")
        await stage.press("right", "right")
        await stage.see("action 3: tell the resident", "The resident has been told")
        await stage.press("left", "left", "left")
        await stage.see("Step 1 of")
        await stage.press("end")
        last = stage.app.stop()
        await stage.press("down")
        assert stage.app.stop() != last
        await stage.see("way 1 of 2: once lunch is acknowledged")
        await stage.press("up")
        await stage.see("way 2 of 2: once lunch is dismissed")
        await stage.press("w")
        await stage.see("> what about cancelled?")
        await stage.press("escape", "escape", "tab", "home", "down", "down", "enter")
        await stage.see("Plan, step by step", "action 2: go to the recreation area")

    play(script, size=(100, 40))


def test_copying_takes_the_way_through_the_terminal(
    play: Play, monkeypatch: pytest.MonkeyPatch
) -> None:
    copied: list[str] = []

    async def script(stage: Stage) -> None:
        monkeypatch.setattr(stage.app, "copy_to_clipboard", copied.append)
        await stage.say("open the fridge")
        await stage.press("tab", "home", "down", "y")
        await choose(stage, "this row")
        await stage.press("y")
        await choose(stage, "all rows")
        await stage.press("y")
        await choose(stage, "last answer")
        await stage.see("Copied.")

    play(script)
    assert copied[0] == "1 go to the hall"
    assert "opened: open the fridge" in copied[1]
    assert "\n" in copied[1]
    assert copied[2] == "Copied."


def test_the_program_file_in_an_editor(
    play: Play, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    script_file = tmp_path / "edit"
    script_file.write_text('#!/bin/sh\nsed -i \'s/"opened"/"cold"/\' "$1"\n')
    script_file.chmod(0o755)
    broken = tmp_path / "break"
    broken.write_text('#!/bin/sh\necho "{" > "$1"\n')
    broken.chmod(0o755)

    async def script(stage: Stage) -> None:
        monkeypatch.setattr(stage.app, "suspend", contextlib.nullcontext)
        await stage.say("open the fridge")
        monkeypatch.setenv("VISUAL", str(script_file))
        await stage.enter(":editor")
        await stage.answered()
        assert names(stage) == ["start", "cold"]
        await stage.enter(":editor")
        await stage.see("Nothing was changed.")
        monkeypatch.setenv("VISUAL", str(broken))
        await stage.enter(":editor")
        await stage.see("The program stays as it was.")
        assert names(stage) == ["start", "cold"]

    play(script)


def test_a_name_for_the_program(play: Play, tmp_path: Path) -> None:
    async def script(stage: Stage) -> None:
        await stage.say("open the fridge")
        await stage.enter(":save-as")
        await stage.until(lambda: stage.prompt.value == "care-home.polaris.json")
        await stage.enter(str(tmp_path / "mine.polaris.json"))
        await stage.see("Kept in mine.polaris.json from now on.")
        await stage.say("go to the hall")
        (tmp_path / "other.polaris.json").write_text('{"schema": "polaris-program/1"}')
        await stage.enter(":save-as")
        await stage.until(lambda: stage.app.state.choosing.last is not None)
        await stage.enter(str(tmp_path / "other.polaris.json"))
        await stage.see("There is another program in")

    play(script)
    assert "hall" in (tmp_path / "mine.polaris.json").read_text()


def test_names_are_completed(play: Play) -> None:
    async def script(stage: Stage) -> None:
        await stage.press(*"go", "space", *"to", "space", *"the", "space", *"recr", "tab")
        assert stage.prompt.value == "go to the recreation area"
        await stage.press("tab")
        assert stage.prompt.value == "go to the recreation room"
        await stage.press("ctrl+u", *"fridg", "tab")
        assert stage.prompt.value == "fridge"
        await stage.press("tab")
        await stage.until(lambda: not stage.prompt.has_focus)

    play(script)


@pytest.mark.parametrize(
    ("line", "found"),
    [
        ("fill the tr", ["fill the tray", "fill the trail"]),
        ("bring the tray to room ", ["bring the tray to room 1"]),
        ("x", []),
        ("", []),
        ("go to room 1", []),
    ],
)
def test_completions(line: str, found: list[str]) -> None:
    assert completions(line, ["tray", "trail", "room 1", "xylophone"]) == found


def test_checkpoints_are_completed_first(play: Play) -> None:
    async def script(stage: Stage) -> None:
        await stage.say("open the fridge")
        known = names_of(stage.session.world, program(stage))
        assert known[0] == "opened"
        assert "mug" in known or "fridge" in known
        assert len(known) == len(set(known))

    play(script)
