"""One run: a program with its plan, a robot, a clock and a log brought together."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from polaris_nl.automaton.automaton import Automaton
from polaris_nl.automaton.program import Program, program_json
from polaris_nl.execution.backend import Robot
from polaris_nl.execution.clock import Clock, RealClock, VirtualClock
from polaris_nl.execution.events import Event, Failed, Heard, Planned, Understood
from polaris_nl.execution.replanner import InlineReplanner, Replanner, ThreadedReplanner
from polaris_nl.execution.resuming import ResumePoint, resume_point
from polaris_nl.execution.runner import RunResult, run
from polaris_nl.execution.settings import RunSettings
from polaris_nl.execution.simulation import SimulatedRobot, SimulationSettings
from polaris_nl.execution.state import HumanCommand, RunPlan
from polaris_nl.logs.paths import new_log_path
from polaris_nl.logs.reader import read_log
from polaris_nl.logs.writer import LogWriter, attachments_of
from polaris_nl.planning.plan_json import plan_json
from polaris_nl.planning.planner import Planner
from polaris_nl.planning.result import BranchingPlan


@dataclass(frozen=True)
class RunOrder:
    """What is to be run, and how.

    Attributes:
        people: the human actions that simulated people prefer; None for the world's own order, empty for
            people who do nothing.
        live: in real time; otherwise as fast as the machine can, with the same events.
        log: the log's path; a new one in the log folder by default.
        before: events that led to this program (what was heard and understood), kept in the log.
        resume: where an earlier run had come to (`resumable`); None begins at the start.
    """

    automaton: Automaton
    plan: BranchingPlan
    planner: Planner
    people: tuple[str, ...] | None = None
    live: bool = False
    log: Path | None = None
    settings: RunSettings = field(default_factory=RunSettings)
    before: tuple[Event, ...] = ()
    resume: ResumePoint | None = None


@dataclass(frozen=True, slots=True)
class RunReport:
    """A run that is over: its result, its log, and why the log is incomplete, or ""."""

    result: RunResult
    log: Path
    failure: str = ""


Sink = Callable[[Event], None]
Connect = Callable[[LogWriter, Sink, float], Robot]
"""Makes a robot: given the log (for messages of its own), the sink of events, and the time."""


def run_on(
    connect: Connect,
    clock: Clock,
    order: RunOrder,
    *,
    confirmed: bool,
    show: Sink = lambda event: None,
    commands: Callable[[], Iterable[HumanCommand]] = tuple,
) -> RunReport:
    """Runs a program on a robot, which is let go of afterwards.

    Args:
        connect: makes the robot.
        clock: the time.
        order: what, and how.
        confirmed: a person said yes to this run.
        show: is given every event as it happens, and is told at once when the log fails.
        commands: what people have commanded since it was last asked.

    Raises:
        RunError: there is no yes, nothing to run, or a robot that can't do it; nothing has moved.
        LogError: the log can't be made.
    """
    planner = order.planner
    now = clock.now()
    path = order.log or new_log_path(planner.world.name)
    plan = RunPlan(order.automaton, order.plan, planner.world, planner.wording, order.settings)
    with LogWriter(path, _attachments(order)) as log:

        def sink(event: Event) -> None:
            sound = not log.failure
            log.write(event)
            show(event)
            if sound and log.failure:
                show(Failed(time=event.time, text=log.failure, what="log"))

        for event in _before(order, now):
            log.write(event)
        replanner = _replanner(planner, clock)
        try:
            robot = connect(log, sink, now)
            try:
                result = run(
                    plan,
                    robot,
                    clock,
                    confirmed=confirmed,
                    sink=sink,
                    commands=commands,
                    replanner=replanner,
                    resume=order.resume.state if order.resume else None,
                )
            finally:
                robot.close()
        finally:
            replanner.close()
    return RunReport(result, path, log.failure)


def run_simulated(
    order: RunOrder,
    *,
    confirmed: bool,
    show: Sink = lambda event: None,
    commands: Callable[[], Iterable[HumanCommand]] = tuple,
) -> RunReport:
    """Runs a program in the simulated world, which goes on from where a resumed run had left it.

    Args:
        order: what, and how.
        confirmed: a person said yes to this run.
        show: is given every event as it happens.
        commands: what people have commanded since it was last asked.

    Raises:
        RunError: there is no yes, or nothing to run.
        LogError: the log can't be made.
    """

    def connect(log: LogWriter, sink: Sink, now: float) -> Robot:
        return SimulatedRobot(
            order.planner.world,
            order.planner.mutexes,
            order.planner.segment,
            SimulationSettings(people=order.people),
            sink=sink,
            start=now,
            state=order.resume.beliefs if order.resume else None,
        )

    real = RealClock()
    clock: Clock = real if order.live else VirtualClock(real.now())
    return run_on(connect, clock, order, confirmed=confirmed, show=show, commands=commands)


def resumable(
    log: Path, automaton: Automaton, plan: BranchingPlan, planner: Planner
) -> ResumePoint:
    """Where the run in a log had come to, whole or cut off.

    Raises:
        LogError: the file can't be read.
        RunError: there is nothing to go on with, or it is another program's run.
    """
    return resume_point(read_log(log).events, automaton, plan, planner.world)


def _replanner(planner: Planner, clock: Clock) -> Replanner:
    # Planning takes no virtual time, and there the answer has to come at the same tick every time.
    virtual = isinstance(clock, VirtualClock)
    return InlineReplanner(planner.segment) if virtual else ThreadedReplanner(planner.segment)


def _before(order: RunOrder, now: float) -> Iterable[Event]:
    yield from (e for e in order.before if isinstance(e, Heard | Understood))
    plan = plan_json(order.plan, order.automaton)
    yield Planned(time=now, revision=0, status=order.plan.status, plan=plan, ms=order.plan.ms)


def _attachments(order: RunOrder) -> Mapping[str, str]:
    world = order.planner.world
    program = program_json(Program(order.automaton, world.domain.name, world.name))
    return attachments_of(program, world.domain.source, world.source)
