"""One run: a program with its plan, a robot, a clock and a log brought together."""

from __future__ import annotations

import hashlib
import platform
from collections.abc import Callable, Iterable, Mapping
from dataclasses import asdict, dataclass, field, replace
from importlib import metadata
from pathlib import Path

from polaris_nl import __version__
from polaris_nl.automaton.automaton import Automaton
from polaris_nl.automaton.program import Program, program_json
from polaris_nl.execution.backend import Health, Observation, Robot
from polaris_nl.execution.clock import Clock, RealClock, VirtualClock
from polaris_nl.execution.events import Event, Failed, Planned
from polaris_nl.execution.replanner import InlineReplanner, Replanner, ThreadedReplanner
from polaris_nl.execution.resuming import ResumePoint, resume_point
from polaris_nl.execution.runner import RunResult, run
from polaris_nl.execution.settings import RunSettings
from polaris_nl.execution.simulation import SimulatedRobot, SimulationSettings
from polaris_nl.execution.state import HumanCommand, RunPlan
from polaris_nl.language.grammar import grammar_folder, grammar_path
from polaris_nl.logs.paths import new_log_path
from polaris_nl.logs.privacy import KEEP_ALL, Privacy
from polaris_nl.logs.reader import read_log
from polaris_nl.logs.writer import LogSettings, LogWriter, attachments_of
from polaris_nl.model.domain import Domain
from polaris_nl.model.errors import RunError
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
    keeping = LogSettings(privacy=order.privacy)
    with LogWriter(path, _attachments(order), keeping) as log:
        watch = _LogWatch(log, order.halt_without_log)

        def sink(event: Event) -> None:
            log.write(event)
            show(event)
            for text in watch.news():
                show(Failed(time=event.time, text=text, what="log"))

        for event in _before(order, now):
            log.write(event)
        replanner = _replanner(planner, clock)
        try:
            robot = connect(log, sink, now)
            try:
                result = run(
                    plan,
                    watch.over(robot),
                    clock,
                    confirmed=confirmed,
                    sink=sink,
                    commands=commands,
                    replanner=replanner,
                    resume=order.resume.state if order.resume else None,
                    record=log.write,
                )
            finally:
                robot.close()
        except RunError as error:
            log.write(Failed(time=clock.now(), text=str(error), what="run"))
            raise
        finally:
            replanner.close()
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


def _attachments(order: RunOrder) -> Mapping[str, str]:
    world = order.planner.world
    program = program_json(Program(order.automaton, world.domain.name, world.name))
    settings = {"run": asdict(order.settings), "versions": versions(world.domain)}
    return attachments_of(program, world.domain.source, world.source, settings)


def versions(domain: Domain) -> dict[str, str]:
    """What a run depends on besides its program: of programs the versions, of grammars a hash."""
    files = sorted(grammar_folder().rglob("*.yaml"))
    own = grammar_path(domain)
    digest = hashlib.sha256()
    for path in (*files, *([own] if own is not None and own not in files else [])):
        digest.update(path.read_bytes())
    return {
        "polaris-nl": __version__,
        "python": platform.python_version(),
        "planner": metadata.version("up-fast-downward"),
        "grammar": digest.hexdigest()[:16],
    }


class _LogWatch:
    """Tells when a log can't be kept, and halts the run then where that is wanted."""

    def __init__(self, log: LogWriter, halts: bool) -> None:
        self._log = log
        self._halts = halts
        self._told: set[str] = set()

    def news(self) -> Iterable[str]:
        """What hasn't been told yet, in sentences."""
        then = "The run halts." if self._halts else "The run goes on without it."
        for text, more in ((self._log.failure, then), (self._log.lost, "")):
            if text and text not in self._told:
                self._told.add(text)
                yield f"{text} {more}".strip()

    def over(self, robot: Robot) -> Robot:
        """The robot, at fault from the moment when its log can't be written, where that is wanted."""
        return _Logged(robot, self._log) if self._halts else robot


class _Logged:
    """A robot that counts as at fault when its log can't be written."""

    def __init__(self, robot: Robot, log: LogWriter) -> None:
        self._robot = robot
        self._log = log
        self.name = robot.name
        self.missing, self.advance, self.command = robot.missing, robot.advance, robot.command
        self.reports, self.close = robot.reports, robot.close

    def observe(self) -> Observation:
        """What the robot perceives."""
        found = self._robot.observe()
        if not self._log.failure or not found.health.ready:
            return found
        why = "the log can't be written any more; make room on the disk first"
        return replace(found, health=Health("fault", why))
