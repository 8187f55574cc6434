"""A planner that hangs, crashes, is killed, lacks memory or disk leaves the session alive and says so."""

from __future__ import annotations

import contextlib
import os
import subprocess
import sys
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from polaris_nl.planning import search, segments
from polaris_nl.planning.budget import never
from polaris_nl.planning.result import Problem
from polaris_nl.snapshot import Snapshot

from .conftest import Open, Watched, add

HELD = "(holding cup)"
Install = Callable[[str], Path]


@pytest.fixture
def install(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Install:
    """Puts a shell script in the place of the search program, for sessions that start then."""

    def make(script: str) -> Path:
        path = tmp_path / "planner"
        path.write_text(f"#!/bin/sh\n{script}\n", encoding="utf-8")
        path.chmod(0o755)
        monkeypatch.setenv(search.OVERRIDE, str(path))
        return path

    return make


def children() -> list[str]:
    found = []
    for task in Path("/proc/self/task").iterdir():
        with contextlib.suppress(OSError):  # A thread may end meanwhile.
            found += (task / "children").read_text(encoding="ascii").split()
    return found


def asked(session: Watched, goal: str) -> Snapshot:
    add(session, goal)
    return session.wait(30)


def the_problem(snapshot: Snapshot) -> Problem:
    assert snapshot.planning == "planned"
    assert snapshot.plan is not None
    (problem,) = snapshot.plan.problems
    assert problem.cause == "undecided"
    assert problem.text.count(".") <= 2  # "For x: one sentence."
    return problem


FAULTS = {
    "hangs": ("exec tail -f /dev/null", "try again, or split the step in two"),
    "hangs and ignores": ("trap '' TERM INT\nexec tail -f /dev/null", "try again"),
    "crashes": ("kill -SEGV $$", "Try again, or undo"),
    "is killed": ("kill -KILL $$", "Try again, or undo"),
    "has no memory": ("cat > /dev/null\nexit 22", "split the step in two, or ask for less"),
    "has a full disk": ("cat > /dev/null\necho plan > /dev/full || exit 32", "Try again, or undo"),
    "talks nonsense": ("cat > /dev/null\necho '(fly cup moon)' >&2", "try again"),
    "talks more nonsense": ("cat > /dev/null\necho '(move home kitchen)' >&2", "try again"),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_a_planner_fault_is_said_and_the_session_goes_on(
    open_session: Open,
    install: Install,
    monkeypatch: pytest.MonkeyPatch,
    tmp_path: Path,
    fault: str,
) -> None:
    script, way_out = FAULTS[fault]
    folder = tmp_path / "here"
    folder.mkdir()
    monkeypatch.chdir(folder)
    monkeypatch.setenv("TMPDIR", str(folder))
    monkeypatch.setattr(segments, "BUDGET_S", 0.3)
    monkeypatch.setattr(segments.Segments.solve, "__defaults__", (0.3, never, False))
    path = install(script)
    session = open_session()
    problem = the_problem(asked(session, HELD))
    assert way_out in problem.text
    path.unlink()
    monkeypatch.delenv(search.OVERRIDE)
    add(session, "(robot-at hall)")
    # What was undecided is shown as that at first, and tried again behind the screen.
    again = session._publisher.wait(
        lambda now: (
            now.planning == "planned" and now.plan is not None and len(now.plan.segments) == 2
        ),
        30,
    )
    assert again.plan is not None
    assert again.plan.status == "ok"
    session.close()
    assert children() == []
    assert list(folder.iterdir()) == []  # No core, no plan, no scratch file.


def test_closing_a_session_ends_a_planner_that_hangs(
    open_session: Open, install: Install, tmp_path: Path
) -> None:
    begun = tmp_path / "begun"
    os.mkfifo(begun)
    install(f"echo > {begun}\nexec tail -f /dev/null")
    session = open_session()
    add(session, HELD)
    begun.read_text(encoding="ascii")  # Waits until it has begun.
    session.close()
    assert children() == []


NO_FILES = """
import resource, sys
resource.setrlimit(resource.RLIMIT_FSIZE, (0, 0))
from polaris_nl.automaton.automaton import Automaton, Checkpoint, Transition
from polaris_nl.model.formula import parse_literal
from polaris_nl.model.world_file import load_world
from polaris_nl.planning.planner import Planner
planner = Planner(load_world("care-home"))
goals = ["(holding cup)", "(at tray table)", "(connected home table)", "(at cup desk)"]
for goal in goals:
    made = Automaton().with_checkpoint(Checkpoint("c1", "x", (parse_literal(goal),)))
    plan = planner.compile(made.with_transition(Transition("t1", "c0", "c1")))
    print(plan.status)
"""


def test_planning_works_where_no_file_can_be_written(tmp_path: Path) -> None:
    """A full disk is no trouble, as nothing is written: the kernel would refuse every byte."""
    done = subprocess.run(
        [sys.executable, "-B", "-W", "error", "-c", NO_FILES],
        cwd=tmp_path,
        env={**os.environ, "TMPDIR": str(tmp_path), "PYTHONPATH": os.pathsep.join(sys.path)},
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert (done.stderr, done.stdout.split()) == ("", ["ok", "ok", "invalid", "ok"])
    assert list(tmp_path.iterdir()) == []


def test_a_planner_may_take_only_the_time_it_is_given_even_without_its_session(
    install: Install, tmp_path: Path
) -> None:
    """So one whose session was killed ends by itself, and a file or core it can't leave behind."""
    limits = tmp_path / "limits"
    os.mkfifo(limits)
    # Reading its problem to the end, the child knows that its limits have been set.
    install(f"cat > /dev/null\necho $(ulimit -t) $(ulimit -f) $(ulimit -c) > {limits}\nexit 12")
    with ThreadPoolExecutor(1) as pool:
        found = pool.submit(search.search, "x", search.OPTIMAL, 1.5, never)
        assert limits.read_text(encoding="ascii").split() == ["3", "0", "0"]
        assert found.result(30).status == "undecided"
