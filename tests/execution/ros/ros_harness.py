"""The contract's harness for the robot back end: a mock driver in a process of its own, over real ROS 2."""

from __future__ import annotations

import errno
import json
import os
import time
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path

from polaris_nl.execution.backend import Command, Robot
from polaris_nl.execution.clock import RealClock
from polaris_nl.execution.events import Event, Failed, RunEnded
from polaris_nl.execution.faults import Fault
from polaris_nl.execution.ros.profile import Profile, profile_for
from polaris_nl.execution.settings import RunSettings
from polaris_nl.execution.state import HumanCommand
from polaris_nl.logs.reader import read_log
from polaris_nl.logs.schema import event_of
from polaris_nl.logs.writer import LogWriter
from polaris_nl.model.errors import RunError
from polaris_nl.robot_runs import connection
from polaris_nl.runs import RunOrder, Sink, run_on
from tests.execution.contract import DISK_FULL, RESTART, WATCH_S, Happening, Ran, Scenario
from tests.execution.ros.processes import Onlooker, Process, new_domain
from tests.execution.story import Case
from tests.replayed_logs import differences

MOCK = "tests.execution.ros.mock_driver"
EXECUTOR = "tests.execution.ros.executor_process"
LONGEST_S = 120.0


PATIENT_S = 2.0
"""When a robot counts as silent in scenarios that aren't about that: test machines are busy ones."""


def profile_of(scenario: Scenario) -> Profile:
    """The simulated robot's profile, without the skills that a scenario takes away."""
    profile = profile_for("stretch-sim")
    able = {k: v for k, v in profile.primitives.items() if k not in scenario.unable}
    if "gone silent" in scenario.says:
        return replace(profile, primitives=able)
    safety = replace(profile.safety, heartbeat_s=PATIENT_S)
    return replace(profile, primitives=able, safety=safety)


@dataclass
class Stage:
    """A scenario under way: what has been shown, and what is still to happen."""

    driver: Process
    onlooker: Onlooker
    clock: RealClock
    waiting: list[Happening]
    due: list[tuple[float, Fault | HumanCommand | str]] = field(default_factory=list)
    counts: dict[int, int] = field(default_factory=dict)
    events: list[Event] = field(default_factory=list)
    commanded: list[tuple[float, Command]] = field(default_factory=list)
    failure: str = ""
    log: LogWriter | None = None

    def show(self, event: Event) -> None:
        """Takes an event in, and keeps in mind what its cue asks for."""
        if isinstance(event, Failed):
            self.failure = event.text
            return
        self.events.append(event)
        for happening in [h for h in self.waiting if h.cue.fits(event)]:
            key = id(happening)
            self.counts[key] = self.counts.get(key, 0) + 1
            if self.counts[key] == happening.cue.nth:
                self.waiting.remove(happening)
                self.due.append((self.clock.now() + happening.cue.delay_s, happening.what))

    def happen(self) -> Iterator[HumanCommand | str]:
        """Lets what is due happen; what people say and restarts are for the caller."""
        now = self.clock.now() + 1e-6
        happened = [what for at, what in self.due if at <= now]
        self.due = [(at, what) for at, what in self.due if at > now]
        for what in happened:
            if isinstance(what, Fault):
                self.strike(what)
            elif what == "thaw":
                self.driver.thaw()
            elif what == DISK_FULL:
                assert self.log is not None
                self.log._write = _no_space
            else:
                yield what

    def strike(self, fault: Fault) -> None:
        """Has a fault strike: by a signal, or by asking the mock."""
        if fault.kind == "vanish":
            self.driver.kill()
        elif fault.kind == "freeze":
            self.driver.freeze()
            self.due.append((self.clock.now() + fault.seconds, "thaw"))
        else:
            self.onlooker.fault({**asdict(fault), "literals": [str(x) for x in fault.literals]})

    def commands(self) -> Iterator[HumanCommand]:
        """What people say by now."""
        for what in self.happen():
            assert isinstance(what, HumanCommand)
            yield what


def _take(line: str, stage: Stage) -> None:
    """Takes in what the executor's process prints: an event, or else what went wrong."""
    if not line.startswith("{"):
        stage.failure += line
        return
    value = json.loads(line)
    event = event_of(value["topic"], value["event"])
    assert event is not None
    stage.show(event)


def _no_space(event: Event) -> None:
    raise OSError(errno.ENOSPC, "No space left on device")


