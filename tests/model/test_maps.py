"""The shipped maps: drawn from the worlds, and fit for a robot to drive by."""

from __future__ import annotations

import importlib.util
import itertools
import sys
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from types import ModuleType

import pytest
import yaml

from polaris_nl.model.data import shipped_worlds
from polaris_nl.model.errors import WorldError
from polaris_nl.model.world import Point, World
from polaris_nl.model.world_file import load_world, read_world

SCRIPT = Path(__file__).parents[2] / "scripts" / "draw_maps.py"
WORLDS = sorted(shipped_worlds())
FREE, OCCUPIED = 254, 0
ROBOT = 0.5  # metres, the side of its footprint
REACH = 1.0  # metres, from the middle of the robot to a piece of furniture

Cell = tuple[int, int]
Area = tuple[Point, Point]


def _script() -> ModuleType:
    spec = importlib.util.spec_from_file_location("draw_maps", SCRIPT)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules["draw_maps"] = module
    spec.loader.exec_module(module)
    return module


draw_maps = _script()


@dataclass(frozen=True)
class Map:
    """An occupancy map as a robot reads it: cell (0, 0) is the lower left one."""

    levels: bytes
    width: int
    height: int
    resolution: float
    origin: Point

    @classmethod
    def read(cls, image: bytes, text: str) -> Map:
        fields = yaml.safe_load(text)
        magic, width, height, most, levels = image.split(maxsplit=4)
        assert (magic, most) == (b"P5", b"255")
        assert len(levels) == int(width) * int(height)
        x, y, _ = fields["origin"]
        return cls(levels, int(width), int(height), fields["resolution"], (x, y))

    def level(self, cell: Cell) -> int:
        x, y = cell
        if not (0 <= x < self.width and 0 <= y < self.height):
            return OCCUPIED
        return self.levels[(self.height - 1 - y) * self.width + x]

    def cell(self, point: Point) -> Cell:
        x, y = ((p - o) / self.resolution for p, o in zip(point, self.origin, strict=True))
        return int(x + 1e-6), int(y + 1e-6)

    def point(self, cell: Cell) -> Point:
        """The lower left corner of a cell."""
        x, y = (o + c * self.resolution for c, o in zip(cell, self.origin, strict=True))
        return x, y

    def cells(self, area: Area) -> Iterator[Cell]:
        (x0, y0), (x1, y1) = map(self.cell, area)
        return itertools.product(range(x0, x1), range(y0, y1))

    def free(self, area: Area) -> float:
        """How much of an area is free, from 0 to 1."""
        cells = list(self.cells(area))
        return sum(self.level(cell) == FREE for cell in cells) / len(cells)

    @cached_property
    def places(self) -> set[Cell]:
        """Where the middle of a robot may be: around it, its whole footprint is free."""
        side = round(ROBOT / self.resolution)
        rows = [self._runs((x, y) for x in range(self.width)) for y in range(self.height)]
        found = set()
        for x in range(self.width):
            wide = [rows[y][x] >= side for y in range(self.height)]
            run = 0
            for y, fits in enumerate(wide):
                run = run + 1 if fits else 0
                if run >= side:
                    found.add((x + 1 - side // 2, y + 1 - side // 2))
        return found

    def _runs(self, cells: Iterable[Cell]) -> list[int]:
        """For each cell of a row, how many free cells end there."""
        runs, run = [], 0
        for cell in cells:
            run = run + 1 if self.level(cell) == FREE else 0
            runs.append(run)
        return runs


def flood(start: Cell, places: set[Cell]) -> set[Cell]:
    found, open_cells = {start}, [start]
    while open_cells:
        x, y = open_cells.pop()
        for cell in ((x + 1, y), (x - 1, y), (x, y + 1), (x, y - 1)):
            if cell in places and cell not in found:
                found.add(cell)
                open_cells.append(cell)
    return found


def inside(point: Point, area: Area) -> bool:
    (x0, y0), (x1, y1) = area
    return x0 <= point[0] <= x1 and y0 <= point[1] <= y1


def middle(area: Area) -> Area:
    """The inner half of an area, in each direction."""
    (x0, y0), (x1, y1) = area
    x, y = (x1 - x0) / 4, (y1 - y0) / 4
    return (x0 + x, y0 + y), (x1 - x, y1 - y)


def areas(world: World) -> dict[str, Area]:
    return {e.name: e.area for e in world.of_type("region") if e.area}


def facts(world: World, predicate: str) -> set[tuple[str, ...]]:
    return {fact.args for fact in world.facts if fact.predicate == predicate}


def located(world: World) -> dict[str, str]:
    return {args[0]: args[1] for args in facts(world, "located")}


def joined(drawn: Map, first: Area, second: Area) -> bool:
    """Whether a robot gets from one area to the other without leaving the two."""
    places = {*drawn.cells(first), *drawn.cells(second)} & drawn.places
    start = min(places & set(drawn.cells(middle(first))))
    return not flood(start, places).isdisjoint(drawn.cells(middle(second)))


@pytest.fixture(scope="module", params=WORLDS)
def world(request: pytest.FixtureRequest) -> World:
    return load_world(request.param)


@pytest.fixture(scope="module")
def shipped(world: World) -> Map:
    assert world.map is not None
    text = world.map.read_text(encoding="utf-8")
    return Map.read((world.map.parent / yaml.safe_load(text)["image"]).read_bytes(), text)


def draw(world: World) -> Map:
    drawn = draw_maps.draw(world)
    assert drawn is not None
    return Map.read(*drawn)


def test_the_shipped_maps_are_what_the_script_draws(world: World) -> None:
    image, text = draw_maps.draw(world)
    assert world.path is not None
    assert world.map == world.path.with_name(f"{world.path.stem}.map.yaml")
    assert world.map.read_bytes() == text.encode("utf-8")
    assert world.path.with_suffix(".pgm").read_bytes() == image
    assert len(image) < 100_000


def test_checking_the_shipped_maps_finds_nothing(capsys: pytest.CaptureFixture[str]) -> None:
    assert draw_maps.main(["--check"]) == 0
    assert capsys.readouterr().out.count("up to date") == 2 * len(WORLDS)


def test_the_map_file_is_what_map_server_reads(world: World) -> None:
    assert world.map is not None
    assert world.path is not None
    fields = yaml.safe_load(world.map.read_text(encoding="utf-8"))
    assert list(fields) == [
        "image",
        "mode",
        "resolution",
        "origin",
        "negate",
        "occupied_thresh",
        "free_thresh",
    ]
    origin = fields.pop("origin")
    assert len(origin) == 3
    assert all(isinstance(number, float) for number in origin)
    assert fields == {
        "image": f"{world.path.stem}.pgm",
        "mode": "trinary",
        "resolution": 0.05,
        "negate": 0,
        "occupied_thresh": 0.65,
        "free_thresh": 0.196,
    }


def test_only_the_three_grey_levels_are_used(shipped: Map) -> None:
    assert set(shipped.levels) == {0, 205, 254}


def test_every_region_is_on_the_map_and_mostly_free(world: World, shipped: Map) -> None:
    for name, (low, high) in areas(world).items():
        assert shipped.origin[0] < low[0], name
        assert shipped.origin[1] < low[1], name
        far = shipped.point((shipped.width, shipped.height))
        assert (high[0] < far[0], high[1] < far[1]) == (True, True), name
        assert shipped.free(middle((low, high))) > 0.8, name


def test_nothing_outside_the_regions_is_free(world: World, shipped: Map) -> None:
    regions = areas(world).values()
    for cell in itertools.product(range(shipped.width), range(shipped.height)):
        if shipped.level(cell) == FREE:
            x, y = shipped.point(cell)
            centre = x + shipped.resolution / 2, y + shipped.resolution / 2
            assert any(inside(centre, area) for area in regions), centre


def test_furniture_stands_in_the_region_that_it_is_located_in(world: World, shipped: Map) -> None:
    posed = [entity for entity in world.of_type("surface", "container") if entity.pose]
    assert posed
    for entity in posed:
        assert entity.pose is not None
        point = entity.pose[:2]
        assert inside(point, areas(world)[located(world)[entity.name]]), entity.name
        assert shipped.level(shipped.cell(point)) == OCCUPIED, entity.name


def test_people_and_the_robot_stand_in_their_regions(world: World) -> None:
    for entity in world.of_type():
        region = world.place_of(entity.name, world.initial)
        if entity.pose and region in areas(world):
            assert inside(entity.pose[:2], areas(world)[region]), entity.name


def test_connected_regions_are_joined_and_others_are_not(world: World, shipped: Map) -> None:
    connected = facts(world, "connected")
    for first, second in itertools.combinations(areas(world), 2):
        expected = (first, second) in connected
        found = joined(shipped, areas(world)[first], areas(world)[second])
        assert found == expected, (first, second)


def test_a_robot_reaches_all_furniture_from_home(world: World, shipped: Map) -> None:
    places = shipped.places
    (home,) = next(iter(facts(world, "robot-at")))
    start = min(places & set(shipped.cells(middle(areas(world)[home]))))
    reached = [shipped.point(place) for place in flood(start, places)]
    for entity in world.of_type("surface", "container"):
        assert entity.pose is not None
        x, y, _ = entity.pose
        area = areas(world)[located(world)[entity.name]]
        assert any(
            inside(point, area) and (point[0] - x) ** 2 + (point[1] - y) ** 2 <= REACH**2
            for point in reached
        ), entity.name


TWO_ROOMS = """schema: polaris-world/1
name: two-rooms
domain: caregiving
entities:
  - {{name: den, type: region, area: [[0.0, 0.0], [4.0, 4.0]]}}
  - {{name: attic, type: region, area: {area}}}
  - {{name: shelf, type: surface, pose: {pose}}}
facts: ["(connected den attic)", "(connected attic den)", "(located shelf den)"]
"""


def two_rooms(folder: Path, area: str, pose: str = "[0.5, 0.5, 0.0]") -> World:
    path = folder / "two-rooms.yaml"
    path.write_text(TWO_ROOMS.format(area=area, pose=pose), encoding="utf-8")
    return read_world(path)


@pytest.mark.parametrize(
    "area",
    [
        "[[4.0, 0.0], [8.0, 4.0]]",
        "[[1.0, -3.0], [5.0, 0.0]]",
        "[[6.0, 1.0], [9.0, 6.0]]",
        "[[1.5, 7.0], [6.0, 9.0]]",
        "[[4.0, 4.0], [8.0, 8.0]]",
        "[[6.0, 6.0], [9.0, 9.0]]",
        "[[-6.0, 6.0], [-3.0, 9.0]]",
        "[[4.0, 3.5], [8.0, 8.0]]",
        "[[3.0, 3.0], [8.0, 8.0]]",
    ],
    ids=["beside", "below", "gap", "gap above", "corner", "across", "left", "short", "overlap"],
)
def test_a_door_or_a_corridor_joins_two_rooms(tmp_path: Path, area: str) -> None:
    world = two_rooms(tmp_path, area)
    drawn = draw(world)
    den, attic = (set(drawn.cells(middle(areas(world)[name]))) for name in ("den", "attic"))
    start = min(drawn.places & den)
    assert not flood(start, drawn.places).isdisjoint(attic)


def test_free_space_never_borders_on_the_unknown(tmp_path: Path) -> None:
    drawn = draw(two_rooms(tmp_path, "[[6.0, 6.0], [9.0, 9.0]]"))
    for x, y in itertools.product(range(drawn.width - 1), range(drawn.height - 1)):
        levels = {drawn.level(cell) for cell in ((x, y), (x + 1, y), (x, y + 1))}
        assert not {FREE, 205} <= levels


def test_furniture_never_blocks_a_door(tmp_path: Path) -> None:
    world = two_rooms(tmp_path, "[[4.0, 0.0], [8.0, 4.0]]", "[3.9, 2.0, 0.0]")
    assert joined(draw(world), areas(world)["den"], areas(world)["attic"])


def test_furniture_is_moved_off_the_wall(tmp_path: Path) -> None:
    drawn = draw(two_rooms(tmp_path, "[[4.0, 0.0], [8.0, 4.0]]", "[0.0, 0.0, 0.0]"))
    assert drawn.free(((0.05, 0.05), (0.45, 0.45))) == 0
    assert drawn.free(((0.45, 0.05), (0.9, 0.9))) == 1


def test_furniture_outside_its_region_is_refused(tmp_path: Path) -> None:
    world = two_rooms(tmp_path, "[[4.0, 0.0], [8.0, 4.0]]", "[5.0, 2.0, 0.0]")
    with pytest.raises(WorldError, match="shelf is located in den, but its pose lies outside"):
        draw_maps.draw(world)


def test_a_world_without_areas_has_no_map(flat: World, tmp_path: Path) -> None:
    path = tmp_path / "bare.yaml"
    path.write_text("schema: polaris-world/1\ndomain: caregiving\n", encoding="utf-8")
    assert draw_maps.draw(read_world(path)) is None
    assert draw_maps.draw(flat) is not None
