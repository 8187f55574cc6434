"""A run on a robot over ROS 2. rclpy is loaded here and nowhere else, when a run begins."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import partial

from polaris_nl.execution.backend import Robot
from polaris_nl.execution.clock import RealClock
from polaris_nl.execution.events import Event
from polaris_nl.execution.ros.profile import Profile, profile_for
from polaris_nl.execution.ros.recording import Definition, Recorder
from polaris_nl.execution.ros.robot import StretchRobot
from polaris_nl.execution.state import HumanCommand
from polaris_nl.logs.writer import LogWriter, RawKind
from polaris_nl.model.errors import RunError
from polaris_nl.runs import CarryOut, Connect, RunOrder, RunReport, Sink, run_on, run_simulated

WORLD = "world"
"""The name of the simulated world, where no robot is."""


def profile_of(robot: str) -> Profile | None:
    """The profile of a robot by its name or file; None for the simulated world.

    Raises:
        RunError: there is no such robot.
        FileError, FormatError: the file can't be read.
    """
    return None if robot == WORLD else profile_for(robot)


def carry_out_with(profile: Profile | None) -> CarryOut:
    """What runs programs on a robot, or in the simulated world where it is None."""
    return run_simulated if profile is None else partial(run_on_robot, profile)


def run_on_robot(
    profile: Profile,
    order: RunOrder,
    *,
    confirmed: bool,
    show: Sink = lambda event: None,
    commands: Callable[[], Iterable[HumanCommand]] = tuple,
) -> RunReport:
    """Runs a program on a robot, in real time, and logs the robot's own messages beside the decisions.

    Args:
        profile: which robot.
        order: what is run; `people` and `live` mean nothing here.
        confirmed: a person said yes to this run.
        show: is given every event as it happens.
        commands: what people have commanded since it was last asked.

    Raises:
        RunError: there is no yes, ROS 2 is missing, the robot doesn't answer, isn't ready or has no
            skill for something. Nothing has been commanded then.
        LogError: the log can't be made.
    """
    if not confirmed:
        raise RunError("A robot moves only after a clear yes, and there was none.")
    clock = RealClock()
    connect = connection(profile, order, clock)
    return run_on(connect, clock, order, confirmed=confirmed, show=show, commands=commands)


def connection(profile: Profile, order: RunOrder, clock: RealClock) -> Connect:
    """What makes the robot of a run, with its log."""

    def connect(log: LogWriter, sink: Callable[[Event], None], now: float) -> Robot:
        def keep(topic: str, definition: Definition, time: float, data: bytes) -> None:
            log.write_raw(topic, RawKind(definition.name, definition.text), time, data)

        recorder = Recorder(keep, profile, clock)
        planner = order.planner
        return StretchRobot(
            profile,
            planner.world,
            planner.segment,
            planner.mutexes,
            clock,
            state=order.resume.beliefs if order.resume else None,
            record=recorder,
            closed=recorder.close,
        )

    return connect