class RosHarness:
    """Carries scenarios out on the robot back end, against the mock driver."""

    name = "ros"
    cannot: Mapping[str, str] = {}

    def carry_out(self, scenario: Scenario, case: Case, folder: Path) -> Ran:
        """Carries a scenario out, with logs in a folder."""
        os.environ["ROS_DOMAIN_ID"] = new_domain()
        os.environ["ROS_AUTOMATIC_DISCOVERY_RANGE"] = "LOCALHOST"
        people = ["none"] if scenario.people == () else list(scenario.people or ())
        driver = Process(MOCK, case.world.name, *people)
        onlooker = None
        try:
            driver.wait_for("ready")
            clock = RealClock()
            onlooker = Onlooker(clock)
            onlooker.ready()
            rest = [h for h in scenario.happenings if h.cue.event is not None]
            stage = Stage(driver, onlooker, clock, rest)
            for happening in scenario.happenings:
                if happening.cue.event is None and isinstance(happening.what, Fault):
                    stage.strike(happening.what)
                    onlooker.wait(lambda: any(what == "fault" for _, what, _ in onlooker.asked))
            if RESTART in scenario.kinds:
                return self._restarted(scenario, case, folder, stage)
            return self._in_process(scenario, case, folder, stage)
        finally:
            if onlooker is not None:
                onlooker.close()
            driver.close()

    def _in_process(self, scenario: Scenario, case: Case, folder: Path, stage: Stage) -> Ran:
        settings = replace(RunSettings(), **scenario.settings)
        log = folder / "run.mcap"
        order = RunOrder(case.automaton, case.plan, case.planner, settings=settings, log=log)
        connect = connection(profile_of(scenario), order, stage.clock)

        def spied(writer: LogWriter, sink: Sink, now: float) -> Robot:
            stage.log = writer
            robot = connect(writer, sink, now)
            command = robot.command

            def keep(order: Command) -> None:
                stage.commanded.append((stage.clock.now(), order))
                command(order)

            robot.command = keep
            return robot

        try:
            report = run_on(
                spied, stage.clock, order, confirmed=True, show=stage.show, commands=stage.commands
            )
        except RunError as error:
            assert not _motions(stage.onlooker, 0.0)
            return Ran("refused", str(error), stage.events, [], stage.commanded, [])
        self._watch(stage)
        result = report.result
        failure = report.failure or stage.failure
        return Ran(
            result.outcome, result.reason, stage.events, _logged(log), stage.commanded,
            stage.onlooker.moved_at, failure,
        )  # fmt: skip

    def _restarted(self, scenario: Scenario, case: Case, folder: Path, stage: Stage) -> Ran:
        """The executor is a process of its own, which is killed and started again."""
        logs: list[Path] = []
        logged: list[Event] = []
        while True:
            logs.append(folder / f"run-{len(logs) + 1}.mcap")
            told = self._one_process(scenario, case, folder, stage, logs)
            found = _logged(logs[-1])
            assert differences(logs[-1]) == []
            shown = stage.events[len(logged) :]
            # The last event may have been written, and not yet shown, when the process was killed.
            assert found[: len(shown)] == shown
            assert len(found) - len(shown) <= (1 if not told else 0)
            logged += found
            stage.events[:] = list(logged)
            if told:
                assert any(isinstance(e, RunEnded) for e in found), stage.failure
                break
        self._watch(stage)
        ended = next(e for e in reversed(logged) if isinstance(e, RunEnded))
        return Ran(
            ended.outcome, ended.reason, stage.events, logged, [], stage.onlooker.moved_at,
            stage.failure,
        )  # fmt: skip

    def _one_process(
        self, scenario: Scenario, case: Case, folder: Path, stage: Stage, logs: list[Path]
    ) -> bool:
        """One process of the executor; whether it came to its end."""
        program = case.automaton
        order = {
            "world": case.world.name,
            "checkpoints": [
                [c.id, c.name, [str(g) for g in c.goals]] for c in program.checkpoints.values()
            ],
            "transitions": [
                [t.id, t.source, t.target, [str(x) for x in t.when]]
                for t in program.transitions.values()
            ],
            "settings": dict(scenario.settings),
            "heartbeat_s": PATIENT_S,
            "log": str(logs[-1]),
            "resume": str(logs[-2]) if len(logs) > 1 else None,
        }
        executor = Process(EXECUTOR, json.dumps(order))
        end = time.monotonic() + LONGEST_S
        try:
            while time.monotonic() < end:
                line = executor.line(0.02)
                if line:
                    _take(line, stage)
                elif executor.popen.poll() is not None:
                    return True
                if RESTART in stage.happen():
                    executor.kill()
                    executor.popen.wait(10)
                    while line := executor.line(1.0):
                        _take(line, stage)
                    return False
            raise AssertionError("the run doesn't end")
        finally:
            executor.close()

    def _watch(self, stage: Stage) -> None:
        """Goes on watching after the end: nothing moves, and nothing that could move is asked for."""
        ended = next(e.time for e in reversed(stage.events) if isinstance(e, RunEnded))
        end = stage.clock.now() + WATCH_S
        while stage.clock.now() < end:
            for _ in stage.happen():
                pass
            time.sleep(0.05)
        assert not _motions(stage.onlooker, ended + 0.1)


def _motions(onlooker: Onlooker, since: float) -> list[object]:
    """What was asked of the driver since a time that could move it."""
    return [
        (what, value)
        for at, what, value in onlooker.asked
        if at > since
        and (what in ("goal", "skill") or (what == "velocity" and value != [0.0, 0.0]))
    ]


def _logged(path: Path) -> list[Event]:
    return [e for e in read_log(path).events if e.topic != "/polaris/planned"]
