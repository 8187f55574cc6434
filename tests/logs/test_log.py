"""Logs: written, read by others, cut off and recovered."""

from __future__ import annotations

import json
import os
import random
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from jsonschema import Draft202012Validator
from mcap.reader import make_reader
from rosbags.highlevel import AnyReader

from polaris_nl.execution.events import (
    EVENTS,
    CheckpointReached,
    Event,
    GoalSent,
    Halted,
    RunEnded,
    RunStarted,
)
from polaris_nl.logs.reader import read_log
from polaris_nl.logs.recovery import recover
from polaris_nl.logs.review import matcher, next_problem, story, summary
from polaris_nl.logs.schema import event_json, event_of, schema_of
from polaris_nl.logs.writer import LogWriter, RawKind, attachments_of
from polaris_nl.model.errors import LogError

EXAMPLE: list[Event] = [
    RunStarted(time=100.0, text="The run starts.", robot="world", program={"schema": "x"}),
    GoalSent(
        time=101.0,
        text="I go home.",
        goal=1,
        action="(move hall home)",
        literals=["(robot-at home)"],
        checkpoint="c1",
    ),
    CheckpointReached(time=104.0, text="Home is reached.", checkpoint="c1", name="home"),
    Halted(
        time=105.5,
        text="I halt: ünïcode \U0001f600 and \x07 control",
        reason="so",
        expected=["(a)"],
    ),
    RunEnded(time=106.0, text="Over.", outcome="halted", reason="so", checkpoints=["home"]),
]


def write(path: Path, events: list[Event]) -> Path:
    with LogWriter(path, attachments_of({"a": 1}, "(define)", "name: x")) as log:
        for event in events:
            assert log.write(event)
    assert log.failure == ""
    return path


def test_a_log_is_read_back_as_it_was_written(tmp_path: Path) -> None:
    log = read_log(write(tmp_path / "a.mcap", EXAMPLE))
    assert log.events == EXAMPLE
    assert log.complete
    assert log.attachments["domain.pddl"] == "(define)"


def test_independent_readers_open_it(tmp_path: Path) -> None:
    path = write(tmp_path / "a.mcap", EXAMPLE)
    with path.open("rb") as file:
        reader = make_reader(file)
        header = reader.get_header()
        topics = {c.topic for _, c, _ in reader.iter_messages()}
        assert header.profile == "ros2"
        assert reader.get_summary() is not None
    assert topics == {"/rosout", *(e.topic for e in EXAMPLE)}
    with AnyReader([path]) as bag:
        connections = [c for c in bag.connections if c.topic == "/rosout"]
        texts = [
            bag.deserialize(raw, connection.msgtype).msg
            for connection, _, raw in bag.messages(connections=connections)
        ]
    assert texts == [e.text for e in EXAMPLE]


def test_raw_messages_stand_beside_the_events_and_survive_a_cut(tmp_path: Path) -> None:
    path = tmp_path / "a.mcap"
    text = RawKind("std_msgs/msg/String", "string data\n")
    data = b"\0\1\0\0\3\0\0\0hi\0"
    log = LogWriter(path)
    log.write(EXAMPLE[0])
    assert log.write_raw("/mode", text, 100.5, data)
    log.write(EXAMPLE[1])
    journal = path.read_bytes()
    log.close()
    assert not log.write_raw("/mode", text, 101.0, data)
    cut = tmp_path / "cut.mcap"
    cut.write_bytes(journal)
    mended = recover(cut, tmp_path / "mended.mcap").path
    for whole in (path, mended):
        assert read_log(whole).events == EXAMPLE[:2]
        with AnyReader([whole]) as bag:
            (mode,) = (c for c in bag.connections if c.topic == "/mode")
            found = [
                (stamp, bag.deserialize(raw, mode.msgtype).data)
                for _, stamp, raw in bag.messages(connections=[mode])
            ]
        assert found == [(100_500_000_000, "hi")]


def test_each_message_fits_its_schema(tmp_path: Path) -> None:
    path = write(tmp_path / "a.mcap", EXAMPLE)
    with path.open("rb") as file:
        for schema, channel, message in make_reader(file).iter_messages():
            if channel.message_encoding == "json":
                assert schema is not None
                Draft202012Validator(json.loads(schema.data)).validate(json.loads(message.data))


@pytest.mark.parametrize("kind", EVENTS)
def test_every_record_has_a_sound_schema_and_is_read_back(kind: type[Event]) -> None:
    schema = schema_of(kind)
    Draft202012Validator.check_schema(schema)
    fill = {"string": "x", "number": 1.5, "integer": 2, "array": [], "object": {}, "boolean": True}
    value = {k: fill[schema["properties"][k]["type"]] for k in schema["required"]}
    event = event_of(kind.topic, {**value, "from-the-future": 1})
    assert event is not None
    Draft202012Validator(schema).validate(event_json(event))


