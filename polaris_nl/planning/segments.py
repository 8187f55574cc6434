"""Plans from one state to some goals: a pure function, remembered."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Literal as OneOf

from polaris_nl.automaton.program import parse_action
from polaris_nl.model.domain import Action
from polaris_nl.model.errors import FormatError, PlanningError
from polaris_nl.model.evaluate import holds
from polaris_nl.model.formula import Formula, Literal
from polaris_nl.model.state import Mutexes, State
from polaris_nl.model.world import World
from polaris_nl.planning.budget import never
from polaris_nl.planning.costs import Extra
from polaris_nl.planning.grounding import Cancelled
from polaris_nl.planning.memory import Memory
from polaris_nl.planning.projection import Projection
from polaris_nl.planning.result import Step
from polaris_nl.planning.search import OPTIMAL, OPTIMAL_ANY, QUICK, search
from polaris_nl.planning.simulate import Simulator
from polaris_nl.planning.tasks import Tasks
from polaris_nl.planning.translate import END, Task

BUDGET_S = 5.0
"""How long one segment may take, in seconds: most of it for a shortest plan, the rest for any plan."""
SHORTEST_SHARE = 0.7
"""The part of a budget that is spent on a shortest plan."""
QUICK_S = 0.15
"""How long a shortest plan is looked for, in seconds, where any plan will do at first."""
MOST_FACTS = 2_000_000
"""Facts of all remembered states together; some 200 MB at the very most."""

Status = OneOf["solved", "unsolvable", "undecided", "cancelled"]
Key = tuple[State, frozenset[Formula]]


@dataclass(frozen=True, slots=True)
class SegmentResult:
    """A plan between two states, or why there is none.

    Attributes:
        optimal: no plan with fewer actions exists.
        reason: for `undecided`, what happened, in words.
        steps: what each action does to the whole world.
        sought_s: how long a shortest plan was looked for at most, in seconds.
    """

    status: Status
    actions: tuple[Action, ...] = ()
    optimal: bool = False
    reason: str = ""
    steps: tuple[Step, ...] = field(default=(), compare=False, repr=False)
    sought_s: float = field(default=0.0, compare=False)

    def settled(self, sought_s: float) -> bool:
        """Whether there is nothing to gain by looking for so many seconds."""
        if self.status == "undecided":
            return self.sought_s >= sought_s
        return self.status == "unsolvable" or self.optimal or self.sought_s >= sought_s


class Segments:
    """Plans segments in one world and remembers them.

    What is remembered is found by the whole state, and, where that is new, by the part of it that
    can matter: when things elsewhere have moved, nothing is planned again.

    Args:
        world: the world.
        mutexes: what excludes what in it; without, tasks are planned whole.
        extra: what decides between equally short plans.
    """

    def __init__(
        self, world: World, mutexes: Mutexes | None = None, extra: Extra | None = None
    ) -> None:
        self._world = world
        groups = mutexes.groups if mutexes else ()
        # What the domain only declares is not relied on.
        self._rules = Mutexes(tuple(g for g in groups if g not in world.domain.mutexes))
        self._projection = Projection(world, mutexes or Mutexes())
        self._tasks = Tasks(world, extra)
        self._simulator = Simulator(world)
        self._known: Memory[Key, SegmentResult] = Memory(MOST_FACTS, _weight)
        self._small: Memory[Key, SegmentResult] = Memory(MOST_FACTS, _weight)

    def solve(
        self,
        state: State,
        goals: Sequence[Formula],
        budget_s: float = BUDGET_S,
        cancelled: Callable[[], bool] = never,
        quick: bool = False,
    ) -> SegmentResult:
        """A plan from a state to goals; shortest, where that can be found within the budget.

        Args:
            state: where the segment starts.
            goals: closed formulas, all of which are to hold at its end.
            budget_s: the hard limit, in seconds.
            cancelled: asked now and then; True ends the work with status `cancelled`.
            quick: settles soon for any plan; asked again without, the same plan is returned, or a
                shorter one.
        """
        key = (state, frozenset(goals))
        sought_s = QUICK_S if quick else budget_s * SHORTEST_SHARE
        known = self._known.get(key)
        if known is not None and known.settled(sought_s) and (quick or known.status != "undecided"):
            return known
        if self._ruled_out(state, goals):
            return SegmentResult("unsolvable")
        result = self._plan(key, sorted(goals, key=str), budget_s, sought_s, cancelled)
        if result.status != "cancelled":
            self._known.put(key, result)
        return result

    def _ruled_out(self, state: State, goals: Sequence[Formula]) -> bool:
        """Whether two goals exclude each other, which a search may take long to find out."""
        literals = [g for g in goals if isinstance(g, Literal)]
        pairs = self._rules.pairs(literals)
        return any(not (state.holds(a) and state.holds(b)) for a, b in pairs)

    def known(self, state: State, goals: Sequence[Formula]) -> bool:
        """Whether `solve` would answer at once."""
        return self._known.get((state, frozenset(goals))) is not None

    def steps(
        self, state: State, goals: Sequence[Formula], actions: Sequence[Action]
    ) -> tuple[Step, ...] | None:
        """What actions do to the whole world; None where they can't be done or miss a goal."""
        steps = self._simulator.run(state, actions)
        if steps is None:
            return None
        end = steps[-1].state if steps else state
        return steps if all(holds(goal, end, self._world) for goal in goals) else None

    def _plan(
        self,
        key: Key,
        goals: Sequence[Formula],
        budget_s: float,
        sought_s: float,
        cancelled: Callable[[], bool],
    ) -> SegmentResult:
        state = key[0]
        deadline = time.monotonic() + budget_s
        try:
            world, start = self._projection.of(state, goals)
            small = (start, key[1])
            found = self._small.get(small)
            if found is None or not found.settled(sought_s):
                found = self._search(world, small, goals, deadline, sought_s, found, cancelled)
            checked = self._checked(state, goals, found)
            if checked is None and len(world.entities) < len(self._world.entities):
                # The part was not all that matters after all, so the whole world is planned in.
                task = self._tasks.of(self._world, state, goals, cancelled)
                found = self._attempts(task, deadline, sought_s, None, cancelled)
                checked = self._checked(state, goals, found)
            if checked is None:
                reason = "The plan that was found doesn't work; try again, or undo."
                return SegmentResult("undecided", reason=reason)
            if checked.status == "undecided":
                reason = (
                    f"No plan was found in {budget_s:g} seconds, and none was ruled out; try again, or"
                    f" split the step in two."
                )
                return replace(checked, reason=checked.reason or reason)
            return checked
        except Cancelled:
            return SegmentResult("cancelled")
        except (PlanningError, FormatError) as error:
            return SegmentResult("undecided", reason=str(error))

    def _search(
        self,
        world: World,
        small: Key,
        goals: Sequence[Formula],
        deadline: float,
        sought_s: float,
        before: SegmentResult | None,
        cancelled: Callable[[], bool],
    ) -> SegmentResult:
        task = self._tasks.of(world, small[0], goals, cancelled)
        found = self._attempts(task, deadline, sought_s, before, cancelled)
        # Only what is certain is remembered: an undecided segment may be decided next time.
        if found.status in ("solved", "unsolvable"):
            self._small.put(small, found)
        return found

    def _attempts(
        self,
        task: Task,
        deadline: float,
        sought_s: float,
        before: SegmentResult | None,
        cancelled: Callable[[], bool],
    ) -> SegmentResult:
        """Looks for a shortest plan, and, where there is none in time, for any.

        What is known before is kept unless there is a shorter plan, so that plans don't flicker.
        """
        if not task.sas:
            return SegmentResult("unsolvable", sought_s=sought_s)
        found = search(task.sas, OPTIMAL if task.plain else OPTIMAL_ANY, sought_s, cancelled)
        optimal = found.status == "solved"
        if found.status == "undecided":
            if before is not None and before.status == "solved":
                return replace(before, sought_s=sought_s)
            left = max(deadline - time.monotonic(), sought_s * 0.3)
            found = search(task.sas, QUICK, left, cancelled)
        actions = tuple(parse_action(text) for text in found.plan if text != f"({END})")
        if before is not None and optimal and len(before.actions) == len(actions):
            actions = before.actions
        return SegmentResult(found.status, actions, optimal, found.reason, sought_s=sought_s)

    def _checked(
        self, state: State, goals: Sequence[Formula], found: SegmentResult
    ) -> SegmentResult | None:
        """The result with what its actions do to the whole world; None where they don't work there."""
        if found.status != "solved":
            return found
        steps = self.steps(state, goals, found.actions)
        return None if steps is None else replace(found, steps=steps)


def _weight(key: Key, result: SegmentResult) -> int:
    """The facts that a memory keeps alive, most of them in the states."""
    return 50 + len(key[0].facts) * (1 + len(result.steps))
