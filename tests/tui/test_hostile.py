"""Text that would break a screen is shown as it is, or without what can't be shown."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from polaris_nl.automaton.automaton import START, Automaton, Checkpoint, Transition
from polaris_nl.automaton.edits import AddCheckpoint, apply
from polaris_nl.execution.events import Said
from polaris_nl.logs.writer import LogWriter
from polaris_nl.model.formula import parse_literal
from polaris_nl.model.wording import PlainWording
from polaris_nl.model.world import World
from polaris_nl.render.glyphs import ASCII
from polaris_nl.session import Session
from polaris_tui.plain import Plain
from polaris_tui.progress import Progress
from polaris_tui.scene import Scene
from polaris_tui.transcript import Entry
from tests.tui.conftest import Play, Stage

HOSTILE = (
    "[/red]",
    "[kitchen]",
    "[@click=app.quit]x[/]",
    "\x1b[2J\x1b]0;title\x07\x9b31m",
    "\u202eשלום\u202c",
    "厨房厨房厨房",
    "👩\u200d👩\u200d👧 e\u0301\u0301",
    "one\rtwo\nthree\ttab",
    "%s {0} $x \\[b] \\",
    "x" * 1990,
)
SURFACES = ("table", "desk", "nightstand", "worktop", "coffee-table")
CONDITIONALS = [f"(at {thing} {surface})" for thing in ("cup", "plate") for surface in SURFACES]
KEYS = (
    *("f3", "f3", "f1", "f1", "ctrl+l", "ctrl+l", "f4", "right", "down", "f3", "escape", "escape"),
    *("escape", "tab", "end", "h", "escape", "m", "escape", "r", "escape", "e", "escape", "g", "g"),
    *("enter", "escape", "y", "escape", "f10", "escape", "f8", "f2", "f2", "escape"),
)
"""Through every view and menu, and back to the program."""
MARKUP = [text for text in HOSTILE if text.startswith("[")]


def harmless(screen: str) -> bool:
    return all(c == "\n" or c.isprintable() for c in screen)


def test_typed(play: Play) -> None:
    async def script(stage: Stage) -> None:
        await stage.press("ctrl+l")
        for text in HOSTILE:
            stage.prompt.insert_text_at_cursor(text)
            await stage.press("left", "right")
            assert harmless(stage.screen())
            await stage.press("enter")
            await stage.answered()
            await stage.press("up")
            assert harmless(stage.screen())
            await stage.press("down", "ctrl+u")
        for text in MARKUP:
            assert f"> {text}" in stage.pane("answers")

    play(script)


@pytest.mark.parametrize("text", HOSTILE[:4])
def test_as_the_name_of_a_world(play: Play, care_home: World, text: str) -> None:
    async def script(stage: Stage) -> None:
        assert harmless(stage.screen())
        if text in MARKUP:
            assert text in stage.pane("title")

    play(script, world=replace(care_home, name=text))


def test_in_names_and_answers(play: Play) -> None:
    goals = (parse_literal("(open cupboard)"), parse_literal("(not (open cupboard))"))
    program = Automaton()
    for number, (text, when) in enumerate(zip(HOSTILE, CONDITIONALS, strict=True), start=1):
        here = Checkpoint(f"c{number}", text, goals)
        arrow = Transition(
            f"t{number}",
            START,
            here.id,
            (parse_literal(when),),
        )
        program = apply(program, AddCheckpoint(here, arrow))

    async def script(stage: Stage) -> None:
        for text in HOSTILE:
            stage.session.edit([], text)
            stage.app.state.note(Entry(text, "! ", "bad"), said=text)
        await stage.answered()
        for key in KEYS:
            await stage.press(key)
            assert harmless(stage.screen())
        for text in MARKUP:
            assert all(text in stage.pane(name) for name in ("main", "trouble", "answers"))

    play(script, program=program, size=(100, 40))


def test_in_logs(play: Play, tmp_path: Path) -> None:
    path = tmp_path / "hostile.mcap"
    with LogWriter(path) as writer:
        for number, text in enumerate(HOSTILE):
            writer.write(Said(time=float(number), text=text))

    async def script(stage: Stage) -> None:
        stage.app.open_log(path)
        await stage.see("Log hostile.mcap")
        for _ in HOSTILE:
            await stage.press("down")
            for key in ("d", "c", "c"):
                await stage.press(key)
                assert harmless(stage.screen())
        assert all(text in stage.pane("main") for text in MARKUP)
        for text in HOSTILE:
            await stage.press("slash", "ctrl+u")
            stage.prompt.insert_text_at_cursor(text)
            await stage.press("enter")
            assert harmless(stage.screen())

    play(script)


def test_line_by_line(care_home: World) -> None:
    shown: list[str] = []
    with Session(care_home) as session:
        scene = Scene(
            care_home,
            "x",
            session.snapshot,
            PlainWording(care_home),
            Progress(care_home.initial),
            ASCII,
        )
        Plain(session, shown.append, scene, 80).work(HOSTILE)
    assert all(harmless(line) for line in shown)
