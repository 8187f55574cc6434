"""The primitives: what a robot does at one go, with the code that makes it so.

Each is a coroutine in the owner's thread. None believes the robot's word: what it should bring about
is for perception to confirm; here only what the robot can tell of itself is checked (where it stands,
where its joints are). All end by themselves, by their deadlines.
"""

from __future__ import annotations

import math
import time
from collections.abc import Awaitable, Callable, Mapping
from typing import Any, Protocol

from polaris_nl.execution.ros.driver import Driver, Refused
from polaris_nl.execution.ros.layout import Pose, wrapped
from polaris_nl.execution.ros.middleware import interface
from polaris_nl.execution.ros.owner import pause, until
from polaris_nl.execution.ros.skills import Primitive

JOINT_POSE = (
    "wrist_extension", "joint_lift", "joint_wrist_yaw", "joint_wrist_pitch", "joint_wrist_roll",
    "joint_head_pan", "joint_head_tilt", "gripper_aperture",
)  # fmt: skip
"""The order of `joint_pose_cmd`, whose last two values move the base."""
NAVIGATION, POSITION = "navigation", "position"
"""The driver's modes for the base and for the arm."""
POINT_S = 3
"""How long a movement of the arm is given on its way, in seconds."""
GOAL_GAP_S = 0.3
"""The driver rejects a movement of the arm that comes sooner after the last one."""
DRIVE_PERIOD_S = 0.1
OVER_ITEM_M = 0.05
"""How high above where a thing is seen the fingers go."""


class Senses(Protocol):
    """What primitives need to know of the robot and the world, at any time."""

    @property
    def base(self) -> Pose | None:
        """Where the base stands on the map."""
        ...

    @property
    def joints(self) -> Mapping[str, float]:
        """Joint positions (m, rad)."""
        ...

    @property
    def mode(self) -> str:
        """The driver's mode."""
        ...

    def position(self, name: str) -> tuple[float, float, float | None] | None:
        """Where an entity is (m; the height only where it is seen), or None."""
        ...

    def stand(self, name: str) -> Pose | None:
        """Where the robot stands to get at an entity or into a region, or None."""
        ...

    def sentence(self, message: str) -> str:
        """The words of a message."""
        ...

    def replied(self, request: str) -> Mapping[str, Any] | None:
        """The reply to a skill request, or None."""
        ...

    def spoken(self, person: str, message: str) -> bool:
        """Whether a message was spoken to a person since it was last sent."""
        ...

    def expect_speech(self, person: str, message: str) -> None:
        """Forgets earlier words, since a message is being sent anew."""
        ...


