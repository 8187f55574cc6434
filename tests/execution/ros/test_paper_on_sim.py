"""The paper's two programs on the simulated Stretch: two processes, real messages, and the log of it all."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import pytest
from rosbags.highlevel import AnyReader

from polaris_nl.execution.clock import RealClock
from polaris_nl.execution.events import (
    CheckpointReached,
    Event,
    GoalConfirmed,
    GoalSent,
    Halted,
    RunEnded,
    TransitionTaken,
)
from polaris_nl.execution.ros.profile import profile_for
from polaris_nl.execution.ros.recording import KEPT_AS
from polaris_nl.execution.runner import RunResult, objectives_met
from polaris_nl.execution.settings import RunSettings
from polaris_nl.logs.reader import read_log
from polaris_nl.robot_runs import run_on_robot
from polaris_nl.runs import RunOrder
from tests.execution.ros.processes import Onlooker, Process, new_domain
from tests.execution.story import Case
from tests.logs.decoding import decoded

SIMULATOR = "polaris_nl.execution.ros.stretch_sim"
SPEED = "12"
STILL_S = 1.0
"""For so long after a run it is watched that nothing moves."""
ROBOT_TOPICS = {
    "/stretch/joint_states", "/odom", "/battery", "/mode", "/tf", "/aruco/marker_array",
    "/is_homed", "/is_runstopped", f"{KEPT_AS}perceived",
}  # fmt: skip


@dataclass
class Ran:
    result: RunResult
    events: list[Event]
    log: Path
    moved_after: list[float]

    def of(self, kind: type[Any]) -> list[Any]:
        return [e for e in self.events if isinstance(e, kind)]


Run = Callable[..., Ran]


@pytest.fixture
def on_sim(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[Run]:
    """Runs a case on a simulator of its own."""
    monkeypatch.setenv("ROS_DOMAIN_ID", new_domain())
    monkeypatch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    open_: list[Process | Onlooker] = []

    def run(
        case: Case,
        people: str,
        react: Callable[[Event, Onlooker], None] = lambda event, onlooker: None,
        **settings: float,
    ) -> Ran:
        options = ("--kinematic", "--speed", SPEED, "--people", people)
        simulator = Process(SIMULATOR, "--world", case.world.name, *options)
        open_.append(simulator)
        simulator.wait_for("ready")
        onlooker = Onlooker(RealClock(), "/polaris/sim/fault")
        open_.append(onlooker)
        onlooker.ready()
        events: list[Event] = []

        def show(event: Event) -> None:
            events.append(event)
            react(event, onlooker)

        patience = replace(RunSettings(), **settings)
        log = tmp_path / "run.mcap"
        order = RunOrder(case.automaton, case.plan, case.planner, log=log, settings=patience)
        report = run_on_robot(profile_for("stretch-sim"), order, confirmed=True, show=show)
        assert report.failure == ""
        ended = onlooker.clock.now()
        time.sleep(STILL_S)
        moved = [at for at in onlooker.moved_at if at > ended + 0.35]
        return Ran(report.result, events, log, moved)

    yield run
    for thing in reversed(open_):
        thing.close()


def check_log(ran: Ran) -> None:
    """The log holds every event, and the robot's own messages, readable by other programs."""
    logged = [e for e in read_log(ran.log).events if e.topic != "/polaris/planned"]
    assert logged == ran.events
    assert set(decoded(ran.log)) >= ROBOT_TOPICS
    with AnyReader([ran.log]) as reader:
        odometry = [c for c in reader.connections if c.topic == "/odom"]
        speeds = [
            (stamp * 1e-9, message.twist.twist.linear.x)
            for connection, stamp, raw in reader.messages(connections=odometry)
            for message in [reader.deserialize(raw, connection.msgtype)]
        ]
    assert any(speed > 0.1 for _, speed in speeds), "it never drove"
    seconds = ran.result.seconds
    assert len(speeds) <= 11 * seconds + 5, "odometry isn't thinned out"
    (ended,) = ran.of(RunEnded)
    assert [s for at, s in speeds if at > ended.time + 0.35 and abs(s) > 0.02] == []


def test_she_acknowledges_so_lunch_is_served(lunch: Case, on_sim: Run) -> None:
    ran = on_sim(lunch, "acknowledge")
    assert (ran.result.outcome, ran.result.reason) == ("done", "The program is done.")
    assert ran.result.checkpoints == ("alerted", "fetched", "home")
    assert [t.when for t in ran.of(TransitionTaken)] == [[], ["(acknowledged lunchtime)"], []]
    assert all(met for _, met in objectives_met(lunch.world, ran.result.beliefs))
    assert ran.moved_after == []
    check_log(ran)
    with AnyReader([ran.log]) as reader:
        texts = {
            c.topic: reader.deserialize(raw, c.msgtype).data
            for c, _, raw in reader.messages()
            if c.topic == f"{KEPT_AS}say"
        }
    said = json.loads(texts[f"{KEPT_AS}say"])
    assert (said["person"], said["text"]) == ("resident", "lunch is ready")


def test_she_dismisses_so_it_just_goes_home(lunch: Case, on_sim: Run) -> None:
    ran = on_sim(lunch, "dismiss")
    assert ran.result.outcome == "done"
    assert ran.result.checkpoints == ("alerted", "cancelled")
    assert not any("tray" in e.action for e in ran.of(GoalSent))
    assert ran.moved_after == []


def test_she_stays_silent_so_it_halts_and_stands_still(lunch: Case, on_sim: Run) -> None:
    ran = on_sim(lunch, "none", wait_s=4.0)
    assert ran.result.outcome == "halted"
    assert ran.result.reason.startswith("I waited 4 seconds, but it didn't happen that lunch is")
    assert ran.result.checkpoints == ("alerted",)
    assert ran.moved_after == []
    check_log(ran)


def test_the_dishes_are_washed_and_put_away(dishes: Case, on_sim: Run) -> None:
    washed: set[str] = set()

    def wash(event: Event, onlooker: Onlooker) -> None:
        """The host washes a dish once the robot has let go of it."""
        for dish in {"cup", "plate"} - washed:
            placed = (
                isinstance(event, GoalConfirmed) and event.action == f"(place {dish} countertop)"
            )
            if placed or (isinstance(event, CheckpointReached) and event.name == "fetched"):
                washed.add(dish)
                facts = [f"(at {dish} drying-rack)", f"(is-clean {dish})"]
                onlooker.fault({"fault": "event", "literals": facts})

    ran = on_sim(dishes, "none", wash)
    assert (ran.result.outcome, ran.of(Halted)) == ("done", []), [
        e.text for e in ran.events if e.text
    ]
    assert all(met for _, met in objectives_met(dishes.world, ran.result.beliefs))
    assert ran.moved_after == []
    check_log(ran)
