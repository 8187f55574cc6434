"""Planning in the background: what subscribers are told, in which order, and that nothing is left behind."""

from __future__ import annotations

import queue
import subprocess
import threading
from contextlib import suppress
from itertools import groupby
from pathlib import Path
from typing import Any

import pytest

from polaris_nl.execution.events import (
    Event,
    Failed,
    Planned,
)
from polaris_nl.model.errors import PlanningError
from polaris_nl.model.world import World
from polaris_nl.planning import search
from polaris_nl.planning.planner import Planner
from polaris_nl.session import Session
from polaris_nl.snapshot import Snapshot, answer_json
from tests.session.conftest import (
    CUP,
    HOME,
    LIMIT_S,
    TABLE,
    GatedPlanner,
    Watched,
    add,
)


def test_subscribers_get_every_revision_first_planning_then_planned(session: Watched) -> None:
    for n, text in enumerate((TABLE, "(robot-at home)"), 1):
        add(session, text)
        session.until_told(n)
    session.undo()
    session.until_told(3)
    # Parts of a plan may come before all of it, and a better one after it: on a slow machine they do.
    states = [state for state, _ in groupby((s.revision, s.planning) for s in session.told)]
    assert states == [
        (1, "planning"),
        (1, "planned"),
        (2, "planning"),
        (2, "planned"),
        (3, "planning"),
        (3, "planned"),
    ]
    # Until the new plan is there, the old one is shown.
    latest = next(s for s in reversed(session.told) if s.revision == 1)
    assert next(s for s in session.told if s.revision == 2).plan is latest.plan


def test_a_subscription_ends(session: Watched) -> None:
    seen: list[Snapshot] = []
    end = session.subscribe(seen.append)
    add(session, TABLE)
    session.until_told(1)
    end()
    add(session, "(robot-at home)")
    session.until_told(2)
    assert {s.revision for s in seen} == {1}
    assert {s.revision for s in session.told} == {1, 2}


def test_an_older_plan_never_comes_after_a_newer_program(world: World) -> None:
    planned, go_on = threading.Event(), threading.Event()

    def slow_disk(event: Event) -> None:
        """Holds the planning thread between making a plan and telling it."""
        if isinstance(event, Planned) and event.revision == 1:
            planned.set()
            assert go_on.wait(LIMIT_S)

    told: list[tuple[int, str]] = []
    over = threading.Event()

    def hear(snapshot: Snapshot) -> None:
        told.append((snapshot.revision, snapshot.planning))
        if told[-1] == (2, "planned"):
            over.set()

    with Session(world, sink=slow_disk) as session:
        session.subscribe(hear)
        add(session, TABLE)
        assert planned.wait(LIMIT_S)
        add(session, "(robot-at home)")
        go_on.set()
        assert over.wait(LIMIT_S)
    first_told = [*dict.fromkeys(told)]
    assert first_told == [(1, "planning"), (1, "planned"), (2, "planning"), (2, "planned")]


def test_a_subscriber_may_edit_and_all_hear_it_in_order(session: Watched) -> None:
    def go_home_too(snapshot: Snapshot) -> None:
        if snapshot.revision == 1 and snapshot.planning == "planning":
            add(session, "(robot-at home)")

    last: list[tuple[int, str]] = []
    session.subscribe(go_home_too)
    session.subscribe(lambda s: last.append((s.revision, s.planning)))
    add(session, TABLE)
    session.until_told(2)
    session.close()
    assert last == sorted(last, key=lambda told: told[0])
    # A plan that takes longer is told in part, too, which is planning still.
    assert [n for n, planning in dict.fromkeys(last) if planning == "planning"] == [1, 2]
    assert last == [(s.revision, s.planning) for s in session.told]


def test_edits_quicker_than_planning_cancel_the_older_work(
    session: Watched, planner: Planner
) -> None:
    session.planner = gated = GatedPlanner(planner)
    add(session, TABLE)
    assert gated.entered.acquire(timeout=LIMIT_S)
    for text in ("(robot-at home)", "(robot-at hall)", "(at tray desk)"):
        add(session, text)
    gated.gate.set()
    last = session.until_told(4)
    # The first was stale when it was done; those between were never begun.
    assert gated.stale == [True, False]
    assert [len(a.checkpoints) for a in gated.asked] == [2, 5]
    assert last.planning == "planned"
    assert last.plan == planner.compile(last.automaton)
    assert [s.revision for s in session.told] == [1, 2, 3, 4, 4]
    assert [e.revision for e in session.events if isinstance(e, Planned)] == [4]


