"""The real program at 80x24 over a real SSH line: by keys, by sentences, and when the line drops."""

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
    terminal.see("The program is done.")
    terminal.keys("c")
    terminal.see("What led to event", "I go home")
    terminal.keys("/")
    terminal.see("Only events with these words")
    terminal.type("topic=transition")
    terminal.see("only: topic=transition", "Lunch is dismissed: on to not now.")
    terminal.keys("C-q")
    terminal.see("code 0")


def test_the_tidying_program_by_sentences_alone(terminal: Tmux, sshd: Sshd, tmp_path: Path) -> None:
    file = tmp_path / "dishes.polaris.json"
    opened(terminal, sshd, file, "dinner-party")
    for sentence, seen in (
        ("Put the cup and the plate on the countertop.", "ok, "),
        ("Wait until both are on the drying rack.", "once the cup and the plate are on"),
        (
            "Open the cupboard, then put both dishes in the cupboard.",
            "put the plate in the cupboard",
        ),
    ):
        terminal.type(sentence)
        terminal.see(seen, "The plan takes")
    assert ["(at cup drying-rack)", "(at plate drying-rack)"] in conditions(file)
    terminal.type("show the steps")
    terminal.see("Plan, step by step", "Step 1 of")
    terminal.type(":last-step")
    terminal.see("Reached: ", "in the cupboard")
    terminal.type("run it")
    terminal.see("Shall I start? Say yes or no.")
    terminal.type("yes")
    terminal.see("running")
    terminal.see("I wait.", seconds=4 * LIMIT_S)
    terminal.type("the cup and the plate are on the drying rack")
    terminal.see("The run is over: ", seconds=6 * LIMIT_S)
    terminal.type(":log")
    terminal.see("Which log?")
    terminal.choose("1", "Log ")
    terminal.type(":chain")
    terminal.see("What led to event")
    terminal.type("quit")
    terminal.see("code 0")


def test_the_tidying_program_by_keys_alone(terminal: Tmux, sshd: Sshd, tmp_path: Path) -> None:
    file = tmp_path / "dishes.polaris.json"
    opened(terminal, sshd, file, "dinner-party")
    terminal.keys("Tab")
    terminal.see("> Program and plan")
    add(terminal, "bring some object to", "cup", "countertop")
    terminal.choose("another goal", "And what else?")
    terminal.choose("bring some object to", "which object")
    terminal.choose("plate", "which surface")
    terminal.choose("countertop", "add it")
    terminal.keys("Enter")
    terminal.see("the plate to the countertop", "ok, ")
    add(terminal, "open some container", "cupboard")
    terminal.choose("only once", "Once what has happened?")
    for dish in ("cup", "plate"):
        terminal.choose("some object is on", "which object")
        terminal.choose(dish, "which surface")
        terminal.choose("drying rack", "on the drying rack:")
        if dish == "cup":
            terminal.choose("only if something else", "Once what has happened?")
    terminal.keys("Enter")
    terminal.see("opened: open the cupboard", "ok, ")
    for dish in ("cup", "plate"):
        add(terminal, "put some object in", dish, "cupboard")
        terminal.keys("Enter")
        terminal.see(f"put the {dish} in the cupboard", "ok, ")
    assert ["(at cup drying-rack)", "(at plate drying-rack)"] in [
        sorted(x) for x in conditions(file)
    ]
    terminal.keys("p")
    terminal.see("> Plan, step by step")
    terminal.keys("End")
    terminal.see("Reached: ", "in the cupboard")
    terminal.keys("F5")
    terminal.see("Shall I start?")
    terminal.keys("Enter")
    terminal.see("> running", "Expected")
    terminal.keys("F9")
    terminal.see("The run is over: stopped.")
    terminal.keys("F10")
    terminal.see("Actions")
    terminal.choose("log:", "Which log?")
    terminal.choose("1", "> Log ")
    terminal.keys("End")
    terminal.see("You stopped the run.")
    terminal.keys("c")
    terminal.see("What led to event")
    terminal.keys("C-q")
    terminal.see("code 0")


