"""The contract of every robot back end: what goes wrong, and how the run has to end.

`SCENARIOS` are values: a program, what happens at which cue, and what is expected. They are carried out
by a `Harness`, and what comes of each is checked by `check`, which also checks what holds always: no goal
is sent after a halt, odometry is still when a run is over, the log holds every event, and nothing that
was confirmed is done again.

To add a back end, write a `Harness` for it and a test like `test_contract.py`:

- `name` and `cannot`: the kinds of faults that can't be injected there, each with the reason. Keep it
  empty if you can: what can't be injected is untested.
- `carry_out(scenario, case, folder)`: brings a robot up with `case.world` as it is at the start, runs
  `case` through `polaris_nl.runs.run_on` (or in a process of its own, where that is to be killed) with
  `scenario.settings`, `scenario.people` and the log in `folder`, and tears everything down.
  - Cues: watch the events given to `show`. When the `nth` event that fits a cue has come, have the fault
    strike `delay_s` seconds later, by the run's clock: send it to the simulator, or a signal to the
    driver (`vanish` is SIGKILL, `freeze` SIGSTOP and SIGCONT after `fault.seconds`). A cue without an
    event strikes before the run starts.
  - `RESTART` ends the executor without any cleaning up (SIGKILL), then resumes the run from its log
    with a new executor and a new log, while the robot and its world go on.
  - `DISK_FULL` makes every further write to the log fail.
  - When the run is over, go on watching odometry for `WATCH_S` seconds.
- `Ran` is what is to be observed: from the outside where there is an outside (commands as the driver got
  them, motion as odometry shows it).

Times in scenarios are seconds and short enough for real time; settings that aren't named are the defaults.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Protocol

from polaris_nl.execution.backend import Command, SendGoal
from polaris_nl.execution.events import (
    CheckpointReached,
    Deviated,
    Event,
    GoalConfirmed,
    GoalSent,
    Halted,
    Recovered,
    Replanned,
    RunEnded,
    RunStarted,
    Skipped,
    TransitionTaken,
    Waiting,
)
from polaris_nl.execution.faults import Fault, FaultKind
from polaris_nl.execution.state import HumanCommand
from polaris_nl.model.formula import Literal, parse_literal
from tests.execution.story import Case

WATCH_S = 3.0
"""Seconds for which odometry is watched after a run."""
SETTLING_S = 0.35
"""Seconds after a run's end in which a real robot's odometry may still show its last movement."""
RESTART = "restart"
DISK_FULL = "disk-full"


@dataclass(frozen=True)
class Cue:
    """A moment of a run: some seconds after the nth event of a kind, or before the start.

    Attributes:
        event: the kind; None is before the start.
        about: a text that its action, transition or checkpoint contains.
    """

    event: type[Event] | None
    about: str = ""
    nth: int = 1
    delay_s: float = 0.4

    def fits(self, event: Event) -> bool:
        """Whether an event is of the kind."""
        if self.event is None or not isinstance(event, self.event):
            return False
        told = (getattr(event, x, "") for x in ("action", "target", "name", "after"))
        return not self.about or any(self.about in str(x) for x in told)


@dataclass(frozen=True)
class Happening:
    """What happens at a cue: a fault, a command, `RESTART` or `DISK_FULL`."""

    cue: Cue
    what: Fault | HumanCommand | str


@dataclass(frozen=True)
class Scenario:
    """One thing that goes wrong, or several, and what is expected.

    Attributes:
        program: the name of a case of `conftest.contract_cases`.
        outcome: `done`, `halted`, `stopped` or `refused` (before the start).
        says: a pattern that the last sentence has to contain.
        people: what people prefer to do, as in `RunOrder`.
        settings: of the run.
        shows: kinds of events that have to occur; hides: those that mustn't.
        unable: operators that the robot has no skill for.
    """

    name: str
    program: str
    happenings: tuple[Happening, ...]
    outcome: str
    says: str = ""
    people: tuple[str, ...] | None = None
    settings: Mapping[str, float] = field(default_factory=dict)
    shows: tuple[type[Event], ...] = ()
    hides: tuple[type[Event], ...] = ()
    unable: tuple[str, ...] = ()

    @property
    def kinds(self) -> set[str]:
        """What has to be injected."""
        whats = (h.what for h in self.happenings)
        return {
            w.kind if isinstance(w, Fault) else w for w in whats if not isinstance(w, HumanCommand)
        }


@dataclass
class Ran:
    """A scenario that was carried out. All times are of the run's clock, in seconds.

    Attributes:
        outcome: as `RunResult.outcome`, or `refused`.
        reason: the last sentence: the run's, or the refusal's.
        events: all that the sink was given, of both runs where there was a restart.
        logged: what the logs hold.
        commands: what the robot was commanded, and when.
        moved_at: when odometry showed motion, until `WATCH_S` after the end.
        failure: what was said about a log that couldn't be written, or "".
    """

    outcome: str
    reason: str
    events: list[Event]
    logged: list[Event]
    commands: list[tuple[float, Command]]
    moved_at: list[float]
    failure: str = ""


class Harness(Protocol):
    """Carries scenarios out on one back end; see the top of this module."""

    name: str
    cannot: Mapping[str, str]

    def carry_out(self, scenario: Scenario, case: Case, folder: Path) -> Ran:
        """Carries a scenario out, with logs in a folder."""
        ...


# What has to hold


def check(scenario: Scenario, ran: Ran) -> None:
    """Checks what was expected, and what holds always."""
    assert ran.outcome == scenario.outcome, ran.reason
    assert re.search(scenario.says, ran.reason, re.IGNORECASE), ran.reason
    _check_sentence(ran.reason)
    if scenario.outcome == "refused":
        assert ran.commands == []
        assert ran.events == []
        return
    kinds = {type(e) for e in ran.events}
    assert set(scenario.shows) <= kinds
    assert kinds.isdisjoint(scenario.hides)
    _check_log(scenario, ran)
    check_always(ran)


def check_always(ran: Ran) -> None:
    """Checks what holds whatever goes wrong: stillness after the end, and nothing is done twice."""
    _check_stillness(ran)
    _check_nothing_again(ran)


def _check_sentence(text: str) -> None:
    assert text[0].isupper()
    assert text.endswith(".")
    assert not re.search(
        r"(?i)\b(node|topic|action server|rclpy|ros|sas|heuristic|pddl|none)\b", text
    )


def _check_log(scenario: Scenario, ran: Ran) -> None:
    if DISK_FULL in scenario.kinds:
        assert ran.failure
        assert ran.logged
        assert ran.logged == ran.events[: len(ran.logged)]
    else:
        assert ran.failure == ""
        assert ran.logged == ran.events


def _check_stillness(ran: Ran) -> None:
    (ended,) = (e for e in ran.events if isinstance(e, RunEnded))
    ending = next((e.time for e in ran.events if isinstance(e, Halted)), ended.time)
    assert [at for at, c in ran.commands if isinstance(c, SendGoal) and at > ending] == []
    assert [at for at in ran.moved_at if at > ended.time + SETTLING_S] == []


def _check_nothing_again(ran: Ran) -> None:
    numbers = [c.goal for _, c in ran.commands if isinstance(c, SendGoal)]
    assert numbers == sorted(set(numbers))
    names = [e.checkpoint for e in ran.events if isinstance(e, CheckpointReached)]
    assert len(names) == len(set(names))
    left: int | None = None
    for event in ran.events:
        if isinstance(event, TransitionTaken) or (isinstance(event, Replanned) and event.segment):
            left = None  # On a new way, a thing that was moved back has to be fetched again.
        elif isinstance(event, GoalSent):
            assert left in (None, len(event.plan)), f"{event.action} is of what was done before"
            left = len(event.plan)
        elif isinstance(event, GoalConfirmed | Skipped) and left is not None:
            left -= 1 if isinstance(event, GoalConfirmed) else len(event.actions)


# Scenarios


def _literals(*texts: str) -> tuple[Literal, ...]:
    return tuple(map(parse_literal, texts))


def _fault(kind: FaultKind, *texts: str, times: int = 1, seconds: float = 0.0) -> Fault:
    return Fault(0.0, kind, times, seconds, _literals(*texts))


def _at(cue: Cue, *whats: Fault | HumanCommand | str) -> tuple[Happening, ...]:
    return tuple(Happening(cue, what) for what in whats)


BEFORE = Cue(None)
MOVING = Cue(GoalSent, "(move hall cafeteria)")
"""On the way, in the middle of a goal."""
FETCHING = Cue(GoalSent, "(move hall cafeteria)", delay_s=0.1)
WAITING = Cue(Waiting)
ALERTED = Cue(CheckpointReached, delay_s=0.0)
MOVED_TRAY = _fault("event", "(at tray dining-table)")
SILENT = r"gone silent"

SCENARIOS = (
    # 1, 2: the driver
    Scenario("driver killed", "serve", _at(MOVING, _fault("vanish")), "halted", SILENT),
    Scenario("driver frozen, then goes on", "serve", _at(MOVING, _fault("freeze", seconds=2.5)),
             "halted", SILENT),
    Scenario("driver hiccups", "serve", _at(MOVING, _fault("freeze", seconds=0.2)), "done",
             hides=(Halted,)),
    # 3: run-stop
    Scenario("run-stop pressed", "serve", _at(MOVING, _fault("runstopped")), "halted", "run-stop"),
    Scenario("run-stop pressed and released", "serve",
             _at(MOVING, _fault("runstopped", seconds=1.0)), "halted", "run-stop"),
    # 4: rejection
    Scenario("goal rejected", "serve", _at(FETCHING, _fault("reject")), "halted", "refused to .*, because"),
    Scenario("wrong mode", "serve", _at(MOVING, _fault("mode")), "halted", "mode"),
    Scenario("goal never accepted", "serve", _at(FETCHING, _fault("mute")), "halted", "doesn't answer"),
    # 5: without end
    Scenario("goal never ends", "serve", _at(FETCHING, _fault("never")), "halted", "took too long to",
             settings={"goal_s": 15.0}),
    # 6, 7: reports
    Scenario("a lie", "serve", _at(FETCHING, _fault("lie")), "done", shows=(Deviated,)),
    Scenario("nothing but lies", "serve", _at(FETCHING, _fault("lie", times=99)), "halted",
             "I expected that .*, but I see", settings={"grace_s": 4.0}),
    Scenario("a failure", "serve", _at(FETCHING, _fault("fail")), "done"),
    Scenario("nothing but failures", "serve", _at(FETCHING, _fault("fail", times=99)), "halted",
             "couldn't .*, because"),
    Scenario("late success after a failure", "serve", _at(FETCHING, _fault("late")), "done"),
    # 8: objects
    Scenario("object moved elsewhere", "serve", _at(MOVING, MOVED_TRAY), "done",
             shows=(Deviated, Replanned), hides=(Halted,)),
    Scenario("object removed", "serve", _at(MOVING, _fault("event", "(not (at tray empty-trays))")),
             "halted", "nothing of it", settings={"grace_s": 4.0}),
    Scenario("help on the way", "serve", _at(MOVING, _fault("event", "(at tray table)", "(is-full tray)")),
             "done", shows=(Skipped,), hides=(Deviated,)),
    Scenario("forgotten wait", "hasty", (), "halted",
             "I expected that the cup is on the countertop, but I see that the cup is on the drying rack",
             settings={"grace_s": 4.0}, hides=(Replanned,)),
    Scenario("forgotten wait, put back in time", "hasty",
             _at(Cue(Deviated, delay_s=2.0), _fault("event", "(at cup countertop)", "(at plate countertop)")),
             "done", settings={"grace_s": 4.0}, shows=(Recovered,), hides=(Halted,)),
    Scenario("forgotten wait, put back too late", "hasty",
             _at(Cue(Deviated, delay_s=5.0), _fault("event", "(at cup countertop)", "(at plate countertop)")),
             "halted", "the cup is on the countertop", settings={"grace_s": 4.0}),
    # 9: perception
    Scenario("nothing seen for a while", "serve", _at(MOVING, _fault("blind", seconds=6.0)), "done"),
    Scenario("nothing seen any more", "serve", _at(MOVING, _fault("blind")), "halted",
             settings={"goal_s": 15.0, "grace_s": 4.0}),
    Scenario("what is waited for flickers", "lunch",
             _at(WAITING, _fault("flicker", "(acknowledged lunchtime)", seconds=3.0)), "halted",
             "it didn't happen", people=(), settings={"wait_s": 6.0}),
    Scenario("old stamps for a while", "serve", _at(MOVING, _fault("stale", seconds=4.0)), "done"),
    Scenario("old stamps for ever", "serve", _at(MOVING, _fault("stale")), "halted",
             settings={"goal_s": 15.0, "grace_s": 4.0}),
    # 10: stopping
    Scenario("cancel ignored", "serve",
             (*_at(BEFORE, _fault("ignore-cancel", times=9)), *_at(MOVING, HumanCommand("stop"))),
             "stopped", "You stopped the run"),
    Scenario("slow to stop", "serve",
             (*_at(BEFORE, _fault("slow-stop", seconds=0.3)), *_at(MOVING, HumanCommand("stop"))),
             "stopped", "You stopped the run"),
    Scenario("only the run-stop stops it", "serve",
             (*_at(BEFORE, _fault("runaway")), *_at(MOVING, HumanCommand("stop"))),
             "stopped", "I used its run-stop"),
    # 11: conditionals
    Scenario("nobody answers", "lunch", (), "halted", "I waited 6 seconds, but it didn't happen that",
             people=(), settings={"wait_s": 6.0}, shows=(Waiting,)),
    Scenario("contradictory answers", "lunch",
             _at(WAITING, _fault("contradict", "(acknowledged lunchtime)", "(dismissed lunchtime)")),
             "halted", "still can't tell whether", people=(), settings={"wait_s": 6.0}),
    Scenario("an answer for a moment only", "lunch",
             _at(WAITING, _fault("blink", "(acknowledged lunchtime)")), "halted", "it didn't happen",
             people=(), settings={"wait_s": 6.0}),
    Scenario("an answer by word of mouth", "lunch",
             _at(WAITING, HumanCommand("happened", _literals("(dismissed lunchtime)"), "voice")), "done",
             people=()),
    # 12: the executor's own machine
    Scenario("disk full", "serve", _at(MOVING, DISK_FULL), "done"),
    Scenario("executor killed in the middle of a goal", "serve", _at(MOVING, RESTART), "done",
             shows=(RunStarted,)),
    Scenario("executor killed while waiting", "lunch", _at(Cue(Waiting, delay_s=0.2), RESTART), "done"),
    Scenario("executor killed at a checkpoint", "lunch", _at(ALERTED, RESTART), "done"),
    Scenario("executor killed twice", "lunch",
             (*_at(Cue(Waiting, delay_s=0.2), RESTART), *_at(Cue(GoalSent, "pick"), RESTART)), "done"),
    # Also
    Scenario("not homed, before the start", "serve", _at(BEFORE, _fault("unhomed")), "refused", "home it"),
    Scenario("run-stopped, before the start", "serve", _at(BEFORE, _fault("runstopped")), "refused",
             "run-stop"),
    Scenario("battery low, before the start", "serve", _at(BEFORE, _fault("battery")), "refused", "battery"),
    Scenario("no skill", "serve", (), "refused", r"no skill to fill .*\(fill\)", unable=("fill",)),
    Scenario("not homed any more", "serve", _at(MOVING, _fault("unhomed")), "halted", "home it"),
    Scenario("battery low", "serve", _at(MOVING, _fault("battery")), "halted", "battery"),
    Scenario("two servers on one name", "serve", _at(MOVING, _fault("duplicate")), "halted",
             "two programs"),
    Scenario("clock jump", "serve", _at(MOVING, _fault("clock")), "halted", "clock"),
    Scenario("unwell while waiting", "lunch", _at(WAITING, _fault("battery")), "halted", "battery",
             people=()),
    Scenario("stopped while waiting", "lunch", _at(WAITING, HumanCommand("stop")), "stopped",
             "You stopped the run", people=()),
    Scenario("paused and resumed", "serve",
             (*_at(MOVING, HumanCommand("pause")), *_at(Cue(GoalSent, "(move hall cafeteria)", delay_s=3.0),
                                                        HumanCommand("resume"))), "done"),
    Scenario("paused and forgotten", "serve", _at(MOVING, HumanCommand("pause")), "halted",
             "nobody said resume", settings={"pause_s": 3.0}),
    Scenario("paused, and then unwell", "serve",
             (*_at(MOVING, HumanCommand("pause")),
              *_at(Cue(GoalSent, "(move hall cafeteria)", delay_s=2.0), _fault("runstopped"))),
             "halted", "run-stop"),
)  # fmt: skip
"""The suite. Names are unique; each fault of the facts' list occurs."""
