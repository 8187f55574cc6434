"""Logs gone through, runs seen from elsewhere, programs kept, and the line mode."""

from __future__ import annotations

import os
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from queue import SimpleQueue

import pytest
from textual.message import Message

from polaris_nl.automaton.automaton import Automaton
from polaris_nl.automaton.program import Program, program_json, write_program
from polaris_nl.execution.events import GoalSent, Halted, Heard, Planned, RunStarted
from polaris_nl.execution.state import HumanCommand
from polaris_nl.language.understanding import Understanding
from polaris_nl.logs.reader import read_log
from polaris_nl.logs.writer import LogWriter
from polaris_nl.model.errors import LogError, RunError
from polaris_nl.model.wording import PlainWording
from polaris_nl.model.world import World
from polaris_nl.planning.plan_json import plan_json
from polaris_nl.render.glyphs import ASCII
from polaris_nl.session import Session
from polaris_tui.keeping import keeping_path, leftovers, tidied
from polaris_tui.messages import Happened, RunOver
from polaris_tui.plain import Plain
from polaris_tui.progress import Progress, advanced
from polaris_tui.remote import RemoteRun, RunServer, _short, live_runs
from polaris_tui.replay import open_replay
from polaris_tui.scene import Scene
from polaris_tui.transcript import Entry
from tests.planning.conftest import program
from tests.tui.conftest import LIMIT_S, LUNCH, Play, Stage


def waited(come: Callable[[], bool]) -> None:
    deadline = time.monotonic() + LIMIT_S
    while not come():
        assert time.monotonic() < deadline
        time.sleep(0.01)


# Logs


def test_any_moment_is_what_the_events_before_it_make(log: Path, care_home: World) -> None:
    replay = open_replay(log, care_home)
    now = Progress(replay.world.initial)
    expected = [now]
    for event in replay.events:
        now = advanced(now, event, replay.plan)
        expected.append(now)
    numbers = [*range(0, len(replay.events) + 1, 7), len(replay.events), 3, 101, 100, 99]
    for number in numbers:
        assert replay.progress(number) == expected[number]
    assert replay.progress(len(replay.events)).outcome.startswith("done")
    assert replay.complete


def test_a_log_brings_its_world_program_and_plan(log: Path, care_home: World) -> None:
    replay = open_replay(log, care_home)
    assert replay.world.name == "care-home"
    assert [c.name for c in replay.automaton.checkpoints.values()][:2] == ["start", "alerted"]
    assert replay.plan.action_count == 14
    assert len(replay.shown("topic=goal-sent")) == 12
    assert replay.shown("no such words") == []
    assert replay.problem(0, 1) is None


def test_what_led_to_an_event(log: Path, care_home: World) -> None:
    replay = open_replay(log, care_home)
    (decided,) = [
        n for n, e in enumerate(replay.events, 1) if "Lunch is acknowledged: on to" in e.text
    ]
    texts = [replay.events[n - 1].text for n in replay.chain(decided)]
    assert texts[-1] == "Lunch is acknowledged: on to fetched."
    assert any(text.startswith("I wait until") for text in texts)
    assert any("acknowledge" in text and "simulated" in text for text in texts)
    last = replay.chain(len(replay.events))
    assert decided not in last  # another decision came after it
    assert last == sorted(last)


def test_a_log_says_what_the_program_came_from(play: Play, tmp_path: Path) -> None:
    async def script(stage: Stage) -> None:
        await stage.say(LUNCH)
        await stage.say("what will you do?")
        await stage.say("run it")
        await stage.say("yes")
        await stage.see("Objectives: 3 of 3")

    session = play(script)
    (path,) = (tmp_path / "logs").glob("*.mcap")
    replay = open_replay(path, session.world)
    events = [replay.events[n - 1] for n in replay.chain(len(replay.events))]
    assert [e.utterance for e in events if isinstance(e, Heard)] == [LUNCH, "yes"]
    assert [type(e) for e in replay.events].count(Planned) == 1

    async def reviewed(stage: Stage) -> None:
        stage.app.open_log(path)
        await stage.see("Typed: Tell the resident that lunch is ready.", "0.0 s   The run starts.")
        await stage.press("end", "c")
        await stage.see("What led to event", "Typed: yes")

    play(reviewed, size=(100, 60))


