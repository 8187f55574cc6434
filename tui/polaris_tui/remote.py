"""Runs seen and commanded from another terminal, through a socket that only the user can open.

A terminal may be gone before its run is over: a dropped line must neither stop the robot in the middle
of a room nor leave it without anybody who can. So the run goes on, and listens here.

Lines of JSON. To a terminal: `{"hello": ...}` with world, program and plan, then each event of the run
so far and to come, then `{"over": ...}`. From it: `{"command": "stop", "literals": []}`.
"""

from __future__ import annotations

import contextlib
import json
import os
import socket
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from textual.message import Message

from polaris_nl.automaton.program import program_of
from polaris_nl.execution.state import HumanCommand
from polaris_nl.logs.schema import event_json, event_of
from polaris_nl.model.errors import PolarisError, RunError
from polaris_nl.model.formula import Literal, parse_formula
from polaris_nl.planning.result import BranchingPlan
from polaris_nl.snapshot import Snapshot
from polaris_tui.keeping import state_folder
from polaris_tui.messages import Happened, RunOver
from polaris_tui.replay import plan_of
from polaris_tui.transcript import Entry

ATTACHED = (
    "This run was begun in another terminal. It can be stopped from here; quitting lets it go on."
)
Tell = Callable[[Message], object]
KINDS = ("stop", "pause", "resume", "happened")
LONGEST_PATH = 100
"""Bytes of a socket's path that every system takes."""
LAST_WORDS_S = 1.0
"""How long terminals are given to read how a run has ended."""


def runs_folder() -> Path:
    """Where runs listen."""
    return state_folder() / "runs"


@contextlib.contextmanager
def _short(path: Path) -> Iterator[str]:
    """A path that is short enough for a socket."""
    if len(os.fsencode(path)) <= LONGEST_PATH:
        yield str(path)
        return
    folder = os.open(path.parent, os.O_RDONLY)
    try:
        yield f"/proc/self/fd/{folder}/{path.name}"
    finally:
        os.close(folder)


class RunServer:
    """Lets other terminals see and command a run.

    Args:
        hello: what the run is about: world, program and plan as JSON values.
        command: is given what they command; called in threads of this server.
        folder: where to listen.
    """

    def __init__(
        self, hello: dict[str, Any], command: Callable[[HumanCommand], None], folder: Path
    ) -> None:
        self._command = command
        self._lines = [_line({"hello": hello})]
        self._over = False
        self._clients: dict[socket.socket, threading.Thread] = {}
        self._changed = threading.Condition()
        self._path = folder / f"{os.getpid()}.sock"
        self._socket = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        folder.mkdir(parents=True, exist_ok=True, mode=0o700)
        self._path.unlink(missing_ok=True)
        with _short(self._path) as name:
            self._socket.bind(name)
        self._path.chmod(0o600)
        self._socket.listen()
        threading.Thread(target=self._accept, name="run-server", daemon=True).start()

    def tell(self, message: Message) -> None:
        """Passes a message of the run on, and waits for nobody; after its end nobody is heard any more."""
        if isinstance(message, Happened):
            event = message.event
            self._send(_line({"topic": event.topic, "event": event_json(event)}))
        elif isinstance(message, RunOver):
            self._send(_line({"over": [[e.text, e.lead, e.tone] for e in message.entries]}))
            self.close()

    def close(self) -> None:
        """Ends it; terminals that still read are given the rest for a while."""
        self._path.unlink(missing_ok=True)
        with self._changed:
            self._over = True
            self._changed.notify_all()
            clients = dict(self._clients)
        _end(self._socket)
        deadline = time.monotonic() + LAST_WORDS_S
        for thread in clients.values():
            thread.join(max(deadline - time.monotonic(), 0.0))
        for client in clients:
            _end(client)

    def _send(self, line: bytes) -> None:
        with self._changed:
            self._lines.append(line)
            self._changed.notify_all()

    def _accept(self) -> None:
        while True:
            try:
                client, _ = self._socket.accept()
            except OSError:
                return
            writer = threading.Thread(target=self._write, args=(client,), daemon=True)
            with self._changed:
                self._clients[client] = writer
            writer.start()
            threading.Thread(target=self._listen, args=(client,), daemon=True).start()

    def _write(self, client: socket.socket) -> None:
        """Gives a terminal all that has happened and happens; one that doesn't read holds only this up."""
        told, over = 0, False
        with contextlib.suppress(OSError):
            while not over:
                with self._changed:
                    while len(self._lines) == told and not self._over:
                        self._changed.wait()
                    news, over = b"".join(self._lines[told:]), self._over
                    told = len(self._lines)
                client.sendall(news)
        with self._changed:
            self._clients.pop(client, None)
        _end(client)

    def _listen(self, client: socket.socket) -> None:
        with contextlib.suppress(OSError, ValueError), client.makefile("rb") as lines:
            for line in lines:
                command = _command(line)
                if command is not None:
                    self._command(command)


