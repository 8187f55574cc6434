"""The line mode: the same sentences, actions and menus, one line at a time."""

from __future__ import annotations

import errno
import fcntl
import io
import json
import os
import pty
import select
import subprocess
import sys
import termios
import time
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path

import pytest
from textual.message import Message

from polaris_nl.automaton.program import Program, write_program
from polaris_nl.execution.state import HumanCommand
from polaris_nl.language.understanding import Understanding
from polaris_nl.model.wording import PlainWording
from polaris_nl.model.world import World
from polaris_nl.render.glyphs import ASCII
from polaris_nl.session import Session
from polaris_tui import authoring
from polaris_tui.actions import BY_ID
from polaris_tui.keeping import Leftover
from polaris_tui.lines import Places
from polaris_tui.messages import Happened, RunOver
from polaris_tui.plain import NOT_HERE, ON_SCREEN, Plain
from polaris_tui.progress import Progress
from polaris_tui.reasons import Situation
from polaris_tui.remote import RemoteRun
from polaris_tui.running import Running
from polaris_tui.scene import Scene
from polaris_tui.serving import served
from polaris_tui.start import printed
from tests.planning.conftest import program
from tests.tui.conftest import LIMIT_S, LUNCH

Talk = Callable[[Iterable[str]], str]


@pytest.fixture
def talk(care_home: World, understanding: Understanding, tmp_path: Path) -> Iterator[Talk]:
    session = Session(care_home)
    session.__dict__["understanding"] = understanding

    def said(lines: Iterable[str]) -> str:
        shown: list[str] = []
        plain = Plain(
            session, shown.append, _scene(session), 100, live=False, logs=tmp_path / "logs"
        )
        plain.work(_in_turn(lines, plain))
        return "\n".join(shown)

    yield said
    session.close()


def _scene(session: Session) -> Scene:
    world = session.world
    state = Progress(world.initial)
    return Scene(world, "(no file)", session.snapshot, PlainWording(world), state, ASCII)


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


# The list of actions and the line mode


def test_every_action_is_done_here_or_is_about_the_screen(care_home: World) -> None:
    with Session(care_home) as session:
        plain = Plain(session, print, _scene(session), 100)
        done = {*plain._do, *authoring.steps(plain._desk())}
        assert done | ON_SCREEN == set(BY_ID)
        assert done & ON_SCREEN == set()


def test_what_is_about_the_screen_says_so(talk: Talk) -> None:
    for id in sorted(ON_SCREEN):
        text = talk([f":{id}"])
        reason = BY_ID[id].reason(Situation())
        assert (reason or NOT_HERE) in " ".join(text.split())


def test_every_action_can_be_asked_for_and_none_breaks(talk: Talk) -> None:
    """On a program, in a plan and in a log: each does something or says why not; menus are left."""
    ids = [id for id in BY_ID if id not in ("quit", "editor")]
    for before in (["open the fridge"], ["open the fridge", ":plan"]):
        text = talk([*before, *(line for id in ids for line in (f":{id}", "", "", ""))])
        assert "Traceback" not in text
        assert "Left as it was." in text


def test_a_program_is_kept_under_another_name(talk: Talk, tmp_path: Path) -> None:
    file = tmp_path / "mine.polaris.json"
    text = talk(["open the fridge", ":save-as", str(file), "go to the hall", "undo"])
    assert "Kept in mine.polaris.json from now on." in text
    assert [c["name"] for c in json.loads(file.read_text())["checkpoints"]] == ["start", "opened"]
    other = tmp_path / "other.polaris.json"
    write_program(Program(program("hall: (robot-at hall)"), "caregiving", "care-home"), other)
    assert "There is another program in" in talk([":save-as", str(other)])
    assert "hall" in other.read_text()


