"""The program as a drawn tree, left to right, a row for each way.

    ○ start ─▸ ● alerted ✓ 3 ─┬─[lunch is acknowledged]─▸ ● fetched ✓ 7 ─▸ ● home ✓ 2
                              └─[lunch is dismissed]────▸ ● cancelled ✓ 2

What would go over the right edge goes on further down, below a sign.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping
from dataclasses import dataclass

from polaris_nl.automaton.automaton import START, Automaton, Transition
from polaris_nl.model.wording import Wording
from polaris_nl.planning.result import BranchingPlan
from polaris_nl.render.glyphs import Glyphs, cells
from polaris_nl.render.layout import Row, cut
from polaris_nl.render.timeline import sorted_ways

_Way = tuple[Transition, int, int, tuple[Transition, ...]]
"""A way to be drawn: the column after its source, its number among its siblings, and these."""

NAME = 22
"""Columns of a checkpoint's name."""
CONDITION = 34
"""Columns of a conditional."""


@dataclass(frozen=True, slots=True)
class Place:
    """Where a checkpoint stands in a drawing: row, first character and the one after the last."""

    row: int
    start: int
    end: int


@dataclass(frozen=True)
class Drawing:
    """A drawn tree.

    Attributes:
        rows: its lines.
        places: where each checkpoint stands.
    """

    rows: tuple[str, ...]
    places: Mapping[str, Place]

    def shown(self, picked: str | None = None) -> list[Row]:
        """As rows, with a checkpoint picked out."""
        place = self.places.get(picked or "")
        return [
            Row(text, span=(place.start, place.end), checkpoint=picked)
            if place is not None and place.row == number
            else Row(text)
            for number, text in enumerate(self.rows)
        ]


def tree_of(
    automaton: Automaton,
    plan: BranchingPlan | None,
    wording: Wording,
    glyphs: Glyphs,
    width: int,
) -> Drawing:
    """Draws a program in `width` columns, however many rows that takes."""
    drawer = _Drawer(automaton, plan, wording, glyphs, width)
    loose = [c for c in automaton.checkpoints if c != START and automaton.incoming(c) is None]
    for root in (START, *loose):
        drawer.block(root)
    return Drawing(tuple(drawer.rows), drawer.places)


class _Drawer:
    def __init__(
        self,
        automaton: Automaton,
        plan: BranchingPlan | None,
        wording: Wording,
        glyphs: Glyphs,
        width: int,
    ) -> None:
        self._automaton = automaton
        self._plan = plan
        self._wording = wording
        self._glyphs = glyphs
        self._width = width
        self._last_row: dict[str, int] = {}  # of the way drawn last from a checkpoint
        self._open: deque[str] = deque()
        self.rows: list[str] = []
        self.places: dict[str, Place] = {}

    def block(self, root: str) -> None:
        """Draws what comes from a checkpoint, and then, further down, what had no room."""
        if root in self.places:
            return
        self._name(root, self._new_row())
        self._open.append(root)
        first = True
        while self._open:
            source = self._open.popleft()
            row = self.places[source].row
            if not first:
                row = self._new_row(f"{self._glyphs.below} ")
                self._name(source, row)
            first = False
            self._ways(source, row)

    def _ways(self, source: str, row: int) -> None:
        """Draws what comes after a checkpoint whose name ends a row; a chain may be long."""
        waiting = self._after(source, row, True)
        while waiting:
            way, column, number, ways = waiting.pop()
            if way.target in self.places:
                continue  # a program that isn't a tree is drawn as far as it is one
            row = self._joint(way, column, number, ways)
            self._name(way.target, row)
            waiting += self._after(way.target, row, False)

    def _after(self, source: str, row: int, begins: bool) -> list[_Way]:
        """The ways from a checkpoint, the first last; none where they go on further down."""
        ways = tuple(t for t in sorted_ways(self._automaton, source) if t.target not in self.places)
        column = cells(self.rows[row])
        widest = max((self._width_of(way, ways) for way in ways), default=0)
        if ways and column + widest > self._width and not begins:
            self.rows[row] += f" {self._glyphs.below}"
            self._open.append(source)
            return []
        self._last_row[source] = row
        return [(way, column, n, ways) for n, way in reversed(list(enumerate(ways)))]

    def _width_of(self, way: Transition, ways: tuple[Transition, ...]) -> int:
        name = min(cells(self._automaton.checkpoints[way.target].name), NAME)
        return self._condition_width(ways) + name + 14  # signs, blanks, and "✓ 12"

    def _condition_width(self, ways: tuple[Transition, ...]) -> int:
        return max(cells(self._condition(way)) for way in ways)

    def _joint(
        self, way: Transition, column: int, number: int, ways: tuple[Transition, ...]
    ) -> int:
        """Draws the line to a checkpoint, with its condition; returns its row."""
        glyphs = self._glyphs
        before = self._last_row[way.source]
        if number == 0:
            row = before
            self.rows[row] += f" {glyphs.dash}" + (glyphs.tee_down if len(ways) > 1 else "")
        else:
            row = self._new_row()
            sign = glyphs.corner if number == len(ways) - 1 else glyphs.fork
            for between in range(before + 1, row):
                self._bar(between, column + 2)
            self.rows[row] = " " * (column + 2) + sign[:1]
        self._last_row[way.source] = row
        condition = self._condition(way)
        dashes = self._condition_width(ways) - cells(condition)
        self.rows[row] += (
            f"{glyphs.dash if condition else ''}{condition}{glyphs.dash * dashes}{glyphs.step} "
        )
        return row

    def _bar(self, row: int, column: int) -> None:
        text = self.rows[row].ljust(column + 1)
        self.rows[row] = text[:column] + self._glyphs.down[:1] + text[column + 1 :]

    def _condition(self, way: Transition) -> str:
        if way.when:
            text = self._wording.events(way.when)
        elif self._automaton.is_else(way.id):
            text = "otherwise"
        else:
            return ""
        return f"[{cut(text, CONDITION, self._glyphs.more)}]"

    def _new_row(self, text: str = "") -> int:
        self.rows.append(text)
        return len(self.rows) - 1

    def _name(self, checkpoint: str, row: int) -> None:
        """Writes a checkpoint at the end of a row."""
        here, glyphs = self._automaton.checkpoints[checkpoint], self._glyphs
        sign = glyphs.start if checkpoint == START else glyphs.checkpoint
        text = f"{sign} {cut(here.name, NAME, glyphs.more)}{self._status(checkpoint)}"
        start = len(self.rows[row])
        self.rows[row] += text
        self.places.setdefault(checkpoint, Place(row, start, start + len(text)))

    def _status(self, checkpoint: str) -> str:
        if checkpoint == START:
            return ""
        if self._plan is None:
            return f" {self._glyphs.open}"
        segment = self._plan.segments.get(checkpoint)
        if segment is not None:
            return f" {self._glyphs.good} {len(segment.actions)}"
        problem = self._plan.problem_at(checkpoint)
        inside = problem is None or problem.cause == "inside"
        return f" {self._glyphs.left_out if inside else self._glyphs.bad}"
