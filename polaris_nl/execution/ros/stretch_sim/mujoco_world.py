"""The world in MuJoCo: floor, walls, furniture as boxes, things that can be gripped, people as figures.

Walls are cut off low, so that one can look into the rooms. Containers have a shelf at which things lie and a
door that is only drawn; people are figures that are moved, and that nothing bumps into.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import mujoco

from polaris_nl.execution.ros.layout import Area, Layout, Pose
from polaris_nl.execution.ros.stretch_sim.floor import Floor
from polaris_nl.execution.ros.stretch_sim.mujoco_robot import (
    FURNITURE,
    GRASP_BODY,
    THING,
    robot_spec,
)
from polaris_nl.execution.ros.stretch_sim.scene import CONTAINER_M, INSIDE_M, SURFACE_M
from polaris_nl.model.world import Entity, World

WALL_M = 0.45
HALF_M = 0.22
"""Half the width of a piece of furniture."""
SPARES = tuple(f"spare-{n}" for n in range(4))
"""Bodies for things that are added during the run."""
AWAY = (0.0, 0.0, -20.0)
"""Where things are that aren't anywhere, far below a shelf of their own."""

Colour = tuple[float, float, float, float]
_COLOURS: dict[str, Colour] = {
    "red": (0.80, 0.15, 0.12, 1.0),
    "blue": (0.15, 0.35, 0.80, 1.0),
    "green": (0.20, 0.60, 0.25, 1.0),
    "white": (0.95, 0.95, 0.92, 1.0),
    "brown": (0.45, 0.30, 0.18, 1.0),
    "yellow": (0.95, 0.80, 0.20, 1.0),
}
_THINGS: Sequence[Colour] = (
    (0.93, 0.55, 0.15, 1.0),
    (0.55, 0.35, 0.75, 1.0),
    (0.20, 0.65, 0.65, 1.0),
    (0.85, 0.45, 0.55, 1.0),
    (0.60, 0.65, 0.25, 1.0),
)
_FLOORS: Sequence[Colour] = (
    (0.78, 0.72, 0.62, 1.0),
    (0.66, 0.74, 0.70, 1.0),
    (0.72, 0.70, 0.78, 1.0),
    (0.80, 0.68, 0.64, 1.0),
    (0.68, 0.74, 0.80, 1.0),
)
_WOOD: Colour = (0.62, 0.46, 0.30, 1.0)
_CASE: Colour = (0.85, 0.83, 0.78, 1.0)
DOOR: Colour = (0.55, 0.62, 0.68, 1.0)
_WALLS: Colour = (0.88, 0.87, 0.84, 1.0)
_CLOTHES: Sequence[Colour] = (
    (0.75, 0.30, 0.35, 1.0),
    (0.25, 0.45, 0.70, 1.0),
    (0.35, 0.60, 0.40, 1.0),
)
_SKIN: Colour = (0.90, 0.75, 0.62, 1.0)

_FLAT = {
    "tray": (0.15, 0.11, 0.012),
    "newspaper": (0.10, 0.07, 0.01),
    "magazine": (0.10, 0.07, 0.01),
}
_CUPS = ("cup", "glass", "bottle", "candle", "juice", "mug")
_DISHES = ("plate", "bowl")


@dataclass(frozen=True)
class Furnished:
    """A compiled world: the model, and the names of what can be gripped in it."""

    model: Any
    things: tuple[str, ...]


def furnished(world: World, layout: Layout, floor: Floor, start: Pose) -> Furnished:
    """Builds the robot in its world."""
    spec = robot_spec(start)
    root = spec.worldbody
    _light(spec)
    _ground(root, layout)
    for wall in floor.walls(layout):
        _box(root, wall, 0.0, WALL_M, _WALLS)
    for name, place in layout.places.items():
        region = layout.areas.get(layout.regions.get(name, ""))
        if name in layout.containers:
            _container(root, name, place, region)
        else:
            _table(root, name, place)
    things = [e.name for e in world.of_type("object")]
    for number, entity in enumerate(world.of_type("object")):
        _thing(spec, entity.name, entity, number)
    for number, name in enumerate(SPARES):
        _thing(spec, name, None, number)
    for number, entity in enumerate(world.of_type("person")):
        _person(root, entity.name, number)
    return Furnished(spec.compile(), (*things, *SPARES))


