"""Logs that were cut off or damaged: what is there is read, what is missing is said."""

from __future__ import annotations

import json
import os
import random
import subprocess
import sys
from pathlib import Path

import pytest
from mcap.reader import make_reader

from polaris_nl.logs.framing import MESSAGE
from polaris_nl.logs.reader import open_log, read_log
from polaris_nl.logs.recovery import being_written, recover
from polaris_nl.logs.salvage import Gap, Piece, pieces
from polaris_nl.logs.writer import LogWriter, RawKind
from tests.logs.writing import goal, goals, numbers, write

KILLS = 200


def journal_of(path: Path, count: int) -> bytes:
    """The bytes of a log that nobody has closed."""
    log = LogWriter(path)
    for event in goals(count):
        log.write(event)
    data = path.read_bytes()
    log.close()
    return data


def test_a_cut_at_any_byte_of_a_finished_log_never_raises(tmp_path: Path) -> None:
    whole = write(tmp_path / "a.mcap", goals(5)).read_bytes()
    cut = tmp_path / "cut.mcap"
    cut.write_bytes(whole)
    for length in reversed(range(len(whole))):
        os.truncate(cut, length)  # Much quicker than writing it anew.
        log = read_log(cut)
        assert not log.complete
        assert log.missing or not length
        found = numbers(log.events)
        assert found == list(range(len(found)))
    cut.write_bytes(whole)
    assert numbers(read_log(cut).events) == list(range(5))


def test_damage_in_a_journal_costs_what_it_touches(tmp_path: Path) -> None:
    whole = journal_of(tmp_path / "a.mcap", 60)
    found = [p for p in pieces(whole) if isinstance(p, Piece) and p.opcode == MESSAGE]
    path = tmp_path / "damaged.mcap"
    for hit in (3, 30, 57):
        data = bytearray(whole)
        data[found[hit].start - 5 : found[hit].start + 4] = b"\xff" * 9
        path.write_bytes(bytes(data))
        log = read_log(path)
        assert numbers(log.events) == [n for n in range(60) if n != hit]
        assert not log.complete
        assert "damaged inside" in log.missing
        mended = recover(path)
        assert not mended.complete
        assert "what stands before and after that is kept" in mended.missing
        assert numbers(read_log(mended.path).events) == [n for n in range(60) if n != hit]


def test_a_hole_of_zeros_and_a_tail_of_zeros(tmp_path: Path) -> None:
    whole = journal_of(tmp_path / "a.mcap", 60)
    path = tmp_path / "zeros.mcap"
    path.write_bytes(whole + bytes(5000))
    log = read_log(path)
    assert numbers(log.events) == list(range(60))
    assert "its last 5 KB make no whole message" in log.missing
    middle = len(whole) // 2
    path.write_bytes(whole[:middle] + bytes(300) + whole[middle + 300 :])
    found = numbers(read_log(path).events)
    assert found[0] == 0
    assert found[-1] == 59
    assert 55 <= len(found) < 60