def halted(log: Path, folder: Path) -> Path:
    """The log, cut short by a halt."""
    made = read_log(log)
    path = folder / "halted.mcap"
    at = next(n for n, e in enumerate(made.events) if isinstance(e, GoalSent))
    goal = made.events[at]
    assert isinstance(goal, GoalSent)
    with LogWriter(path, made.attachments) as writer:
        for event in made.events[: at + 1]:
            writer.write(event)
        writer.write(
            Halted(
                time=goal.time + 9,
                text="I halt: the door is shut.",
                reason="The door is shut.",
                expected=[goal.literals[0]],
            )
        )
    return path


def test_a_problem_is_found_and_compared(
    play: Play, log: Path, tmp_path: Path, care_home: World
) -> None:
    path = halted(log, tmp_path)
    replay = open_replay(path, care_home)
    number = len(replay.events)
    assert replay.problem(0, 1) == number
    assert replay.problem(number, -1) is None
    found = replay.differences(number)
    assert found
    assert not all(holds for _, holds in found)

    async def script(stage: Stage) -> None:
        stage.app.open_log(path)
        await stage.see("Log halted.mcap", "event 2 of")
        await stage.press("n")
        await stage.see(f"event {number} of {number}", "I halt: the door is shut.")
        await stage.press("n")
        await stage.see("There is no problem after this event.")
        await stage.press("d")
        await stage.see("Expected", "Perceived", "✗ no")
        await stage.press("home")
        await stage.see("event 2 of")
        await stage.press("slash")
        await stage.until(lambda: stage.app.state.choosing.last is not None)
        await stage.press(*"topic=halt", "enter")
        await stage.see("only: topic=halt")
        await stage.press("slash", "ctrl+u", "asterisk", "enter")
        await stage.see("The run starts.")
        await stage.press("r")
        await stage.see('"r" means nothing here.')
        await stage.press("f3")
        await stage.see("Map, after event")
        await stage.press("f3", "escape", "escape")
        await stage.see("Program and plan")

    play(script, size=(120, 40))


def test_a_log_without_its_world_is_read_with_this_one(tmp_path: Path, care_home: World) -> None:
    path = tmp_path / "bare.mcap"
    with LogWriter(path) as writer:
        writer.write(RunStarted(time=1.0, robot="world", text="The run starts."))
    replay = open_replay(path, care_home)
    assert replay.world is care_home
    assert replay.automaton == Automaton()
    with LogWriter(tmp_path / "bad.mcap", {"program.polaris.json": "{"}) as writer:
        writer.write(RunStarted(time=1.0, robot="world"))
    with pytest.raises(LogError, match=r"The program in .*bad\.mcap can't be read"):
        open_replay(tmp_path / "bad.mcap", care_home)


# Runs of another terminal


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


# Programs without a name


def test_what_a_dead_session_left_is_found(tmp_path: Path) -> None:
    own = keeping_path("care-home", tmp_path)
    assert own is not None
    write_program(Program(program("open: (open fridge)"), "caregiving", "care-home"), own)
    assert leftovers("care-home", tmp_path) == []  # this process lives
    done = subprocess.run([sys.executable, "-c", "import os; print(os.getpid())"],
                          capture_output=True, text=True, timeout=LIMIT_S, check=True)  # fmt: skip
    left = own.rename(tmp_path / f"care-home-{int(done.stdout)}.polaris.json")
    assert [x.path for x in leftovers("care-home", tmp_path)] == [left]
    assert leftovers("dinner-party", tmp_path) == []
    assert tidied(left)
    write_program(Program(Automaton(), "caregiving", "care-home"), left)
    assert not tidied(left)
    assert not left.exists()
    (tmp_path / "file").write_text("")
    assert keeping_path("x", tmp_path / "file") is None
    (tmp_path / "broken-1x.polaris.json").write_text("{")
    assert leftovers("care-home", tmp_path) == []


