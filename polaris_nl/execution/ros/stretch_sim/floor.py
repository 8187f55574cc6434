"""The floor: which places are free, and the way from one to another.

The world's ROS map is used where there is one (map_server's YAML and an 8-bit PGM); otherwise what isn't
furniture is free. The way is found with A* over the cells that the robot's round base fits on.
"""

from __future__ import annotations

import heapq
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import yaml

from polaris_nl.execution.ros.layout import Layout
from polaris_nl.model.errors import FormatError

Cell = tuple[int, int]

ROBOT_RADIUS_M = 0.22
_HALF_FURNITURE_M = 0.2
_MARGIN_M = 0.5
_OPEN_RESOLUTION_M = 0.05
_NEAR_WALL_M = 0.45
"""Cells nearer to a wall than this cost more, so that ways keep their distance where they can."""


@dataclass(frozen=True)
class Floor:
    """Cells of a map, row by row from the lower left.

    Attributes:
        width, height: in cells.
        resolution: metres a cell.
        origin: the lower left corner of the first cell, in metres.
        clearance: for each cell the metres to the nearest occupied one, at most `_NEAR_WALL_M`.
    """

    width: int
    height: int
    resolution: float
    origin: tuple[float, float]
    clearance: Sequence[float]

    def fits(self, x: float, y: float) -> bool:
        """Whether the robot can be at a point."""
        return self._open(self.cell(x, y))

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
        cells = self._search(self.cell(*start), self.cell(*goal))
        if not cells:
            return []
        points = [self.point(c) for c in cells]
        return [*self._straightened(start, points)[:-1], goal]

    def sees(self, a: tuple[float, float], b: tuple[float, float], clearance: float = 0.0) -> bool:
        """Whether the straight line between two points keeps a distance from everything occupied."""
        steps = max(1, math.ceil(math.dist(a, b) / self.resolution))
        for i in range(steps + 1):
            t = i / steps
            cell = self.cell(a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t)
            if not self._inside(cell) or self._at(cell) <= clearance:
                return False
        return True

    def _inside(self, cell: Cell) -> bool:
        return 0 <= cell[0] < self.width and 0 <= cell[1] < self.height

    def _at(self, cell: Cell) -> float:
        return self.clearance[cell[1] * self.width + cell[0]]

    def _open(self, cell: Cell) -> bool:
        return self._inside(cell) and self._at(cell) > ROBOT_RADIUS_M

    def _search(self, start: Cell, goal: Cell) -> list[Cell]:
        if not self._open(goal):
            return []
        best: dict[Cell, float] = {start: 0.0}
        came: dict[Cell, Cell] = {}
        queue: list[tuple[float, Cell]] = [(0.0, start)]
        closed: set[Cell] = set()
        while queue:
            _, cell = heapq.heappop(queue)
            if cell == goal:
                return _way(came, cell)
            if cell in closed:
                continue
            closed.add(cell)
            for near, cost in self._neighbours(cell):
                total = best[cell] + cost
                if total < best.get(near, math.inf):
                    best[near] = total
                    came[near] = cell
                    heapq.heappush(queue, (total + math.dist(near, goal), near))
        return []

    def _neighbours(self, cell: Cell) -> Iterator[tuple[Cell, float]]:
        # From where the robot doesn't fit (it was put there) it may go on to where it does.
        for dx, dy in ((1, 0), (-1, 0), (0, 1), (0, -1), (1, 1), (1, -1), (-1, 1), (-1, -1)):
            near = cell[0] + dx, cell[1] + dy
            if not self._inside(near):
                continue
            if not self._open(near) and (self._open(cell) or self._at(near) <= 0):
                continue
            tight = 2.0 * (1 - min(self._at(near) / _NEAR_WALL_M, 1.0))
            yield near, math.hypot(dx, dy) * (1 + tight)

    def _straightened(
        self, start: tuple[float, float], points: Sequence[tuple[float, float]]
    ) -> list[tuple[float, float]]:
        kept: list[tuple[float, float]] = []
        here, at = start, 0
        while at < len(points) - 1:
            ahead = len(points) - 1
            while ahead > at + 1 and not self.sees(here, points[ahead], ROBOT_RADIUS_M + 0.03):
                ahead = at + (ahead - at) // 2
            kept.append(points[ahead])
            here, at = points[ahead], ahead
        return kept or [points[-1]]


def _way(came: dict[Cell, Cell], cell: Cell) -> list[Cell]:
    way = [cell]
    while cell in came:
        cell = came[cell]
        way.append(cell)
    return way[::-1]


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
    return Floor(width, height, _OPEN_RESOLUTION_M, (left, bottom), cleared)


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
        negate = bool(given.get("negate", 0))
        magic, width, height, _ = _header(image)
        x, y = float(origin[0]), float(origin[1])
    except (OSError, KeyError, TypeError, ValueError, yaml.YAMLError) as error:
        raise FormatError(f"This map can't be read ({error}).", path) from error
    if magic != b"P5" or len(image) < width * height:
        raise FormatError(f"The image {given['image']} isn't an 8-bit PGM.", path)
    levels = image[len(image) - width * height :]
    occupied = bytearray(width * height)
    for row in range(height):
        for column in range(width):
            level = levels[row * width + column]
            darkness = level / 255 if negate else (255 - level) / 255
            # Where nothing is known the robot doesn't go.
            occupied[(height - 1 - row) * width + column] = darkness >= free_below
    cleared = _clearance(occupied, width, height, resolution)
    return Floor(width, height, resolution, (x, y), cleared)


def _header(image: bytes) -> tuple[bytes, int, int, int]:
    words: list[bytes] = []
    for line in image.split(b"\n", 8)[:8]:
        words += line.partition(b"#")[0].split()
        if len(words) >= 4:
            break
    return words[0], int(words[1]), int(words[2]), int(words[3])


def _clearance(occupied: bytearray, width: int, height: int, resolution: float) -> list[float]:
    """The metres from each cell to the nearest occupied one, as far as they matter."""
    reach = math.ceil(_NEAR_WALL_M / resolution)
    ring = sorted(
        (math.hypot(dx, dy) * resolution, dx, dy)
        for dx in range(-reach, reach + 1)
        for dy in range(-reach, reach + 1)
    )
    clearance = [0.0 if cell else _NEAR_WALL_M for cell in occupied]
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
