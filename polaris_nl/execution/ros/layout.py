"""Where things are on the map, and where the robot stands to get at them. Pure."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from polaris_nl.model.world import World

MARGIN_M = 0.35
"""How far the robot keeps from the edge of a region: half its width, and some."""
STEP_M = 0.25
INSIDE_M = 0.3
OUTSIDE_M = 0.5
"""How far inside an edge a region counts as entered, and how far outside as left."""


@dataclass(frozen=True, slots=True)
class Pose:
    """A place on the map (m) and a heading (rad)."""

    x: float
    y: float
    yaw: float = 0.0

    def distance(self, x: float, y: float) -> float:
        """Metres to a point."""
        return math.hypot(self.x - x, self.y - y)


@dataclass(frozen=True, slots=True)
class Area:
    """A rectangle on the map, in metres."""

    left: float
    bottom: float
    right: float
    top: float

    def holds(self, x: float, y: float, margin: float = 0.0) -> bool:
        """Whether a point is in it, `margin` or more from its edge."""
        return (
            self.left + margin <= x <= self.right - margin
            and self.bottom + margin <= y <= self.top - margin
        )

    @property
    def middle(self) -> tuple[float, float]:
        """Its centre."""
        return (self.left + self.right) / 2, (self.bottom + self.top) / 2

    def grid(self, margin: float) -> Iterator[tuple[float, float]]:
        """Points in it, `STEP_M` apart."""
        across = max(int((self.right - self.left - 2 * margin) / STEP_M), 0)
        up = max(int((self.top - self.bottom - 2 * margin) / STEP_M), 0)
        for i in range(across + 1):
            for j in range(up + 1):
                yield self.left + margin + i * STEP_M, self.bottom + margin + j * STEP_M


@dataclass(frozen=True)
class Layout:
    """What perception and navigation know of a world's map.

    Attributes:
        areas: by region.
        places: surfaces and containers, with their poses.
        regions: the region that each surface and container is in.
        containers: which of the places are containers.
    """

    areas: Mapping[str, Area]
    places: Mapping[str, Pose]
    regions: Mapping[str, str]
    containers: frozenset[str]

    @classmethod
    def of(cls, world: World) -> Layout:
        """The layout of a world."""
        areas = {
            e.name: Area(
                min(e.area[0][0], e.area[1][0]),
                min(e.area[0][1], e.area[1][1]),
                max(e.area[0][0], e.area[1][0]),
                max(e.area[0][1], e.area[1][1]),
            )
            for e in world.of_type("region")
            if e.area is not None
        }
        places = {
            e.name: Pose(*e.pose)
            for e in world.of_type("surface", "container")
            if e.pose is not None
        }
        regions = {f.args[0]: f.args[1] for f in world.facts if f.predicate == "located"}
        containers = frozenset(e.name for e in world.of_type("container"))
        return cls(areas, places, regions, containers)

    def region_at(self, x: float, y: float, before: str = "") -> str:
        """The region of a point, or "".

        At an edge it is the one that it was in before, so that it doesn't flicker: a region is
        entered when the whole robot is in, and left when it is well out.
        """
        entered = next((n for n, area in self.areas.items() if area.holds(x, y, INSIDE_M)), "")
        if entered:
            return entered
        if before in self.areas and self.areas[before].holds(x, y, -OUTSIDE_M):
            return before
        return next((name for name, area in self.areas.items() if area.holds(x, y)), "")

    def place_at(self, x: float, y: float, near_m: float) -> str:
        """The surface or container that is nearest to a point, and nearer than `near_m`, or ""."""
        near = [(p.distance(x, y), name) for name, p in self.places.items()]
        distance, name = min(near, default=(math.inf, ""))
        return name if distance <= near_m else ""

    def standing(self, region: str) -> Pose | None:
        """Where the robot stands in a region: free of furniture, and near its middle; None if unknown."""
        area = self.areas.get(region)
        if area is None:
            return None
        x, y = area.middle
        best = min(
            area.grid(MARGIN_M),
            key=lambda p: (max(0.0, 0.8 - self.clearance(*p)), math.dist(p, (x, y))),
            default=(x, y),
        )
        return Pose(*best)

    def beside(self, x: float, y: float, region: str, standoff_m: float) -> Pose | None:
        """Where the robot stands to reach a point: beside it, since the arm goes out to the right.

        Returns:
            A pose in the region with the point on the robot's right; None for an unknown region.
        """
        area = self.areas.get(region)
        if area is None:
            return None
        middle = area.middle

        def cost(bearing: float) -> tuple[float, float]:
            at = x - standoff_m * math.cos(bearing), y - standoff_m * math.sin(bearing)
            outside = 0.0 if area.holds(*at, MARGIN_M) else 10.0
            outside += 0.0 if area.holds(*at) else 100.0
            tight = max(0.0, 0.6 - self.clearance(*at))
            return outside + tight, math.dist(at, middle)

        bearing = min((math.pi * k / 12 for k in range(24)), key=cost)
        return Pose(
            x - standoff_m * math.cos(bearing),
            y - standoff_m * math.sin(bearing),
            wrapped(bearing + math.pi / 2),
        )

    def clearance(self, x: float, y: float) -> float:
        """Metres from a point to the nearest furniture."""
        return min((p.distance(x, y) for p in self.places.values()), default=math.inf)


def wrapped(angle: float) -> float:
    """An angle in -pi to pi."""
    return math.atan2(math.sin(angle), math.cos(angle))
