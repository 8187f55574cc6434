"""The real program at 80x24 over a real SSH line: by keys alone, by sentences alone, and when the line drops."""

from __future__ import annotations

import json
import os
import re
import signal
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.tui.ssh import LIMIT_S, MISSING, Sshd, Tmux, server


@pytest.fixture
def sshd(tmp_path: Path) -> Iterator[Sshd]:
    if MISSING:
        pytest.fail(MISSING)
    folder = tmp_path / "ssh"
    folder.mkdir()
    with server(folder) as found:
        yield found


@pytest.fixture
def terminal(tmp_path: Path) -> Iterator[Tmux]:
    found = Tmux(tmp_path)
    yield found
    found("kill-server")


def opened(terminal: Tmux, sshd: Sshd, file: Path, world: str) -> None:
    terminal.start(sshd.command("tui", str(file), "--world", world))
    terminal.see("empty program")


def goals(file: Path) -> dict[str, list[str]]:
    return {c["name"]: c["goals"] for c in json.loads(file.read_text())["checkpoints"]}


def conditions(file: Path) -> list[list[str]]:
    return [t["when"] for t in json.loads(file.read_text())["transitions"]]


def add(terminal: Tmux, predicate: str, *entities: str) -> None:
    """Adds a checkpoint by the typed menus."""
    terminal.keys("a")
    terminal.see("What should be so after")
    terminal.choose(predicate, "which" if entities else "add it")
    for number, entity in enumerate(entities, start=1):
        last = number == len(entities)
        terminal.choose(entity, "add it" if last else "which")


def test_the_caregiving_program_by_keys_alone(terminal: Tmux, sshd: Sshd, tmp_path: Path) -> None:
    file = tmp_path / "lunch.polaris.json"
    opened(terminal, sshd, file, "care-home")
    terminal.keys("Tab")
    terminal.see("> Program and plan")
    add(terminal, "tell some person", "resident", "lunch")
    terminal.keys("Enter")
    terminal.see("alerted: tell the resident", "ok, 3 actions")
    add(terminal, "fill some object", "tray")
    terminal.choose("another goal", "And what else?")
    terminal.choose("bring some object to", "which object")
    terminal.choose("tray", "which surface")
    terminal.choose("resident's table", "only once")
    terminal.choose("only once", "Once what has happened?")
    terminal.choose("some message has been acknowledged", "which message")
    terminal.choose("lunch", "Once lunch is acknowledged")
    terminal.keys("Enter")
    terminal.see("ok, 10 actions")
    add(terminal, "go to some region", "home")
    terminal.keys("Enter")
    terminal.see("ok, 12 actions")
    terminal.keys("/")
    terminal.see("Go to which checkpoint?")
    terminal.choose("alerted", "> Program and plan")
    add(terminal, "go to some region", "home")
    terminal.choose("only once", "Once what has happened?")
    terminal.choose("some message has been dismissed", "which message")
    terminal.choose("lunch", "Once lunch is dismissed")
    terminal.keys("Enter")
    terminal.see("ok, 14 actions")
    terminal.keys("r")
    terminal.see("text: cancelled")
    terminal.keys("C-u")
    terminal.type("not now")
    terminal.see("not now: go home")
    assert goals(file)["not now"] == ["(robot-at home)"]
    assert sorted(conditions(file)) == [
        [],
        [],
        ["(acknowledged lunchtime)"],
        ["(dismissed lunchtime)"],
    ]

    # Branch by branch.
    terminal.keys("F4")
    terminal.see("> Plan, step by step", "Step 8 of 8, checkpoint not now")
    terminal.keys("Home")
    terminal.see("Step 1 of", "Why: I go to the hall")
    terminal.keys("Right", "Right", "Right", "Right")
    terminal.see("Step 5 of", "way 2 of 2: once lunch is dismissed")
    terminal.keys("Down")
    terminal.see("Step 5 of 16, way 1 of 2: once lunch is acknowledged", "Lunch has been")
    terminal.keys("F3")
    terminal.see("Map, after step 5")

    # Run.
    terminal.keys("F5")
    terminal.see("Shall I start?", "yes, start", "bring")
    terminal.keys("Enter")
    terminal.see("running")
    terminal.keys(":")
    terminal.see("Actions")
    terminal.choose("watch", "Expected")
    terminal.see("I wait. Say what has happened", seconds=3 * LIMIT_S)
    terminal.keys("C-t")
    terminal.see("What has happened?")
    terminal.choose("dismissed", "The run is over: done.")

    # Review.
    terminal.keys("Tab")
    terminal.keys("l")
    terminal.see("Which log?")
    terminal.choose("1", "> Log ")
    terminal.keys("End")
    terminal.see("The run is done.")
    terminal.keys("c")
    terminal.see("What led to event", "I go home")
    terminal.keys("/")
    terminal.see("Only events with these words")
    terminal.type("topic=transition")
    terminal.see("only: topic=transition", "Lunch is dismissed: on to not now.")
    terminal.keys("C-q")
    terminal.see("code 0")