class Primitives:
    """Does primitives on one robot."""

    def __init__(self, driver: Driver, senses: Senses) -> None:
        self._driver = driver
        self._senses = senses
        self._profile = driver.profile
        self._requests = 0
        self._moved_arm = 0.0
        self._code: Mapping[str, Callable[[Mapping[str, str]], Awaitable[None]]] = {
            "navigate": self._navigate,
            "reach": self._reach,
            "retract": self._retract,
            "say": self._say,
        }

    async def do(self, primitive: Primitive) -> None:
        """Does one primitive.

        Raises:
            Refused: the robot can't or won't; the text says why.
            Late: it took too long.
        """
        code = self._code.get(primitive.name)
        if code is not None:
            await code(primitive.arguments)
            return
        means = self._profile.primitives[primitive.name]
        if means.startswith("/"):
            await self._service(means)
        else:
            await self._skill(primitive)

    # Base

    async def _navigate(self, arguments: Mapping[str, str]) -> None:
        target = self._senses.stand(arguments["to"])
        if target is None:
            raise Refused(f"it doesn't know where {_spoken(arguments['to'])} is")
        if self._stands(target, 1.0):
            return
        await self._mode(NAVIGATION, "navigation_mode")
        if "navigate" in self._driver.actions and self._driver.offers("navigate"):
            goal = interface("nav2_msgs/action/NavigateToPose").Goal()
            goal.pose.header.frame_id = "map"
            goal.pose.pose.position.x, goal.pose.pose.position.y = target.x, target.y
            goal.pose.pose.orientation.z = math.sin(target.yaw / 2)
            goal.pose.pose.orientation.w = math.cos(target.yaw / 2)
            await self._driver.pursue(
                "navigate", goal, self._profile.times.navigate, "driving there"
            )
        else:
            await self._drive(target)
        await self._arrived(target)

    async def _arrived(self, target: Pose) -> None:
        """Whether it stands where it says; a little later, since its pose comes after its word."""
        try:
            await until(lambda: self._stands(target, 1.5), 1.0, "arriving")
        except Exception as error:
            base = self._senses.base
            off = (
                "" if base is None else f" and stands {base.distance(target.x, target.y):.1f} m off"
            )
            raise Refused(f"it says that it arrived{off}") from error

    def _stands(self, target: Pose, slack: float) -> bool:
        base = self._senses.base
        how = self._profile.base
        return (
            base is not None
            and base.distance(target.x, target.y) <= how.tolerance_m * slack
            and abs(wrapped(base.yaw - target.yaw)) <= how.tolerance_rad * slack
        )

    async def _drive(self, target: Pose) -> None:
        """Drives in a straight line by velocity: turn, go, turn. For robots without navigation."""
        deadline = self._profile.times.navigate
        self._driver.accepted()
        waited = 0.0
        try:
            while not self._stands(target, 0.8):
                base = self._senses.base
                if base is None:
                    raise Refused("it doesn't know where it stands")
                self._driver.velocity(*steering(base, target, self._profile.base.tolerance_m * 0.6))
                await pause(DRIVE_PERIOD_S)
                waited += DRIVE_PERIOD_S
                if waited > deadline:
                    raise Refused("it didn't get there in time")
        finally:
            self._driver.velocity(0.0, 0.0)

    # Arm

    async def _reach(self, arguments: Mapping[str, str]) -> None:
        arm = self._profile.arm
        where = self._senses.position(arguments["to"])
        base = self._senses.base
        joints = {
            "joint_lift": arm.reach_lift,
            "wrist_extension": self._profile.base.standoff_m - arm.side_m,
        }
        if where is not None and base is not None:
            joints["wrist_extension"] = base.distance(where[0], where[1]) - arm.side_m
            if where[2] is not None:
                joints["joint_lift"] = where[2] + OVER_ITEM_M - arm.base_m
        for name, value in joints.items():
            low, high = self._profile.joints[name]
            joints[name] = min(max(value, low), high)
        await self._move_arm(joints)

    async def _retract(self, arguments: Mapping[str, str]) -> None:
        arm = self._profile.arm
        await self._move_arm({"wrist_extension": arm.stowed_extension})
        await self._move_arm({"joint_lift": arm.stowed_lift})

    async def _move_arm(self, joints: Mapping[str, float]) -> None:
        wrong = self._profile.beyond(joints)
        if wrong:
            raise Refused(wrong)
        if self._at(joints):
            return
        await self._mode(POSITION, "position_mode")
        seconds = self._profile.times.trajectory
        if "trajectory" in self._driver.actions and self._driver.offers("trajectory"):
            goal = interface("control_msgs/action/FollowJointTrajectory").Goal()
            goal.trajectory.joint_names = list(joints)
            point = interface("trajectory_msgs/msg/JointTrajectoryPoint")()
            point.positions = [float(v) for v in joints.values()]
            point.time_from_start.sec = POINT_S
            goal.trajectory.points = [point]
            await until(
                lambda: time.monotonic() - self._moved_arm > GOAL_GAP_S, 1.0, "moving its arm"
            )
            self._moved_arm = time.monotonic()
            await self._driver.pursue("trajectory", goal, seconds, "moving its arm")
        else:
            await self._stream(joints)
        await until(lambda: self._at(joints), seconds, "moving its arm")

    async def _stream(self, joints: Mapping[str, float]) -> None:
        """Sends joint positions directly, for robots without trajectories."""
        await self._driver.call("streaming", self._profile.times.service)
        now = self._senses.joints
        values = [float(joints.get(name, now.get(name, 0.0))) for name in JOINT_POSE]
        message = interface("std_msgs/msg/Float64MultiArray")(data=[*values, 0.0, 0.0])
        self._driver.accepted()
        self._driver.publish("joint_pose_cmd", message)

    def _at(self, joints: Mapping[str, float]) -> bool:
        now = self._senses.joints
        return all(
            name in now and abs(now[name] - value) <= self._profile.arm.tolerance
            for name, value in joints.items()
        )

    # Modes, speech, skills

    async def _mode(self, mode: str, service: str) -> None:
        if self._senses.mode == mode:
            return
        answer = await self._driver.call(service, self._profile.times.service)
        if not answer.success:
            raise Refused(f"it doesn't switch to {mode}")
        seconds = self._profile.times.service
        await until(lambda: self._senses.mode == mode, seconds, f"switching to {mode}")

    async def _say(self, arguments: Mapping[str, str]) -> None:
        person, message = arguments["person"], arguments["message"]
        seconds = self._profile.times.say
        await until(lambda: self._driver.listeners("say") > 0, seconds, "speaking")
        self._senses.expect_speech(person, message)
        text = self._senses.sentence(message)
        self._driver.accepted()
        self._driver.tell("say", {"person": person, "message": message, "text": text})
        await until(lambda: self._senses.spoken(person, message), seconds, "speaking")

    async def _service(self, name: str) -> None:
        answer = await self._driver.call(name, self._profile.times.skill)
        if not answer.success:
            raise Refused(str(answer.message).strip().rstrip(".") or "it failed")
        self._driver.accepted()

    async def _skill(self, primitive: Primitive) -> None:
        seconds = self._profile.times.skill
        await until(lambda: self._driver.listeners("skill") > 0, seconds, "its skills")
        self._requests += 1
        request = f"{id(self):x}-{self._requests}"
        skill, thing, at = _requested(primitive)
        self._driver.accepted()
        self._driver.tell("skill", {"id": request, "skill": skill, "object": thing, "at": at})
        await until(lambda: self._senses.replied(request) is not None, seconds, primitive.name)
        reply = self._senses.replied(request) or {}
        if not reply.get("ok"):
            raise Refused(str(reply.get("reason") or "it failed").rstrip("."))


def steering(base: Pose, target: Pose, near_m: float) -> tuple[float, float]:
    """Speeds (m/s, rad/s) that bring the base nearer to a pose: turn, go, turn. Pure.

    Args:
        base: where it is.
        target: where it is to be.
        near_m: from where on only the heading counts.
    """
    distance = base.distance(target.x, target.y)
    if distance <= near_m:
        return 0.0, 1.5 * wrapped(target.yaw - base.yaw)
    off = wrapped(math.atan2(target.y - base.y, target.x - base.x) - base.yaw)
    if abs(off) > 0.3:
        return 0.0, 1.5 * off
    return 0.8 * distance, 1.5 * off


def _requested(primitive: Primitive) -> tuple[str, str, str]:
    """A primitive as a skill request: skill, object, place."""
    given = primitive.arguments
    name = {"hand-over": "release", "take": "grasp"}.get(primitive.name, primitive.name)
    at = given.get("at") or given.get("to") or given.get("from") or given.get("what") or ""
    return name, given.get("object", ""), at


def _spoken(name: str) -> str:
    return f"the {name.replace('-', ' ')}"
