"""Draws moments of a simulation: the robot seen from near on the left, the whole world on the right.

MuJoCo draws off screen with EGL; names are written over it.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Any

import mujoco
import numpy as np
from PIL import Image, ImageDraw, ImageFont

from polaris_nl.execution.ros.layout import Layout, Pose
from polaris_nl.execution.ros.stretch_sim.floor import Floor
from polaris_nl.execution.ros.stretch_sim.mujoco_robot import controls
from polaris_nl.execution.ros.stretch_sim.mujoco_world import AWAY, DOOR, SPARES, furnished
from polaris_nl.execution.ros.stretch_sim.scene import CONTAINER_M, SURFACE_M
from polaris_nl.execution.ros.stretch_sim.snapshot import Snapshot
from polaris_nl.model.world import World

WIDTH, HEIGHT = 640, 480
CAPTION = 28
LABEL_NEAR_M = 3.2
_AHEAD_M = 0.4
ROBOT_LABEL = "robot"
_INK, _PAPER, _ROBOT = (20, 22, 26), (255, 255, 255), (255, 176, 64)
_FOV_Y = math.radians(45)

Label = tuple[str, tuple[float, float, float]]


class Painter:
    """Draws one world. All calls come from one thread, as OpenGL wants it.

    Args:
        world, layout, floor: what there is.
        start: where the robot stands at the start.
    """

    def __init__(self, world: World, layout: Layout, floor: Floor, start: Pose) -> None:
        built = furnished(world, layout, floor, start)
        self._model: Any = built.model
        self._data: Any = mujoco.MjData(self._model)
        self._things = built.things
        self._layout = layout
        self._renderer: Any = mujoco.Renderer(self._model, HEIGHT, WIDTH)
        self._near, self._far = mujoco.MjvCamera(), mujoco.MjvCamera()
        self._font = ImageFont.load_default(size=13)
        self._aim_far(layout)

    def draw(self, moment: Snapshot) -> Any:
        """A picture.

        Returns:
            An array of bytes, height x width x 3 (RGB).
        """
        self._pose(moment)
        self._aim_near(moment)
        views = [
            self._view(self._near, self._nearby(moment)),
            self._view(self._far, self._regions(moment)),
        ]
        picture = Image.new("RGB", (2 * WIDTH, HEIGHT + CAPTION), _INK)
        for number, view in enumerate(views):
            picture.paste(view, (number * WIDTH, 0))
        ImageDraw.Draw(picture).text((10, HEIGHT + 6), moment.caption, _PAPER, self._font)
        return np.asarray(picture)

    def close(self) -> None:
        """Frees what OpenGL holds."""
        self._renderer.close()

    def _view(self, camera: Any, labels: Iterator[Label]) -> Image.Image:
        self._renderer.update_scene(self._data, camera)
        view = Image.fromarray(self._renderer.render())
        draw = ImageDraw.Draw(view)
        taken: list[tuple[float, float, float, float]] = []
        for text, at in labels:
            where = self._project(at)
            if where is None:
                continue
            half = draw.textlength(text, self._font) / 2 + 4
            where = min(max(where[0], half), WIDTH - half), min(max(where[1], 10), HEIGHT - 10)
            box = draw.textbbox(where, text, self._font, anchor="mm")
            if any(_overlap(box, other) for other in taken):
                continue
            taken.append(box)
            paper = _ROBOT if text == ROBOT_LABEL else _PAPER
            draw.rectangle((box[0] - 3, box[1] - 2, box[2] + 3, box[3] + 2), fill=paper)
            draw.text(where, text, _INK, self._font, anchor="mm")
        return view

    def _project(self, at: Sequence[float]) -> tuple[float, float] | None:
        """Where a point of the world is in the picture, or None if it is outside."""
        cameras = self._renderer.scene.camera
        eye = (np.asarray(cameras[0].pos) + np.asarray(cameras[1].pos)) / 2
        forward, up = np.asarray(cameras[0].forward), np.asarray(cameras[0].up)
        ray = np.asarray(at) - eye
        depth = float(ray @ forward)
        if depth <= 0.1:
            return None
        scale = HEIGHT / 2 / math.tan(_FOV_Y / 2) / depth
        x = WIDTH / 2 + float(ray @ np.cross(forward, up)) * scale
        y = HEIGHT / 2 - float(ray @ up) * scale
        return (x, y) if 0 <= x < WIDTH and 0 <= y < HEIGHT else None

    # Labels

    def _nearby(self, moment: Snapshot) -> Iterator[Label]:
        def near(x: float, y: float) -> bool:
            return moment.pose.distance(x, y) < LABEL_NEAR_M

        for name, person in moment.people.items():
            if near(person.x, person.y):
                yield name, (person.x, person.y, 1.8)
        if moment.held in moment.things:
            x, y, z = moment.things[moment.held]
            yield moment.held, (x, y, z + 0.12)
        for name, place in self._layout.places.items():
            if near(place.x, place.y):
                height = CONTAINER_M if name in self._layout.containers else SURFACE_M
                yield name, (place.x, place.y, height - 0.2)
        for name, (x, y, z) in moment.things.items():
            if name != moment.held and near(x, y) and not self._hidden(moment, x, y):
                yield name, (x, y, z + 0.12)

    def _regions(self, moment: Snapshot) -> Iterator[Label]:
        yield ROBOT_LABEL, (moment.pose.x, moment.pose.y, 1.6)
        for name, person in moment.people.items():
            yield name, (person.x, person.y, 1.9)
        for name, area in self._layout.areas.items():
            yield name, (area.middle[0], area.bottom + 0.7, 0.0)

    def _hidden(self, moment: Snapshot, x: float, y: float) -> bool:
        place = self._layout.place_at(x, y, 0.3)
        return place in self._layout.containers and place not in moment.open

    # Cameras and bodies

    def _aim_near(self, moment: Snapshot) -> None:
        pose = moment.pose
        # From the left in front of the robot, so that the arm, which goes out to its right, isn't hidden.
        self._near.lookat[:] = (
            pose.x + _AHEAD_M * math.sin(pose.yaw),
            pose.y - _AHEAD_M * math.cos(pose.yaw),
            0.7,
        )
        self._near.distance = 3.0
        self._near.elevation = -28
        self._near.azimuth = math.degrees(pose.yaw) - 150

    def _aim_far(self, layout: Layout) -> None:
        left = min(a.left for a in layout.areas.values())
        right = max(a.right for a in layout.areas.values())
        bottom = min(a.bottom for a in layout.areas.values())
        top = max(a.top for a in layout.areas.values())
        self._far.lookat[:] = ((left + right) / 2, (bottom + top) / 2 - 0.3, 0.0)
        across, along = (right - left) / (WIDTH / HEIGHT), (top - bottom) * 0.95
        self._far.distance = 0.64 * max(across, along) / math.tan(_FOV_Y / 2) + 0.5
        self._far.elevation = -68
        self._far.azimuth = 90

    def _pose(self, moment: Snapshot) -> None:
        base = self._data.joint("base").qpos
        base[:3] = (moment.pose.x, moment.pose.y, 0.0)
        base[3:] = _turned(moment.pose.yaw)
        for name, value in controls(moment.joints).items():
            self._data.joint(name).qpos[0] = value
        self._put_things(moment)
        for name, person in moment.people.items():
            body = self._model.body(f"person-{name}").mocapid[0]
            self._data.mocap_pos[body] = (person.x, person.y, 0.0)
            self._data.mocap_quat[body] = _turned(person.yaw)
        for name in self._layout.containers:
            door = self._model.geom(f"door-{name}").id
            self._model.geom_rgba[door] = (*DOOR[:3], 0.0 if name in moment.open else 1.0)
        mujoco.mj_forward(self._model, self._data)

    def _put_things(self, moment: Snapshot) -> None:
        spares = iter(SPARES)
        for name in self._things:
            self._data.joint(f"free-{name}").qpos[:3] = AWAY
        for name, at in moment.things.items():
            body = name if name in self._things else next(spares, None)
            if body is not None:
                joint = self._data.joint(f"free-{body}").qpos
                joint[:3] = at
                joint[3:] = _turned(moment.pose.yaw if name == moment.held else 0.0)


def _turned(yaw: float) -> tuple[float, float, float, float]:
    return math.cos(yaw / 2), 0.0, 0.0, math.sin(yaw / 2)


def _overlap(a: Sequence[float], b: Sequence[float]) -> bool:
    return a[0] < b[2] + 6 and b[0] < a[2] + 6 and a[1] < b[3] + 4 and b[1] < a[3] + 4
