"""Driving to a pose: a route over the floor, followed with velocities that only navigation mode heeds."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import pairwise

from polaris_nl.execution.ros.layout import Pose, wrapped
from polaris_nl.execution.ros.stretch_sim.floor import Floor

GOAL_TOLERANCE_M = 0.25
GOAL_TOLERANCE_RAD = 0.25
PROGRESS_S = 10.0
"""Without 5 cm or 3 degrees of progress in so many seconds it is given up."""
_NEAREST_M = 0.5
_PROGRESS = 0.05
_CLOSE_M = 0.06
_DRIFT_M = 0.15
_CLOSE_RAD = 0.06
_CORNER_M = 0.12
_LINEAR, _ANGULAR = 0.26, 0.8


@dataclass(slots=True)
class Navigation:
    """One goal under way.

    Attributes:
        route: points that are still ahead.
        state: `active`, `succeeded`, `aborted` or `canceled`.
        endless: it never ends by itself, and doesn't move.
    """

    goal: Pose
    route: list[tuple[float, float]] = field(default_factory=list)
    state: str = "active"
    reason: str = ""
    endless: bool = False
    elapsed: float = 0.0
    _progress_at: float = 0.0
    _best: Pose | None = None
    _there: bool = False

    def remaining(self, pose: Pose) -> float:
        """Metres still to go."""
        points = [(pose.x, pose.y), *self.route]
        return sum(math.dist(a, b) for a, b in pairwise(points))

    def abort(self, reason: str) -> None:
        """Gives it up."""
        if self.state == "active":
            self.state, self.reason = "aborted", reason

    def step(self, pose: Pose, seconds: float, drive: Callable[[float, float], bool]) -> None:
        """Lets time pass.

        Args:
            pose: where the base is.
            seconds: how long.
            drive: is given m/s and rad/s.
        """
        if self.state != "active" or self.endless:
            return
        self.elapsed += seconds
        self._watch(pose)
        while len(self.route) > 1 and pose.distance(*self.route[0]) < _CORNER_M:
            self.route.pop(0)
        linear, angular = self._velocity(pose)
        if linear == angular == 0.0:
            self.state = "succeeded"
        drive(linear, angular)

    def _velocity(self, pose: Pose) -> tuple[float, float]:
        x, y = self.route[0]
        distance = pose.distance(x, y)
        if len(self.route) == 1 and distance < (_DRIFT_M if self._there else _CLOSE_M):
            # While it turns the base drifts a little; that alone doesn't send it back.
            self._there = True
            error = wrapped(self.goal.yaw - pose.yaw)
            return 0.0, 0.0 if abs(error) < _CLOSE_RAD else _turn(error)
        self._there = False
        error = wrapped(math.atan2(y - pose.y, x - pose.x) - pose.yaw)
        if abs(error) > 0.35:
            return 0.0, _turn(error)
        slow = min(1.0, max(distance / 0.3, 0.2)) if len(self.route) == 1 else 1.0
        return _LINEAR * slow * math.cos(error) ** 2, max(-_ANGULAR, min(_ANGULAR, 2.0 * error))

    def _watch(self, pose: Pose) -> None:
        best = self._best
        if (
            best is None
            or best.distance(pose.x, pose.y) > _PROGRESS
            or abs(wrapped(pose.yaw - best.yaw)) > _PROGRESS
        ):
            self._best, self._progress_at = pose, self.elapsed
        elif self.elapsed - self._progress_at > PROGRESS_S:
            self.abort("the robot made no progress")


def begin(floor: Floor, pose: Pose, goal: Pose) -> Navigation:
    """Finds the way; a goal that can't be stood on is moved by up to half a metre."""
    navigation = Navigation(goal)
    target = floor.nearest(goal.x, goal.y, _NEAREST_M)
    if target is None:
        navigation.abort("the goal is in a wall or a piece of furniture")
        return navigation
    navigation.route = floor.route((pose.x, pose.y), target)
    if not navigation.route:
        navigation.abort("there is no way to the goal")
    return navigation


def _turn(error: float) -> float:
    return math.copysign(min(_ANGULAR, max(0.15, 1.8 * abs(error))), error)
