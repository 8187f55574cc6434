"""The map of a world as text: its regions to scale, with what is where."""

from __future__ import annotations

from polaris_nl.model.state import State
from polaris_nl.model.world import Entity, World
from polaris_nl.render.glyphs import ASCII, Glyphs, cells, plain
from polaris_nl.render.layout import cut

_ASPECT = 2.0
"""A character is about twice as high as wide."""
_STRETCH = 2.0
"""How much wider than to scale a map may be where it has few rows, so that names have room."""


def map_lines(world: World, state: State, glyphs: Glyphs, width: int, height: int) -> list[str]:
    """The regions as boxes with their names, robot, people and objects inside; "" where none has an area.

    Args:
        world: the world.
        state: where things are now.
        glyphs: ASCII or Unicode decides the lines.
        width: the room there is, in characters.
        height: the same, in rows.
    """
    regions = [e for e in world.of_type("region") if e.area is not None]
    if not regions:
        return []
    left, right, bottom, top = _bounds(regions)
    per_line = max((right - left) / (width - 1) * _ASPECT, (top - bottom) / (height - 1))
    per_column = max((right - left) / (width - 1), per_line / _ASPECT / _STRETCH)
    columns = int((right - left) / per_column) + 1
    lines = int((top - bottom) / per_line) + 1
    grid = [[" "] * columns for _ in range(lines)]

    def place(x: float, y: float) -> tuple[int, int]:
        column = round((x - left) / per_column)
        line = round((top - y) / per_line)
        return min(line, lines - 1), min(column, columns - 1)

    for region in regions:
        assert region.area is not None
        (x1, y1), (x2, y2) = region.area
        _box(grid, place(min(x1, x2), max(y1, y2)), place(max(x1, x2), min(y1, y2)), glyphs)
    for region in regions:
        assert region.area is not None
        (x1, y1), (x2, y2) = region.area
        start, end = place(min(x1, x2), max(y1, y2)), place(max(x1, x2), min(y1, y2))
        _write(grid, start, end, [region.spoken, *_inside(region, world, state)], glyphs)
    return ["".join(line).rstrip() for line in grid]


def _bounds(regions: list[Entity]) -> tuple[float, float, float, float]:
    corners = [corner for region in regions if region.area for corner in region.area]
    xs, ys = [x for x, _ in corners], [y for _, y in corners]
    return min(xs), max(xs), min(ys), max(ys)


def _inside(region: Entity, world: World, state: State) -> list[str]:
    robot = [f for f in state.facts if f.predicate == "robot-at" and f.args == (region.name,)]
    things = ["ROBOT"] if robot else []
    for kind in ("person", "object"):
        if kind in world.domain.types:
            things += [
                e.spoken.upper() if kind == "person" else e.spoken
                for e in world.of_type(kind)
                if world.place_of(e.name, state) == region.name
            ]
    return things


def _box(
    grid: list[list[str]], start: tuple[int, int], end: tuple[int, int], glyphs: Glyphs
) -> None:
    across, down, corner = ("-", "|", "+") if glyphs is ASCII else ("─", "│", "┼")
    (top, left), (bottom, right) = start, end
    for column in range(left, right + 1):
        for line in (top, bottom):
            grid[line][column] = across if grid[line][column] in (" ", across) else corner
    for line in range(top, bottom + 1):
        for column in (left, right):
            grid[line][column] = down if grid[line][column] in (" ", down) else corner
    for line, column in ((top, left), (top, right), (bottom, left), (bottom, right)):
        grid[line][column] = corner


def _write(
    grid: list[list[str]],
    start: tuple[int, int],
    end: tuple[int, int],
    texts: list[str],
    glyphs: Glyphs,
) -> None:
    (top, left), (bottom, right) = start, end
    room = right - left - 1
    if bottom - top < 2 and texts:  # too low for an inside: the name stands on the wall
        for column, sign in enumerate(cut(texts[0], room, glyphs.more)):
            grid[top][left + 1 + column] = sign
        return
    for offset, text in enumerate(texts):
        line = top + 1 + offset
        if line >= bottom:
            break
        last = line == bottom - 1 and offset < len(texts) - 1
        shown = f"{cut(text, room - 4, glyphs.more)} +{len(texts) - offset - 1}" if last else text
        column = left + 1
        for sign in cut(plain(shown), room, glyphs.more):
            if not cells(sign):
                grid[line][column - 1] += sign  # an accent belongs to the letter before it
                continue
            grid[line][column] = sign
            for covered in range(column + 1, column + cells(sign)):
                grid[line][covered] = ""  # a wide sign stands in this column, too
            column += cells(sign)
