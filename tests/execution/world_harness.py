"""The contract's harness for the in-process world, in virtual time."""

from __future__ import annotations

import errno
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

from polaris_nl.execution.backend import Command, Robot
from polaris_nl.execution.events import Event, Failed
from polaris_nl.execution.faults import Fault
from polaris_nl.execution.settings import RunSettings
from polaris_nl.execution.simulation import SimulatedRobot
from polaris_nl.execution.simulation_settings import SimulationSettings
from polaris_nl.execution.state import HumanCommand
from polaris_nl.logs.reader import read_log
from polaris_nl.logs.writer import LogWriter
from polaris_nl.model.errors import RunError
from polaris_nl.runs import RunOrder, RunReport, Sink, resumable, run_on
from tests.execution.contract import DISK_FULL, RESTART, WATCH_S, Happening, Ran, Scenario
from tests.execution.story import T0, BoundedClock, Case


class Killed(BaseException):
    """The executor's process is gone; nothing that it would do on its way out is done."""


class HarnessedRobot(SimulatedRobot):
    """The simulated robot; a dead executor's commands don't reach it."""

    def __init__(self, case: Case, scenario: Scenario, faults: Iterable[Fault]) -> None:
        planner = case.planner
        how = SimulationSettings(people=scenario.people, unable=scenario.unable)
        super().__init__(
            planner.world, planner.mutexes, planner.segment, how, faults, self.acted, start=T0
        )
        self.commanded: list[tuple[float, Command]] = []
        self.cut_off = False
        self.sink: Sink | None = None

    def acted(self, event: Event) -> None:
        if self.sink is not None:
            self.sink(event)

    def command(self, command: Command) -> None:
        if not self.cut_off:
            self.commanded.append((self._now, command))
            super().command(command)


@dataclass
class Stage:
    """A scenario under way: what has been shown, and what is still to happen."""

    scenario: Scenario
    robot: HarnessedRobot
    clock: BoundedClock
    waiting: list[Happening]
    due: list[tuple[float, str | HumanCommand]] = field(default_factory=list)
    counts: dict[int, int] = field(default_factory=dict)
    events: list[Event] = field(default_factory=list)
    failure: str = ""
    log: LogWriter | None = None

    def show(self, event: Event) -> None:
        """Takes an event, and does what its cue asks for."""
        if isinstance(event, Failed):
            self.failure = event.text
            return
        self.events.append(event)
        for happening in [h for h in self.waiting if h.cue.fits(event)]:
            key = id(happening)
            self.counts[key] = self.counts.get(key, 0) + 1
            if self.counts[key] == happening.cue.nth:
                self.waiting.remove(happening)
                self._plan(happening)

    def _plan(self, happening: Happening) -> None:
        if isinstance(happening.what, Fault):
            self.robot.suffer(replace(happening.what, at=happening.cue.delay_s))
        else:
            self.due.append((self.clock.now() + happening.cue.delay_s, happening.what))

    def commands(self) -> Iterator[HumanCommand]:
        """What people say by now; also where the executor is killed and the disk filled."""
        now = self.clock.now() + 1e-6
        happened = [what for at, what in self.due if at <= now]
        self.due = [(at, what) for at, what in self.due if at > now]
        for what in happened:
            if isinstance(what, HumanCommand):
                yield what
            elif what == DISK_FULL:
                assert self.log is not None
                self.log._write = _no_space
            else:
                assert what == RESTART
                self.robot.cut_off = True
                raise Killed


def _no_space(event: Event) -> None:
    raise OSError(errno.ENOSPC, "No space left on device")


class WorldHarness:
    """Carries scenarios out in the in-process world."""

    name = "world"
    cannot: Mapping[str, str] = {}

    def carry_out(self, scenario: Scenario, case: Case, folder: Path) -> Ran:
        """Carries a scenario out, with logs in a folder."""
        first = [h for h in scenario.happenings if h.cue.event is None]
        faults = [h.what for h in first if isinstance(h.what, Fault)]
        robot = HarnessedRobot(case, scenario, faults)
        clock = BoundedClock(T0)
        rest = [h for h in scenario.happenings if h.cue.event is not None]
        stage = Stage(scenario, robot, clock, rest)
        settings = replace(RunSettings(), **scenario.settings)
        order = RunOrder(case.automaton, case.plan, case.planner, settings=settings)
        logs: list[Path] = []
        try:
            report = self._to_the_end(stage, order, folder, logs)
        except RunError as error:
            return Ran("refused", str(error), stage.events, [], robot.commanded, robot.moved_at)
        end = clock.now() + WATCH_S
        while clock.now() < end:
            clock.sleep(settings.tick_s)
            robot.advance(clock.now())
            robot.observe()
        logged = [e for log in logs for e in read_log(log).events if e.topic != "/polaris/planned"]
        result = report.result
        return Ran(
            result.outcome,
            result.reason,
            stage.events,
            logged,
            robot.commanded,
            robot.moved_at,
            report.failure or stage.failure,
        )

    def _to_the_end(
        self, stage: Stage, order: RunOrder, folder: Path, logs: list[Path]
    ) -> RunReport:
        """Runs, and resumes each time the executor is killed."""
        while True:
            logs.append(folder / f"run-{len(logs) + 1}.mcap")

            def connect(log: LogWriter, sink: Sink, now: float) -> Robot:
                stage.log, stage.robot.sink, stage.robot.cut_off = log, sink, False
                return stage.robot

            try:
                return run_on(
                    connect,
                    stage.clock,
                    replace(order, log=logs[-1]),
                    confirmed=True,
                    show=stage.show,
                    commands=stage.commands,
                )
            except Killed:
                stage.robot.sink = None
                point = resumable(logs[-1], order.automaton, order.plan, order.planner)
                order = replace(order, resume=point)
