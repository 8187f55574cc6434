"""Runs seen and commanded from another terminal."""

from __future__ import annotations

import socket
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from queue import SimpleQueue

import pytest
from textual.message import Message

from polaris_nl.automaton.program import Program, program_json
from polaris_nl.execution.events import GoalSent, Halted, RunStarted
from polaris_nl.execution.state import HumanCommand
from polaris_nl.model.errors import RunError
from polaris_nl.model.world import World
from polaris_nl.planning.plan_json import plan_json
from polaris_nl.session import Session
from polaris_tui.messages import Happened, RunOver
from polaris_tui.remote import RemoteRun, RunServer, _short, live_runs
from polaris_tui.transcript import Entry
from tests.planning.conftest import program
from tests.tui.conftest import LIMIT_S


def waited(come: Callable[[], bool]) -> None:
    deadline = time.monotonic() + LIMIT_S
    while not come():
        assert time.monotonic() < deadline
        time.sleep(0.01)


@pytest.fixture
def served(
    tmp_path: Path, care_home: World
) -> Iterator[tuple[RunServer, SimpleQueue[HumanCommand]]]:
    automaton = program("open: (open fridge)")
    with Session(care_home, automaton) as session:
        plan = session.wait().plan
        assert plan is not None
        hello = {
            "world": care_home.name,
            "program": program_json(Program(automaton, "caregiving", care_home.name)),
            "plan": plan_json(plan, automaton),
        }
    commands: SimpleQueue[HumanCommand] = SimpleQueue()
    deep = tmp_path / ("long" * 30)
    server = RunServer(hello, commands.put, deep)
    yield server, commands
    server.close()


def test_a_run_is_seen_and_commanded_from_elsewhere(
    served: tuple[RunServer, SimpleQueue[HumanCommand]],
) -> None:
    server, commands = served
    started = RunStarted(time=1.0, robot="world", beliefs=["(robot-at home)"])
    server.tell(Happened(started))
    told: list[Message] = []
    run = RemoteRun(server._path, told.append)
    assert run.world == "care-home"
    assert run.plan.action_count == 3
    run.start()
    waited(lambda: len(told) == 1)
    server.tell(Happened(GoalSent(time=2.0, goal=1, action="(x)", literals=[], checkpoint="c1")))
    waited(lambda: len(told) == 2)
    assert isinstance(told[0], Happened)
    assert told[0].event == started
    (when,) = program("x [(open fridge)]: ").transitions["t1"].when
    run.command(HumanCommand("happened", (when,)))
    run.command(HumanCommand("stop"))
    assert commands.get(timeout=LIMIT_S).literals == (when,)
    assert commands.get(timeout=LIMIT_S).kind == "stop"
    run._socket.sendall(b'nonsense\n{"command": "explode"}\n{"command": "pause"}\n')
    assert commands.get(timeout=LIMIT_S).kind == "pause"
    server.tell(RunOver(Entry("It is over.")))
    run.wait(LIMIT_S)
    assert isinstance(told[-1], RunOver)
    assert told[-1].entries == (Entry("It is over."),)
    assert not server._path.exists()
    run.leave()
    with pytest.raises(RunError, match="can't be reached"):
        RemoteRun(server._path, told.append)


def test_a_terminal_that_does_not_read_holds_nothing_up(
    served: tuple[RunServer, SimpleQueue[HumanCommand]],
) -> None:
    server, commands = served
    deaf = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
    told: list[Message] = []
    with deaf:
        with _short(server._path) as name:
            deaf.connect(name)
        reader = RemoteRun(server._path, told.append)
        reader.start()
        waited(lambda: len(server._clients) == 2)
        event = Happened(Halted(time=1.0, text="x" * 100_000, reason="x", expected=[]))
        began = time.monotonic()
        for _ in range(100):  # 20 MB: more than any socket takes
            server.tell(event)
        assert time.monotonic() - began < 5.0
        waited(lambda: len(told) == 100)
        deaf.sendall(b'{"command": "stop"}\n')
        assert commands.get(timeout=LIMIT_S).kind == "stop"
        server.tell(RunOver(Entry("It is over.")))
        reader.wait(LIMIT_S)
        assert isinstance(told[-1], RunOver)
        waited(lambda: not server._clients)
        reader.leave()


def test_runs_that_are_gone_are_forgotten(
    served: tuple[RunServer, SimpleQueue[HumanCommand]], tmp_path: Path
) -> None:
    server, _ = served
    folder = server._path.parent
    assert live_runs(folder) == []  # this process's own
    other = folder / "1.sock"
    server._path.rename(other)
    server._path = other
    assert live_runs(folder) == [other]
    gone = folder / "2.sock"
    with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as dead, _short(gone) as name:
        dead.bind(name)
    assert gone.exists()
    assert live_runs(folder) == [other]
    assert not gone.exists()