def _light(spec: Any) -> None:
    spec.visual.headlight.ambient = [0.45, 0.45, 0.45]
    spec.visual.headlight.diffuse = [0.45, 0.45, 0.45]
    spec.visual.headlight.specular = [0.1, 0.1, 0.1]
    glob = spec.visual.global_
    glob.offwidth, glob.offheight = 1280, 960
    # As if the model were a few metres wide, whatever lies far below: near and far are measured by it.
    spec.stat.extent = 4.0
    spec.visual.map.znear = 0.01
    spec.visual.map.zfar = 20.0
    spec.worldbody.add_light(
        type=mujoco.mjtLightType.mjLIGHT_DIRECTIONAL,
        pos=[0, 0, 8],
        dir=[0.3, 0.4, -1.0],
        diffuse=[0.45, 0.45, 0.42],
        castshadow=False,
    )


def _ground(root: Any, layout: Layout) -> None:
    root.add_geom(
        name="ground",
        type=mujoco.mjtGeom.mjGEOM_PLANE,
        size=[30, 30, 0.1],
        rgba=[0.35, 0.37, 0.40, 1.0],
        contype=FURNITURE,
        conaffinity=0,
        friction=[1.0, 0.005, 0.0001],
    )
    for number, (name, area) in enumerate(layout.areas.items()):
        x, y = area.middle
        root.add_geom(
            name=f"floor-{name}",
            type=mujoco.mjtGeom.mjGEOM_BOX,
            pos=[x, y, -0.007],
            size=[(area.right - area.left) / 2, (area.top - area.bottom) / 2, 0.01],
            rgba=list(_FLOORS[number % len(_FLOORS)]),
            contype=0,
            conaffinity=0,
        )
    # Things that aren't anywhere lie down here.
    root.add_geom(
        type=mujoco.mjtGeom.mjGEOM_BOX,
        pos=[0, 0, AWAY[2] - 0.5],
        size=[50, 50, 0.1],
        rgba=[0, 0, 0, 0],
        contype=FURNITURE,
        conaffinity=0,
    )


def _box(body: Any, area: Area, low: float, high: float, colour: Colour, name: str = "") -> None:
    x, y = area.middle
    body.add_geom(
        **({"name": name} if name else {}),
        type=mujoco.mjtGeom.mjGEOM_BOX,
        pos=[x, y, (low + high) / 2],
        size=[(area.right - area.left) / 2, (area.top - area.bottom) / 2, (high - low) / 2],
        rgba=list(colour),
        contype=FURNITURE,
        conaffinity=0,
    )


def _around(x: float, y: float, half_x: float, half_y: float) -> Area:
    return Area(x - half_x, y - half_y, x + half_x, y + half_y)


def _table(root: Any, name: str, at: Pose) -> None:
    top = _around(at.x, at.y, HALF_M, HALF_M)
    _box(root, top, SURFACE_M - 0.03, SURFACE_M, _WOOD, f"top-{name}")
    for dx in (-1, 1):
        for dy in (-1, 1):
            leg = _around(at.x + dx * (HALF_M - 0.03), at.y + dy * (HALF_M - 0.03), 0.02, 0.02)
            _box(root, leg, 0.0, SURFACE_M - 0.03, _WOOD)


def _container(root: Any, name: str, at: Pose, region: Area | None) -> None:
    """A case with a shelf, whose front looks to the middle of the room."""
    dx, dy = facing(at, region)
    case = _around(at.x, at.y, HALF_M, HALF_M)
    _box(root, case, 0.0, INSIDE_M, _CASE, f"case-{name}")
    _box(root, case, CONTAINER_M - 0.02, CONTAINER_M, _CASE)
    for sx, sy in ((1, 0), (-1, 0), (0, 1), (0, -1)):
        if (sx, sy) == (dx, dy):
            continue
        side = _around(
            at.x + sx * (HALF_M - 0.01),
            at.y + sy * (HALF_M - 0.01),
            0.01 if sx else HALF_M,
            0.01 if sy else HALF_M,
        )
        _box(root, side, INSIDE_M, CONTAINER_M - 0.02, _CASE)
    root.add_geom(
        name=f"door-{name}",
        type=mujoco.mjtGeom.mjGEOM_BOX,
        pos=[
            at.x + dx * (HALF_M + 0.01),
            at.y + dy * (HALF_M + 0.01),
            (INSIDE_M + CONTAINER_M) / 2,
        ],
        size=[0.012 if dx else HALF_M, 0.012 if dy else HALF_M, (CONTAINER_M - INSIDE_M) / 2],
        rgba=list(DOOR),
        contype=0,
        conaffinity=0,
    )