def test_a_damaged_chunk_keeps_both_sides(tmp_path: Path) -> None:
    chance = random.Random(3)
    path = tmp_path / "a.mcap"
    with LogWriter(path) as log:
        for number in range(6000):
            noise = "".join(chance.choices("abcdefghijklmnopqrstuvwxyz", k=400))
            log.write(goal(number, noise))
    data = bytearray(path.read_bytes())
    gaps = [p for p in pieces(bytes(data)) if isinstance(p, Gap)]
    assert gaps == []
    data[len(data) // 3] ^= 0xFF
    path.write_bytes(bytes(data))
    log_read = read_log(path)
    found = numbers(log_read.events)
    assert (found[0], found[-1]) == (0, 5999)
    assert 1000 < len(found) < 6000
    assert not log_read.complete
    mended = recover(path)
    assert numbers(read_log(mended.path).events) == found
    with mended.path.open("rb") as file:
        assert make_reader(file).get_summary() is not None


def test_random_damage_never_raises_and_invents_nothing(tmp_path: Path) -> None:
    chance = random.Random(11)
    finished = write(tmp_path / "a.mcap", goals(40)).read_bytes()
    journal = journal_of(tmp_path / "b.mcap", 40)
    path = tmp_path / "damaged.mcap"
    for whole in (finished, journal):
        for _ in range(150):
            data = bytearray(whole)
            for _ in range(chance.randint(1, 4)):
                at = chance.randrange(8, len(data))
                data[at : at + chance.randint(1, 30)] = chance.randbytes(chance.randint(0, 30))
            path.write_bytes(bytes(data))
            found = [n for n in numbers(read_log(path).events) if n in range(40)]
            assert len(found) <= 40
            recover(path, tmp_path / "mended.mcap")
            read_log(tmp_path / "mended.mcap")


def test_an_open_log_is_told_from_a_cut_off_one(tmp_path: Path) -> None:
    path = tmp_path / "a.mcap"
    log = LogWriter(path)
    log.write(goal(1))
    assert being_written(path)
    log.close()
    assert not being_written(path)


def test_robot_messages_are_recovered_with_their_definitions(tmp_path: Path) -> None:
    path = tmp_path / "a.mcap"
    log = LogWriter(path)
    log.write_raw("/mode", RawKind("std_msgs/msg/String", "string data\n"), 5.0, b"\0\1\0\0abc")
    log.write(goal(1))
    cut = tmp_path / "cut.mcap"
    cut.write_bytes(path.read_bytes())
    log.close()
    mended = recover(cut)
    with mended.path.open("rb") as file:
        (found,) = make_reader(file).iter_messages(topics=["/mode"])
    schema, channel, message = found
    assert schema is not None
    assert (schema.name, schema.encoding) == ("std_msgs/msg/String", "ros2msg")
    assert (channel.message_encoding, message.data) == ("cdr", b"\0\1\0\0abc")


KILLER = """
import json, os, random, signal, sys
from pathlib import Path
from polaris_nl.logs.writer import LogWriter
from tests.logs.writing import goal

def write(path, pipe, count):
    log = LogWriter(path)
    for number in range(count):
        os.write(pipe, b"x" if log.write(goal(number, "I go.")) else b"-")
    log.close()
    os.write(pipe, b"c")
    os._exit(0)

folder, chance, told = Path(sys.argv[1]), random.Random(7), []
for run in range(int(sys.argv[2])):
    moment = chance.randint(1, 60)
    count = 10_000 if run % 2 else max(moment - 1, 1)  # Every other one is killed while it closes its log.
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        os.close(reading)
        write(folder / f"{run}.mcap", writing, count)
    os.close(writing)
    seen = b""
    while len(seen) < min(moment, count):
        data = os.read(reading, 1)
        if not data:
            sys.exit(f"writer {run} ended by itself")
        seen += data
    os.kill(child, signal.SIGKILL)
    while data := os.read(reading, 4096):
        seen += data
    os.waitpid(child, 0)
    os.close(reading)
    told.append(seen.rfind(b"x") + 1)  # What is acknowledged has all before it in the file, too.
print(json.dumps(told))
"""


def test_killing_writers_at_random_moments_keeps_all_that_was_acknowledged(tmp_path: Path) -> None:
    """200 processes that write one event after the other, killed while they write or close.

    They are writers and not whole sessions, which would take 200 times as long and differ in nothing
    that the log sees.
    """
    done = subprocess.run(
        [sys.executable, "-W", "ignore", "-c", KILLER, str(tmp_path), str(KILLS)],
        capture_output=True, text=True, check=True, timeout=120,
    )  # fmt: skip
    told = json.loads(done.stdout)
    assert len(told) == KILLS
    assert sum(told) > KILLS
    for run, acknowledged in enumerate(told):
        path = tmp_path / f"{run}.mcap"
        found = numbers(read_log(path).events)

        assert found[:acknowledged] == list(range(acknowledged))
        mended = recover(path)
        assert numbers(read_log(mended.path).events) == found


def test_pages_of_a_finished_log_are_read_by_its_index(tmp_path: Path) -> None:
    path = tmp_path / "a.mcap"
    chance = random.Random(4)
    with LogWriter(path) as log:
        for number in range(9000):
            log.write(goal(number, "x" * chance.randint(100, 400)))
    with open_log(path) as file:
        assert len(file) == 9000
        assert file.topics()["/polaris/goal-sent"] == 9000
        for start, stop in ((0, 20), (4990, 5010), (8995, 9005), (9000, 9020)):
            assert numbers(list(file.events(start, stop))) == list(range(start, min(stop, 9000)))


@pytest.mark.parametrize("count", [0, 1])
def test_short_logs(tmp_path: Path, count: int) -> None:
    path = write(tmp_path / "a.mcap", goals(count))
    log = read_log(path)
    assert len(log.events) == count
    assert log.complete
    assert recover(path).missing == ""
