"""Carries a program out: the executor's core, a robot and a clock, until the run ends."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace

from polaris_nl.automaton.program import Program, program_json
from polaris_nl.execution.backend import Observation, Robot, StopRobot
from polaris_nl.execution.clock import Clock
from polaris_nl.execution.events import Event, Observed, RunEnded, RunStarted
from polaris_nl.execution.executor import step
from polaris_nl.execution.state import TERMINAL, ExecutorState, HumanCommand, Inputs, RunPlan
from polaris_nl.model.errors import RunError
from polaris_nl.model.evaluate import holds
from polaris_nl.model.state import State
from polaris_nl.model.world import Objective, World


@dataclass(frozen=True, slots=True)
class RunResult:
    """How a run ended.

    Attributes:
        outcome: `done`, `halted` or `stopped`.
        reason: one sentence.
        checkpoints: the names of the checkpoints reached, in order.
        seconds: how long it took.
        beliefs: what was perceived at the end.
    """

    outcome: str
    reason: str
    checkpoints: tuple[str, ...]
    seconds: float
    beliefs: State


def run(
    plan: RunPlan,
    robot: Robot,
    clock: Clock,
    *,
    confirmed: bool,
    sink: Callable[[Event], None],
    commands: Callable[[], Iterable[HumanCommand]] = tuple,
) -> RunResult:
    """Runs a program to its end.

    Args:
        plan: program, branching plan, world and settings.
        robot: who does it.
        clock: the time.
        confirmed: whether a person has said yes to this run, after hearing what it will do.
        sink: is given every event, in order.
        commands: asked at each step for what people have commanded since.

    Raises:
        RunError: there is no yes, or nothing that can be run.
    """
    if not confirmed:
        raise RunError("A run needs a clear yes, and there was none; say run, then yes.")
    if not plan.plan.segments:
        problem = plan.plan.problems[0].text if plan.plan.problems else "The program is empty."
        raise RunError(f"There is nothing to run. {problem}")
    started = clock.now()
    robot.advance(started)
    observation = robot.observe()
    world = plan.world
    program = program_json(Program(plan.automaton, world.domain.name, world.name))
    beliefs = [str(f) for f in sorted(observation.state.facts)]
    sink(
        RunStarted(
            time=started, text="The run starts.", robot=robot.name, program=program, beliefs=beliefs
        )
    )
    state = ExecutorState(since=started)
    ended: RunEnded | None = None
    try:
        while True:
            now = clock.now()
            robot.advance(now)
            observation = _observed(robot, observation, now, sink)
            inputs = Inputs(observation, tuple(robot.reports()), tuple(commands()))
            state, orders, events = step(plan, state, now, inputs)
            for order in orders:
                robot.command(order)
            for event in events:
                if isinstance(event, RunEnded):
                    event = ended = replace(event, seconds=round(now - started, 3))
                sink(event)
            if state.phase in TERMINAL:
                break
            clock.sleep(plan.settings.tick_s)
    except BaseException:
        # Whatever went wrong (a full disk, a key that interrupts), nothing moves without its executor.
        robot.command(StopRobot())
        raise
    assert ended is not None
    seconds = clock.now() - started
    return RunResult(
        ended.outcome, ended.reason, tuple(ended.checkpoints), seconds, observation.state
    )


def objectives_met(world: World, state: State) -> tuple[tuple[Objective, bool], ...]:
    """Which of the scenario's objectives hold in a state."""
    return tuple((o, holds(o.goal, state, world)) for o in world.scenario.objectives)


def _observed(
    robot: Robot, before: Observation, now: float, sink: Callable[[Event], None]
) -> Observation:
    observation = robot.observe()
    removed, added = before.state.difference(observation.state)
    stale = observation.unknown - before.unknown
    if removed or added or stale:
        sink(
            Observed(
                time=now,
                added=[str(x) for x in added],
                removed=[str(x) for x in removed],
                stale=[str(x) for x in sorted(stale)],
                source=robot.name,
            )
        )
    return observation