def test_a_plan_that_is_made_just_too_late_is_thrown_away(
    session: Watched, planner: Planner, monkeypatch: pytest.MonkeyPatch
) -> None:
    session.planner = gated = GatedPlanner(planner)
    # The edit falls between the planning thread's look at the time and its publishing.
    monkeypatch.setattr(session._replanner, "_stale", lambda revision: False)
    add(session, TABLE)
    assert gated.entered.acquire(timeout=LIMIT_S)
    add(session, "(robot-at home)")
    gated.gate.set()
    session.until_told(2)
    assert [(s.revision, s.planning) for s in session.told] == [
        (1, "planning"),
        (2, "planning"),
        (2, "planned"),
    ]
    assert [e.revision for e in session.events if isinstance(e, Planned)] == [2]


def test_the_final_plan_belongs_to_the_final_revision(session: Watched, planner: Planner) -> None:
    places = ("(robot-at hall)", "(at cup desk)", "(robot-at home)", "(open fridge)")
    for n in range(24):
        add(session, places[n % 4])
        if n % 5 == 4:
            session.undo()
    final = session.wait(LIMIT_S)
    session.until_told(final.revision)
    assert final.revision == 28
    assert final.planning == "planned"
    assert final.plan == planner.compile(final.automaton)
    revisions = [s.revision for s in session.told]
    assert revisions == sorted(revisions)
    assert set(revisions) == set(range(1, 29))
    for snapshot in session.told:
        if snapshot.planning == "planned":
            assert snapshot.plan == planner.compile(snapshot.automaton)


@pytest.mark.parametrize("error", [PlanningError("The planner is gone."), ValueError("no")])
def test_a_planner_that_fails_is_told_and_the_next_edit_is_planned(
    session: Watched, planner: Planner, error: Exception
) -> None:
    class Broken:
        def drafts(self, *_: object) -> None:
            raise error

    session.planner = Broken()
    answer = session.say(CUP)
    assert answer.snapshot.planning == "failed"
    assert str(error) in answer.snapshot.failure
    assert answer.snapshot.failure in answer.say
    assert [e.what for e in session.events if isinstance(e, Failed)] == ["planning"]
    assert answer_json(answer, session.program)["plan"]["status"] == "pending"
    assert answer.snapshot.failure in session.say("run").say
    assert not session.say("yes").confirmed
    session.planner = planner
    assert session.say(HOME).snapshot.planning == "planned"


def children() -> set[str]:
    found: set[str] = set()
    for task in Path("/proc/self/task").iterdir():
        with suppress(FileNotFoundError):  # A thread that has just ended.
            found.update((task / "children").read_text().split())
    return found


def test_close_leaves_no_thread_and_no_process(world: World) -> None:
    threads, processes = set(threading.enumerate()), children()
    with Session(world) as session:
        add(session, TABLE)
        session.wait(LIMIT_S)
        assert set(threading.enumerate()) > threads
    assert set(threading.enumerate()) == threads
    assert children() == processes
    session.close()
    Session(world).close()


def test_an_edit_and_the_end_kill_the_search_that_is_under_way(
    world: World, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    endless = tmp_path / "search"
    endless.write_text("#!/bin/sh\nexec sleep 1000\n", encoding="utf-8")
    endless.chmod(0o755)
    started: queue.Queue[Any] = queue.Queue()

    class Child(subprocess.Popen[str]):
        def __init__(self, *args: Any, **kwargs: Any) -> None:
            super().__init__(*args, **kwargs)
            started.put(self)

    monkeypatch.setattr(search, "binary", lambda: endless)
    monkeypatch.setattr(search.subprocess, "Popen", Child)
    threads, processes = set(threading.enumerate()), children()
    with Session(world) as session:
        add(session, TABLE)
        first = started.get(timeout=LIMIT_S)
        assert first.poll() is None
        add(session, "(robot-at home)")
        second = started.get(timeout=LIMIT_S)
        assert first.returncode is not None
        assert second.poll() is None
        told: list[Snapshot] = []
        session.subscribe(told.append)
    assert second.returncode is not None
    assert told == []
    assert started.empty()
    assert set(threading.enumerate()) == threads
    assert children() == processes
