"""One edit to an updated plan, beside unified-planning's own Fast Downward engine."""

from __future__ import annotations

import warnings
from collections.abc import Iterator

from bench.table import Row, timed
from bench.worlds import GOALS, chain, grown, with_leaf
from polaris_nl.automaton.automaton import Automaton
from polaris_nl.model.formula import parse_literal
from polaris_nl.planning.planner import Planner
from polaris_nl.planning.up_model import up_problem

SIZES = ((30, "p95 <= 60"), (100, "p95 <= 120"), (300, ""), (1000, "p95 <= 250"))
LARGE = 300


def rows() -> Iterator[Row]:
    """The rows about planning."""
    for size, aim in SIZES:
        yield _edit(size, aim)
    world = grown(40)
    program = chain(100)
    yield Row(
        "cold compile of 100 checkpoints",
        "<= 1500",
        timed(lambda: Planner(world).compile(program), 2),
    )
    planner = Planner(world)
    planner.compile(program)
    goals = [
        f"(at {o} {s})"
        for o in ("cup", "plate", "tray")
        for s in ("desk", "table", "worktop", "nightstand")
    ]
    times = [timed(lambda g=g: planner.compile(with_leaf(program, g)), 1)[0] for g in goals]  # type: ignore[misc]
    yield Row("edit at a leaf of 100 checkpoints", "p95 <= 60", times)


def _edit(size: int, aim: str) -> Row:
    world = grown(size)
    planner = Planner(world)
    goals = [g for g in GOALS if g != "(robot-at home)"]
    count = 3 if size <= LARGE else 1
    plans = [planner.compile(with_leaf(Automaton(), g)) for g in goals[:1]]
    times = [
        timed(lambda g=g: plans.append(planner.compile(with_leaf(Automaton(), g))), 1)[0]  # type: ignore[misc]
        for g in goals[1 : 1 + count]
    ]
    plain = [] if size > LARGE else _plain(world, goals[1 : 1 + min(count, 2)])
    undecided = sum(plan.status != "ok" for plan in plans)
    note = (
        f"{undecided} of {len(plans)} not decided in time: projection to what matters is still to come"
        if undecided
        else ""
    )
    return Row(
        f"one edit -> plan, {size} entities",
        aim,
        times,
        plain,
        "UP's Fast Downward engine",
        note=note,
    )


def _plain(world: object, goals: list[str]) -> list[float]:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        from unified_planning.shortcuts import OneshotPlanner, get_environment

        get_environment().credits_stream = None

        def solve(goal: str) -> None:
            problem = up_problem(world, world.initial, (parse_literal(goal),))  # type: ignore[attr-defined, arg-type]
            with OneshotPlanner(name="fast-downward-opt") as planner:
                planner.solve(problem)

        return [timed(lambda g=g: solve(g), 1)[0] for g in goals]  # type: ignore[misc]
