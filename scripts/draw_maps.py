"""Draws the maps of the shipped worlds, as ROS's map_server reads them.

For each world, `<world>.pgm` and `<world>.map.yaml` are written beside its file. Regions are free
inside and walled, everything around them is unknown, regions that are connected share a door (or a
corridor, where they don't touch), and furniture with a pose stands in the way. The same world always
gives the same bytes:

    python scripts/draw_maps.py            # draws the maps of all worlds
    python scripts/draw_maps.py --check    # only says which maps are not what would be drawn
"""

from __future__ import annotations

import argparse
import math
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from polaris_nl.model.data import shipped_worlds
from polaris_nl.model.errors import PolarisError, WorldError
from polaris_nl.model.world import Entity, Point, World
from polaris_nl.model.world_file import load_world

CELLS_PER_METRE = 20
RESOLUTION = 1 / CELLS_PER_METRE  # metres
FREE, UNKNOWN, OCCUPIED = 254, 205, 0  # grey levels

# In cells.
_MARGIN = 10  # around everything
_HALF_WALL = 1  # walls lie astride the borders of regions
_WALL = 2 * _HALF_WALL
_HALF_DOOR = 9
_DOOR = 2 * _HALF_DOOR
_HALF_FURNITURE = 4
_CLEARANCE = 10  # around doors, where no furniture is drawn: the width of a robot

_FURNITURE = ("surface", "container")


@dataclass(frozen=True, slots=True)
class Box:
    """The cells from (x0, y0), its lower left, up to but without (x1, y1)."""

    x0: int
    y0: int
    x1: int
    y1: int

    def grown(self, cells: int) -> Box:
        """The box with so many cells more, or fewer, on each side."""
        return Box(self.x0 - cells, self.y0 - cells, self.x1 + cells, self.y1 + cells)

    def cells(self) -> Iterator[tuple[int, int]]:
        """Its cells, x and y."""
        return ((x, y) for y in range(self.y0, self.y1) for x in range(self.x0, self.x1))

    def __contains__(self, cell: tuple[int, int]) -> bool:
        return self.x0 <= cell[0] < self.x1 and self.y0 <= cell[1] < self.y1


class Grid:
    """A map being drawn; its cells are counted from the world's point (0, 0)."""

    def __init__(self, extent: Box) -> None:
        self.extent = extent
        self.width = extent.x1 - extent.x0
        self.height = extent.y1 - extent.y0
        self._levels = bytearray([UNKNOWN]) * (self.width * self.height)

    def __getitem__(self, cell: tuple[int, int]) -> int:
        return self._levels[self._index(cell)]

    def __setitem__(self, cell: tuple[int, int], level: int) -> None:
        self._levels[self._index(cell)] = level

    def fill(self, box: Box, level: int) -> None:
        """Gives all cells of a box one grey level."""
        for cell in box.cells():
            self[cell] = level

    def pgm(self) -> bytes:
        """The image, its topmost row first."""
        rows = [
            self._levels[start : start + self.width]
            for start in range(0, len(self._levels), self.width)
        ]
        header = f"P5\n{self.width} {self.height}\n255\n".encode("ascii")
        return header + b"".join(reversed(rows))

    def _index(self, cell: tuple[int, int]) -> int:
        return (cell[1] - self.extent.y0) * self.width + cell[0] - self.extent.x0


def draw(world: World) -> tuple[bytes, str] | None:
    """The image and the map_server file of a world; None if it has no region with an area.

    Raises:
        WorldError: furniture stands outside the region that it is located in.
    """
    regions = {e.name: _box(e.area) for e in world.of_type("region") if e.area}
    if not regions:
        return None
    passages = list(_passages(world, regions))
    grid = Grid(_extent(world, regions))
    for box in regions.values():
        grid.fill(box, FREE)
    for box in regions.values():
        for wall in _walls(box):
            grid.fill(wall, OCCUPIED)
    for passage in passages:
        for cell in passage.grown(_WALL).cells():
            if grid[cell] == UNKNOWN:
                grid[cell] = OCCUPIED
    for passage in passages:
        grid.fill(passage, FREE)
    kept_clear = [passage.grown(_CLEARANCE) for passage in passages]
    for piece in _furniture(world, regions):
        for cell in piece.cells():
            if not any(cell in box for box in kept_clear):
                grid[cell] = OCCUPIED
    return grid.pgm(), _yaml(world, grid)


