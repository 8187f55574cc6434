"""Trajectories of the arm and the base, as the driver's action carries them out."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise

from polaris_nl.execution.ros.layout import Pose, wrapped
from polaris_nl.execution.ros.stretch_sim.body import Body
from polaris_nl.execution.ros.stretch_sim.joints import BASE, JOINTS, ROTATE, TRANSLATE, known

POINT_TIMEOUT_S = 10.0
ARRIVED = 0.012
"""A joint this near to its target, in m or rad, has arrived; those in rad get twice as much."""
_BASE_SPEED = (0.25, 0.6)


@dataclass(frozen=True, slots=True)
class Waypoint:
    """Positions by the joints' order in the goal, and when they are due, in seconds from the start."""

    positions: tuple[float, ...]
    at_s: float = 0.0


@dataclass(frozen=True, slots=True)
class Step:
    """Where joints are to be, how far the base is to move (m) and turn (rad), and when."""

    joints: Mapping[str, float]
    translate: float = 0.0
    rotate: float = 0.0
    at_s: float = 0.0


@dataclass(frozen=True, slots=True)
class BaseMove:
    """A motion of the base by a distance or an angle, from where it began."""

    start: Pose
    translate: float = 0.0
    rotate: float = 0.0

    def left(self, pose: Pose) -> float:
        """What is still to be done, in m or rad, with its sign."""
        if self.rotate:
            return wrapped(self.start.yaw + self.rotate - pose.yaw)
        dx, dy = pose.x - self.start.x, pose.y - self.start.y
        return self.translate - (dx * math.cos(self.start.yaw) + dy * math.sin(self.start.yaw))

    def step(self, body: Body) -> BaseMove | None:
        """Drives on; None once it is done."""
        left = self.left(body.pose)
        if abs(left) < ARRIVED:
            body.drive(0.0, 0.0)
            return None
        top = _BASE_SPEED[1 if self.rotate else 0]
        speed = math.copysign(min(top, max(0.03, abs(left) * 2)), left)
        body.drive(0.0, speed) if self.rotate else body.drive(speed, 0.0)
        return self


def checked(
    names: Sequence[str], points: Sequence[Waypoint], timed: bool
) -> tuple[tuple[Step, ...], str]:
    """A goal's steps, and what is wrong with it, or ""."""
    if not points:
        return (), "the trajectory has no points"
    if timed and any(a.at_s >= b.at_s for a, b in pairwise(points)):
        return (), "the points' times don't rise"
    steps = []
    for point in points:
        if len(point.positions) != len(names):
            return (), "a point doesn't have a position for each joint"
        values: dict[str, float] = {}
        for name, value in zip(names, point.positions, strict=True):
            joint = known(name, value)
            if joint is None:
                return (), f"there is no joint {name}"
            values[joint[0]] = joint[1]
        base = {name: values.pop(name, 0.0) for name in BASE}
        if base[TRANSLATE] and base[ROTATE]:
            return (), "the base can't move and turn at once"
        for name, value in values.items():
            if not JOINTS[name].allows(value):
                return (), f"{name} can't be at {value:g}"
        steps.append(Step(values, base[TRANSLATE], base[ROTATE], point.at_s))
    return tuple(steps), ""


@dataclass(slots=True)
class Trajectory:
    """A trajectory under way.

    Attributes:
        timed: positions are due at their times (trajectory mode); otherwise one point follows on another.
        state: `active`, `succeeded`, `aborted` or `canceled`.
        invalid: whether it was aborted for what it asked.
        reason: why it was aborted.
        held: the robot was stopped, and doesn't move until the point's time is over.
        endless: it never ends by itself.
    """

    steps: tuple[Step, ...]
    timed: bool = False
    state: str = "active"
    invalid: bool = False
    reason: str = ""
    held: bool = False
    endless: bool = False
    _at: int = -1
    _elapsed: float = 0.0
    _total: float = 0.0
    _base: BaseMove | None = None
    _from: Mapping[str, float] = field(default_factory=dict)

    def abort(self, reason: str, invalid: bool = False) -> None:
        """Gives it up."""
        if self.state == "active":
            self.state, self.reason, self.invalid = "aborted", reason, invalid

    def succeed(self) -> None:
        """Says that it is done."""
        self.state = "succeeded"

    def cancel(self, body: Body) -> None:
        """Ends it at the client's wish."""
        if self.state == "active":
            self.state = "canceled"
            body.hold()

    def step(self, body: Body, seconds: float) -> None:
        """Lets time pass."""
        if self.state != "active" or self.endless:
            return
        self._elapsed += seconds
        self._total += seconds
        if self._at < 0:
            self._next(body)
        step = self.steps[self._at]
        if self.held:
            self._time_out(step, body)
            return
        self._pursue(step, body)
        if self._arrived(step, body):
            if self._at + 1 < len(self.steps):
                self._next(body)
            else:
                self.succeed()
        else:
            self._time_out(step, body)

    def _next(self, body: Body) -> None:
        self._at += 1
        self._elapsed = 0.0
        step = self.steps[self._at]
        self._from = dict(body.joints)
        if step.translate or step.rotate:
            self._base = BaseMove(body.pose, step.translate, step.rotate)

    def _pursue(self, step: Step, body: Body) -> None:
        share = 1.0
        if self.timed:
            begun = self.steps[self._at - 1].at_s if self._at else 0.0
            span = step.at_s - begun
            share = min(1.0, (self._total - begun) / span) if span > 0 else 1.0
        for name, target in step.joints.items():
            body.aim(name, self._from[name] + (target - self._from[name]) * share)
        if self._base is not None:
            self._base = self._base.step(body)

    def _arrived(self, step: Step, body: Body) -> bool:
        if self._base is not None or (self.timed and self._total < step.at_s):
            return False
        return all(
            abs(body.joints[name] - target) <= ARRIVED * (1 if name.endswith(_METRIC) else 2)
            for name, target in step.joints.items()
        )

    def _time_out(self, step: Step, body: Body) -> None:
        limit = POINT_TIMEOUT_S + (step.at_s if self.timed else 0.0)
        if (self._total if self.timed else self._elapsed) > limit:
            self.abort(f"a point took more than {POINT_TIMEOUT_S:g} seconds")
            body.hold()


_METRIC = ("extension", "lift", "aperture")