def test_a_cut_at_any_byte_never_raises_and_loses_only_what_is_cut(tmp_path: Path) -> None:
    path = tmp_path / "a.mcap"
    log = LogWriter(path)
    ends = []
    for event in EXAMPLE:
        log.write(event)
        ends.append(path.stat().st_size)
    whole = path.read_bytes()
    log.close()
    cut = tmp_path / "cut.mcap"
    cut.write_bytes(whole)
    for length in reversed(range(len(whole) + 1)):
        os.truncate(cut, length)  # Much quicker than writing it anew.
        found = read_log(cut).events
        written = sum(end <= length for end in ends)
        assert found[:written] == EXAMPLE[:written]
    cut.write_bytes(whole)
    recovered = recover(cut)
    assert not recovered.complete
    assert read_log(recovered.path).events == EXAMPLE
    with recovered.path.open("rb") as file:
        assert make_reader(file).get_summary() is not None


def test_damage_in_a_finished_log_never_raises(tmp_path: Path) -> None:
    whole = write(tmp_path / "a.mcap", EXAMPLE).read_bytes()
    chance = random.Random(5)
    path = tmp_path / "damaged.mcap"
    for _ in range(150):
        data = bytearray(whole)
        for _ in range(4):
            data[chance.randrange(8, len(data))] = chance.randrange(256)
        path.write_bytes(bytes(data))
        read_log(path)


CHILD = """
import sys
from pathlib import Path
from polaris_nl.execution.events import GoalSent
from polaris_nl.logs.writer import LogWriter
log = LogWriter(Path(sys.argv[1]))
for number in range(100000):
    log.write(GoalSent(time=float(number), goal=number, action="(a)", literals=[], checkpoint="c"))
    print(number, flush=True)
"""


@pytest.mark.parametrize("moment", [1, 7, 40, 163])
def test_killing_the_writer_loses_no_event_that_was_written(tmp_path: Path, moment: int) -> None:
    path = tmp_path / "a.mcap"
    with subprocess.Popen(
        [sys.executable, "-c", CHILD, str(path)], stdout=subprocess.PIPE, text=True
    ) as child:
        assert child.stdout is not None
        acknowledged = [int(child.stdout.readline()) for _ in range(moment)][-1]
        os.kill(child.pid, signal.SIGKILL)
        rest = [line for line in child.stdout if line.endswith("\n")]
    acknowledged = int(rest[-1]) if rest else acknowledged
    goals = [e.goal for e in read_log(path).events if isinstance(e, GoalSent)]
    assert goals[: acknowledged + 1] == list(range(acknowledged + 1))
    assert recover(path).messages == len(goals)


def test_a_full_disk_is_said_once_and_loses_nothing_before_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "a.mcap"
    log = LogWriter(path)
    log.write(EXAMPLE[0])

    def full(_: bytes) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(log._records.journal, "append", full)
    assert not log.write(EXAMPLE[1])
    assert "No space left on device" in log.failure
    assert not log.write(EXAMPLE[2])
    log.close()
    assert read_log(path).events == EXAMPLE[:1]


@pytest.mark.parametrize("content", [b"", b"hello there, no log", b"\x89MCAP"])
def test_files_that_are_no_logs(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "x.mcap"
    path.write_bytes(content)
    if b"\x89MCAP0\r\n".startswith(content):
        assert read_log(path).events == []
    else:
        with pytest.raises(LogError, match="no MCAP log"):
            read_log(path)
    with pytest.raises(LogError, match="Can't read"):
        read_log(tmp_path / "missing.mcap")
    with pytest.raises(LogError, match="already"):
        LogWriter(path)


def test_a_log_is_summed_up() -> None:
    found = summary(EXAMPLE)
    assert (found.outcome, found.reason, found.checkpoints) == ("halted", "so", ("home",))
    assert found.seconds == 6.0
    assert [n for n, _ in found.problems] == [4]
    assert next_problem(EXAMPLE) == 4
    assert next_problem(EXAMPLE, 4) is None
    lines = [line for line, _ in story(EXAMPLE)]
    assert lines == ["goal (move hall home)", "checkpoint home", "end: halted. so"]
    assert [e for e in EXAMPLE if matcher(["severity=warning"])(e)] == [EXAMPLE[3]]
    assert [e for e in EXAMPLE if matcher(["topic=goal", "home"])(e)] == [EXAMPLE[1]]