def test_the_program_goes_through_an_editor(
    talk: Talk, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    script = tmp_path / "edit"
    script.write_text('#!/bin/sh\nsed -i s/opened/cold/ "$1"\n')
    script.chmod(0o700)
    monkeypatch.setenv("VISUAL", str(script))
    text = talk(["open the fridge", ":editor", ":program", ":editor"])
    assert "cold: open the fridge" in text
    assert "Nothing was changed." in text
    monkeypatch.setenv("VISUAL", str(tmp_path / "none"))
    assert "The program stays as it was." in talk([":editor"])
    monkeypatch.delenv("VISUAL")
    monkeypatch.delenv("EDITOR", raising=False)
    assert "There is no editor: set the environment variable EDITOR" in talk([":editor"])


def test_what_an_earlier_session_left_comes_back(care_home: World, tmp_path: Path) -> None:
    left = tmp_path / "care-home-1.polaris.json"
    kept = Program(program("open: (open fridge)"), "caregiving", "care-home")
    write_program(kept, left)
    shown: list[str] = []
    with Session(care_home) as session:
        places = Places((Leftover(left, kept),))
        plain = Plain(session, shown.append, _scene(session), 100, places=places)
        plain.work([":recover", "1", ":undo", ":redo"])
        assert session.snapshot.automaton == kept.automaton
    assert " 1. Open the fridge.  (care-home-1.polaris.json)" in shown


def test_a_run_of_another_terminal_is_told_and_stopped(care_home: World, tmp_path: Path) -> None:
    shown: list[str] = []
    with Session(care_home, program("open: (open fridge)")) as session:
        snapshot = session.wait()
        assert snapshot.plan is not None
        run = Running(
            session, snapshot, snapshot.plan, lambda message: None, log=tmp_path / "r.mcap"
        )
        run.tell, trouble = served(run, session, tmp_path / "runs", lambda message: None)
        assert trouble == ""
        (listens,) = (tmp_path / "runs").glob("*.sock")
        run.start()
        plain = Plain(session, shown.append, _scene(session), 100, places=Places((), (listens,)))
        plain.work(_in_turn([":attach", "stop", "...", ":attach"], plain))
        run.wait(LIMIT_S)
    text = " ".join(shown)
    assert "This run was begun in another terminal." in text
    assert "You stopped the run." in text
    assert "No run goes on in another terminal." in text
    assert not listens.exists()


def test_a_line_that_hangs_up_lets_the_run_go_on(tmp_path: Path) -> None:
    """The terminal of the line mode goes away in a run; the run can be seen and stopped from another."""
    homes = {"XDG_STATE_HOME": str(tmp_path), "XDG_CONFIG_HOME": str(tmp_path)}
    settings = tmp_path / "polaris-nl" / "tui.toml"
    settings.parent.mkdir()
    settings.write_text(f'logs = "{tmp_path}"\n')
    master, slave = pty.openpty()
    process = subprocess.Popen(
        [sys.executable, "-m", "polaris_nl.cli", "tui", "--plain", "--world", "care-home"],
        stdin=slave, stdout=slave, stderr=slave, env={**os.environ, **homes}, preexec_fn=_own_terminal,
    )  # fmt: skip
    os.close(slave)
    told: list[Message] = []
    try:
        for line, answer in (
            (
                "tell the resident that lunch is ready, and once she dismisses it, go home",
                "plan takes",
            ),
            ("run it", "Say yes or no"),
            ("yes", "The run starts."),
        ):
            os.write(master, f"{line}\n".encode())
            _read_until(master, answer)
        os.close(master)
        (listens,) = (tmp_path / "polaris-nl" / "runs").glob("*.sock")
        run = RemoteRun(listens, told.append)
        run.start()
        assert process.poll() is None
        run.command(HumanCommand("stop"))
        run.wait(LIMIT_S)
        run.leave()
        assert process.wait(LIMIT_S) == 0
    finally:
        process.kill()
        process.wait()
    assert isinstance(told[-1], RunOver)
    assert any(
        e.text == "You stopped the run." for m in told if isinstance(m, Happened) for e in [m.event]
    )


def test_a_terminal_that_is_gone_breaks_nothing_before_its_signal_comes(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    class Gone(io.StringIO):
        def write(self, text: str, /) -> int:
            raise OSError(errno.EIO, "Input/output error")

    monkeypatch.setattr("sys.stdout", Gone())
    printed("I wait.")


def _own_terminal() -> None:
    os.setsid()
    fcntl.ioctl(0, termios.TIOCSCTTY, 0)


def _read_until(terminal: int, text: str) -> None:
    found, deadline = "", time.monotonic() + LIMIT_S
    while text not in " ".join(found.split()):
        assert time.monotonic() < deadline, found
        if select.select([terminal], [], [], 0.1)[0]:
            found += os.read(terminal, 65536).decode(errors="replace")
