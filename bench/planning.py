"""Edits to updated plans, beside unified-planning's own Fast Downward engine.

What is timed on our side is from the edited program to the first whole plan, its warnings and its tree
included; what is improved afterwards is not. The plain way plans every checkpoint anew after each edit,
with the engine `fast-downward` of unified-planning, the states in between kept in step. Every plan is
checked by unified-planning's `SequentialPlanValidator` outside the timed part.
"""

from __future__ import annotations

import sys
import time
import warnings
from collections.abc import Iterator, Sequence

from bench.table import Row, timed
from bench.worlds import chain, goals, grown, tree, with_goal, with_leaf
from polaris_nl.automaton.automaton import START, Automaton
from polaris_nl.model.domain import Action
from polaris_nl.model.evaluate import after
from polaris_nl.model.formula import Literal
from polaris_nl.model.state import State
from polaris_nl.model.world import World
from polaris_nl.planning.planner import Planner
from polaris_nl.planning.result import BranchingPlan, Segment
from polaris_nl.planning.up_model import is_valid, up_problem

SIZES = ((10, ""), (30, "p95 <= 60"), (100, "p95 <= 120"), (300, ""), (1000, "p95 <= 250"))
LENGTHS = (5, 20, 100, 500)
HOME = 40
"""Entities of the shipped care home."""
MOST_PLAIN_ENTITIES = 300
MOST_PLAIN_LENGTH = 100
PLAIN = "UP's Fast Downward, whole program"
TOO_LONG = "the plain way is left out: one run takes more than 30 s"
EDITS = 12


class Measured:
    """A planner whose plans are all kept, to be checked when nothing is timed."""

    def __init__(self, world: World) -> None:
        self.world = world
        self.planner = Planner(world)
        self.segments: dict[tuple[State, tuple[Action, ...], tuple[Literal, ...]], Segment] = {}
        self.statuses: set[str] = set()

    def plan(self, program: Automaton) -> BranchingPlan:
        """The first whole plan of a program."""
        return next(d.plan for d in self.planner.drafts(program) if d.whole)

    def finish(self, program: Automaton) -> None:
        """Waits for all improvements of a program's plan."""
        for draft in self.planner.drafts(program):
            self.keep(draft.plan)

    def keep(self, plan: BranchingPlan) -> None:
        """Keeps a plan to be checked."""
        self.statuses.add(plan.status)
        for segment in plan.segments.values():
            self.segments[segment.before, segment.actions, segment.goals] = segment

    def times(self, programs: Sequence[Automaton]) -> list[float]:
        """How long each program's first whole plan takes, one edit after the other, in milliseconds."""
        found = []
        for program in programs:
            plans: list[BranchingPlan] = []
            found += timed(lambda p=program, k=plans: k.append(self.plan(p)), 1)
            self.keep(plans[0])
        return found

    def check(self) -> str:
        """Checks all plans and says so, for a row's note."""
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            wrong = sum(
                not is_valid(self.world, s.before, s.goals, s.actions)
                for s in self.segments.values()
            )
        optimal = sum(s.optimal for s in self.segments.values())
        count = len(self.segments)
        if wrong or self.statuses - {"ok", "undecided"}:
            raise SystemExit(f"bench: {wrong} of {count} segments are wrong; {self.statuses}")
        return f"{count} segments, all valid, {optimal} of them proven shortest"


def rows() -> Iterator[Row]:
    """The rows about planning."""
    for size, aim in SIZES:
        yield _edit(size, aim)
    world = grown(HOME)
    for shape, make in (("chain", chain), ("tree", tree)):
        for length in LENGTHS:
            yield from _program(world, f"{shape} of {length}", make(world, length), length)


def _edit(size: int, aim: str) -> Row:
    world = grown(size)
    measured = Measured(world)
    asked = goals(world, EDITS + 1)
    measured.finish(with_leaf(Automaton(), str(asked[0])))
    programs = [with_leaf(Automaton(), str(goal)) for goal in asked[1:]]
    times = measured.times(programs)
    note = measured.check()
    plain = []
    if size <= MOST_PLAIN_ENTITIES:
        plain = [_plainly(world, p) for p in programs[: 1 if size == MOST_PLAIN_ENTITIES else 3]]
    else:
        note = f"{note}; {TOO_LONG}"
    return Row(f"one edit -> plan, {size} entities", aim, times, plain, PLAIN, note=note)


def _program(world: World, what: str, program: Automaton, length: int) -> Iterator[Row]:
    aims = {"chain of 100": ("<= 1500", "p95 <= 60"), "tree of 100": ("<= 1500", "p95 <= 60")}
    cold, leaf = aims.get(what, ("", ""))
    plain = [] if length > MOST_PLAIN_LENGTH else [_plainly(world, program)]
    note = TOO_LONG if not plain else ""

    def row(name: str, aim: str, times: list[float], more: str = "") -> Row:
        told = "; ".join(x for x in (more, note) if x)
        return Row(f"{what} checkpoints, {name}", aim, times, plain, PLAIN, note=told)

    measured = Measured(world)
    times = measured.times([program])
    for _ in range(2):
        again = Measured(world)
        times += again.times([program])
        measured.segments.update(again.segments)
    yield row("cold compile", cold, times)
    measured.finish(program)
    fresh = goals(world, EDITS, seed=length + 7)
    leaves = [with_leaf(program, str(goal)) for goal in fresh]
    yield row("edit at a leaf", leaf, measured.times(leaves))
    middle = list(program.checkpoints)[(length + 1) // 2]
    yield row(
        "edit in the middle",
        "",
        measured.times([with_goal(program, middle, goal) for goal in fresh[: EDITS // 2]]),
    )
    root = program.children(START)[0]
    edited = [with_goal(program, root, goal) for goal in fresh[: EDITS // 2]]
    yield row("edit at the root", "", measured.times(edited))
    undone = []
    for one in edited:
        measured.plan(one)
        undone += measured.times([program])
    yield row("undo", "", undone, measured.check())


def _plainly(world: World, program: Automaton) -> float:
    """How long the plain way takes for a whole program, in milliseconds."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        from unified_planning.shortcuts import OneshotPlanner, get_environment

        get_environment().credits_stream = None
        mutexes = Planner(world).mutexes
        started = time.perf_counter()
        waiting = [(START, world.initial)]
        while waiting:
            checkpoint, state = waiting.pop()
            for transition in program.outgoing(checkpoint):
                before = state.after_event(transition.when, mutexes)
                wanted = program.checkpoints[transition.target].goals
                problem = up_problem(world, before, wanted)
                with OneshotPlanner(name="fast-downward") as planner:
                    plan = planner.solve(problem).plan
                if plan is None:
                    sys.stderr.write(f"the plain way found no plan for {transition.target}\n")
                    continue
                for step in plan.actions:
                    name = str(step.action.name).removeprefix("do ")
                    action = Action(name, tuple(str(p) for p in step.actual_parameters))
                    before = after(action, world.domain.operators[name], before, world)
                waiting.append((transition.target, before))
        return (time.perf_counter() - started) * 1000
