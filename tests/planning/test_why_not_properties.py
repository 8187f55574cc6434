"""Causes and conflicting sets of random goals, against every state that can be reached at all."""

from __future__ import annotations

import itertools
from collections.abc import Iterable
from functools import cache
from pathlib import Path

from hypothesis import given, settings
from hypothesis import strategies as st

from polaris_nl.automaton.automaton import Automaton, Checkpoint, Transition
from polaris_nl.automaton.edits import apply_all
from polaris_nl.model.domain import Action
from polaris_nl.model.evaluate import after, applicable
from polaris_nl.model.formula import Literal, parse_literal
from polaris_nl.model.state import State
from polaris_nl.model.world import World
from polaris_nl.model.world_file import read_world
from polaris_nl.planning.planner import Planner

FOLDER = Path(__file__).parent / "broken" / "worlds"
GOALS = {
    "two_hands.yaml": [
        *(f"(held {c}-ball)" for c in ("red", "blue", "green")),
        "(in red-ball left-hand)",
        "(in blue-ball left-hand)",
        "(free left-hand)",
        "(free right-hand)",
        "(on-floor red-ball)",
        "(not (on-floor blue-ball))",
    ],
    "shop.yaml": [
        *(f"(bought {w})" for w in ("tea", "cake", "milk", "wine")),
        "(robot-at home)",
        "(robot-at cellar)",
        "(robot-at island)",
        "(have dime)",
        "(have crown)",
        "(not (have penny))",
        "(way home island)",
    ],
}


@cache
def planner_of(name: str) -> Planner:
    return Planner(read_world(FOLDER / name))


@cache
def reachable(name: str) -> frozenset[State]:
    """Every state that some sequence of actions leads to, by trying all of them."""
    world = planner_of(name).world
    found = {world.initial}
    waiting = [world.initial]
    while waiting:
        state = waiting.pop()
        for action in every_action(world):
            operator = world.domain.operators[action.operator]
            if applicable(action, operator, state, world):
                following = after(action, operator, state, world)
                if following not in found:
                    found.add(following)
                    waiting.append(following)
    return frozenset(found)


def every_action(world: World) -> Iterable[Action]:
    for operator in world.domain.operators.values():
        fitting = [[e.name for e in world.of_type(*p.types)] for p in operator.parameters]
        for values in itertools.product(*fitting):
            yield Action(operator.name, values)


def conflicts(name: str, goals: tuple[Literal, ...]) -> set[frozenset[Literal]]:
    """The minimal sets of goals that hold in no reachable state."""
    found: set[frozenset[Literal]] = set()
    for size in range(1, len(goals) + 1):
        for some in map(frozenset, itertools.combinations(goals, size)):
            met = any(all(map(state.holds, some)) for state in reachable(name))
            if not met and not any(core < some for core in found):
                found.add(some)
    return found


CASES = st.sampled_from(sorted(GOALS)).flatmap(
    lambda name: st.tuples(
        st.just(name),
        st.lists(st.sampled_from(GOALS[name]), min_size=1, max_size=5, unique=True),
    )
)


@settings(max_examples=60, deadline=None)
@given(CASES)
def test_conflicts_are_those_of_an_exhaustive_search(case: tuple[str, list[str]]) -> None:
    name, texts = case
    goals = tuple(map(parse_literal, texts))
    planner = planner_of(name)
    automaton = Automaton().with_checkpoint(Checkpoint("c1", "x", goals))
    automaton = automaton.with_transition(Transition("t1", "c0", "c1"))
    plan = planner.compile(automaton)
    wanted = conflicts(name, goals)
    if not wanted:
        assert plan.status == "ok"
        return
    (problem,) = plan.problems
    told = {frozenset(core) for core in problem.cores}
    ruled_out = {
        frozenset(pair)
        for pair in itertools.combinations(goals, 2)
        if pair[0] == pair[1].negation
        or (all(g.positive for g in pair) and planner.mutexes.exclusive(*pair))
    }
    # Of two goals that a rule excludes, the pair is told even where one of them is out of reach.
    paired = {goal for pair in ruled_out for goal in pair}
    alone = {core for core in wanted if len(core) == 1 and core <= paired}
    assert told == (wanted - alone) | ruled_out
    assert problem.cause == ("conflict" if any(len(c) > 1 for c in told) else "unreachable")
    for repair in problem.repairs:
        mended = planner.compile(apply_all(automaton, repair.edits))
        assert mended.status == "ok", repair.text
