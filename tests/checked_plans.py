"""Every plan that a test makes is checked by another planner's own validator, and for being shortest.

Plans are caught where they leave the compiler and where single segments are planned, and checked once each
when the test that made them is over: by unified-planning's `SequentialPlanValidator`, and, where a
program's segment is said to be the shortest, by a blind search, if that can tell in a second.
"""

from __future__ import annotations

import threading
import warnings
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from polaris_nl.automaton.automaton import Automaton
from polaris_nl.model.domain import Action
from polaris_nl.model.errors import PlanningError
from polaris_nl.model.formula import Formula, Literal
from polaris_nl.model.state import State
from polaris_nl.model.world import World
from polaris_nl.planning import search as searching
from polaris_nl.planning.budget import never, within
from polaris_nl.planning.compile import Compiler
from polaris_nl.planning.pddl_text import domain_text, problem_text
from polaris_nl.planning.result import BranchingPlan
from polaris_nl.planning.search import OPTIMAL_ANY
from polaris_nl.planning.segments import SegmentResult, Segments
from polaris_nl.planning.translate import translate
from polaris_nl.planning.up_model import is_valid

BLIND_S = 1.0
MOST_DENIED = 3
"""Negative goals of which the translator, which counts combinations of what may hold instead, can tell."""
_search = searching.search  # As it is before any test puts something else in its place.


@dataclass(frozen=True)
class Made:
    """A plan that was made."""

    world: World = field(repr=False, hash=False)
    state: State = field(repr=False)
    goals: frozenset[Formula]
    actions: tuple[Action, ...]
    optimal: bool = False


class CheckedPlans:
    """Catches plans, and checks what it hasn't checked before."""

    def __init__(self) -> None:
        self._waiting: dict[Made, None] = {}
        self._checked: set[Made] = set()
        self._lock = threading.Lock()
        self.count = 0

    def watch(self, patch: Any) -> None:
        """Wraps the two places that plans come from."""
        solve, plan = Segments.solve, Compiler._plan

        def solved(it: Segments, state: State, goals: Sequence[Formula], *a: Any, **k: Any) -> Any:
            result: SegmentResult = solve(it, state, goals, *a, **k)
            if result.status == "solved":
                self._keep(Made(it._world, state, frozenset(goals), result.actions, result.optimal))
            return result

        def planned(it: Compiler, automaton: Automaton, *a: Any, **k: Any) -> BranchingPlan:
            whole: BranchingPlan = plan(it, automaton, *a, **k)
            for name, s in whole.segments.items():
                # Where the user insists on an action, that is what is shortest, and not its goals.
                shortest = s.optimal and automaton.checkpoints[name].action is None
                self._keep(Made(it._world, s.before, frozenset(s.goals), s.actions, shortest))
            return whole

        solved.__defaults__ = solve.__defaults__
        patch.setattr(Segments, "solve", solved)
        patch.setattr(Compiler, "_plan", planned)

    def faults(self) -> list[str]:
        """What is wrong with the plans made since the last call."""
        with self._lock:
            waiting = [made for made in self._waiting if made not in self._checked]
            self._waiting.clear()
        return [text for made in waiting for text in self._check(made)]

    def _keep(self, made: Made) -> None:
        with self._lock:
            self._waiting[made] = None

    def _check(self, made: Made) -> list[str]:
        self._checked.add(made)
        self.count += 1
        goals = sorted(made.goals, key=str)
        if not _valid(made, goals, made.actions):
            return [f"not valid: {made}"]
        if made.optimal:
            least = self._least(made, goals)
            if least is not None and least != len(made.actions):
                return [f"{least} actions are enough: {made}"]
        return []

    def _least(self, made: Made, goals: list[Formula]) -> int | None:
        if len(made.actions) < 2:  # Nothing is shorter than one action, but none.
            none_needed = not made.actions or _valid(made, goals, ())
            return 0 if none_needed else 1
        if sum(isinstance(g, Literal) and not g.positive for g in goals) > MOST_DENIED:
            return None
        text = problem_text(made.world, made.state, goals)
        try:
            task = translate(domain_text(made.world.domain), text, within(BLIND_S, never))
        except PlanningError:
            return None
        found = _search(task.sas, OPTIMAL_ANY, BLIND_S, never)
        return len(found.plan) if found.status == "solved" else None


def _valid(made: Made, goals: list[Formula], actions: tuple[Action, ...]) -> bool:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return is_valid(made.world, made.state, goals, actions)
