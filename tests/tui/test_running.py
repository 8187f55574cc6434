"""Runs: read out, confirmed, watched, stopped."""

from __future__ import annotations

import threading
from pathlib import Path

import pytest

from tests.tui.conftest import LUNCH, Play, Stage


def runs() -> list[str]:
    return [t.name for t in threading.enumerate() if t.name == "run"]


async def start(stage: Stage, *sentences: str) -> None:
    for sentence in sentences:
        await stage.say(sentence)
    await stage.press("f5")
    await stage.see("Shall I start?", "1. yes, start")
    assert not runs()
    await stage.press("enter")


def test_a_run_to_its_end(play: Play, tmp_path: Path) -> None:
    async def script(stage: Stage) -> None:
        await start(stage, LUNCH)
        await stage.see("Objectives: 3 of 3", "polaris-nl review", "ok, 14 actions")
        await stage.see("The run is over: done.")
        assert "Reached fetched." in stage.pane("answers")
        await stage.press("f3")
        await stage.see("Map, after the run")

    play(script, size=(100, 40))
    assert len(list((tmp_path / "logs").glob("*.mcap"))) == 1


@pytest.mark.parametrize("stop", ["f9", "ctrl+c", "stop", "Stop it now!"])
def test_stop_always_works(play: Play, stop: str) -> None:
    async def script(stage: Stage) -> None:
        await start(stage, "open the fridge")
        await stage.see("> running", "«go to the hall»", "Expected", "F9 stop")
        await stage.press("f2")
        await stage.see(">   1 go to the hall", "being carried out")
        await (stage.press(stop) if stop in ("f9", "ctrl+c") else stage.enter(stop))
        await stage.see("You stopped the run.", "ok, 3 actions")
        await stage.until(lambda: not runs())

    play(script, live=True)


def test_stop_overtakes_a_yes(play: Play) -> None:
    async def script(stage: Stage) -> None:
        await stage.say("open the fridge")
        await stage.say("run it")
        stage.app.say("yes")
        stage.app.action_do("stop")
        await stage.see("You said stop before it began")
        assert not runs()
        await stage.answered()
        await stage.say("run it")
        await stage.press("f9")
        await stage.say("yes")
        assert not runs()
        await stage.say("run it")
        await stage.enter("yes")
        await stage.see("Objectives:")

    play(script)


def test_pause_and_resume(play: Play) -> None:
    async def script(stage: Stage) -> None:
        await start(stage, "open the fridge")
        await stage.see("> running")
        await stage.press("f6")
        await stage.see("> paused")
        await stage.press("f6")
        await stage.see("> running")
        await stage.enter("pause")
        await stage.see("> paused")
        await stage.enter("go on")
        await stage.see("> running")
        await stage.press("f5")
        await stage.see("A run is going on.")

    play(script, live=True)


def test_what_is_said_in_a_run_reaches_it(play: Play) -> None:
    async def script(stage: Stage) -> None:
        await start(stage, LUNCH)
        before = stage.session.snapshot
        await stage.see("> running")
        await stage.enter("she dismisses it")
        await stage.until(
            lambda: bool(stage.app.state.current and stage.app.state.current._commands.empty())
        )
        await stage.enter("open the fridge")
        await stage.see("The run goes on with the program that was read out")
        assert stage.session.snapshot.revision == before.revision + 1
        assert "open the fridge" not in stage.pane("main")
        await stage.press("ctrl+c")
        await stage.see("The run is over: stopped.")
        await stage.press("f2")
        await stage.until(lambda: "open the fridge" in stage.pane("main"))

    play(script, live=True)


def test_no_run_without_a_yes(play: Play) -> None:
    async def script(stage: Stage) -> None:
        await stage.say("open the fridge")
        await stage.say("yes")
        await stage.say("run it")
        await stage.say("no")
        await stage.see("All right, I won't start.")
        await stage.say("run it")
        await stage.say("go to the hall")
        await stage.say("yes")
        assert not runs()
        await stage.press("f9")
        await stage.see("There is no run.")
        await stage.say("pause")
        assert "Pausing" not in stage.screen()

    play(script)


def test_nothing_to_run_is_said(play: Play) -> None:
    async def script(stage: Stage) -> None:
        await stage.press("f5")
        await stage.see("There is nothing I can run.")

    play(script)


@pytest.mark.parametrize("keys", [("ctrl+q",), ("ctrl+q", "ctrl+q")])
def test_quitting_stops_the_run(play: Play, keys: tuple[str, ...]) -> None:
    async def script(stage: Stage) -> None:
        await start(stage, "open the fridge")
        await stage.see("> running")
        await stage.press(*keys)
        await stage.until(lambda: not stage.app.is_running)

    play(script, live=True)
    assert not runs()


def test_leaving_in_another_way_stops_the_run(play: Play) -> None:
    async def script(stage: Stage) -> None:
        await start(stage, "open the fridge")
        await stage.see("> running")

    play(script, live=True)
    assert not runs()
