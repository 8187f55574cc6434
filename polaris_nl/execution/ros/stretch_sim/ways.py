"""Ways over a floor: A* on a grid of points a hand apart, kept away from walls where there is room.

Everything that doesn't depend on start and goal is made once, since the driver's topics wait meanwhile.
"""

from __future__ import annotations

import heapq
import math
from typing import Protocol

SPACING_M = 0.15
_WALL_COST = 2.0
"""How much dearer a point right at a wall is."""
_PUT_M = 0.6
"""From where the robot doesn't fit (somebody put it there) it may go this far to where it does."""


class Ground(Protocol):
    """What ways lead over: cells of `resolution` metres, the first with its lower left corner at `origin`."""

    @property
    def width(self) -> int:
        """In cells."""
        ...

    @property
    def height(self) -> int:
        """In cells."""
        ...

    @property
    def resolution(self) -> float:
        """Metres a cell."""
        ...

    @property
    def origin(self) -> tuple[float, float]:
        """In metres."""
        ...

    def fits(self, x: float, y: float) -> bool:
        """Whether the robot can be at a point."""
        ...

    def room(self, x: float, y: float) -> float:
        """The metres from a point to what is nearest."""
        ...


class Ways:
    """A grid of points of a floor and what each costs.

    Args:
        floor: the floor.
        roomy_m: the distance to walls above which more makes no difference.
    """

    def __init__(self, floor: Ground, roomy_m: float) -> None:
        self._floor = floor
        self._width = max(int(floor.width * floor.resolution / SPACING_M), 1)
        self._height = max(int(floor.height * floor.resolution / SPACING_M), 1)
        self._cost = [0.0] * (self._width * self._height)
        # The outermost points stay closed, so that rows don't run into each other.
        for row in range(1, self._height - 1):
            for column in range(1, self._width - 1):
                index = row * self._width + column
                x, y = self._point(index)
                if floor.fits(x, y):
                    room = min(floor.room(x, y) / roomy_m, 1.0)
                    self._cost[index] = 1.0 + _WALL_COST * (1.0 - room)
        diagonal = math.sqrt(2)
        w = self._width
        self._steps = (
            (1, 1.0), (-1, 1.0), (w, 1.0), (-w, 1.0),
            (w + 1, diagonal), (w - 1, diagonal), (-w + 1, diagonal), (-w - 1, diagonal),
        )  # fmt: skip

    def between(
        self, start: tuple[float, float], goal: tuple[float, float]
    ) -> list[tuple[float, float]]:
        """Points from near the start to near the goal; [] where there is no way."""
        first, last = self._nearest(start), self._nearest(goal)
        if first is None or last is None:
            return []
        came = self._search(first, last)
        if last != first and last not in came:
            return []
        way = [last]
        while way[-1] != first:
            way.append(came[way[-1]])
        return [self._point(index) for index in reversed(way)]

    def _search(self, first: int, last: int) -> dict[int, int]:
        cost, width = self._cost, self._width
        goal_x, goal_y = last % width, last // width
        best, came = {first: 0.0}, {}
        queue = [(0.0, first)]
        done: set[int] = set()
        while queue:
            index = heapq.heappop(queue)[1]
            if index == last:
                break
            if index in done:
                continue
            done.add(index)
            so_far = best[index]
            for step, length in self._steps:
                near = index + step
                if not cost[near]:
                    continue
                total = so_far + length * cost[near]
                if total < best.get(near, math.inf):
                    best[near] = total
                    came[near] = index
                    ahead = math.hypot(near % width - goal_x, near // width - goal_y)
                    heapq.heappush(queue, (total + ahead, near))
        return came

    def _nearest(self, at: tuple[float, float]) -> int | None:
        """The free point that is nearest to a place, if one is near."""
        column, row = self._cell(at)
        reach = math.ceil(_PUT_M / SPACING_M)
        near = [
            y * self._width + x
            for y in range(max(row - reach, 0), min(row + reach + 1, self._height))
            for x in range(max(column - reach, 0), min(column + reach + 1, self._width))
            if self._cost[y * self._width + x]
        ]
        return min(near, key=lambda index: math.dist(self._point(index), at), default=None)

    def _cell(self, at: tuple[float, float]) -> tuple[int, int]:
        x, y = self._floor.origin
        return int((at[0] - x) / SPACING_M), int((at[1] - y) / SPACING_M)

    def _point(self, index: int) -> tuple[float, float]:
        x, y = self._floor.origin
        return (
            x + (index % self._width + 0.5) * SPACING_M,
            y + (index // self._width + 0.5) * SPACING_M,
        )
