"""The joints of a Stretch: their names, limits and speeds, and the names that the driver also takes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Joint:
    """One joint: limits in m or rad, and the speed at which it moves, a second."""

    name: str
    lower: float
    upper: float
    speed: float

    def clip(self, value: float) -> float:
        """The nearest position within the limits."""
        return min(max(value, self.lower), self.upper)

    def allows(self, value: float) -> bool:
        """Whether a position is within the limits, give or take what rounding makes."""
        return self.lower - 1e-3 <= value <= self.upper + 1e-3


ARM = "wrist_extension"
LIFT = "joint_lift"
GRIPPER = "gripper_aperture"
JOINTS: Mapping[str, Joint] = {
    joint.name: joint
    for joint in (
        Joint(ARM, 0.0, 0.52, 0.25),
        Joint(LIFT, 0.0, 1.10, 0.20),
        Joint("joint_wrist_yaw", -1.75, 4.0, 2.0),
        Joint("joint_wrist_pitch", -1.57, 0.56, 2.0),
        Joint("joint_wrist_roll", -3.14, 3.14, 2.0),
        Joint("joint_head_pan", -3.9, 1.5, 2.0),
        Joint("joint_head_tilt", -1.53, 0.79, 2.0),
        Joint(GRIPPER, -0.02, 0.16, 0.15),
    )
}
"""In the order of `joint_pose_cmd`, whose last two values move the base."""

TRANSLATE = "translate_mobile_base"
ROTATE = "rotate_mobile_base"
BASE = (TRANSLATE, ROTATE)

_FINGERS = ("joint_gripper_finger_left", "joint_gripper_finger_right")
_SEGMENTS = tuple(f"joint_arm_l{n}" for n in range(4))
_METRES_A_RAD = 0.25
"""The opening of the gripper for one radian of a finger, about."""

STOWED: Mapping[str, float] = {
    ARM: 0.0,
    LIFT: 0.30,
    "joint_wrist_yaw": 3.0,
    "joint_wrist_pitch": -0.5,
    "joint_wrist_roll": 0.0,
    "joint_head_pan": 0.0,
    "joint_head_tilt": -0.3,
    GRIPPER: 0.0,
}
HOME: Mapping[str, float] = {**STOWED, LIFT: 0.60, "joint_wrist_yaw": 0.0, "joint_wrist_pitch": 0.0}


def known(name: str, value: float) -> tuple[str, float] | None:
    """A joint's own name and position, from one of the names that the driver takes; None for no joint."""
    if name in JOINTS or name in BASE:
        return name, value
    if name in _FINGERS:
        return GRIPPER, value * _METRES_A_RAD
    if name == "joint_arm":
        return ARM, value
    return None


def published(joints: Mapping[str, float]) -> dict[str, float]:
    """All joints as the driver publishes them: also the arm's four segments and the gripper's fingers."""
    fingers = dict.fromkeys(_FINGERS, joints[GRIPPER] / _METRES_A_RAD)
    return {**joints, **dict.fromkeys(_SEGMENTS, joints[ARM] / 4), **fingers}
