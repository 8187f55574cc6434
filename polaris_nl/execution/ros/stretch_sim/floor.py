"""The floor: which places are free, and the way from one to another.

The world's ROS map is used where there is one (map_server's YAML and an 8-bit PGM); otherwise what isn't
furniture is free.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import yaml

from polaris_nl.execution.ros.layout import Area, Layout
from polaris_nl.execution.ros.stretch_sim.ways import Ways
from polaris_nl.model.errors import FormatError

Cell = tuple[int, int]

ROBOT_RADIUS_M = 0.22
_ROUTE_RADIUS_M = ROBOT_RADIUS_M + 0.03
_HALF_FURNITURE_M = 0.2
_MARGIN_M = 0.5
_FURNITURE_REACH_M = 0.45
_HALF_WALL_M = 0.06
_OPEN_RESOLUTION_M = 0.05
NEAR_WALL_M = 0.45
"""Cells nearer to a wall than this cost more, so that ways keep their distance where they can."""


@dataclass(frozen=True)
class Floor:
    """Cells of a map, row by row from the lower left.

    Attributes:
        width, height: in cells.
        resolution: metres a cell.
        origin: the lower left corner of the first cell, in metres.
        clearance: for each cell the metres to the nearest occupied one, at most `NEAR_WALL_M`.
        solid: for each cell whether something is known to be there, a wall or a piece of furniture.
    """

    width: int
    height: int
    resolution: float
    origin: tuple[float, float]
    clearance: Sequence[float]
    solid: bytes

    def fits(self, x: float, y: float) -> bool:
        """Whether the robot can be at a point."""
        return self._open(self.cell(x, y))

    def room(self, x: float, y: float) -> float:
        """The metres from a point to what is nearest, as far as they matter; 0 off the map."""
        cell = self.cell(x, y)
        return self._at(cell) if self._inside(cell) else 0.0

    def cell(self, x: float, y: float) -> Cell:
        """The cell of a point."""
        return (
            math.floor((x - self.origin[0]) / self.resolution),
            math.floor((y - self.origin[1]) / self.resolution),
        )

    def point(self, cell: Cell) -> tuple[float, float]:
        """The middle of a cell."""
        return (
            self.origin[0] + (cell[0] + 0.5) * self.resolution,
            self.origin[1] + (cell[1] + 0.5) * self.resolution,
        )

    def nearest(self, x: float, y: float, within_m: float) -> tuple[float, float] | None:
        """The point if the robot fits there, or else the nearest where it does; None if there is none."""
        if self.fits(x, y):
            return x, y
        reach = math.ceil(within_m / self.resolution)
        cx, cy = self.cell(x, y)
        around = (
            (cx + dx, cy + dy) for dx in range(-reach, reach + 1) for dy in range(-reach, reach + 1)
        )
        found = [(math.dist(self.point(c), (x, y)), self.point(c)) for c in around if self._open(c)]
        distance, point = min(found, default=(math.inf, (x, y)))
        return point if distance <= within_m else None

    def route(
        self, start: tuple[float, float], goal: tuple[float, float]
    ) -> list[tuple[float, float]]:
        """Points on the way, the goal last, with as few corners as there can be; [] where there is no way."""
        if self.fits(*start) and self.sees(start, goal, _ROUTE_RADIUS_M):
            return [goal]
        points = self._ways.between(start, goal)
        return [*self._straightened(start, [*points, goal])[:-1], goal] if points else []

    def sees(self, a: tuple[float, float], b: tuple[float, float], clearance: float = 0.0) -> bool:
        """Whether the straight line between two points keeps a distance from everything occupied."""
        steps = max(1, math.ceil(math.dist(a, b) / self.resolution))
        for i in range(steps + 1):
            t = i / steps
            cell = self.cell(a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t)
            if not self._inside(cell) or self._at(cell) <= clearance:
                return False
        return True

    @cached_property
    def _ways(self) -> Ways:
        return Ways(self, NEAR_WALL_M)

    def walls(self, layout: Layout) -> list[Area]:
        """Rectangles that cover what is solid, but for furniture, in metres."""
        left = bytearray(self.solid)
        for place in layout.places.values():
            for index, cell in self._around(place.x, place.y, _FURNITURE_REACH_M):
                x, y = self.point(cell)
                region = layout.areas.get(layout.region_at(place.x, place.y))
                if region is not None and region.holds(x, y, _HALF_WALL_M):
                    left[index] = 0
        # Each rectangle takes its cells out of what is left for the ones after it.
        return [self._rectangle(left, start) for start in range(len(left)) if left[start]]

    def _around(self, x: float, y: float, reach: float) -> Iterator[tuple[int, Cell]]:
        steps = math.ceil(reach / self.resolution)
        cx, cy = self.cell(x, y)
        for dy in range(-steps, steps + 1):
            for dx in range(-steps, steps + 1):
                cell = cx + dx, cy + dy
                if self._inside(cell):
                    yield cell[1] * self.width + cell[0], cell

    def _rectangle(self, left: bytearray, start: int) -> Area:
        """Takes the largest run to the right of a cell, and then upwards, out of what is left."""
        x0, y0 = start % self.width, start // self.width
        x1 = x0
        while x1 < self.width and left[y0 * self.width + x1]:
            x1 += 1
        y1 = y0
        while y1 < self.height and all(left[y1 * self.width + x0 : y1 * self.width + x1]):
            left[y1 * self.width + x0 : y1 * self.width + x1] = bytes(x1 - x0)
            y1 += 1
        (ox, oy), r = self.origin, self.resolution
        return Area(ox + x0 * r, oy + y0 * r, ox + x1 * r, oy + y1 * r)

    def _inside(self, cell: Cell) -> bool:
        return 0 <= cell[0] < self.width and 0 <= cell[1] < self.height

    def _at(self, cell: Cell) -> float:
        return self.clearance[cell[1] * self.width + cell[0]]

    def _open(self, cell: Cell) -> bool:
        return self._inside(cell) and self._at(cell) > ROBOT_RADIUS_M

    def _straightened(
        self, start: tuple[float, float], points: Sequence[tuple[float, float]]
    ) -> list[tuple[float, float]]:
        kept: list[tuple[float, float]] = []
        here, at = start, 0
        while at < len(points) - 1:
            ahead = len(points) - 1
            while ahead > at + 1 and not self.sees(here, points[ahead], _ROUTE_RADIUS_M):
                ahead = at + (ahead - at) // 2
            kept.append(points[ahead])
            here, at = points[ahead], ahead
        return kept or [points[-1]]


def floor_of(layout: Layout, map_file: Path | None) -> Floor:
    """The floor of a world.

    Raises:
        FormatError: the map can't be read.
    """
    if map_file is not None:
        return read_map(map_file)
    areas = list(layout.areas.values())
    left, bottom = min(a.left for a in areas) - _MARGIN_M, min(a.bottom for a in areas) - _MARGIN_M
    right, top = max(a.right for a in areas) + _MARGIN_M, max(a.top for a in areas) + _MARGIN_M
    width = math.ceil((right - left) / _OPEN_RESOLUTION_M)
    height = math.ceil((top - bottom) / _OPEN_RESOLUTION_M)
    occupied = bytearray(width * height)
    for place in layout.places.values():
        for y in range(height):
            for x in range(width):
                px, py = left + x * _OPEN_RESOLUTION_M, bottom + y * _OPEN_RESOLUTION_M
                if max(abs(px - place.x), abs(py - place.y)) <= _HALF_FURNITURE_M:
                    occupied[y * width + x] = 1
    cleared = _clearance(occupied, width, height, _OPEN_RESOLUTION_M)
    solid = bytes(len(occupied))
    return Floor(width, height, _OPEN_RESOLUTION_M, (left, bottom), cleared, solid)


def read_map(path: Path) -> Floor:
    """A map_server file with its image.

    Raises:
        FormatError: it isn't one, or its image isn't an 8-bit PGM.
    """
    try:
        given = yaml.safe_load(path.read_text(encoding="utf-8"))
        image = path.with_name(given["image"]).read_bytes()
        resolution, origin = float(given["resolution"]), given["origin"]
        free_below = float(given.get("free_thresh", 0.196))
        solid_above = float(given.get("occupied_thresh", 0.65))
        negate = bool(given.get("negate", 0))
        magic, width, height, _ = _header(image)
        x, y = float(origin[0]), float(origin[1])
    except (OSError, KeyError, TypeError, ValueError, yaml.YAMLError) as error:
        raise FormatError(f"This map can't be read ({error}).", path) from error
    if magic != b"P5" or len(image) < width * height:
        raise FormatError(f"The image {given['image']} isn't an 8-bit PGM.", path)
    levels = image[len(image) - width * height :]
    occupied, solid = bytearray(width * height), bytearray(width * height)
    for row in range(height):
        for column in range(width):
            level = levels[row * width + column]
            darkness = level / 255 if negate else (255 - level) / 255
            cell = (height - 1 - row) * width + column
            # Where nothing is known the robot doesn't go.
            occupied[cell] = darkness >= free_below
            solid[cell] = darkness >= solid_above
    cleared = _clearance(occupied, width, height, resolution)
    return Floor(width, height, resolution, (x, y), cleared, bytes(solid))


def _header(image: bytes) -> tuple[bytes, int, int, int]:
    words: list[bytes] = []
    for line in image.split(b"\n", 8)[:8]:
        words += line.partition(b"#")[0].split()
        if len(words) >= 4:
            break
    return words[0], int(words[1]), int(words[2]), int(words[3])


def _clearance(occupied: bytearray, width: int, height: int, resolution: float) -> list[float]:
    """The metres from each cell to the nearest occupied one, as far as they matter."""
    reach = math.ceil(NEAR_WALL_M / resolution)
    ring = sorted(
        (math.hypot(dx, dy) * resolution, dx, dy)
        for dx in range(-reach, reach + 1)
        for dy in range(-reach, reach + 1)
    )
    clearance = [0.0 if cell else NEAR_WALL_M for cell in occupied]
    for index, cell in enumerate(occupied):
        if not cell:
            continue
        x, y = index % width, index // width
        if _buried(occupied, x, y, width, height):
            continue
        for distance, dx, dy in ring:
            if 0 <= x + dx < width and 0 <= y + dy < height:
                near = (y + dy) * width + x + dx
                clearance[near] = min(clearance[near], distance)
    return clearance


def _buried(occupied: bytearray, x: int, y: int, width: int, height: int) -> bool:
    """Whether all cells around one are occupied too, so that it is nobody's nearest."""
    if not (0 < x < width - 1 and 0 < y < height - 1):
        return False
    at = y * width + x
    return bool(
        occupied[at - 1] and occupied[at + 1] and occupied[at - width] and occupied[at + width]
    )
