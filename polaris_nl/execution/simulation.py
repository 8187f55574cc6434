"""The in-process world: a robot that plans its own way to each goal, and people who do as the world says.

Seeded and without a clock of its own, so that a run is the same every time. Faults can be
scheduled: it is the test double of the executor as well as the robot of `run --robot world`.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field

from polaris_nl.execution.backend import (
    CancelGoal,
    Command,
    Observation,
    Report,
    SendGoal,
    StopRobot,
)
from polaris_nl.execution.events import Event, PersonActed
from polaris_nl.model.domain import Action
from polaris_nl.model.evaluate import after, applicable
from polaris_nl.model.formula import Literal
from polaris_nl.model.state import Mutexes, State
from polaris_nl.model.text import sentence
from polaris_nl.model.world import HumanAction, World
from polaris_nl.planning.segments import SegmentResult

PlanTo = Callable[[State, Sequence[Literal]], SegmentResult]
"""Plans from a state to literals, as the robot does for each of its goals."""

ROBOT_PLAN_LIMIT = 6
"""Actions that the robot does by itself for one goal: a small perturbation, not another task."""


@dataclass(frozen=True, slots=True)
class Fault:
    """Something that goes wrong at a time.

    Attributes:
        at: seconds after the start.
        kind: `reject`, `never`, `lie`, `fail` (for the goals from then on, `times` of them),
            `blind` (perception is
            lost for `seconds`), `ignore-cancel`, or `event` (somebody makes `literals` true).
    """

    at: float
    kind: str
    times: int = 1
    seconds: float = 0.0
    literals: tuple[Literal, ...] = ()


@dataclass(frozen=True, slots=True)
class SimulationSettings:
    """How the simulated world behaves.

    Attributes:
        action_s: how long an action takes, by operator; `default` for the others.
        human_s: the shortest and longest time that a person takes to act, in seconds.
        people: names of human actions that people prefer, or None for whatever the world lists
            first.
        seed: makes the same run again.
    """

    action_s: Mapping[str, float] = field(default_factory=lambda: {"default": 2.0, "move": 4.0})
    human_s: tuple[float, float] = (1.0, 3.0)
    people: tuple[str, ...] | None = None
    seed: int = 0


@dataclass(slots=True)
class _Task:
    goal: SendGoal
    actions: list[Action]
    next_at: float
    lies: bool = False
    stuck: bool = False


class SimulatedRobot:
    """A robot in a simulated world.

    Args:
        world: the world, at its start.
        mutexes: what displaces what when people act.
        plan: the robot's own planning.
        settings: durations and people.
        faults: what goes wrong.
        sink: is given what people do.
        start: the time of the start, in seconds.
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
    ) -> None:
        self.state = world.initial
        self._world = world
        self._mutexes = mutexes
        self._plan = plan
        self._settings = settings or SimulationSettings()
        self._random = random.Random(self._settings.seed)
        self._faults = sorted(faults, key=lambda f: f.at)
        self._active: dict[str, int] = {}
        self._blind_until = start
        self._last_seen = world.initial
        self._sink = sink or (lambda event: None)
        self._start = self._now = start
        self._task: _Task | None = None
        self._reports: list[Report] = []
        self._people = _willing(world, self._settings.people, mutexes)
        self._acts_at: dict[str, float] = {}
        self._acted: set[str] = set()
        self.stopped = False
        self.motions: list[tuple[float, Action]] = []

    # The robot protocol

    def missing(self, actions: Iterable[Action]) -> tuple[str, ...]:
        """The operators that its world doesn't have."""
        named = dict.fromkeys(action.operator for action in actions)
        return tuple(name for name in named if name not in self._world.domain.operators)

    def advance(self, now: float) -> None:
        """Lets time pass: faults strike, the robot moves on, people act."""
        self._now = now
        while self._faults and self._start + self._faults[0].at <= now:
            self._strike(self._faults.pop(0))
        self._work()
        self._people_act()

    def command(self, command: Command) -> None:
        """Takes a goal, gives one up, or stops."""
        if isinstance(command, SendGoal):
            self._accept(command)
        elif isinstance(command, CancelGoal):
            if not self._take_fault("ignore-cancel") and self._task is not None:
                self._reports.append(Report(command.goal, "cancelled"))
                self._task = None
        elif isinstance(command, StopRobot):
            self._task = None
            self.stopped = True

    def observe(self) -> Observation:
        """What is perceived: everything, unless perception is lost."""
        if self._now < self._blind_until:
            return Observation(self._last_seen, self._last_seen.facts)
        self._last_seen = self.state
        return Observation(self.state)

    def reports(self) -> Sequence[Report]:
        """The reports since the last call."""
        reports, self._reports = self._reports, []
        return reports

    def close(self) -> None:
        """Nothing to let go of."""

    # The robot

    def _accept(self, goal: SendGoal) -> None:
        if self._take_fault("reject"):
            self._reports.append(Report(goal.goal, "rejected", "it is in the wrong mode"))
            return
        self._reports.append(Report(goal.goal, "accepted"))
        task = _Task(goal, [], self._now)
        task.stuck = self._take_fault("never")
        task.lies = self._take_fault("lie")
        if self._take_fault("fail"):
            self._reports.append(Report(goal.goal, "failed", "something slipped"))
            return
        if not task.stuck and not task.lies:
            result = self._plan(self.state, goal.literals)
            if result.status != "solved" or len(result.actions) > ROBOT_PLAN_LIMIT:
                self._reports.append(Report(goal.goal, "failed", "it found no way"))
                return
            task.actions = list(result.actions)
        self._task = task
        task.next_at = self._now + self._duration(task)

    def _duration(self, task: _Task) -> float:
        times = self._settings.action_s
        name = task.actions[0].operator if task.actions else "default"
        return times.get(name, times.get("default", 1.0))

    def _work(self) -> None:
        task = self._task
        if task is None or task.stuck or self._now < task.next_at:
            return
        if task.actions:
            action = task.actions.pop(0)
            operator = self._world.domain.operators[action.operator]
            if not applicable(action, operator, self.state, self._world):
                self._reports.append(
                    Report(task.goal.goal, "failed", "the world changed on the way")
                )
                self._task = None
                return
            self.state = after(action, operator, self.state, self._world)
            self.motions.append((self._now, action))
            task.next_at = self._now + self._duration(task)
        if not task.actions:
            self._reports.append(Report(task.goal.goal, "succeeded"))
            self._task = None

    # People

    def _people_act(self) -> None:
        for action in self._people:
            enabled = action.name not in self._acted and all(
                self.state.holds(x) for x in action.when
            )
            if not enabled:
                self._acts_at.pop(action.name, None)
                continue
            shortest, longest = self._settings.human_s
            at = self._acts_at.setdefault(
                action.name, self._now + self._random.uniform(shortest, longest)
            )
            if self._now >= at:
                self._acted.add(action.name)
                self._make_true(action.effect)
                text = sentence(f"a simulated person does this: {action.name}")
                effect = [str(x) for x in action.effect]
                self._sink(
                    PersonActed(time=self._now, text=text, action=action.name, effect=effect)
                )

    def _make_true(self, literals: Sequence[Literal]) -> None:
        self.state = self.state.after_event(literals, self._mutexes)

    # Faults

    def _strike(self, fault: Fault) -> None:
        if fault.kind == "event":
            self._make_true(fault.literals)
        elif fault.kind == "blind":
            self._blind_until = self._now + fault.seconds
        else:
            self._active[fault.kind] = self._active.get(fault.kind, 0) + fault.times

    def _take_fault(self, kind: str) -> bool:
        left = self._active.get(kind, 0)
        if left:
            self._active[kind] = left - 1
        return left > 0


def _willing(
    world: World, people: tuple[str, ...] | None, mutexes: Mutexes
) -> tuple[HumanAction, ...]:
    """The human actions that will be done: preferred ones, and of those that exclude each other the first."""
    actions = list(world.scenario.human_actions)
    if people is not None:
        preferred = [a for a in actions if a.name in people]
        actions = preferred + [a for a in actions if a.name not in people]
        if not people:
            return ()
    chosen: list[HumanAction] = []
    for action in actions:
        rivals = (other for other in chosen if _rivals(action, other, mutexes))
        if next(rivals, None) is None:
            chosen.append(action)
    return tuple(chosen)


def _rivals(a: HumanAction, b: HumanAction, mutexes: Mutexes) -> bool:
    return any(
        mutexes.exclusive(x, y) for x in a.effect for y in b.effect if x.positive and y.positive
    )
