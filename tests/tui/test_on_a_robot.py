"""Runs on a robot from the screen: the simulated Stretch as a process of its own, in a terminal of its own."""

from __future__ import annotations

import importlib.util
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from polaris_nl.automaton.program import Program, write_program
from polaris_nl.execution.events import GoalSent, Heard, RunEnded, RunStarted
from polaris_nl.execution.ros.profile import Profile, profile_for
from polaris_nl.logs.reader import Log, read_log
from polaris_nl.runs import RunOrder, RunReport, run_simulated
from tests.execution.ros.processes import Process, new_domain
from tests.planning.conftest import program
from tests.tui.conftest import LIMIT_S, LUNCH, Play, Stage
from tests.tui.ssh import Tmux

SIMULATOR = "polaris_nl.execution.ros.stretch_sim"
SIM = profile_for("stretch-sim")


@pytest.fixture
def terminal(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Tmux]:
    monkeypatch.setenv("ROS_DOMAIN_ID", new_domain())
    monkeypatch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    settings = tmp_path / "config" / "polaris-nl" / "tui.toml"
    settings.parent.mkdir(parents=True)
    settings.write_text(f'logs = "{tmp_path / "logs"}"\n')
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path / "config"))
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    found = Tmux(tmp_path)
    yield found
    found("kill-server")


@pytest.fixture
def simulator(terminal: Tmux) -> Iterator[Process]:
    options = ("--kinematic", "--speed", "12", "--people", "none")
    found = Process(SIMULATOR, "--world", "care-home", *options)
    try:
        found.wait_for("ready")
        yield found
    finally:
        found.close()


def opened(terminal: Tmux, *sentences: str) -> Path:
    file = terminal.folder / "lunch.polaris.json"
    terminal.open("tui", str(file), "--world", "care-home", "--robot", "stretch-sim")
    terminal.see("empty program", "robot: the simulated Stretch")
    for sentence in sentences:
        terminal.type(sentence)
        terminal.see("The plan takes")
    return file


def logs(terminal: Tmux) -> list[Log]:
    return [read_log(path) for path in sorted((terminal.folder / "logs").glob("*.mcap"))]


def test_the_simulated_stretch_is_run_by_keys(terminal: Tmux, simulator: Process) -> None:
    opened(terminal, LUNCH)
    terminal.keys("F5")
    terminal.see("will move. Shall I start?")
    terminal.keys("Enter")
    terminal.see("─ Run on the simulated Stretch ─", "Expected", "> running")
    terminal.keys("F6")
    terminal.see("> paused")
    terminal.keys("F6")
    terminal.see("I wait. Say what has happened", seconds=3 * LIMIT_S)
    terminal.keys("C-t")
    terminal.see("What has happened?")
    terminal.choose("dismissed", "dismissed: on to cancelled")
    terminal.see("The run is over: done.", seconds=3 * LIMIT_S)
    log = logs(terminal)[-1]
    (started,) = [e for e in log.events if isinstance(e, RunStarted)]
    assert started.robot == "stretch-sim"
    said = [e.utterance for e in log.events if isinstance(e, Heard)]
    assert said[0] == LUNCH
    assert said[-2:] == ["run it", "yes"]

    # Quitting stops the robot before the program ends.
    terminal.keys("F5")
    terminal.see("will move. Shall I start?")
    terminal.keys("Enter")
    terminal.see("> running")
    terminal.keys("C-q")
    terminal.see("code 0")
    (ended,) = [e for e in logs(terminal)[-1].events if isinstance(e, RunEnded)]
    assert ended.outcome == "stopped"


def test_a_robot_outlives_its_line_and_no_longer(terminal: Tmux, simulator: Process) -> None:
    """The terminal goes away in the middle of a run: another one takes it over, and stops it."""
    opened(terminal, LUNCH)
    terminal.keys("F5")
    terminal.see("will move. Shall I start?")
    terminal.keys("Enter")
    terminal.see("> running")
    terminal("kill-server")
    again = Tmux(terminal.folder, "again")
    try:
        again.open("tui", "--world", "care-home")
        again.see(
            "─ Run on the simulated Stretch, begun in another terminal ─", "tell the resident"
        )
        again.keys("F9")
        again.see("The run is over: stopped.")
        again.keys("C-q")
        again.see("code 0")
    finally:
        again("kill-server")
    folder, deadline = terminal.folder / "state" / "polaris-nl" / "runs", time.monotonic() + LIMIT_S
    while list(folder.glob("*.sock")):
        assert time.monotonic() < deadline
        time.sleep(0.05)


def test_a_stop_overtakes_a_robot_that_is_looked_for(
    play: Play, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """Pressed before the robot has answered, it is the first thing that the run hears: nothing is sent."""
    answers = threading.Event()

    def slow(profile: Profile, order: RunOrder, **how: Any) -> RunReport:
        assert profile is SIM
        assert answers.wait(LIMIT_S)
        return run_simulated(order, **how)

    monkeypatch.setattr("polaris_nl.robot_runs.run_on_robot", slow)

    async def script(stage: Stage) -> None:
        await stage.say("open the fridge")
        await stage.say("run it")
        await stage.enter("yes")
        await stage.see("I'm looking for the simulated Stretch.", "… connecting")
        await stage.press("f9")
        await stage.see("… stopping")
        answers.set()
        await stage.see("You stopped the run.", "Run on the simulated Stretch, as it ended")

    play(script, profile=SIM)
    (path,) = (tmp_path / "logs").glob("*.mcap")
    kinds = [type(e) for e in read_log(path).events]
    assert RunEnded in kinds
    assert GoalSent not in kinds


def test_no_robot_is_said_in_words(play: Play, monkeypatch: pytest.MonkeyPatch) -> None:
    """Without ROS 2, as on a machine that only edits; the screen stays, and the program with it."""
    monkeypatch.setitem(sys.modules, "rclpy", None)
    found = importlib.util.find_spec
    monkeypatch.setattr(
        "importlib.util.find_spec", lambda name: None if name == "rclpy" else found(name)
    )
    monkeypatch.delenv("ROS_DISTRO", raising=False)

    async def script(stage: Stage) -> None:
        await stage.say("open the fridge")
        await stage.press("f5")
        await stage.see("The simulated Stretch will move. Shall I start?", "1. yes, start")
        await stage.press("enter")
        await stage.see("A Stretch is reached over ROS 2, which is missing here.", "ok, 3 actions")
        await stage.say("go to the hall")
        await stage.see("ok, ")
        await stage.say("run it")
        assert "The simulated Stretch will move." in stage.pane("answers")
        await stage.say("no")

    play(script, profile=SIM)


def test_a_run_that_never_begins_can_be_left(terminal: Tmux) -> None:
    """No simulator runs: the search for it ends, by its own deadline or when the user quits."""
    write_program(
        Program(program("open: (open fridge)"), "caregiving", "care-home"),
        terminal.folder / "lunch.polaris.json",
    )
    file = terminal.folder / "lunch.polaris.json"
    terminal.open("tui", str(file), "--robot", "stretch-sim")
    terminal.see("ok, 3 actions")
    terminal.type("run it")
    terminal.see("The simulated Stretch will move.", "Shall I start? Say yes or no.")
    terminal.type("yes")
    terminal.see("I'm looking for the simulated Stretch.", "connecting")
    terminal.keys("C-q")
    terminal.see("stopping")
    screen = terminal.see("code ")
    assert "code 0" in screen
    assert "terminate" not in screen