# The line mode


Talk = Callable[[Iterable[str]], str]


@pytest.fixture
def talk(care_home: World, understanding: Understanding, tmp_path: Path) -> Iterator[Talk]:
    session = Session(care_home)
    session.__dict__["understanding"] = understanding

    def said(lines: Iterable[str]) -> str:
        shown: list[str] = []
        scene = Scene(
            care_home,
            "(no file)",
            session.snapshot,
            PlainWording(care_home),
            Progress(care_home.initial),
            ASCII,
        )
        plain = Plain(session, shown.append, scene, 100, live=False, logs=tmp_path / "logs")
        plain.work(_in_turn(lines, plain))
        return "\n".join(shown)

    yield said
    session.close()


def _in_turn(lines: Iterable[str], plain: Plain) -> Iterator[str]:
    """The lines; "..." waits for the end of the run."""
    for line in lines:
        if line == "...":
            assert plain._over.wait(LIMIT_S)
        else:
            yield line


def test_a_program_line_by_line(talk: Talk) -> None:
    text = talk(
        [
            *(":add", "open some", "fridge", "1"),
            *(":add", "go to some region", "hall", "2", "pick up", "plate", "1"),
            *(":pick", "opened", ":rename", "cold", ":why", ":program", ":map"),
            *(":undo", ":redo", ":history", "", ":mend", ":nonsense", ":theme"),
            *("go to the room", "2", ":actions", "quit", "never said"),
        ]
    )
    assert "Done: add opened. The plan takes 3 actions." in text
    assert "which container?" in text
    assert "opened is now cold" in text
    assert "You are at cold." in text
    assert "cold: open the fridge" in text
    assert "ROBOT" in text
    assert "Undone: opened is now cold." in text
    assert "you are here" in text
    assert "The plan has no problem that has a way out." in text
    assert "There is no action nonsense." in text
    assert "That is about the screen" in text
    assert "2. room 2" in text
    assert ":add add a checkpoint after this one" in text
    assert "never" not in text
    assert text.isascii()


def test_a_run_and_its_log_line_by_line(talk: Talk) -> None:
    text = talk(
        [
            *(LUNCH, ":plan", ":next", ":last-step", ":other-way", ":first-step", ":stop"),
            *("run it", "yes", "...", ":watch", ":log", "1", ":filter", "topic=transition"),
            *(":next-problem", ":compare", ":chain", ":program"),
        ]
    )
    assert "Step 1 of 16, action 1: go to the hall" in text
    assert "Step 16 of 16, checkpoint home" in text
    assert "way 2 of 2: once lunch is dismissed" in text
    assert "Nothing is running, so there is nothing to stop." in text
    assert "Shall I start? Say yes or no." in text
    assert "Reached alerted." in text
    assert "Objectives: 3 of 3" in text
    assert "Lunch is acknowledged: on to fetched." in text
    assert "There is no further problem." in text
    assert text.isascii()


def test_the_line_mode_of_the_command(tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-m", "polaris_nl.cli", "tui", "--plain", "--world", "care-home"],
        input="open the fridge\n:program\n",
        capture_output=True,
        text=True,
        timeout=3 * LIMIT_S,
        env={**os.environ, "XDG_STATE_HOME": str(tmp_path), "XDG_CONFIG_HOME": str(tmp_path)},
    )
    assert done.returncode == 0
    assert done.stderr == ""
    assert "Open the fridge. The plan takes 3 actions." in done.stdout
    assert "The program is kept. Go on with: polaris-nl tui " in done.stdout
    assert "\x1b" not in done.stdout
