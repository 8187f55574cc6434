"""The in-process world: a robot that plans its own way to each goal, and people who do as the world says.

Seeded and without a clock of its own, so that a run is the same every time. Faults can be
scheduled: it is the test double of the executor as well as the robot of `run --robot world`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

from polaris_nl.execution.backend import (
    CancelGoal,
    Command,
    Observation,
    Report,
    RunStop,
    SendGoal,
)
from polaris_nl.execution.events import Event, PersonActed
from polaris_nl.execution.faults import Fault, Troubles
from polaris_nl.execution.goals import Act, Arrived, Lost, PlanTo, Pursuit
from polaris_nl.execution.simulated_people import People
from polaris_nl.execution.simulated_senses import Senses
from polaris_nl.execution.simulation_settings import SimulationSettings
from polaris_nl.model.domain import Action
from polaris_nl.model.evaluate import after, applicable
from polaris_nl.model.formula import Literal
from polaris_nl.model.state import Mutexes, State
from polaris_nl.model.text import sentence
from polaris_nl.model.world import World

LATE_S = 1.0
"""Seconds after a failure at which a late success is reported."""


@dataclass(slots=True)
class _Task:
    """A goal that the robot is at.

    Attributes:
        action: what it does at present, until `ends_at`.
        pretended: nothing is done: the goal never ends, or success is only said.
        says: what is reported at the end of a pretended task; "" for nothing.
    """

    goal: SendGoal
    pursuit: Pursuit
    action: Action | None = None
    ends_at: float = 0.0
    pretended: bool = False
    says: bool = False


class SimulatedRobot:
    """A robot in a simulated world.

    Args:
        world: the world.
        mutexes: what displaces what when people act.
        plan: the robot's own planning.
        settings: durations and people.
        faults: what goes wrong.
        sink: is given what people do.
        start: the time of the start, in seconds.
        state: what is so at the start; the world's own start by default.
        acted: what people have done before; each thing is done once.
    """

    name = "world"

    def __init__(
        self,
        world: World,
        mutexes: Mutexes,
        plan: PlanTo,
        settings: SimulationSettings | None = None,
        faults: Iterable[Fault] = (),
        sink: Callable[[Event], None] | None = None,
        start: float = 0.0,
        state: State | None = None,
        acted: Iterable[str] = (),
    ) -> None:
        self.state = state or world.initial
        self._world = world
        self._mutexes = mutexes
        self._plan = plan
        self._settings = how = settings or SimulationSettings()
        self._people = People(world, how.people, mutexes, how.human_s, how.seed, acted)
        self._senses = Senses(world, mutexes, start)
        self._troubles = Troubles(faults, start)
        self._sink = sink or (lambda event: None)
        self._start = self._now = start
        self._task: _Task | None = None
        self._stopping: float | None = None
        self._unread: list[Command] = []
        self._reports: list[Report] = []
        self._late: list[tuple[float, Report]] = []
        self.stopped = False
        self.run_stopped = False
        self.motions: list[tuple[float, Action]] = []
        self.moved_at: list[float] = []

    # The robot protocol

    def missing(self, actions: Iterable[Action]) -> tuple[str, ...]:
        """The operators that its world doesn't have, or that it was made without."""
        able = self._world.domain.operators.keys() - set(self._settings.unable)
        named = dict.fromkeys(action.operator for action in actions)
        return tuple(name for name in named if name not in able)

    def advance(self, now: float) -> None:
        """Lets time pass: faults strike, the robot moves on, people act."""
        self._now = now
        for fault in self._troubles.strike(now):
            self._strike(fault)
        if not self._gone:
            for command in self._unread:
                self._obey(command)
            self._unread.clear()
            self._work()
        for action in self._people.acting(lambda: self.state, now):
            self._make_true(action.effect)
            text = sentence(f"a simulated person does this: {action.name}")
            effect = [str(x) for x in action.effect]
            self._sink(PersonActed(time=now, text=text, action=action.name, effect=effect))

    def command(self, command: Command) -> None:
        """Takes a command; a frozen driver reads it when it goes on, a dead one never."""
        if self._gone:
            self._unread.append(command)
        else:
            self._obey(command)

    def observe(self) -> Observation:
        """What is perceived."""
        moving = self._moving
        if moving and (not self.moved_at or self.moved_at[-1] < self._now):
            self.moved_at.append(self._now)
        return self._senses.perceive(
            self.state, self._troubles, self._now, moving, silent=self._gone
        )

    def reports(self) -> Sequence[Report]:
        """The reports since the last call."""
        if self._gone:
            return ()
        reports, self._reports = self._reports, []
        return reports

    def close(self) -> None:
        """Nothing to let go of."""

    def suffer(self, fault: Fault) -> None:
        """Has something go wrong, `fault.at` seconds from now."""
        delayed = self._now - self._start + fault.at
        self._troubles.add(Fault(delayed, fault.kind, fault.times, fault.seconds, fault.literals))

    @property
    def _gone(self) -> bool:
        return bool(self._troubles.lasting("vanish", "freeze"))

    @property
    def _moving(self) -> bool:
        task = self._task
        return task is not None and (task.action is not None or task.pretended) and not self._gone

    # Commands

    def _obey(self, command: Command) -> None:
        if isinstance(command, SendGoal):
            self._accept(command)
        elif isinstance(command, RunStop):
            self.run_stopped = self.stopped = True
            self._give_up("cancelled", "its run-stop was used")
        elif isinstance(command, CancelGoal):
            if self._task is not None and not self._troubles.take("ignore-cancel"):
                self._stop_within(command.goal)
        else:
            self.stopped = True
            if self._task is not None:
                self._stop_within(self._task.goal.goal)

    def _stop_within(self, goal: int) -> None:
        if self._troubles.lasting("runaway"):
            return
        slow = self._troubles.lasting("slow-stop")
        if slow:
            self._stopping = self._stopping or self._now + max(f.seconds for f in slow)
        else:
            self._give_up("cancelled", "")

    def _give_up(self, kind: str, reason: str) -> None:
        if self._task is not None:
            self._report(self._task.goal.goal, kind, reason)
        self._task, self._stopping = None, None

    def _accept(self, goal: SendGoal) -> None:
        troubles = self._troubles
        if troubles.take("mute") or self.run_stopped:
            return
        if troubles.take("reject"):
            self._report(goal.goal, "rejected", "it is in the wrong mode")
            return
        self.stopped = False
        self._report(goal.goal, "accepted")
        if troubles.take("fail"):
            self._report(goal.goal, "failed", "something slipped")
            return
        if troubles.take("late"):
            self._report(goal.goal, "failed", "it took too long")
            self._late.append((self._now + LATE_S, Report(goal.goal, "succeeded")))
            return
        task = _Task(goal, Pursuit(goal, self._plan, self._world, self._settings.limits))
        stuck, lies = troubles.take("never"), troubles.take("lie")
        self._task = task
        if stuck or lies:
            task.pretended, task.says = True, not stuck
            task.ends_at = self._now + self._settings.duration(None)
        else:
            self._next(task)

    # Motion

    def _work(self) -> None:
        while self._late and self._late[0][0] <= self._now:
            self._reports.append(self._late.pop(0)[1])
        task = self._task
        if task is None:
            return
        if self._stopping is not None and self._now >= self._stopping:
            self._give_up("cancelled", "")
        elif self._troubles.lasting("runstopped"):
            self._give_up("failed", "its run-stop is pressed")
        elif self._now >= task.ends_at and (task.says or not task.pretended):
            self._finish(task)

    def _finish(self, task: _Task) -> None:
        if task.action is None:
            self._succeed(task)
            return
        operator = self._world.domain.operators[task.action.operator]
        if applicable(task.action, operator, self.state, self._world):
            self.state = after(task.action, operator, self.state, self._world)
            self.motions.append((self._now, task.action))
        self._next(task)

    def _next(self, task: _Task) -> None:
        """The next action of the robot's own way to its goal, from what is so by now."""
        found = task.pursuit.next(self.state)
        if isinstance(found, Lost):
            self._report(task.goal.goal, "failed", found.reason)
            self._task = None
        elif isinstance(found, Arrived) and task.action is not None:
            self._succeed(task)
        else:
            if isinstance(found, Act):
                if found.before is not None:
                    self._reports.append(
                        Report(
                            task.goal.goal,
                            "replanned",
                            "the world changed on the way",
                            found.before,
                            found.way,
                        )
                    )
                task.action = found.action
            task.ends_at = self._now + self._settings.duration(task.action)

    def _succeed(self, task: _Task) -> None:
        self._report(task.goal.goal, "succeeded")
        self._task = None

    def _report(self, goal: int, kind: str, reason: str = "") -> None:
        self._reports.append(Report(goal, kind, reason))  # type: ignore[arg-type] # kind is one of the kinds

    # The world

    def _strike(self, fault: Fault) -> None:
        if fault.kind == "event":
            self._make_true(fault.literals)
        elif fault.kind == "vanish":
            self._task = None  # Its motors have a watchdog of their own.

    def _make_true(self, literals: Sequence[Literal]) -> None:
        self.state = self.state.after_event(literals, self._mutexes)
