"""The writer under pressure: a slow disk, a full one, several threads, long and late runs."""

from __future__ import annotations

import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from polaris_nl.execution.events import Edited, Failed, Observed, RunEnded, Stepped
from polaris_nl.logs.journal import Journal
from polaris_nl.logs.paths import parts_of
from polaris_nl.logs.reader import read_log
from polaris_nl.logs.recovery import recover
from polaris_nl.logs.writer import LogSettings, LogWriter, RawKind
from polaris_nl.runs import RunOrder, run_simulated
from tests.execution.story import Case
from tests.logs.writing import goal, goals, numbers, write

DAY = 86400.0
WAIT_S = 20.0


class SlowDisk:
    """Forcing a file to the disk takes until it is let go."""

    def __init__(self, patch: pytest.MonkeyPatch) -> None:
        self.begun, self.free = threading.Event(), threading.Event()
        patch.setattr(Journal, "force", lambda journal: self._force())

    def _force(self) -> None:
        self.begun.set()
        assert self.free.wait(WAIT_S)


def test_a_slow_disk_delays_nobody_and_loses_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    disk = SlowDisk(monkeypatch)
    log = LogWriter(tmp_path / "a.mcap", settings=LogSettings(slow_s=0.0))
    assert log.write(goal(0))
    assert disk.begun.wait(WAIT_S)
    assert [log.write(goal(n)) for n in range(1, 200)] == [False] * 199
    assert numbers(read_log(log.path).events) == [0]
    disk.free.set()
    log.close()
    assert numbers(read_log(log.path).events) == list(range(200))
    assert log.lost == ""


def test_what_a_slow_disk_has_no_room_for_is_counted_and_said(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    disk = SlowDisk(monkeypatch)
    log = LogWriter(tmp_path / "a.mcap", settings=LogSettings(slow_s=0.0, queue=10))
    log.write(goal(0))
    assert disk.begun.wait(WAIT_S)
    raw = RawKind("std_msgs/msg/String", "string data\n")
    for number in range(1, 7):
        log.write_raw("/joint_states", raw, float(number), b"\0")
        log.write(Stepped(time=float(number)))
        log.write(goal(number))
    disk.free.set()
    log.close()
    found = read_log(log.path, inputs=True)
    assert numbers(found.events) == list(range(7)), "what is many gives way to what is rare"
    (said,) = (e for e in found.events if isinstance(e, Failed))
    assert said.text == log.lost
    assert "4 of /joint_states, 4 of /polaris/inputs" in log.lost
    assert len(found.inputs) == 2


def test_the_disk_is_forced_for_what_must_not_be_lost(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    forced = threading.Event()
    monkeypatch.setattr(Journal, "force", lambda _: forced.set())
    with LogWriter(tmp_path / "a.mcap") as log:
        log.write(Observed(time=1.0))
        assert not forced.is_set()
        log.write(Edited(time=2.0, revision=1, label="x"))
        assert forced.wait(WAIT_S)


def test_several_threads_write_every_event_once(tmp_path: Path) -> None:
    log = LogWriter(tmp_path / "a.mcap")

    def work(first: int) -> None:
        for number in range(first, first + 300):
            log.write(goal(number))

    threads = [threading.Thread(target=work, args=(n * 1000,)) for n in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    log.close()
    events = read_log(log.path).events
    assert sorted(numbers(events)) == sorted(n * 1000 + k for n in range(4) for k in range(300))
    for n in range(4):
        own = [x for x in numbers(events) if x // 1000 == n]
        assert own == sorted(own), "each thread's events stay in order"
    assert [e.id for e in events] == list(range(1, 1201))


def test_a_long_log_goes_on_in_other_files_and_is_read_as_one(tmp_path: Path) -> None:
    path = write(tmp_path / "a.mcap", goals(400), LogSettings(part_bytes=20_000))
    parts = parts_of(path)
    assert len(parts) > 2
    assert parts[1] == tmp_path / "a.part2.mcap"
    log = read_log(path)
    assert numbers(log.events) == list(range(400))
    assert [e.id for e in log.events] == list(range(1, 401))
    assert log.complete
    assert log.parts == tuple(parts)
    later = read_log(parts[1])
    assert later.metadata["follows"] == "a.mcap"
    assert later.events[0].id == int(later.metadata["first_event"])


@pytest.fixture
def zone(monkeypatch: pytest.MonkeyPatch) -> Iterator[Callable[[str], None]]:
    """Goes to another time zone, and back at the end."""

    def go(name: str) -> None:
        monkeypatch.setenv("TZ", name)
        time.tzset()

    yield go
    monkeypatch.undo()
    time.tzset()


@pytest.mark.parametrize(("name", "count"), [("UTC0", 3), ("WEST5", 2), ("EAST-9", 3)])
def test_a_log_goes_on_in_another_file_at_midnight(
    name: str, count: int, zone: Callable[[str], None], tmp_path: Path
) -> None:
    zone(name)
    events = [Observed(time=n * DAY / 4) for n in range(1, 9)]
    path = write(tmp_path / "a.mcap", events)
    assert len(parts_of(path)) == count
    assert read_log(path).events == events


FULL = """
import resource, sys
from pathlib import Path
from polaris_nl.logs.writer import LogWriter
from tests.logs.writing import goal
log = LogWriter(Path(sys.argv[1]))
resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, 20_000))
kept = [log.write(goal(n, "I go.")) for n in range(200)]
log.close()
print(sum(kept), kept == sorted(kept, reverse=True), log.failure)
"""


def test_a_file_that_cannot_grow_ends_with_a_whole_event(tmp_path: Path) -> None:
    path = tmp_path / "a.mcap"
    done = subprocess.run(
        [sys.executable, "-c", FULL, str(path)], capture_output=True, text=True, check=True
    )
    kept, in_order, failure = done.stdout.strip().split(" ", 2)
    assert in_order == "True"
    assert "can't be written any more" in failure
    log = read_log(path)
    assert 0 < int(kept) < 200
    assert numbers(log.events) == list(range(int(kept)))
    assert not log.complete
    assert log.missing == "It has no end, as it couldn't be written any more (File too large)."
    assert recover(path).missing == log.missing


@pytest.mark.parametrize("halts", [False, True])
def test_a_run_goes_on_or_halts_when_its_disk_is_full(
    halts: bool, serve: Case, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    append = Journal.append

    def full(journal: Journal, records: bytes) -> None:
        if journal.size > 15_000:
            raise OSError(28, "No space left on device")
        append(journal, records)

    monkeypatch.setattr(Journal, "append", full)
    order = RunOrder(
        serve.automaton, serve.plan, serve.planner, log=tmp_path / "a.mcap", halt_without_log=halts
    )
    shown: list[object] = []
    report = run_simulated(order, confirmed=True, show=shown.append)
    (said,) = (e.text for e in shown if isinstance(e, Failed))
    assert "No space left on device" in said
    ended = [e for e in shown if isinstance(e, RunEnded)]
    if halts:
        assert report.result.outcome == "halted"
        assert "the log can't be written" in ended[0].reason.lower()
        assert said.endswith("The run halts.")
    else:
        assert report.result.outcome == "done"
        assert said.endswith("The run goes on without it.")
    assert report.failure in said
