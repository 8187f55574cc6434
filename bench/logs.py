"""What a log costs the one who writes it, and the one who reads it, beside the plain `mcap` package.

The disk and the other programs of the machine have their say in all of these; each figure is of several
runs, and the longest is told.
"""

from __future__ import annotations

import itertools
import json
import os
import random
import shutil
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from mcap.reader import make_reader
from mcap.records import Channel, Schema
from mcap.writer import CompressionType, Writer

from bench.table import Row, percentile, timed
from polaris_nl.execution.events import Event, GoalSent, Observed
from polaris_nl.logs.compacting import Compactor
from polaris_nl.logs.finalising import content, finalise, written
from polaris_nl.logs.framing import END, HEAD, encoded, message
from polaris_nl.logs.journal import Journal
from polaris_nl.logs.reader import open_log, read_log
from polaris_nl.logs.review import summary
from polaris_nl.logs.salvage import Piece, pieces
from polaris_nl.logs.writer import LogWriter, RawKind

EVENTS = 20_000
RUNS = 5
JOURNAL_BYTES = 100 << 20
LARGE_BYTES = 1 << 30
"""Of the log that is opened and paged through; a tenth of it where the disk has no room."""


def rows() -> Iterator[Row]:
    """The rows about logs."""
    with _folder() as folder:
        yield from _writing(folder)
        yield _sustained(folder)
        yield _finalising(folder)
    with _folder() as folder:
        yield from _reading(folder)


@contextmanager
def _folder() -> Iterator[Path]:
    with tempfile.TemporaryDirectory() as name:
        yield Path(name)


def _event(number: int) -> Event:
    time_s = 1e9 + number / 100
    if number % 10:
        return Observed(time=time_s, added=["(at cup desk)"], removed=["(holding cup)"])
    text = "I go to the hall."
    return GoalSent(
        time=time_s, text=text, goal=number, action="(move home hall)",
        literals=["(robot-at hall)", "(not (robot-at home))"], checkpoint="c1",
    )  # fmt: skip


def _writing(folder: Path) -> Iterator[Row]:
    """Each event by itself, as the executor's thread sees it."""
    ours: list[float] = []
    for run in range(RUNS):
        with LogWriter(folder / f"w{run}.mcap") as log:
            for number in range(EVENTS):
                event = _event(number)
                started = time.perf_counter()
                log.write(event)
                ours.append((time.perf_counter() - started) * 1e6)
            assert not log.lost
    plain = _plainly(folder / "plain.mcap")
    note = f"p99 {percentile(ours, 99):.0f} us, longest {max(ours) / 1000:.1f} ms of {len(ours)}"
    yield Row(
        "an event into the log, in the caller's thread", "p99 <= 1000", ours, plain,
        "json and mcap.Writer, flushed", "us", note,
    )  # fmt: skip


def _plainly(path: Path) -> list[float]:
    found = []
    with path.open("wb") as file:
        writer = Writer(file, use_chunking=False, compression=CompressionType.NONE)
        writer.start(profile="ros2")
        channel = writer.register_channel("/events", "json", 0)
        for number in range(EVENTS):
            event = _event(number)
            started = time.perf_counter()
            value = {name: getattr(event, name) for name in ("time", "text", "id", "causes")}
            more = {"added": getattr(event, "added", []), "removed": getattr(event, "removed", [])}
            nanoseconds = int(event.time * 1e9)
            data = json.dumps({**value, **more}).encode()
            writer.add_message(channel, nanoseconds, data, nanoseconds)
            writer.flush()
            found.append((time.perf_counter() - started) * 1e6)
    return found


def _sustained(folder: Path) -> Row:
    """Messages a second, from the first to the last in the file; a goal with its line is two."""
    events = [_event(number) for number in range(EVENTS)]
    messages = sum(2 if e.text else 1 for e in events)
    raw = RawKind("std_msgs/msg/String", "string data\n")
    rates, busy = [], []
    for run in range(RUNS):
        with LogWriter(folder / f"s{run}.mcap") as log:
            started, cpu = time.perf_counter(), time.process_time()
            for event in events:
                log.write(event)
            for number in range(EVENTS):
                log.write_raw("/joint_states", raw, 1e9 + number / 100, b"\0" * 200)
            took, used = time.perf_counter() - started, time.process_time() - cpu
            assert not log.lost
        rates.append((messages + EVENTS) / took / 1000)
        busy.append((messages + EVENTS) / used / 1000)
    note = f"{percentile(busy, 50):.0f} thousand a second of processor time"
    return Row("messages sustained, events and robot's", ">= 50", rates, unit="k/s", note=note)


