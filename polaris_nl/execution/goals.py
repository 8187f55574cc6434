"""The robot's own way to one goal, planned from what is perceived and planned anew when that changes.

The paper (Plan Execution): an action isn't sent as it is but as a goal, its end effects, so that the
robot can compute a new plan to them and is flexible to minor perturbations. Every back end pursues
its goals with a `Pursuit`: it is asked for the next action each time the robot is free. What is out of
place that the action itself names (the tray isn't where it is to be picked up) is no minor
perturbation: the goal is given up then, and the executor decides.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from polaris_nl.execution.backend import SendGoal
from polaris_nl.execution.expectations import needed_places
from polaris_nl.execution.shortcuts import shortcut
from polaris_nl.model.domain import Action
from polaris_nl.model.formula import Literal
from polaris_nl.model.state import State
from polaris_nl.model.world import World
from polaris_nl.planning.segments import SegmentResult
from polaris_nl.planning.simulate import Simulator

PlanTo = Callable[[State, Sequence[Literal], float], SegmentResult]
"""Plans from a state to literals within some seconds (`Planner.segment`)."""


@dataclass(frozen=True, slots=True)
class GoalLimits:
    """How far the robot goes by itself for one goal: a small perturbation, not another task.

    Attributes:
        actions: the most actions of one way.
        plans: how often the way may be planned.
        plan_s: how long planning may take each time, in seconds.
    """

    actions: int = 6
    plans: int = 6
    plan_s: float = 2.0


@dataclass(frozen=True, slots=True)
class Arrived:
    """The goal's literals are perceived."""


@dataclass(frozen=True, slots=True)
class Lost:
    """The goal is given up; `reason` is a clause to go after "because"."""

    reason: str


@dataclass(frozen=True, slots=True)
class Act:
    """The next action of the way.

    Attributes:
        way: all that is left of the way, this action first.
        before: what was left of the old way (at first, the action itself), where the way was planned
            anew; else None.
    """

    way: tuple[Action, ...]
    before: tuple[Action, ...] | None = None

    @property
    def action(self) -> Action:
        """What to do next."""
        return self.way[0]


class Pursuit:
    """The way to one goal.

    Deterministic for a deterministic planner; knows no clock and moves nothing.

    Args:
        goal: what is to be made true.
        plan: the planner.
        world: the world, for what actions need and do.
        limits: how far the robot goes by itself.
    """

    def __init__(
        self, goal: SendGoal, plan: PlanTo, world: World, limits: GoalLimits | None = None
    ) -> None:
        self.goal = goal
        self._plan = plan
        self._limits = limits or GoalLimits()
        operator = world.domain.operators[goal.action.operator]
        self._places = needed_places(goal.action, operator)
        self._simulator = Simulator(world)
        # Mostly the action itself can be done, and then there is nothing to plan.
        self._way: tuple[Action, ...] = (goal.action,)
        self._planned = 0

    def next(self, state: State) -> Act | Arrived | Lost:
        """What to do next, from what is perceived now.

        To be asked when the last action has ended, in whatever way, or when the perceived state has
        changed under it. An action is taken off the way when the rest leads to the goal without it,
        so nothing needs to be said about how the last one went.

        Args:
            state: what is believed to hold.
        """
        if all(map(state.holds, self.goal.literals)):
            return Arrived()
        if not all(map(state.holds, self._places)):
            return Lost("something isn't in its place any more")
        before = self._way
        at = shortcut(self._simulator, state, before, self.goal.literals)
        if at is not None:
            self._way = before[at:]
            return Act(self._way)
        found = self._planned_anew(state)
        if isinstance(found, Lost):
            return found
        self._way = found
        return Act(found, before)

    def _planned_anew(self, state: State) -> tuple[Action, ...] | Lost:
        if self._planned >= self._limits.plans:
            return Lost("things change faster than it can plan")
        self._planned += 1
        result = self._plan(state, self.goal.literals, self._limits.plan_s)
        if result.status == "undecided":
            return Lost("it found no way in time")
        if result.status != "solved" or not result.actions:
            return Lost("it found no way")
        if len(result.actions) > self._limits.actions:
            return Lost("the way is too long to be found out by itself")
        return result.actions
