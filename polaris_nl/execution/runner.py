"""Carries a program out: the executor's core, a robot and a clock, until the run ends."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace

from polaris_nl.automaton.program import Program, program_json
from polaris_nl.execution.backend import Observation, Robot, RunStop, StopRobot, ZeroVelocity
from polaris_nl.execution.clock import Clock
from polaris_nl.execution.events import Event, Observed, RunEnded, RunStarted, Stepped
from polaris_nl.execution.executor import step
from polaris_nl.execution.inputs import Differences
from polaris_nl.execution.replanner import NoReplanner, Replanner
from polaris_nl.execution.replaying import segments_json
from polaris_nl.execution.resuming import ResumePoint, resumed_json
from polaris_nl.execution.state import (
    TERMINAL,
    ExecutorState,
    HumanCommand,
    Inputs,
    PlanRequest,
    RunPlan,
)
from polaris_nl.model.domain import Action
from polaris_nl.model.errors import RunError
from polaris_nl.model.evaluate import holds
from polaris_nl.model.state import State
from polaris_nl.model.text import listed
from polaris_nl.model.world import Objective, World


@dataclass(frozen=True, slots=True)
class RunResult:
    """How a run ended.

    Attributes:
        outcome: `done`, `halted` or `stopped`.
        reason: one sentence or two.
        checkpoints: the names of the checkpoints reached, in order, those of an earlier run that was
            resumed included.
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
    replanner: Replanner | None = None,
    resume: ResumePoint | None = None,
    record: Callable[[Stepped], object] = lambda step: None,
) -> RunResult:
    """Runs a program to its end.

    Args:
        plan: program, branching plan, world and settings.
        robot: who does it.
        clock: the time.
        confirmed: whether a person has said yes to this run, after hearing what it will do.
        sink: is given every event, in order.
        commands: asked at each step for what people have commanded since.
        replanner: plans the rest of a segment anew; without one, every deviation is left to people.
        resume: where an earlier run of the same program had come to.
        record: is given what each step was given, for replays.

    Raises:
        RunError: there is no yes, nothing that can be run, something that the robot has no skill for,
            or the robot isn't ready. Nothing has been commanded then.
    """
    _refuse(plan, robot, confirmed)
    started = clock.now()
    robot.advance(started)
    observation = robot.observe()
    if not observation.health.ready:
        raise RunError(f"The run doesn't start: {observation.health.words}.")
    state = replace(resume.state if resume else ExecutorState(), now=started, since=started)
    sink(_started(plan, robot, observation, resume, started))
    if resume is not None:
        robot.command(StopRobot())  # It may still be at the goal of an executor that is gone.
    differences = Differences(observation.state)
    going = _Going(
        plan, robot, clock, sink, commands, replanner or NoReplanner(), record, differences
    )
    return going.to_the_end(state, observation)


