"""Runs in virtual time, and what can be asked of them."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from typing import TypeVar

from polaris_nl.automaton.automaton import START, Automaton, Checkpoint, Transition
from polaris_nl.execution.backend import Command, SendGoal
from polaris_nl.execution.clock import VirtualClock
from polaris_nl.execution.events import Event, StateChanged
from polaris_nl.execution.faults import Fault
from polaris_nl.execution.goals import GoalLimits
from polaris_nl.execution.replanner import InlineReplanner
from polaris_nl.execution.runner import RunResult, run
from polaris_nl.execution.settings import RunSettings
from polaris_nl.execution.simulation import SimulatedRobot
from polaris_nl.execution.simulation_settings import SimulationSettings
from polaris_nl.execution.state import HumanCommand, RunPlan
from polaris_nl.model.formula import Literal, parse_formula
from polaris_nl.model.world import World
from polaris_nl.planning.planner import Planner
from polaris_nl.planning.result import BranchingPlan

E = TypeVar("E", bound=Event)

T0 = 1000.0
"""When runs start, in virtual time."""
FULL_TRAY = ("(at tray table)", "(is-full tray)")


@dataclass(frozen=True)
class Case:
    """A program with its plan, ready to run."""

    automaton: Automaton
    plan: BranchingPlan
    planner: Planner

    @property
    def world(self) -> World:
        return self.planner.world

    def run_plan(self, **settings: float | None) -> RunPlan:
        patience = replace(RunSettings(), **settings)
        return RunPlan(self.automaton, self.plan, self.world, self.planner.wording, patience)


class SpiedRobot(SimulatedRobot):
    """The simulated robot; it also keeps what it was told to do, and when."""

    def __init__(self, case: Case, **kwargs: object) -> None:
        planner = case.planner
        super().__init__(planner.world, planner.mutexes, planner.segment, start=T0, **kwargs)
        self.commanded: list[tuple[float, Command]] = []

    def command(self, command: Command) -> None:
        self.commanded.append((self._now - T0, command))
        super().command(command)

    @property
    def sent(self) -> list[str]:
        return [str(c.action) for _, c in self.commanded if isinstance(c, SendGoal)]


@dataclass
class Told:
    """A run that is over."""

    result: RunResult
    robot: SpiedRobot
    events: list[Event] = field(repr=False)

    def of(self, kind: type[E]) -> list[E]:
        return [e for e in self.events if isinstance(e, kind)]

    @property
    def phases(self) -> list[str]:
        return [e.after for e in self.of(StateChanged)]

    def one(self, kind: type[E]) -> E:
        (found,) = self.of(kind)
        return found


class BoundedClock(VirtualClock):
    """Virtual time that ends, so that a run without an end fails instead of hanging."""

    def sleep(self, seconds: float) -> None:
        super().sleep(seconds)
        assert self.now() < T0 + 5000.0, "the run doesn't end"


Commands = Callable[[float], Iterable[HumanCommand]]
"""What people command, asked once a tick with the seconds since the start."""


def literal(text: str) -> Literal:
    parsed = parse_formula(text)
    assert isinstance(parsed, Literal)
    return parsed


def literals(*texts: str) -> tuple[Literal, ...]:
    return tuple(map(literal, texts))


def program(*steps: tuple[str, str, tuple[str, ...], tuple[str, ...]]) -> Automaton:
    """An automaton of steps (after which checkpoint, name, when, goals); ids are c1, c2, ... in order."""
    automaton = Automaton()
    ids = {"start": START}
    for number, (after, name, when, goals) in enumerate(steps, 1):
        ids[name] = f"c{number}"
        automaton = automaton.with_checkpoint(Checkpoint(f"c{number}", name, literals(*goals)))
        arrow = Transition(f"t{number}", ids[after], f"c{number}", literals(*when))
        automaton = automaton.with_transition(arrow)
    return automaton


def case(planner: Planner, *steps: tuple[str, str, tuple[str, ...], tuple[str, ...]]) -> Case:
    automaton = program(*steps)
    plan = planner.compile(automaton)
    assert plan.status == "ok", plan.problems
    return Case(automaton, plan, planner)


def carry_out(
    case: Case,
    *faults: Fault,
    people: tuple[str, ...] | None = None,
    commands: Commands = lambda seconds: (),
    seed: int = 0,
    human_s: tuple[float, float] = (1.0, 3.0),
    replans: bool = True,
    limits: GoalLimits = GoalLimits(),
    **settings: float | None,
) -> Told:
    """Runs a case in virtual time to its end."""
    events: list[Event] = []
    clock = BoundedClock(T0)
    how = SimulationSettings(people=people, seed=seed, human_s=human_s, limits=limits)
    robot = SpiedRobot(case, settings=how, faults=faults, sink=events.append)
    result = run(
        case.run_plan(**settings),
        robot,
        clock,
        confirmed=True,
        sink=events.append,
        commands=lambda: commands(clock.now() - T0),
        replanner=InlineReplanner(case.planner.segment) if replans else None,
    )
    return Told(result, robot, events)