class RemoteRun:
    """A run of another terminal; looks like one of this one.

    Args:
        path: where it listens.
        tell: is given messages, in a thread of its own.

    Raises:
        RunError: it can't be reached, or doesn't say what it is about.
    """

    ours = False

    def __init__(self, path: Path, tell: Tell) -> None:
        self._tell = tell
        self._socket = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        self._lines = self._socket.makefile("rb")
        try:
            with _short(path) as name:
                self._socket.connect(name)
            hello = json.loads(self._lines.readline())["hello"]
            automaton = program_of(hello["program"]).automaton
            self.world: str = hello["world"]
            self.robot: str = hello.get("robot", "")
            self.plan: BranchingPlan = plan_of(hello["plan"], automaton)
        except (OSError, ValueError, KeyError, PolarisError) as error:
            self._close()
            raise RunError(f"The run that goes on elsewhere can't be reached ({error}).") from error
        self.snapshot = Snapshot(0, automaton, self.plan, "planned")
        self._thread = threading.Thread(target=self._read, name="remote-run", daemon=True)

    def start(self) -> None:
        """Begins to tell what happens, from the run's beginning."""
        self._thread.start()

    @property
    def active(self) -> bool:
        """Whether it goes on, as far as is known."""
        return self._thread.is_alive()

    def command(self, command: HumanCommand) -> None:
        """Commands the run."""
        literals = [str(x) for x in command.literals]
        with contextlib.suppress(OSError):
            self._socket.sendall(_line({"command": command.kind, "literals": literals}))

    def leave(self) -> None:
        """Looks no longer; the run goes on."""
        _end(self._socket)
        if self._thread.ident is None:
            self._close()

    def _close(self) -> None:
        """Lets the socket go; where the thread reads, that does."""
        self._socket.close()
        self._lines.close()

    def wait(self, seconds: float | None) -> None:
        """Waits for its end."""
        self._thread.join(seconds)

    def end(self) -> None:
        """Looks no longer."""
        self.leave()
        self.wait(LAST_WORDS_S)

    def _read(self) -> None:
        entries = [Entry("The run's own program has ended; its log may tell more.", "! ", "bad")]
        with contextlib.suppress(OSError, ValueError), self._socket, self._lines:
            for line in self._lines:
                value = json.loads(line)
                if "over" in value:
                    entries = [Entry(text, lead, tone) for text, lead, tone in value["over"]]
                    break
                event = event_of(value["topic"], value["event"])
                if event is not None:
                    self._tell(Happened(event))
        self._tell(RunOver(*entries))


def _end(part: socket.socket) -> None:
    """Closes a socket, also where another thread waits for it."""
    with contextlib.suppress(OSError):
        part.shutdown(socket.SHUT_RDWR)
    part.close()


def live_runs(folder: Path | None = None) -> list[Path]:
    """Where runs of other terminals listen; what is left of runs that are gone is removed."""
    found = []
    for path in sorted((folder or runs_folder()).glob("*.sock")):
        if path.name == f"{os.getpid()}.sock":
            continue
        with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as probe:
            try:
                with _short(path) as name:
                    probe.connect(name)
            except ConnectionRefusedError:
                path.unlink(missing_ok=True)
            except OSError:
                continue
            else:
                found.append(path)
    return found


def _line(value: dict[str, Any]) -> bytes:
    return json.dumps(value, ensure_ascii=True).encode() + b"\n"


def _command(line: bytes) -> HumanCommand | None:
    try:
        value = json.loads(line)
        kind, texts = value["command"], value.get("literals", [])
        facts = [x for text in texts if isinstance(x := parse_formula(text), Literal)]
    except (ValueError, KeyError, TypeError, AttributeError, PolarisError):
        return None
    return HumanCommand(kind, tuple(facts), "another terminal") if kind in KINDS else None