def facing(at: Pose, region: Area | None) -> tuple[int, int]:
    """The side of a piece of furniture that looks into the room."""
    if region is None:
        return 0, 1
    x, y = region.middle
    # Along walls, the nearest one is behind it.
    gaps = {
        (1, 0): at.x - region.left,
        (-1, 0): region.right - at.x,
        (0, 1): at.y - region.bottom,
        (0, -1): region.top - at.y,
    }
    nearest = min(gaps.values())
    sides = [side for side, gap in gaps.items() if math.isclose(gap, nearest)]
    return max(sides, key=lambda side: side[0] * (x - at.x) + side[1] * (y - at.y))


def _thing(spec: Any, name: str, entity: Entity | None, number: int) -> None:
    body = spec.worldbody.add_body(name=f"thing-{name}", pos=_away(number, entity is None))
    body.add_freejoint(name=f"free-{name}")
    words = name.replace("_", "-").split("-")
    noun = entity.noun if entity is not None and entity.noun else words[-1]
    kind, size = _shape(noun)
    colour = next((_COLOURS[w] for w in words if w in _COLOURS), None)
    if colour is None:
        colour = (
            (0.93, 0.92, 0.88, 1.0) if noun in ("cup", "plate", "tray") else _THINGS[number % 5]
        )
    body.add_geom(
        name=f"shape-{name}",
        type=kind,
        size=list(size),
        rgba=list(colour),
        mass=0.15,
        contype=THING,
        conaffinity=FURNITURE | THING,
        friction=[0.8, 0.01, 0.001],
        condim=4,
    )
    weld = spec.add_equality(
        name=f"grasp-{name}",
        type=mujoco.mjtEq.mjEQ_WELD,
        objtype=mujoco.mjtObj.mjOBJ_BODY,
        name1=GRASP_BODY,
        name2=f"thing-{name}",
        active=False,
    )
    # Anchor, position and orientation of the thing in the gripper's frame, and how stiffly it turns along.
    weld.data[:11] = [0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1]


def _shape(noun: str) -> tuple[Any, tuple[float, float, float]]:
    if noun in _FLAT:
        return mujoco.mjtGeom.mjGEOM_BOX, _FLAT[noun]
    if noun in _CUPS:
        return mujoco.mjtGeom.mjGEOM_CYLINDER, (0.035, 0.045, 0.0)
    if noun in _DISHES:
        return mujoco.mjtGeom.mjGEOM_CYLINDER, (0.06, 0.015, 0.0)
    return mujoco.mjtGeom.mjGEOM_BOX, (0.045, 0.03, 0.03)


def _away(number: int, spare: bool) -> list[float]:
    return [AWAY[0] + 0.5 * number, AWAY[1] + (2.0 if spare else 0.0), AWAY[2]]


def _person(root: Any, name: str, number: int) -> None:
    body = root.add_body(name=f"person-{name}", mocap=True, pos=[0, 0, 0])
    quiet = {"contype": 0, "conaffinity": 0}
    clothes = list(_CLOTHES[number % len(_CLOTHES)])
    body.add_geom(
        type=mujoco.mjtGeom.mjGEOM_CAPSULE, pos=[0, 0, 0.45], size=[0.13, 0.32, 0],
        rgba=[0.25, 0.25, 0.30, 1.0], **quiet,
    )  # fmt: skip
    body.add_geom(
        type=mujoco.mjtGeom.mjGEOM_CAPSULE, pos=[0, 0, 1.05], size=[0.18, 0.25, 0], rgba=clothes, **quiet
    )  # fmt: skip
    body.add_geom(
        type=mujoco.mjtGeom.mjGEOM_SPHERE, pos=[0, 0, 1.55], size=[0.12, 0, 0], rgba=list(_SKIN), **quiet
    )  # fmt: skip
    body.add_geom(
        type=mujoco.mjtGeom.mjGEOM_SPHERE, pos=[0.12, 0, 1.55], size=[0.03, 0, 0], rgba=list(_SKIN), **quiet
    )  # fmt: skip
