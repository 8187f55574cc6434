"""The robot's body and the things it handles: the protocol, and the one without forces."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Protocol

from polaris_nl.execution.ros.layout import Pose, wrapped
from polaris_nl.execution.ros.stretch_sim.joints import ARM, HOME, JOINTS, LIFT

Point3 = tuple[float, float, float]

MAX_LINEAR = 0.30
"""Metres a second; Nav2 asks for 0.26."""
MAX_ANGULAR = 1.0
LINEAR_ACCELERATION = 0.6
ANGULAR_ACCELERATION = 3.0

ARM_SIDE_M = 0.415
"""From the middle of the base to the gripper's fingers, to the right, with the arm drawn in."""
ARM_FORWARD_M = -0.02
LIFT_BASE_M = 0.11
"""The height of the gripper above the floor with the lift down."""


class Body(Protocol):
    """What moves: a base, joints and a gripper, and the things that can be gripped."""

    physical: bool
    """Whether forces are simulated."""

    @property
    def pose(self) -> Pose:
        """Where the base is."""
        ...

    @property
    def velocity(self) -> tuple[float, float]:
        """Of the base: m/s forwards, rad/s to the left."""
        ...

    @property
    def joints(self) -> Mapping[str, float]:
        """The position of each joint, in m or rad."""
        ...

    @property
    def gripper(self) -> Point3:
        """The point between the fingers."""
        ...

    def drive(self, linear: float, angular: float) -> None:
        """Sets the velocity that the base is to have."""
        ...

    def aim(self, joint: str, position: float) -> None:
        """Sets the position that a joint is to have."""
        ...

    def hold(self) -> None:
        """Stops everything where it is."""
        ...

    def step(self, seconds: float) -> None:
        """Lets time pass."""
        ...

    def grip(self, name: str | None) -> None:
        """Attaches a thing to the gripper, or lets go."""
        ...

    def put(self, name: str, at: Point3) -> None:
        """Puts a thing somewhere, at rest."""
        ...

    def where(self, name: str) -> Point3 | None:
        """Where a thing is, or None if it isn't there."""
        ...

    def forget(self, name: str) -> None:
        """Takes a thing out of the world."""
        ...


class KinematicBody:
    """A body that moves as it is told, without weight or contact; walls and furniture only stop it.

    Args:
        pose: where the base stands at the start.
        free: whether the base can be at a point.
    """

    physical = False

    def __init__(self, pose: Pose, free: Callable[[float, float], bool]) -> None:
        self._pose = pose
        self._free = free
        self._joints = dict(HOME)
        self._targets = dict(HOME)
        self._wanted = (0.0, 0.0)
        self._velocity = (0.0, 0.0)
        self._things: dict[str, Point3] = {}
        self._held: str | None = None

    @property
    def pose(self) -> Pose:
        """Where the base is."""
        return self._pose

    @property
    def velocity(self) -> tuple[float, float]:
        """Of the base: m/s forwards, rad/s to the left."""
        return self._velocity

    @property
    def joints(self) -> Mapping[str, float]:
        """The position of each joint, in m or rad."""
        return self._joints

    @property
    def gripper(self) -> Point3:
        """The point between the fingers."""
        return gripper_of(self._pose, self._joints)

    def drive(self, linear: float, angular: float) -> None:
        """Sets the velocity that the base is to have."""
        self._wanted = clipped_velocity(linear, angular)

    def aim(self, joint: str, position: float) -> None:
        """Sets the position that a joint is to have."""
        self._targets[joint] = JOINTS[joint].clip(position)

    def hold(self) -> None:
        """Stops everything where it is."""
        self._wanted = self._velocity = (0.0, 0.0)
        self._targets = dict(self._joints)

    def step(self, seconds: float) -> None:
        """Lets time pass."""
        self._move_base(seconds)
        for name, joint in JOINTS.items():
            self._joints[name] = towards(
                self._joints[name], self._targets[name], joint.speed * seconds
            )
        if self._held is not None:
            self._things[self._held] = self.gripper

    def grip(self, name: str | None) -> None:
        """Attaches a thing to the gripper, or lets go."""
        self._held = name
        if name is not None:
            self._things[name] = self.gripper

    def put(self, name: str, at: Point3) -> None:
        """Puts a thing somewhere, at rest."""
        if self._held == name:
            self._held = None
        self._things[name] = at

    def where(self, name: str) -> Point3 | None:
        """Where a thing is, or None if it isn't there."""
        return self._things.get(name)

    def forget(self, name: str) -> None:
        """Takes a thing out of the world."""
        if self._held == name:
            self._held = None
        self._things.pop(name, None)

    def _move_base(self, seconds: float) -> None:
        linear = towards(self._velocity[0], self._wanted[0], LINEAR_ACCELERATION * seconds)
        angular = towards(self._velocity[1], self._wanted[1], ANGULAR_ACCELERATION * seconds)
        turned = self._pose.yaw + angular * seconds / 2
        x = self._pose.x + linear * seconds * math.cos(turned)
        y = self._pose.y + linear * seconds * math.sin(turned)
        if not self._free(x, y) and self._free(self._pose.x, self._pose.y):
            x, y, linear = self._pose.x, self._pose.y, 0.0
        self._velocity = linear, angular
        self._pose = Pose(x, y, wrapped(self._pose.yaw + angular * seconds))


def gripper_of(pose: Pose, joints: Mapping[str, float]) -> Point3:
    """Where the gripper is: the arm goes out to the robot's right."""
    side = ARM_SIDE_M + joints[ARM]
    x, y = ARM_FORWARD_M, -side
    cos, sin = math.cos(pose.yaw), math.sin(pose.yaw)
    return pose.x + x * cos - y * sin, pose.y + x * sin + y * cos, LIFT_BASE_M + joints[LIFT]


def clipped_velocity(linear: float, angular: float) -> tuple[float, float]:
    """A velocity within what the base can do."""
    return (
        min(max(linear, -MAX_LINEAR), MAX_LINEAR),
        min(max(angular, -MAX_ANGULAR), MAX_ANGULAR),
    )


def towards(value: float, target: float, step: float) -> float:
    """A value that moves towards another by no more than a step."""
    return target if abs(target - value) <= step else value + math.copysign(step, target - value)
