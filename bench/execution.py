"""Steps of the executor, beside the plain way of carrying a plan out: planning anew at each tick.

All steps of whole runs in virtual time are timed, those with a new state, a help or a new plan to look at
included; the simulated world's own work isn't. What the executor doesn't do in a step is plan: that is
asked for, and timed by itself.
"""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import partial

from bench.table import Row, percentile, timed
from bench.worlds import grown
from polaris_nl.automaton.automaton import START, Automaton, Checkpoint, Transition
from polaris_nl.execution.clock import VirtualClock
from polaris_nl.execution.executor import step
from polaris_nl.execution.faults import Fault
from polaris_nl.execution.simulation import SimulatedRobot
from polaris_nl.execution.state import TERMINAL, ExecutorState, Inputs, PlanAnswer, RunPlan
from polaris_nl.model.formula import parse_literal
from polaris_nl.planning.planner import Planner

SIZES = (40, 300, 1000)
RUNS = 5
PLAIN = "planning anew at each tick"
HELP = Fault(30.0, "event", literals=(parse_literal("(is-full tray)"),))
MOVED = Fault(12.0, "event", literals=(parse_literal("(at tray table)"),))


@dataclass
class Timed:
    """What was timed, in milliseconds."""

    steps: list[float] = field(default_factory=list)
    plans: list[float] = field(default_factory=list)


def rows() -> Iterator[Row]:
    """The rows about execution."""
    for size in SIZES:
        planner = Planner(grown(size))
        program = lunch()
        plan = planner.compile(program)
        if plan.status != "ok":
            raise SystemExit(f"bench: {plan.problems[0].text}")
        run = RunPlan(program, plan, planner.world, planner.wording)
        found = Timed()
        for faults in ([], [HELP], [MOVED]) * RUNS:
            _carry_out(run, planner, faults, found)
        plain = _plainly(run)
        p99, most = percentile(found.steps, 99), max(found.steps)
        note = f"p99 {p99:.2f} ms, longest {most:.2f} ms of {len(found.steps)} steps"
        yield Row(
            f"executor step, {size} entities", "p99 <= 5", found.steps, plain, PLAIN, note=note
        )
        yield Row(f"rest of a segment anew, {size} entities", "", found.plans)


def _plainly(run: RunPlan) -> list[float]:
    """How long a plan takes from some states of the run, by a planner that has seen none of them."""
    segment = max(run.plan.segments.values(), key=lambda s: len(s.actions))
    planner = Planner(run.world)
    planner.segment(run.world.initial, (parse_literal("(robot-at hall)"),))
    states = [segment.before, *(x.state for x in segment.steps)][:5]
    return [timed(partial(planner.segment, state, segment.goals), 1)[0] for state in states]


def lunch() -> Automaton:
    """The paper's caregiving program, in the branch in which lunch is served."""
    automaton, before = Automaton(), START
    for number, (when, goals) in enumerate(
        (
            ((), ("(alerted-to resident lunchtime)",)),
            (("(acknowledged lunchtime)",), ("(at tray table)", "(is-full tray)")),
            ((), ("(robot-at home)",)),
        ),
        1,
    ):
        name = f"c{number}"
        wanted = tuple(map(parse_literal, goals))
        arrow = Transition(f"t{number}", before, name, tuple(map(parse_literal, when)))
        automaton = automaton.with_checkpoint(Checkpoint(name, name, wanted)).with_transition(arrow)
        before = name
    return automaton


def _carry_out(run: RunPlan, planner: Planner, faults: list[Fault], found: Timed) -> None:
    clock = VirtualClock()
    robot = SimulatedRobot(planner.world, planner.mutexes, planner.segment, faults=faults)
    state = ExecutorState()
    answers: tuple[PlanAnswer, ...] = ()
    while state.phase not in TERMINAL:
        robot.advance(clock.now())
        inputs = Inputs(robot.observe(), tuple(robot.reports()), plans=answers)
        before, started = state, time.perf_counter()
        state, commands, _ = step(run, state, clock.now(), inputs)
        found.steps.append((time.perf_counter() - started) * 1000)
        for command in commands:
            robot.command(command)
        answers, request = (), state.request
        if request is not None and request is not before.request:
            started = time.perf_counter()
            result = planner.segment(request.state, request.goals, run.settings.plan_s)
            found.plans.append((time.perf_counter() - started) * 1000)
            answers = (PlanAnswer(request.number, result.actions),)
        clock.sleep(run.settings.tick_s)
    if state.outcome != "done":
        raise SystemExit(f"bench: the run ended with: {state.why}")
