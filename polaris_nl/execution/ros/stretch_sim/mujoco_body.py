"""The robot's body in MuJoCo: wheels that roll, joints that are driven, things with weight."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import mujoco

from polaris_nl.execution.ros.layout import Layout, Pose
from polaris_nl.execution.ros.stretch_sim.body import (
    ANGULAR_ACCELERATION,
    LINEAR_ACCELERATION,
    Point3,
    clipped_velocity,
    towards,
)
from polaris_nl.execution.ros.stretch_sim.floor import Floor
from polaris_nl.execution.ros.stretch_sim.joints import HOME, JOINTS
from polaris_nl.execution.ros.stretch_sim.mujoco_robot import (
    BASE_BODY,
    FURNITURE,
    GRASP_BODY,
    THING,
    TIMESTEP_S,
    controls,
    measured,
    modelled,
    rolled,
    wheel_speeds,
)
from polaris_nl.execution.ros.stretch_sim.mujoco_world import AWAY, SPARES, furnished
from polaris_nl.model.world import World

BRAKING = 2.5
"""How much harder the base brakes than it speeds up, when it is told to stop: 1.5 m/s2."""


class MujocoBody:
    """A body with forces.

    Grasps are attached: a weld between gripper and thing is switched on, and what is held touches nothing.

    Args:
        world, layout, floor: what there is.
        start: where the base stands.
    """

    physical = True

    def __init__(self, world: World, layout: Layout, floor: Floor, start: Pose) -> None:
        built = furnished(world, layout, floor, start)
        self.model: Any = built.model
        self.data: Any = mujoco.MjData(self.model)
        self._actuators = {self.model.actuator(i).name: i for i in range(self.model.nu)}
        self._bodies = {name: self.model.body(f"thing-{name}").id for name in built.things}
        self._alias = {name: name for name in built.things if name not in SPARES}
        self._there: set[str] = set()
        self._held: str | None = None
        self._goals = dict(HOME)
        self._commanded = dict(HOME)
        self._wanted = (0.0, 0.0)
        self._driven = (0.0, 0.0)
        self._brakes = False
        self._owed = 0.0
        for name, value in controls(HOME).items():
            self.data.joint(name).qpos[0] = value
        self._control()
        mujoco.mj_forward(self.model, self.data)
        self._grasp = self.model.body(GRASP_BODY).id
        self._base = self.model.body(BASE_BODY).id

    @property
    def pose(self) -> Pose:
        """Where the base is."""
        x, y, _, w, _, _, z = self.data.qpos[:7]
        return Pose(float(x), float(y), 2 * math.atan2(z, w))

    @property
    def velocity(self) -> tuple[float, float]:
        """By its wheels, as the robot measures it: m/s forwards, rad/s to the left; trembling is nought."""
        linear, angular = rolled(
            *(float(self.data.joint(f"joint_{side}_wheel").qvel[0]) for side in ("left", "right"))
        )
        return linear if abs(linear) > 5e-3 else 0.0, angular if abs(angular) > 2e-2 else 0.0

    @property
    def joints(self) -> Mapping[str, float]:
        """The position of each joint, in m or rad."""
        return measured({name: float(self.data.joint(name).qpos[0]) for name in modelled()})

    @property
    def gripper(self) -> Point3:
        """The point between the fingers."""
        return self._point(self._grasp)

    def drive(self, linear: float, angular: float) -> None:
        """Sets the velocity that the base is to have."""
        self._wanted = clipped_velocity(linear, angular)
        self._brakes = self._brakes and self._wanted == (0.0, 0.0)

    def aim(self, joint: str, position: float) -> None:
        """Sets the position that a joint is to have."""
        self._goals[joint] = JOINTS[joint].clip(position)

    def hold(self) -> None:
        """Stops everything where it is; the base brakes as hard as it can without tipping forward."""
        self._wanted = (0.0, 0.0)
        self._brakes = True
        self._goals = dict(self._commanded)

    def step(self, seconds: float) -> None:
        """Lets time pass, in steps of the physics."""
        self._owed += seconds
        while self._owed >= TIMESTEP_S - 1e-9:
            self._owed -= TIMESTEP_S
            self._ramp(TIMESTEP_S)
            self._control()
            mujoco.mj_step(self.model, self.data)

    def grip(self, name: str | None) -> None:
        """Attaches a thing to the gripper, or lets go."""
        if self._held is not None:
            self.data.eq_active[self._weld(self._held)] = 0
            self._touchable(self._held, True)
            # What lies still is left alone by the solver, also in the air; a touch makes it fall.
            self.data.joint(f"free-{self._alias[self._held]}").qvel[2] = -0.01
        self._held = name
        if name is None:
            return
        self._place(name, self.gripper, self.data.xquat[self._grasp])
        self._touchable(name, False)
        self.data.eq_active[self._weld(name)] = 1
        mujoco.mj_forward(self.model, self.data)

    def put(self, name: str, at: Point3) -> None:
        """Puts a thing somewhere, at rest."""
        if self._held == name:
            self.grip(None)
        self._place(name, at, (1.0, 0.0, 0.0, 0.0))

    def where(self, name: str) -> Point3 | None:
        """Where a thing is, or None if it isn't there."""
        return self._point(self._bodies[self._alias[name]]) if name in self._there else None

    def forget(self, name: str) -> None:
        """Takes a thing out of the world."""
        if name in self._there:
            self.put(name, (AWAY[0] + len(self._there), AWAY[1] - 1.0, AWAY[2]))
            self._there.discard(name)

    def _ramp(self, seconds: float) -> None:
        most = seconds * (BRAKING if self._brakes else 1.0)
        self._driven = (
            towards(self._driven[0], self._wanted[0], LINEAR_ACCELERATION * most),
            towards(self._driven[1], self._wanted[1], ANGULAR_ACCELERATION * most),
        )
        for name, joint in JOINTS.items():
            self._commanded[name] = towards(
                self._commanded[name], self._goals[name], joint.speed * seconds
            )

    def _control(self) -> None:
        wanted = {**controls(self._commanded), **wheel_speeds(*self._driven)}
        for name, value in wanted.items():
            self.data.ctrl[self._actuators[name]] = value

    def _place(self, name: str, at: Point3, turned: Any) -> None:
        if name not in self._alias:
            taken = set(self._alias.values())
            # Where all spare bodies are in use, the last one is used again.
            self._alias[name] = next((s for s in SPARES if s not in taken), SPARES[-1])
        joint = self.data.joint(f"free-{self._alias[name]}")
        joint.qpos[:3] = at
        joint.qpos[3:] = turned
        joint.qvel[:] = 0.0
        self._there.add(name)
        mujoco.mj_forward(self.model, self.data)

    def _touchable(self, name: str, touchable: bool) -> None:
        geom = self.model.geom(f"shape-{self._alias[name]}").id
        self.model.geom_contype[geom] = THING if touchable else 0
        self.model.geom_conaffinity[geom] = (FURNITURE | THING) if touchable else 0

    def _weld(self, name: str) -> int:
        return int(self.model.equality(f"grasp-{self._alias[name]}").id)

    def _point(self, body: int) -> Point3:
        x, y, z = self.data.xpos[body]
        return float(x), float(y), float(z)
