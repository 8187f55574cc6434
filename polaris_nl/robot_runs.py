"""A run on a robot over ROS 2: link, plan, clock and log brought together."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from contextlib import ExitStack

from polaris_nl.execution.clock import RealClock
from polaris_nl.execution.events import Event, Planned
from polaris_nl.execution.replanner import ThreadedReplanner
from polaris_nl.execution.ros.profile import Profile
from polaris_nl.execution.ros.recording import Definition, Recorder
from polaris_nl.execution.runner import run
from polaris_nl.execution.state import HumanCommand, RunPlan
from polaris_nl.logs.paths import new_log_path
from polaris_nl.logs.writer import LogWriter, RawKind
from polaris_nl.model.errors import RunError
from polaris_nl.planning.plan_json import plan_json
from polaris_nl.runs import RunOrder, RunReport, attachments


def run_on_robot(
    order: RunOrder,
    profile: Profile,
    *,
    confirmed: bool,
    show: Callable[[Event], None] = lambda event: None,
    commands: Callable[[], Iterable[HumanCommand]] = tuple,
) -> RunReport:
    """Runs a program on a robot, in real time, and logs its messages beside the decisions.

    Args:
        order: what is run; `people` and `live` mean nothing here.
        profile: which robot.
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
    from polaris_nl.execution.ros.robot import StretchRobot

    planner = order.planner
    world = planner.world
    clock = RealClock()
    path = order.log or new_log_path(world.name)
    plan = RunPlan(order.automaton, order.plan, world, planner.wording, order.settings)
    with ExitStack() as stack:
        log = stack.enter_context(LogWriter(path, attachments(order)))

        def sink(event: Event) -> None:
            log.write(event)
            show(event)

        def keep(topic: str, definition: Definition, time: float, data: bytes) -> None:
            log.write_raw(topic, RawKind(definition.name, definition.text), time, data)

        record = Recorder(keep, profile, clock)
        stack.callback(record.close)
        for event in order.before:
            log.write(event)
        log.write(
            Planned(
                time=clock.now(),
                revision=0,
                status=order.plan.status,
                plan=plan_json(order.plan, order.automaton),
                ms=order.plan.ms,
            )
        )
        robot = StretchRobot(profile, world, planner.segment, planner.mutexes, clock, record)
        stack.callback(robot.close)
        replanner = ThreadedReplanner(planner.segment)
        stack.callback(replanner.close)
        result = run(
            plan,
            robot,
            clock,
            confirmed=confirmed,
            sink=sink,
            commands=commands,
            replanner=replanner,
        )
    return RunReport(result, path, log.failure or record.failure)
