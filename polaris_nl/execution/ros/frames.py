"""The robot's tree of transforms, and where things are on the map by it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from polaris_nl.execution.ros.layout import Pose

MAP = "map"
BASE = "base_link"
MOST_LINKS = 32
Vector = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]


@dataclass(frozen=True, slots=True)
class Transform:
    """A translation (m) and a rotation (unit quaternion x, y, z, w)."""

    at: Vector = (0.0, 0.0, 0.0)
    turn: Quaternion = (0.0, 0.0, 0.0, 1.0)

    @classmethod
    def of(cls, at: Any, turn: Any) -> Transform:
        """From the fields of a message."""
        return cls((at.x, at.y, at.z), (turn.x, turn.y, turn.z, turn.w))

    def __matmul__(self, inner: Transform) -> Transform:
        """This transform after an inner one."""
        x, y, z = rotated(inner.at, self.turn)
        return Transform(
            (self.at[0] + x, self.at[1] + y, self.at[2] + z), _product(self.turn, inner.turn)
        )

    @property
    def pose(self) -> Pose:
        """Place and heading in the plane."""
        x, y, z, w = self.turn
        return Pose(
            self.at[0], self.at[1], math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
        )


class Frames:
    """The latest transform of each frame, from its parent."""

    def __init__(self) -> None:
        self._links: dict[str, tuple[str, Transform, float]] = {}

    def take(self, parent: str, child: str, link: Transform, stamp: float) -> None:
        """Takes a transform in; `stamp` is its time in seconds."""
        self._links[child.lstrip("/")] = (parent.lstrip("/"), link, stamp)

    def on_map(self, frame: str, local: Transform | None = None) -> Transform | None:
        """A pose given in a frame, on the map; None where the chain of frames has a gap."""
        frame, found = frame.lstrip("/"), local or Transform()
        for _ in range(MOST_LINKS):
            if frame == MAP:
                return found
            if frame not in self._links:
                return None
            frame, link, _ = self._links[frame]
            found = link @ found
        return None

    def base(self) -> tuple[Pose, float] | None:
        """The base's pose on the map, and the time of its own, last link."""
        found = self.on_map(BASE)
        return None if found is None else (found.pose, self._links[BASE][2])


def rotated(v: Vector, q: Quaternion) -> Vector:
    """A vector turned by a rotation."""
    x, y, z, _ = _product(_product(q, (*v, 0.0)), (-q[0], -q[1], -q[2], q[3]))
    return x, y, z


def _product(a: Quaternion, b: Quaternion) -> Quaternion:
    return (
        a[3] * b[0] + a[0] * b[3] + a[1] * b[2] - a[2] * b[1],
        a[3] * b[1] - a[0] * b[2] + a[1] * b[3] + a[2] * b[0],
        a[3] * b[2] + a[0] * b[1] - a[1] * b[0] + a[2] * b[3],
        a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2],
    )
