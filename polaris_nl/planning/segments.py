"""Plans from one state to some goals: a pure function, remembered."""

from __future__ import annotations

import time
from collections import OrderedDict
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from threading import Lock
from typing import Literal as OneOf

from polaris_nl.automaton.program import parse_action
from polaris_nl.model.domain import Action
from polaris_nl.model.errors import PlanningError
from polaris_nl.model.formula import Formula
from polaris_nl.model.state import Mutexes, State
from polaris_nl.model.world import World
from polaris_nl.planning.pddl_text import domain_text, problem_text
from polaris_nl.planning.projection import Projection
from polaris_nl.planning.search import OPTIMAL, OPTIMAL_ANY, QUICK, Found, search
from polaris_nl.planning.translate import Task, translate

BUDGET_S = 5.0
"""How long one segment may take, in seconds: most of it for a shortest plan, the rest for any plan."""
MEMORY = 5_000
"""Segments that are remembered."""

Status = OneOf["solved", "unsolvable", "undecided", "cancelled"]


def never() -> bool:
    """The answer to "is this cancelled?" where nothing cancels."""
    return False


@dataclass(frozen=True, slots=True)
class SegmentResult:
    """A plan between two states, or why there is none.

    Attributes:
        optimal: no plan with fewer actions exists.
        reason: for `undecided`, what happened, in words.
    """

    status: Status
    actions: tuple[Action, ...] = ()
    optimal: bool = False
    reason: str = ""


class Segments:
    """Plans segments in one world and remembers them.

    Args:
        world: the world.
        mutexes: what excludes what in it; without, tasks are planned whole.
    """

    def __init__(self, world: World, mutexes: Mutexes | None = None) -> None:
        self._projection = Projection(world, mutexes or Mutexes())
        self._domain = domain_text(world.domain)
        self._known: OrderedDict[tuple[State, frozenset[Formula]], SegmentResult] = OrderedDict()
        self._lock = Lock()

    def solve(
        self,
        state: State,
        goals: Sequence[Formula],
        budget_s: float = BUDGET_S,
        cancelled: Callable[[], bool] = never,
    ) -> SegmentResult:
        """A plan from a state to goals; shortest, where that can be found within the budget.

        Args:
            state: where the segment starts.
            goals: closed formulas, all of which are to hold at its end.
            budget_s: the hard limit, in seconds.
            cancelled: asked now and then; True ends the work with status `cancelled`.
        """
        key = (state, frozenset(goals))
        with self._lock:
            known = self._known.get(key)
            if known is not None:
                self._known.move_to_end(key)
                return known
        result = self._plan(state, sorted(goals, key=str), budget_s, cancelled)
        # Only what is certain is remembered: an undecided segment may be decided next time.
        if result.status in ("solved", "unsolvable"):
            with self._lock:
                self._known[key] = result
                while len(self._known) > MEMORY:
                    self._known.popitem(last=False)
        return result

    def _plan(
        self, state: State, goals: Sequence[Formula], budget_s: float, cancelled: Callable[[], bool]
    ) -> SegmentResult:
        deadline = time.monotonic() + budget_s
        try:
            world, start = self._projection.of(state, goals)
            task = translate(self._domain, problem_text(world, start, goals))
            if not task.sas:
                return SegmentResult("unsolvable")
            return self._search(task, budget_s, deadline, cancelled)
        except PlanningError as error:
            return SegmentResult("undecided", reason=str(error))

    def _search(
        self, task: Task, budget_s: float, deadline: float, cancelled: Callable[[], bool]
    ) -> SegmentResult:
        found = search(task.sas, OPTIMAL if task.plain else OPTIMAL_ANY, budget_s * 0.7, cancelled)
        optimal = found.status == "solved"
        if found.status == "undecided":
            left = max(deadline - time.monotonic(), budget_s * 0.2)
            found = search(task.sas, QUICK, left, cancelled)
        return _result(found, optimal, budget_s)


def _result(found: Found, optimal: bool, budget_s: float) -> SegmentResult:
    if found.status == "undecided":
        reason = f"No plan was found in {budget_s:g} seconds, and none was ruled out."
        return SegmentResult("undecided", reason=reason)
    return SegmentResult(found.status, tuple(parse_action(text) for text in found.plan), optimal)