def test_the_caregiving_program_by_sentences_alone(
    terminal: Tmux, sshd: Sshd, tmp_path: Path
) -> None:
    file = tmp_path / "lunch.polaris.json"
    opened(terminal, sshd, file, "care-home")
    for sentence, seen in (
        ("Tell the resident that lunch is ready.", "ok, 3 actions"),
        (
            "Once she acknowledges, bring a full tray to her table and then go home.",
            "ok, 12 actions",
        ),
        ("If she dismisses it, just go home.", "ok, 14 actions"),
    ):
        terminal.type(sentence)
        terminal.see(seen, "The plan takes")
    assert ["(acknowledged lunchtime)"] in conditions(file)
    assert ["(dismissed lunchtime)"] in conditions(file)
    terminal.type("show the steps")
    terminal.see("Plan, step by step")
    terminal.type(":first-step")
    terminal.see("Step 1 of")
    for _ in range(4):
        terminal.type(":next")
    terminal.see("Step 5 of 16, way 1 of 2: once lunch is acknowledged")
    terminal.type(":next-way")
    terminal.see("way 2 of 2: once lunch is dismissed")
    terminal.type("show the map")
    terminal.see("Map, after step 5")
    terminal.type("run it")
    terminal.see("Shall I start? Say yes or no.")
    terminal.type("yes")
    terminal.see("Map, now", "I wait until", seconds=4 * LIMIT_S)
    terminal.type("she dismisses it")
    # A simulated resident may have been quicker, and have acknowledged it.
    terminal.see(": on to ")
    terminal.type("stop")
    terminal.see("You stopped the run.")
    terminal.type(":log")
    terminal.see("Which log?")
    terminal.choose("1", "Log ")
    terminal.type(":filter")
    terminal.see("Only events with these words")
    terminal.type("topic=transition")
    terminal.see("only: topic=transition", ": on to ")
    terminal.type("quit")
    terminal.see("code 0")


def test_kill_loses_no_edit(terminal: Tmux, sshd: Sshd, tmp_path: Path) -> None:
    terminal.start(sshd.command("tui", "--world", "care-home"))
    terminal.see("empty program", "(no name)")
    for sentence, checkpoint in (("open the fridge", "opened"), ("go to the hall", "hall")):
        terminal.type(sentence)
        # An edit that is shown is kept; a sentence that is only echoed may still be read.
        terminal.see(f"> {sentence}", f"{checkpoint}: {sentence}", "The plan takes")
    (kept,) = (sshd.state / "polaris-nl" / "unsaved").glob("*.polaris.json")
    os.kill(int(re.findall(r"-(\d+)\.", kept.name)[0]), signal.SIGKILL)
    terminal.see("code ")
    again = Tmux(tmp_path, "again")
    try:
        again.start(sshd.command("tui", "--world", "care-home"))
        again.see("empty program", ":recover brings it back.")
        again.type(":recover")
        again.see("Which one?", "Open the fridge, then go to the hall.")
        again.keys("Enter")
        again.see("opened: open the fridge", "hall: go to the hall")
        again.type("quit")
        again.see("code 0")
    finally:
        again("kill-server")


def test_a_dropped_line_neither_stops_nor_orphans_a_run(
    terminal: Tmux, sshd: Sshd, tmp_path: Path
) -> None:
    file = tmp_path / "lunch.polaris.json"
    opened(terminal, sshd, file, "care-home")
    terminal.type("tell the resident that lunch is ready, and once she dismisses it, go home")
    terminal.see("The plan takes")
    terminal.type("run it")
    terminal.see("Shall I start?")
    terminal.type("yes")
    terminal.see("> running")
    (listens,) = (sshd.state / "polaris-nl" / "runs").glob("*.sock")
    runner = int(listens.stem)
    terminal("kill-server")  # The terminal, the ssh client and with them the line are gone.
    deadline = time.monotonic() + LIMIT_S
    while connected(sshd):
        assert time.monotonic() < deadline
        time.sleep(0.05)
    os.kill(runner, 0)
    again = Tmux(tmp_path, "again")
    try:
        again.start(sshd.command("tui", str(file), "--world", "care-home"))
        again.see("─ Run, begun in another terminal ─", "tell the resident")
        again.see("I wait.", "lunch is dismissed", seconds=2 * LIMIT_S)
        again.keys("F9")
        again.see("The run is over: stopped.", "polaris-nl review")
        again.keys("C-q")
        again.see("code 0")
    finally:
        again("kill-server")
    while Path(f"/proc/{runner}").exists():
        assert time.monotonic() < deadline + LIMIT_S
        time.sleep(0.05)
    assert not listens.exists()


def connected(sshd: Sshd) -> bool:
    """Whether a client is still connected."""
    children = Path(f"/proc/{sshd.process}/task/{sshd.process}/children").read_text().split()
    return bool(children)