def map_path(world_file: Path) -> Path:
    """The map_server file of a world file."""
    return world_file.with_name(f"{world_file.stem}.map.yaml")


def image_path(world_file: Path) -> Path:
    """The image of a world file's map."""
    return world_file.with_name(f"{world_file.stem}.pgm")


def _yaml(world: World, grid: Grid) -> str:
    name = f"{world.path.stem if world.path else world.name}.pgm"
    x, y = grid.extent.x0 / CELLS_PER_METRE, grid.extent.y0 / CELLS_PER_METRE
    return (
        f"image: {name}\n"
        "mode: trinary\n"
        f"resolution: {RESOLUTION}\n"
        f"origin: [{x}, {y}, 0.0]\n"
        "negate: 0\n"
        "occupied_thresh: 0.65\n"
        "free_thresh: 0.196\n"
    )


def _box(area: tuple[Point, Point]) -> Box:
    (x0, y0), (x1, y1) = area
    return Box(*(round(value * CELLS_PER_METRE) for value in (x0, y0, x1, y1)))


def _extent(world: World, regions: dict[str, Box]) -> Box:
    """What the map shows: all regions, all poses and a margin."""
    poses = [(x * CELLS_PER_METRE, y * CELLS_PER_METRE) for x, y, _ in _poses(world)]
    boxes = [*regions.values(), *(Box(*map(math.floor, p), *map(math.ceil, p)) for p in poses)]
    return Box(
        min(box.x0 for box in boxes),
        min(box.y0 for box in boxes),
        max(box.x1 for box in boxes),
        max(box.y1 for box in boxes),
    ).grown(_MARGIN)


def _poses(world: World) -> Iterator[tuple[float, float, float]]:
    return (entity.pose for entity in world.of_type() if entity.pose)


def _walls(box: Box) -> Iterator[Box]:
    outer, inner = box.grown(_HALF_WALL), box.grown(-_HALF_WALL)
    yield Box(outer.x0, outer.y0, outer.x1, inner.y0)
    yield Box(outer.x0, inner.y1, outer.x1, outer.y1)
    yield Box(outer.x0, outer.y0, inner.x0, outer.y1)
    yield Box(inner.x1, outer.y0, outer.x1, outer.y1)


def _passages(world: World, regions: dict[str, Box]) -> Iterator[Box]:
    """The doors and corridors between connected regions."""
    pairs = {tuple(sorted(f.args)) for f in world.facts if f.predicate == "connected"}
    for first, second in sorted(pairs):
        if first != second and first in regions and second in regions:
            yield from _passage(regions[first], regions[second])


def _passage(a: Box, b: Box) -> Iterator[Box]:
    """A straight way where two regions face each other for long enough, or else one with a corner."""
    (left, right), (low, high) = _shared(a.x0, a.x1, b.x0, b.x1), _shared(a.y0, a.y1, b.y0, b.y1)
    needed = _DOOR + _WALL
    if high - low >= needed:
        y = (low + high) // 2
        x0, x1 = sorted((left, right))
        yield Box(x0 - _HALF_WALL, y - _HALF_DOOR, x1 + _HALF_WALL, y + _HALF_DOOR)
    elif right - left >= needed:
        x = (left + right) // 2
        y0, y1 = sorted((low, high))
        yield Box(x - _HALF_DOOR, y0 - _HALF_WALL, x + _HALF_DOOR, y1 + _HALF_WALL)
    else:
        (xa, xb), (ya, yb) = _nearest(a.x0, a.x1, b.x0, b.x1), _nearest(a.y0, a.y1, b.y0, b.y1)
        yield Box(min(xa, xb), ya, max(xa, xb), ya).grown(_HALF_DOOR)
        yield Box(xb, min(ya, yb), xb, max(ya, yb)).grown(_HALF_DOOR)


