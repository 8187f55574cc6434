"""Start-up of the command and what a log costs."""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

from bench.table import Row, timed
from polaris_nl.execution.events import Observed
from polaris_nl.logs.writer import LogWriter

EVENTS = 2_000


def rows() -> Iterator[Row]:
    """The rows about the command line and logs."""
    yield Row(
        "polaris-nl --help",
        "<= 250",
        timed(lambda: _run("-m", "polaris_nl.cli", "--help"), 10),
        timed(lambda: _run("-c", "import argparse"), 10),
        "import argparse",
    )
    with tempfile.TemporaryDirectory() as folder:
        ours = [_log(Path(folder) / f"{n}.mcap") for n in range(5)]
        plain = [_lines(Path(folder) / f"{n}.jsonl") for n in range(5)]
    yield Row("an event into the log, flushed", "", ours, plain, "a line of JSON, flushed", "us")


def _run(*arguments: str) -> None:
    subprocess.run([sys.executable, *arguments], check=True, capture_output=True)


def _event(number: int) -> Observed:
    return Observed(
        time=float(number), added=["(at cup desk)"], removed=["(holding cup)"], source="world"
    )


def _log(path: Path) -> float:
    with LogWriter(path) as log:
        total = timed(lambda: [log.write(_event(n)) for n in range(EVENTS)], 1)[0]
    return total * 1000 / EVENTS


def _lines(path: Path) -> float:
    with path.open("w", encoding="utf-8") as file:

        def write() -> None:
            for number in range(EVENTS):
                event = _event(number)
                file.write(
                    json.dumps({"time": event.time, "added": event.added, "removed": event.removed})
                    + "\n"
                )
                file.flush()

        return timed(write, 1)[0] * 1000 / EVENTS
