"""Stretch 3 in MuJoCo, from the URDF that Hello Robot publishes.

The URDF is made for visualisation: its base is fixed, its wheels are meshes with the gearbox's friction
(10.48 Nm), and nothing drives it. So at run time the base gets a free joint, the wheels become cylinders, the
caster a slippery sphere (MuJoCo takes the larger of two friction coefficients unless a geom has priority), and
each joint an actuator. Gravity doesn't act on the upper body: the real one is balanced by its controllers.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import mujoco
from stretch_urdf import __file__ as _urdf_package

from polaris_nl.execution.ros.layout import Pose
from polaris_nl.execution.ros.stretch_sim.joints import ARM, GRIPPER, HOME, LIFT

WHEEL_RADIUS_M = 0.0508
WHEEL_SEPARATION_M = 0.34
"""Of the URDF; stretch_body reckons with 0.3153."""
TIMESTEP_S = 0.004
GRASP_BODY = "link_grasp_center"
BASE_BODY = "base_link"

ROBOT, FURNITURE, THING = 1, 2, 4
"""Kinds of geoms, as bits: robot and things touch furniture, and things each other."""

_URDF = "SE3/stretch_description_SE3_eoa_wrist_dw3_tool_sg3.urdf"
_SOLID = ("caster_link", "link_mast", "link_head")
_WHEELS = ("joint_left_wheel", "joint_right_wheel")
_SEGMENTS = tuple(f"joint_arm_l{n}" for n in range(4))
_FINGERS = ("joint_gripper_finger_left", "joint_gripper_finger_right")
_STIFFNESS: Mapping[str, tuple[float, float]] = {
    LIFT: (4000.0, 400.0),
    **dict.fromkeys(_SEGMENTS, (2000.0, 150.0)),
    **dict.fromkeys(("joint_wrist_yaw", "joint_wrist_pitch", "joint_wrist_roll"), (20.0, 2.0)),
    **dict.fromkeys(("joint_head_pan", "joint_head_tilt"), (20.0, 2.0)),
    **dict.fromkeys(_FINGERS, (4.0, 0.4)),
}
"""Stiffness and damping of position actuators, in N/m and Ns/m, or Nm/rad and Nms/rad."""
_WHEEL_GAIN = 15.0
_FINGER_RAD_A_METRE = 4.0


def robot_spec(start: Pose) -> Any:
    """The robot alone, on no floor, as an MjSpec that can be added to.

    Args:
        start: where its base is.
    """
    path = Path(_urdf_package).parent / _URDF
    spec = mujoco.MjSpec.from_string(_quietened(path.read_text(encoding="utf-8")))
    spec.meshdir = str(path.parent / "meshes")
    for mesh in spec.meshes:
        mesh.file = Path(mesh.file).name
    spec.compiler.fusestatic = False
    spec.compiler.discardvisual = False
    # What lies about at rest costs nothing: some three times as fast in a furnished world.
    spec.option.enableflags |= mujoco.mjtEnableBit.mjENBL_SLEEP
    spec.option.timestep = TIMESTEP_S
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    spec.option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
    spec.option.impratio = 10.0
    base = spec.body(BASE_BODY)
    base.pos = [start.x, start.y, 0.0]
    base.quat = [math.cos(start.yaw / 2), 0.0, 0.0, math.sin(start.yaw / 2)]
    base.add_freejoint(name="base")
    for body in spec.bodies:
        body.gravcomp = 0.0 if body.name in ("world", BASE_BODY) else 1.0
    for geom in spec.geoms:
        # Grasps are attached, so what grasps needn't touch: only base, mast and head bump into furniture.
        solid = geom.parent.name in _SOLID
        geom.contype, geom.conaffinity = (ROBOT, FURNITURE) if solid else (0, 0)
    _put_on_wheels(spec)
    _actuate(spec)
    return spec


def _quietened(urdf: str) -> str:
    """The URDF, with limits for the fingers, whose own are empty and would be warned of."""
    for finger in _FINGERS:
        at = urdf.find(f'<joint name="{finger}"')
        limit = urdf.find("<limit", at)
        end = urdf.find("/>", limit)
        if -1 < at < limit < end:
            given = '<limit effort="10" velocity="1" lower="-0.6" upper="0.8"'
            urdf = urdf[:limit] + given + urdf[end:]
    return urdf


def _put_on_wheels(spec: Any) -> None:
    for side in ("left", "right"):
        wheel = spec.body(f"link_{side}_wheel")
        wheel.add_geom(
            name=f"{side}_tyre",
            type=mujoco.mjtGeom.mjGEOM_CYLINDER,
            size=[WHEEL_RADIUS_M, 0.0125, 0.0],
            contype=ROBOT,
            conaffinity=FURNITURE,
            friction=[1.2, 0.005, 0.0001],
            solref=[0.008, 1.0],
            solimp=[0.95, 0.99, 0.001, 0.5, 2.0],
            mass=0.0,
            rgba=[0.15, 0.15, 0.15, 1.0],
        )
        joint = spec.joint(f"joint_{side}_wheel")
        joint.frictionloss = 0.0
        joint.damping = [0.05, 0.0, 0.0]
        joint.armature = 0.01
    for geom in spec.body("caster_link").geoms:
        geom.type = mujoco.mjtGeom.mjGEOM_SPHERE
        geom.size = [0.032, 0.0, 0.0]
        geom.friction = [0.0, 0.0, 0.0]
        geom.priority = 1
        geom.condim = 1
    # The hull of the base would touch the floor.
    spec.body(BASE_BODY).add_geom(
        name="bumper",
        type=mujoco.mjtGeom.mjGEOM_CYLINDER,
        size=[0.17, 0.06, 0.0],
        pos=[-0.1, 0.0, 0.10],
        contype=ROBOT,
        conaffinity=FURNITURE,
        mass=0.0,
        rgba=[0.0, 0.0, 0.0, 0.0],
    )


def _actuate(spec: Any) -> None:
    for name in _WHEELS:
        actuator = _actuator(spec, name)
        actuator.set_to_velocity(kv=_WHEEL_GAIN)
    for name, (stiffness, damping) in _STIFFNESS.items():
        spec.joint(name).armature = 0.02
        actuator = _actuator(spec, name)
        actuator.set_to_position(kp=stiffness, kv=damping)


def _actuator(spec: Any, joint: str) -> Any:
    return spec.add_actuator(
        name=joint, target=joint, trntype=mujoco.mjtTrn.mjTRN_JOINT, ctrllimited=False
    )


def wheel_speeds(linear: float, angular: float) -> dict[str, float]:
    """The speeds of the wheels, in rad/s, for a velocity of the base."""
    half = angular * WHEEL_SEPARATION_M / 2
    return {
        "joint_left_wheel": (linear - half) / WHEEL_RADIUS_M,
        "joint_right_wheel": (linear + half) / WHEEL_RADIUS_M,
    }


def rolled(left: float, right: float) -> tuple[float, float]:
    """The velocity of the base, in m/s and rad/s, by the speeds of its wheels, in rad/s."""
    linear = (left + right) / 2 * WHEEL_RADIUS_M
    return linear, (right - left) * WHEEL_RADIUS_M / WHEEL_SEPARATION_M


def controls(joints: Mapping[str, float]) -> dict[str, float]:
    """The positions that the model's actuators are to hold for the robot's joints."""
    found = {name: value for name, value in joints.items() if name not in (ARM, GRIPPER)}
    found.update(dict.fromkeys(_SEGMENTS, joints[ARM] / 4))
    found.update(dict.fromkeys(_FINGERS, joints[GRIPPER] * _FINGER_RAD_A_METRE))
    return found


def measured(position: Mapping[str, float]) -> dict[str, float]:
    """The robot's joints from the model's."""
    found = {name: position[name] for name in HOME if name in position}
    found[ARM] = sum(position[name] for name in _SEGMENTS)
    found[GRIPPER] = sum(position[name] for name in _FINGERS) / 2 / _FINGER_RAD_A_METRE
    return {name: found[name] for name in HOME}


def modelled() -> tuple[str, ...]:
    """The names of the model's joints that are positioned."""
    return tuple(_STIFFNESS)