def _finalising(folder: Path) -> Row:
    """A journal of 100 MB, made into a compressed, indexed file."""
    path = folder / "journal.mcap"
    journal = Journal(path)
    chance = random.Random(1)
    channel = journal.add_channel(
        "/joint_states", "cdr", "sensor_msgs/msg/JointState", "ros2msg", b""
    )
    for number in itertools.count():
        if journal.size >= JOURNAL_BYTES:
            break
        parts = [
            journal.message(channel, number, number, chance.randbytes(60) * 5) for _ in range(50)
        ]
        journal.append(b"".join(parts))
    journal.append(END)
    journal.close()
    ours, plain = [], []
    for run in range(3):
        copy = folder / f"copy{run}.mcap"
        shutil.copy(path, copy)
        os.sync()  # What the copying left to be written is no matter of finalising.
        ours += timed(lambda copy=copy: finalise(copy), 1)
    plain += timed(lambda: _copied(folder / "copy0.mcap", folder / "again.mcap"), 1)
    return Row("finalising 100 MB", "<= 3000", ours, plain, "mcap's reader into its writer")


def _copied(source: Path, target: Path) -> None:
    with source.open("rb") as file, target.open("wb") as out:
        writer = Writer(out)
        writer.start(profile="ros2")
        channel = writer.register_channel("/joint_states", "cdr", 0)
        for _, _, found in make_reader(file).iter_messages(log_time_order=False):
            writer.add_message(
                channel, found.log_time, found.data, found.publish_time, found.sequence
            )
        writer.finish()


def _reading(folder: Path) -> Iterator[Row]:
    """A log of 1 GB: the robot's messages, and twenty thousand events among them."""
    room = shutil.disk_usage(folder).free
    size = LARGE_BYTES if room > 4 * LARGE_BYTES else LARGE_BYTES // 10
    path = folder / "large.mcap"
    _make_large(path, size, folder / "events.mcap")
    note = f"{path.stat().st_size / (1 << 30):.2f} GB, {EVENTS} events"

    def opened() -> None:
        with open_log(path) as log:
            list(log.events(0, 20))

    def paged() -> None:
        with open_log(path) as log:
            list(log.events(EVENTS // 2, EVENTS // 2 + 20))

    def plain() -> None:
        with path.open("rb") as file:
            topics = ["/polaris/beliefs", "/polaris/goal-sent"]
            list(make_reader(file).iter_messages(topics=topics))

    all_plain = timed(plain, 2)
    way = "mcap's reader, its topics"
    yield Row("opening a log of 1 GB, first page", "<= 1000", timed(opened, 10), note=note)
    yield Row("a page from its middle", "", timed(paged, 10))
    yield Row(
        "all its events, summed up",
        "",
        timed(lambda: summary(read_log(path).events), 3),
        all_plain,
        way,
    )


def _make_large(path: Path, size: int, events: Path) -> None:
    """Robot messages that don't compress, with a run's events between."""
    with LogWriter(events) as log:
        for number in range(EVENTS):
            log.write(_event(number))
    noise = random.Random(2).randbytes(1 << 20)
    number = 900  # A channel that the events don't have.

    def robot(count: int) -> Iterator[Piece]:
        for at in range(count):
            start = (at * 7919) % (1 << 19)
            record = message(number, at, 10**18 + at * 10**7, noise[start : start + 8192])
            yield Piece(record[0], record, HEAD, len(record))

    with content(events) as data, written(path) as out:
        compactor = Compactor(out)
        schema = encoded(Schema(number, b"uint8[] data\n", "ros2msg", "polaris/msg/Noise"))
        channel = encoded(Channel(number, "/noise", "cdr", {}, number))
        compactor.take(pieces(data))
        compactor.take(Piece(r[0], r, HEAD, len(r)) for r in (schema, channel))
        compactor.take(robot(size // 8192))
        compactor.finish()
