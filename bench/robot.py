"""How soon a robot's motion is withdrawn, and how soon the next goal is sent, over real ROS 2.

Against the tests' mock driver, a process of its own on this machine. Needs what `make robot` installs.
"""

from __future__ import annotations

import os
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from bench.table import Row
from polaris_nl.automaton.automaton import START, Automaton, Checkpoint, Transition
from polaris_nl.execution.clock import RealClock
from polaris_nl.execution.events import Event, GoalConfirmed
from polaris_nl.execution.ros.profile import profile_for
from polaris_nl.execution.ros.robot import StretchRobot
from polaris_nl.model.formula import parse_literal
from polaris_nl.model.world_file import load_world
from polaris_nl.planning.planner import Planner
from polaris_nl.robot_runs import run_on_robot
from polaris_nl.runs import RunOrder
from tests.execution.ros.processes import Onlooker, Process, new_domain

MOCK = "tests.execution.ros.mock_driver"
TIMES = 8
GOALS = (("(robot-at cafeteria)",), ("(robot-at kitchen)",), ("(robot-at home)",))
MS = 1000.0


def rows() -> Iterator[Row]:
    """The rows about a robot."""
    planner = Planner(load_world("care-home"))
    runstop = [_one(planner, _runstop) for _ in range(TIMES)]
    note = "From the driver's own run-stop to the velocity of zero that it gets."
    yield Row("run-stop to a velocity of zero", "<= 100", runstop, note=note)
    note = "The plain sign, server_is_ready() turning false, takes about 20 s."
    killed = [_one(planner, lambda *scene: _silent(*scene, Process.kill)) for _ in range(TIMES)]
    yield Row("driver killed to motion withdrawn", "<= 600", killed, note=note)
    frozen = [_one(planner, lambda *scene: _silent(*scene, Process.freeze)) for _ in range(TIMES)]
    yield Row("driver frozen to motion withdrawn", "<= 600", frozen)
    yield Row("goal confirmed to the next one at the driver", "<= 50", _goals(planner))


class _Sent:
    """When velocities of zero were sent."""

    def __init__(self) -> None:
        self.stops: list[float] = []

    def __call__(self, topic: str, kind: str, message: Any) -> None:
        if topic.endswith("cmd_vel") and message.linear.x == message.angular.z == 0.0:
            self.stops.append(time.monotonic())


Scene = Callable[[Process, Onlooker, _Sent], float]


def _one(planner: Planner, measure: Callable[..., float]) -> float:
    os.environ["ROS_DOMAIN_ID"] = new_domain()
    os.environ["ROS_AUTOMATIC_DISCOVERY_RANGE"] = "LOCALHOST"
    driver = Process(MOCK, "care-home", "none")
    clock = RealClock()
    sent = _Sent()
    try:
        driver.wait_for("ready")
        onlooker = Onlooker(clock)
        onlooker.ready()
        world, profile = planner.world, profile_for("stretch-sim")
        robot = StretchRobot(profile, world, planner.segment, planner.mutexes, clock, record=sent)
        try:
            onlooker.wait(lambda: robot.observe().health.ready)
            return measure(driver, onlooker, sent)
        finally:
            robot.close()
            onlooker.close()
    finally:
        driver.close()


def _runstop(driver: Process, onlooker: Onlooker, sent: _Sent) -> float:
    onlooker.fault({"kind": "runstopped"})
    onlooker.wait(lambda: any(what == "velocity" for _, what, _ in onlooker.asked))
    struck = next(at for at, what, _ in onlooker.told if what == "fault")
    return (next(at for at, what, _ in onlooker.told if what == "velocity") - struck) * MS


def _silent(
    driver: Process, onlooker: Onlooker, sent: _Sent, strike: Callable[[Process], None]
) -> float:
    started = time.monotonic()
    strike(driver)
    onlooker.wait(lambda: bool(sent.stops))
    return (sent.stops[0] - started) * MS


def _goals(planner: Planner) -> list[float]:
    """From a goal's confirmation to the driver's receiving the next one, on a drive around."""
    os.environ["ROS_DOMAIN_ID"] = new_domain()
    driver = Process(MOCK, "care-home", "none")
    automaton, before = Automaton(), START
    for number, goals in enumerate(GOALS, 1):
        literals = tuple(map(parse_literal, goals))
        automaton = automaton.with_checkpoint(Checkpoint(f"c{number}", f"stop-{number}", literals))
        automaton = automaton.with_transition(Transition(f"t{number}", before, f"c{number}", ()))
        before = f"c{number}"
    confirmed: list[float] = []

    def show(event: Event) -> None:
        if isinstance(event, GoalConfirmed) and event.seconds > 0:
            confirmed.append(event.time)

    try:
        driver.wait_for("ready")
        onlooker = Onlooker(RealClock())
        onlooker.ready()
        with tempfile.TemporaryDirectory() as folder:
            plan = planner.compile(automaton)
            order = RunOrder(automaton, plan, planner, log=Path(folder) / "run.mcap")
            run_on_robot(profile_for("stretch-sim"), order, confirmed=True, show=show)
        onlooker.close()
    finally:
        driver.close()
    asked = [at for at, what, _ in onlooker.told if what == "goal"]
    nexts = [next((a for a in asked if a > at), None) for at in confirmed]
    return [(a - at) * MS for at, a in zip(confirmed, nexts, strict=True) if a is not None]
