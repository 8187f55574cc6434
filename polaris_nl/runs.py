"""One run: a program with its plan, a robot, a clock and a log brought together."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from contextlib import closing, suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Protocol

from polaris_nl.automaton.automaton import Automaton
from polaris_nl.automaton.program import Program, program_json
from polaris_nl.execution.backend import Robot
from polaris_nl.execution.clock import Clock, RealClock, VirtualClock
from polaris_nl.execution.durations import LEARNED_FROM
from polaris_nl.execution.durations_file import learn
from polaris_nl.execution.events import Event, Failed, Planned, RunStarted
from polaris_nl.execution.replanner import InlineReplanner, Replanner, ThreadedReplanner
from polaris_nl.execution.resuming import ResumePoint, resume_point
from polaris_nl.execution.runner import RunResult, run
from polaris_nl.execution.settings import RunSettings
from polaris_nl.execution.simulation import SimulatedRobot
from polaris_nl.execution.simulation_settings import SimulationSettings
from polaris_nl.execution.state import HumanCommand, RunPlan
from polaris_nl.logs.paths import new_log_path
from polaris_nl.logs.privacy import KEEP_ALL, Privacy
from polaris_nl.logs.reader import read_log
from polaris_nl.logs.writer import LogSettings, LogWriter
from polaris_nl.model.errors import FileError, RunError
from polaris_nl.planning.plan_json import plan_json
from polaris_nl.planning.planner import Planner
from polaris_nl.planning.result import BranchingPlan
from polaris_nl.run_logs import LogWatch, run_attachments


@dataclass(frozen=True)
class RunOrder:
    """What is to be run, and how.

    Attributes:
        people: the human actions that simulated people prefer; None for the world's own order, empty for
            people who do nothing.
        live: in real time; otherwise as fast as the machine can, with the same events.
        log: the log's path; a new one in the log folder by default.
        before: events that led to this program (what was heard, understood and changed), kept in the log.
        privacy: what the log leaves out.
        halt_without_log: a run whose log can't be written any more halts; otherwise it goes on.
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
    privacy: Privacy = KEEP_ALL
    halt_without_log: bool = False


@dataclass(frozen=True, slots=True)
class RunReport:
    """A run that is over: its result, its log, and why the log is incomplete, or ""."""

    result: RunResult
    log: Path
    failure: str = ""


Sink = Callable[[Event], None]


class CarryOut(Protocol):
    """What runs a program: `run_simulated`, or `run_on_robot` with its profile."""

    def __call__(
        self,
        order: RunOrder,
        *,
        confirmed: bool,
        show: Sink = ...,
        commands: Callable[[], Iterable[HumanCommand]] = ...,
    ) -> RunReport:
        """Runs it to its end."""
        ...


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
    planner, now = order.planner, clock.now()
    path = order.log or new_log_path(planner.world.name)
    plan = RunPlan(order.automaton, order.plan, planner.world, planner.wording, order.settings)
    kept: list[Event] = []
    try:
        with LogWriter(path, attachments(order), LogSettings(privacy=order.privacy)) as log:
            watch = LogWatch(log, order.halt_without_log)

            def sink(event: Event) -> None:
                log.write(event)
                show(event)
                if isinstance(event, (RunStarted, *LEARNED_FROM)):
                    kept.append(event)
                for text in watch.news():
                    show(Failed(time=event.time, text=text, what="log"))

            for event in _before(order, now):
                log.write(event)
            with (
                closing(_replanner(planner, clock)) as replanner,
                closing(connect(log, sink, now)) as robot,
            ):
                result = run(
                    plan,
                    watch.over(robot),
                    clock,
                    confirmed=confirmed,
                    sink=sink,
                    commands=commands,
                    replanner=replanner,
                    resume=order.resume,
                    record=log.write,
                )
    except RunError:
        if not kept:
            path.unlink(missing_ok=True)  # Of a run that never began there is nothing to read.
        raise
    if not isinstance(clock, VirtualClock):
        # It serves later plans alone; that it can't be kept is no matter of this run.
        with suppress(FileError):
            learn(planner.world, kept)
    return RunReport(result, path, log.failure or log.lost)


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
            acted=order.resume.acted if order.resume else (),
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
    yield from order.before
    if not any(isinstance(e, Planned) for e in order.before):
        plan = plan_json(order.plan, order.automaton)
        yield Planned(time=now, revision=0, status=order.plan.status, plan=plan, ms=order.plan.ms)


def attachments(order: RunOrder) -> Mapping[str, str]:
    """What makes an order's log explain itself."""
    world = order.planner.world
    program = program_json(Program(order.automaton, world.domain.name, world.name))
    return run_attachments(program, world, order.settings)
