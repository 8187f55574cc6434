"""One run: a program with its plan, a robot, a clock and a log brought together."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from polaris_nl.automaton.automaton import Automaton
from polaris_nl.automaton.program import Program, program_json
from polaris_nl.execution.clock import Clock, RealClock, VirtualClock
from polaris_nl.execution.events import Event, Heard, Planned, Understood
from polaris_nl.execution.runner import RunResult, run
from polaris_nl.execution.settings import RunSettings
from polaris_nl.execution.simulation import SimulatedRobot, SimulationSettings
from polaris_nl.execution.state import HumanCommand, RunPlan
from polaris_nl.logs.paths import new_log_path
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
    """

    automaton: Automaton
    plan: BranchingPlan
    planner: Planner
    people: tuple[str, ...] | None = None
    live: bool = False
    log: Path | None = None
    settings: RunSettings = field(default_factory=RunSettings)
    before: tuple[Event, ...] = ()


@dataclass(frozen=True, slots=True)
class RunReport:
    """A run that is over: its result, its log, and why the log is incomplete, or ""."""

    result: RunResult
    log: Path
    failure: str = ""


def run_simulated(
    order: RunOrder,
    *,
    confirmed: bool,
    show: Callable[[Event], None] = lambda event: None,
    commands: Callable[[], Iterable[HumanCommand]] = tuple,
) -> RunReport:
    """Runs a program in the simulated world.

    Args:
        order: what, and how.
        confirmed: a person said yes to this run.
        show: is given every event as it happens.
        commands: what people have commanded since it was last asked.

    Raises:
        RunError: there is no yes, or nothing to run.
        LogError: the log can't be made.
    """
    planner = order.planner
    world = planner.world
    now = RealClock().now()
    clock: Clock = RealClock() if order.live else VirtualClock(now)
    path = order.log or new_log_path(world.name)
    wording = planner.wording
    plan = RunPlan(order.automaton, order.plan, world, wording, order.settings)
    with LogWriter(path, attachments(order)) as log:

        def sink(event: Event) -> None:
            log.write(event)
            show(event)

        for event in order.before:
            if isinstance(event, Heard | Understood):
                log.write(event)
        log.write(
            Planned(
                time=now,
                revision=0,
                status=order.plan.status,
                plan=plan_json(order.plan, order.automaton),
                ms=order.plan.ms,
            )
        )
        robot = SimulatedRobot(
            world,
            planner.mutexes,
            planner.segment,
            SimulationSettings(people=order.people),
            sink=sink,
            start=now,
        )
        try:
            result = run(plan, robot, clock, confirmed=confirmed, sink=sink, commands=commands)
        finally:
            robot.close()
    return RunReport(result, path, log.failure)


def attachments(order: RunOrder) -> Mapping[str, str]:
    """What makes the log of a run explain itself: program, domain and world."""
    world = order.planner.world
    program = program_json(Program(order.automaton, world.domain.name, world.name))
    return attachments_of(program, world.domain.source, world.source)
