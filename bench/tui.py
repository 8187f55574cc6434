"""The terminal application over a pseudo-terminal: first paint, and bytes for what a user does."""

from __future__ import annotations

import contextlib
import fcntl
import json
import os
import pty
import select
import signal
import struct
import subprocess
import sys
import tempfile
import termios
import time
from collections.abc import Iterator
from pathlib import Path

from bench.table import Row

LIMIT_S = 20.0
QUIET_S = 0.15
"""When nothing has come for so long, an answer is complete."""
STARTS = 5
SENTENCES = (
    "tell the resident that lunch is ready",
    "once she acknowledges, bring a full tray to her table and then go home",
    "if she dismisses it, just go home",
    "put the cup on the desk",
    "open the fridge",
)
KEYS = "wait until"
KEYS_ALONE = "QXZ@~^`{}|"
"""Keys that are in nothing else that the terminal is sent."""
UP = b"\x1b[A"
LEFT = b"\x1b[D"


def _homes(folder: Path) -> dict[str, str]:
    """Neither settings nor programs of the user's are touched."""
    return {"XDG_STATE_HOME": str(folder), "XDG_CONFIG_HOME": str(folder)}


class Terminal:
    """The application in a pseudo-terminal that only counts what it is sent."""

    def __init__(self, folder: Path, columns: int = 80, rows: int = 24) -> None:
        self._master, slave = pty.openpty()
        fcntl.ioctl(slave, termios.TIOCSWINSZ, struct.pack("HHHH", rows, columns, 0, 0))
        program = folder / "program.polaris.json"
        arguments = ["tui", str(program), "--world", "care-home"]
        self.started = time.perf_counter()
        self._process = subprocess.Popen(
            [sys.executable, "-m", "polaris_nl.cli", *arguments],
            stdin=slave, stdout=slave, stderr=slave, start_new_session=True,
            env={**os.environ, "TERM": "xterm-256color", **_homes(folder)},
        )  # fmt: skip
        os.close(slave)

    def send(self, keys: bytes) -> None:
        os.write(self._master, keys)

    def read(self, quiet_s: float = QUIET_S) -> bytes:
        """All that comes until nothing more does."""
        found = b""
        while select.select([self._master], [], [], quiet_s)[0]:
            try:
                found += os.read(self._master, 65536)
            except OSError:  # the other end is closed
                break
        return found

    def read_until(self, wanted: bytes) -> bytes:
        """All that comes up to some text, which must come."""
        found, deadline = b"", time.perf_counter() + LIMIT_S
        while wanted not in found:
            if time.perf_counter() > deadline:
                raise TimeoutError(f"{wanted!r} did not come: {found[-2000:]!r}")
            if select.select([self._master], [], [], 0.1)[0]:
                found += os.read(self._master, 65536)
        return found

    def settle(self, wanted: bytes) -> int:
        """The bytes that come up to some text and after it."""
        return len(self.read_until(wanted)) + len(self.read())

    def close(self) -> None:
        with contextlib.suppress(OSError):
            self.send(b"\x11")
            self.read()
        with contextlib.suppress(subprocess.TimeoutExpired):
            self._process.wait(5)
        if self._process.poll() is None:
            os.killpg(self._process.pid, signal.SIGKILL)
            self._process.wait()
        os.close(self._master)

    def __enter__(self) -> Terminal:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def rows() -> Iterator[Row]:
    """The rows about the terminal application."""
    with tempfile.TemporaryDirectory() as folder:
        yield Row(
            "polaris-nl tui, first paint", "<= 800", [_paint(Path(folder)) for _ in range(STARTS)]
        )
        with Terminal(Path(folder)) as terminal:
            start = terminal.settle(b"empty program")
            yield Row("bytes: start", "", [start], unit="B")
            yield Row("bytes: a key in the input line", "<= 1024", list(keys(terminal)), unit="B")
            yield Row("bytes: an updated plan", "<= 6144", list(plans(terminal)), unit="B")
            yield Row("bytes: moving in the program", "<= 512", list(moves(terminal)), unit="B")
            yield Row("bytes: a step of the plan", "", list(steps(terminal)), unit="B")
    with tempfile.TemporaryDirectory() as folder:
        found = list(echoes(Path(folder)))
        yield Row("echo of a key while 500 checkpoints are planned", "<= 50", found)


def echoes(folder: Path, checkpoints: int = 500) -> Iterator[float]:
    """Milliseconds from a key to its echo, 50 keys a second, while a long program is being compiled."""
    places = ("hall", "kitchen", "office", "laundry", "cafeteria", "room-1", "room-2", "home")
    value = {
        "schema": "polaris-program/1",
        "domain": "caregiving",
        "world": "care-home",
        "checkpoints": [
            {"id": f"c{n}", "name": f"step {n}" if n else "start", "goals": _goals(n, places)}
            for n in range(checkpoints + 1)
        ],
        "transitions": [
            {"id": f"t{n}", "from": f"c{n - 1}", "to": f"c{n}", "when": []}
            for n in range(1, checkpoints + 1)
        ],
    }
    (folder / "program.polaris.json").write_text(json.dumps(value))
    with Terminal(folder) as terminal:
        terminal.read_until(b"planning")
        for number in range(100):
            if number and number % 50 == 0:
                terminal.send(b"\x15")
            key = KEYS_ALONE[number % len(KEYS_ALONE)].encode()
            sent = time.perf_counter()
            terminal.send(key)
            terminal.read_until(key)
            took = time.perf_counter() - sent
            yield took * 1000
            time.sleep(max(0.02 - took, 0))


def _goals(number: int, places: tuple[str, ...]) -> list[str]:
    """A different thing somewhere else at each step, so that little can be found again."""
    if number == 0:
        return []
    place = places[number % len(places)]
    return (
        [f"(robot-at {place})"]
        if number % 3
        else ["(open fridge)" if number % 2 else "(not (open fridge))"]
    )


def _paint(folder: Path) -> float:
    with Terminal(folder) as terminal:
        terminal.read_until(b"Program and plan")
        return (time.perf_counter() - terminal.started) * 1000


def keys(terminal: Terminal) -> Iterator[int]:
    """Bytes for each key typed; the line is empty again at the end."""
    for key in KEYS:
        terminal.send(key.encode())
        yield len(terminal.read())
    terminal.send(b"\x15")
    terminal.read()


def plans(terminal: Terminal) -> Iterator[int]:
    """Bytes from Enter to the new plan, for each sentence."""
    for sentence in SENTENCES:
        terminal.send(sentence.encode())
        terminal.read()
        terminal.send(b"\r")
        yield terminal.settle(b"The plan takes")


def moves(terminal: Terminal) -> Iterator[int]:
    """Bytes for each step of the cursor in the program, up from what was changed last."""
    terminal.send(b"\t")
    terminal.read()
    for _ in range(8):
        terminal.send(UP)
        yield _answered(terminal)


def steps(terminal: Terminal) -> Iterator[int]:
    """Bytes for each step of the plan, back from where the cursor was, with the map below it."""
    terminal.send(b"\x1bOS")
    terminal.read()
    for _ in range(8):
        terminal.send(LEFT)
        yield _answered(terminal)


def _answered(terminal: Terminal) -> int:
    """The bytes that a key brings; a key that changes nothing measures nothing."""
    found = len(terminal.read())
    if not found:
        raise RuntimeError("A key that was measured did nothing.")
    return found