def _shared(a0: int, a1: int, b0: int, b1: int) -> tuple[int, int]:
    """What two intervals share, from where to where; the other way round, the gap between them."""
    return max(a0, b0), min(a1, b1)


def _nearest(a0: int, a1: int, b0: int, b1: int) -> tuple[int, int]:
    """Points of two intervals that are near each other, yet leave room for a door inside each."""

    def towards(target: int, low: int, high: int) -> int:
        inset = min(_HALF_DOOR + _HALF_WALL, (high - low) // 2)
        return min(max(target, low + inset), high - inset)

    low, high = sorted(_shared(a0, a1, b0, b1))
    middle = (low + high) // 2
    return towards(middle, a0, a1), towards(middle, b0, b1)


def _furniture(world: World, regions: dict[str, Box]) -> Iterator[Box]:
    """Where furniture stands, moved off the walls of its region."""
    located = {f.args[0]: f.args[1] for f in sorted(world.facts) if f.predicate == "located"}
    for entity in world.of_type(*_FURNITURE):
        region = regions.get(located.get(entity.name, ""))
        if entity.pose is None or region is None:
            continue
        _check_inside(entity, world.entities[located[entity.name]], world)
        x, y = (round(value * CELLS_PER_METRE) for value in entity.pose[:2])
        inside = region.grown(-_HALF_WALL)
        x = _between(x, inside.x0 + _HALF_FURNITURE, inside.x1 - _HALF_FURNITURE)
        y = _between(y, inside.y0 + _HALF_FURNITURE, inside.y1 - _HALF_FURNITURE)
        yield Box(
            max(x - _HALF_FURNITURE, inside.x0),
            max(y - _HALF_FURNITURE, inside.y0),
            min(x + _HALF_FURNITURE, inside.x1),
            min(y + _HALF_FURNITURE, inside.y1),
        )


def _between(value: int, low: int, high: int) -> int:
    return max(low, min(value, high))


def _check_inside(piece: Entity, region: Entity, world: World) -> None:
    assert piece.pose is not None
    assert region.area is not None
    x, y, _ = piece.pose
    (x0, y0), (x1, y1) = region.area
    if not (x0 <= x <= x1 and y0 <= y <= y1):
        raise WorldError(
            f"{piece.name} is located in {region.name}, but its pose lies outside that area.",
            world.path,
        )


def _world(path: Path) -> World:
    """A shipped world, which may name a map that is yet to be drawn."""
    target = map_path(path)
    missing = not target.exists()
    if missing:
        target.touch()
    try:
        return load_world(path.stem)
    finally:
        if missing:
            target.unlink()


def _stale(path: Path, content: bytes) -> bool:
    return not path.is_file() or path.read_bytes() != content


def main(arguments: Sequence[str] | None = None) -> int:
    """Draws the maps, or checks them, and returns the exit status."""
    parser = argparse.ArgumentParser(description="Draws the ROS maps of the shipped worlds.")
    parser.add_argument("worlds", nargs="*", metavar="WORLD", help="all shipped worlds by default")
    parser.add_argument("--check", action="store_true", help="only say which maps are out of date")
    options = parser.parse_args(arguments)
    known = shipped_worlds()
    for name in options.worlds:
        if name not in known:
            parser.error(f"there is no shipped world called {name}: {', '.join(known)}")
    stale = False
    for name in options.worlds or known:
        try:
            drawn = draw(_world(known[name]))
        except PolarisError as error:
            print(error, file=sys.stderr)
            return 1
        if drawn is None:
            print(f"{name}: no region has an area, so there is no map")
            continue
        image, text = drawn
        for path, content in ((image_path(known[name]), image), (map_path(known[name]), text)):
            data = content.encode("utf-8") if isinstance(content, str) else content
            if not _stale(path, data):
                print(f"{path.name}: up to date")
            elif options.check:
                stale = True
                print(f"{path.name}: out of date; run scripts/draw_maps.py")
            else:
                path.write_bytes(data)
                print(f"{path.name}: drawn, {len(data)} bytes")
    return 1 if stale else 0


if __name__ == "__main__":
    sys.exit(main())