@dataclass(slots=True)
class _Going:
    """A run under way."""

    plan: RunPlan
    robot: Robot
    clock: Clock
    sink: Callable[[Event], None]
    commands: Callable[[], Iterable[HumanCommand]]
    replanner: Replanner
    record: Callable[[Stepped], object]
    differences: Differences

    def to_the_end(self, state: ExecutorState, observation: Observation) -> RunResult:
        """Steps until a terminal phase; whatever breaks the run leaves the robot standing."""
        started = state.now
        ended: RunEnded | None = None
        try:
            while True:
                now = self.clock.now()
                observation = self._observed(observation, now)
                asked = state.request
                inputs = self._inputs(observation)
                self.record(self.differences.record(now, inputs))
                state, orders, events = step(self.plan, state, now, inputs)
                for order in orders:
                    self.robot.command(order)
                if state.request is not None and state.request is not asked:
                    self._ask(state.request)
                for event in events:
                    if isinstance(event, RunEnded):
                        event = ended = replace(event, seconds=round(now - started, 3))
                    self.sink(event)
                if state.phase in TERMINAL:
                    break
                self.clock.sleep(self.plan.settings.tick_s)
        except BaseException:
            # Whatever went wrong (a full disk, a key that interrupts), nothing moves without its executor.
            self._abandon()
            raise
        assert ended is not None
        seconds = self.clock.now() - started
        return RunResult(
            ended.outcome, ended.reason, tuple(ended.checkpoints), seconds, observation.state
        )

    def _inputs(self, observation: Observation) -> Inputs:
        reports, commands = tuple(self.robot.reports()), tuple(self.commands())
        return Inputs(observation, reports, commands, self.replanner.answers())

    def _observed(self, before: Observation, now: float) -> Observation:
        """What is perceived now; what has changed since the step before is told."""
        self.robot.advance(now)
        found = self.robot.observe()
        removed, added = before.state.difference(found.state)
        stale = (found.state.facts - found.certain) - (before.state.facts - before.certain)
        health = found.health.kind if found.health != before.health else None
        if removed or added or stale or health:
            sources = {found.seen[x].source for x in (*added, *removed) if x in found.seen}
            self.sink(
                Observed(
                    time=now,
                    added=[str(x) for x in added],
                    removed=[str(x) for x in removed],
                    stale=[str(x) for x in sorted(stale)],
                    source=", ".join(sorted(sources)) or self.robot.name,
                    health=health,
                )
            )
        return found

    def _ask(self, request: PlanRequest) -> None:
        def able(actions: tuple[Action, ...]) -> bool:
            return not self.robot.missing(actions)

        self.replanner.ask(request, self.plan.settings.plan_s, able)

    def _abandon(self) -> None:
        """Stops the robot without the core, and uses its run-stop where that doesn't help."""
        self.robot.command(ZeroVelocity())
        self.robot.command(StopRobot())
        deadline = self.clock.now() + self.plan.settings.halt_s
        while self.clock.now() < deadline:
            self.clock.sleep(self.plan.settings.tick_s)
            self.robot.advance(self.clock.now())
            if self.robot.observe().moving is False:
                return
        self.robot.command(RunStop())


def objectives_met(world: World, state: State) -> tuple[tuple[Objective, bool], ...]:
    """Which of the scenario's objectives hold in a state."""
    return tuple((o, holds(o.goal, state, world)) for o in world.scenario.objectives)


def _refuse(plan: RunPlan, robot: Robot, confirmed: bool) -> None:
    if not confirmed:
        raise RunError("A run needs a clear yes, and there was none; say run, then yes.")
    if not plan.plan.segments:
        problem = plan.plan.problems[0].text if plan.plan.problems else "The program is empty."
        raise RunError(f"There is nothing to run. {problem}")
    actions = [a for s in plan.plan.segments.values() for a in s.actions]
    missing = robot.missing(actions)
    if missing:
        first = {a.operator: a for a in reversed(actions)}
        words = [f"{plan.wording.action(first[name])} ({name})" for name in missing]
        raise RunError(
            f"The run doesn't start: the robot {robot.name} has no skill to {listed(words, 'or to')}."
            " Change these steps, or use another robot."
        )


def _started(
    plan: RunPlan,
    robot: Robot,
    observation: Observation,
    resume: ResumePoint | None,
    now: float,
) -> RunStarted:
    program = program_json(Program(plan.automaton, plan.world.domain.name, plan.world.name))
    text = "The run starts."
    if resume is not None:
        text = f"The run goes on where it was interrupted: {_where(plan, resume.state)}."
    return RunStarted(
        time=now,
        text=text,
        robot=robot.name,
        program=program,
        beliefs=[str(f) for f in sorted(observation.state.facts)],
        resumed=resumed_json(resume) if resume is not None else {},
        segments=segments_json(plan.plan),
    )


def _where(plan: RunPlan, state: ExecutorState) -> str:
    checkpoints = plan.automaton.checkpoints
    if not state.segment:
        return f"at {checkpoints[state.checkpoint].name}"
    done, count = state.done_actions, len(state.actions)
    way = f"on the way to {checkpoints[state.segment].name}"
    return f"{way}, {done} of {count} actions done" if done else way
