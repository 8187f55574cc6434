"""kill -9 during a run: everything that was written is there, for us and for an independent reader."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

from rosbags.highlevel import AnyReader

from polaris_nl.execution.events import GoalConfirmed, Heard, RunEnded
from polaris_nl.logs.chain import origin
from polaris_nl.logs.reader import read_log
from tests.cli.conftest import ROOT, Command
from tests.replayed_logs import differences

SHOWN = 6


def test_killing_a_run_loses_no_event_that_was_written(
    command: Command, lunch: Path, tmp_path: Path
) -> None:
    log = tmp_path / "killed.mcap"
    child = subprocess.Popen(
        [
            sys.executable,
            "-u",
            "-m",
            "polaris_nl.cli",
            "run",
            str(lunch),
            "--live",
            "--log",
            str(log),
        ],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        cwd=ROOT,
        text=True,
        env={**os.environ, "PYTHONPATH": str(ROOT), "COLUMNS": "100"},
    )
    assert child.stdout is not None
    shown = [child.stdout.readline().strip() for _ in range(SHOWN)]
    child.send_signal(signal.SIGKILL)
    child.communicate()
    read = read_log(log)
    assert not read.complete
    texts = [event.text for event in read.events]
    for line in shown:
        assert any(line.endswith(text) for text in texts if text), line
    assert differences(log) == [], "a replay of what there is decides the same"
    assert command("review", log).code == 1
    assert command("review", log, "--recover").code == 0
    mended = log.with_name("killed.recovered.mcap")
    assert [e.text for e in read_log(mended).events] == texts
    with AnyReader([mended]) as reader:
        messages = [reader.deserialize(raw, c.msgtype).msg for c, _, raw in reader.messages(
            connections=[c for c in reader.connections if c.topic == "/rosout"]
        )]  # fmt: skip
    assert messages == [text for text in texts if text]
    # The run goes on from the very file that the dead process has left.
    rest = tmp_path / "rest.mcap"
    result = command("run", lunch, "--resume", log, "--log", rest)
    assert result.code == 0, result.err
    assert "The run goes on where it was interrupted: " in result.out
    done = [
        e.action for x in (log, rest) for e in read_log(x).events if isinstance(e, GoalConfirmed)
    ]
    plain = tmp_path / "plain.mcap"
    assert command("run", lunch, "--log", plain).code == 0
    assert done == [e.action for e in read_log(plain).events if isinstance(e, GoalConfirmed)]
    again = command("run", lunch, "--resume", rest)
    assert (again.code, again.err) == (
        1,
        "polaris-nl: The run in this log is done, so nothing is left to go on with.\n",
    )


def test_an_independent_reader_opens_a_run(command: Command, lunch: Path, tmp_path: Path) -> None:
    log = tmp_path / "run.mcap"
    assert command("run", lunch, "--log", log).code == 0
    with AnyReader([log]) as reader:
        topics = {c.topic for c in reader.connections}
        said = [
            reader.deserialize(raw, c.msgtype).msg
            for c, _, raw in reader.messages(
                connections=[c for c in reader.connections if c.topic == "/rosout"]
            )
        ]
    assert "/rosout" in topics
    assert said[0] == "The run starts."
    assert said[-1] == "The program is done."


def test_stop_typed_during_a_run_ends_it(lunch: Path, tmp_path: Path) -> None:
    log = tmp_path / "stopped.mcap"
    child = subprocess.Popen(
        [
            sys.executable,
            "-u",
            "-m",
            "polaris_nl.cli",
            "run",
            str(lunch),
            "--live",
            "--log",
            str(log),
        ],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        cwd=ROOT,
        text=True,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
    )
    assert child.stdout is not None
    assert child.stdin is not None
    child.stdout.readline()
    child.stdin.write("stop\n")
    child.stdin.flush()
    out, _ = child.communicate(timeout=60)
    assert child.returncode == 1
    assert "You stopped the run." in out
    read = read_log(log)
    assert read.complete
    ended = next(e for e in read.events if isinstance(e, RunEnded))
    words = [e.utterance for e in origin(read.events, ended.id) if isinstance(e, Heard)]
    assert words == ["stop"]
    assert differences(log) == []
