"""A pane of rows that repaints only the characters that changed.

Textual repaints whole widgets; over a slow line that is felt. A pane keeps what each of its lines
shows now, and refreshes the columns in between the first and the last that differ.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol

from rich.cells import cell_len, set_cell_size
from rich.segment import Segment
from rich.style import Style
from textual import events
from textual.geometry import Region
from textual.strip import Strip
from textual.widget import Widget

from polaris_nl.render.glyphs import Glyphs, plain
from polaris_nl.render.layout import Row
from polaris_tui.progress import Place
from polaris_tui.prompt import Prompt
from polaris_tui.styles import CURSOR, MARK, Look

Draw = Callable[[int, int], Sequence[Row]]
"""Makes the rows for a width and a height in columns and rows."""

GUTTER = 1
"""Columns left of the rows, for the sign of what the robot does now."""


class Owner(Protocol):
    """Who is told at once of what happens in a pane, so that keys keep their order."""

    def pane_key(self, pane: Pane, key: str, character: str | None) -> bool:
        """A key was pressed; whether it meant anything."""
        ...

    def pane_moved(self, pane: Pane) -> None:
        """The cursor is on another row."""
        ...

    def pane_entered(self, pane: Pane) -> None:
        """The pane has got the focus."""
        ...

    def pane_left(self, pane: Pane) -> None:
        """The pane has lost the focus."""
        ...


@dataclass(frozen=True, slots=True)
class Line:
    """What one line of the screen shows: text as wide as the pane, in one style, and a part in reverse."""

    text: str
    style: Style
    span: tuple[int, int] | None = None


class Pane(Widget, can_focus=True):
    """Rows under a heading, with a cursor while it has the focus.

    Args:
        owner: is told of keys.
        glyphs: the signs to draw with.
        look: the colours.
        follows: stays at the last row, unless the user has scrolled up.
        focusable: the user can go there, and scroll.
        id: the widget's id.
    """

    def __init__(
        self,
        owner: Owner,
        glyphs: Glyphs,
        look: Look,
        *,
        follows: bool = False,
        focusable: bool = True,
        id: str,
    ) -> None:
        super().__init__(id=id)
        self.can_focus = focusable
        self._owner = owner
        self._glyphs = glyphs
        self._look = look
        self._follows = follows
        self._draw: Draw = lambda width, height: ()
        self._rows: tuple[Row, ...] = ()
        self._heading = ""
        self._top = 0
        self._cursor = 0
        self._spanned = False  # the drawing itself shows what is picked
        self._marked: Place | None = None
        self._mark: int | None = None
        self._point: int | None = None  # the row that should be in sight
        self._lines: list[Line] = []

    @property
    def row(self) -> Row | None:
        """The row at the cursor."""
        return self._rows[self._cursor] if self._cursor < len(self._rows) else None

    @property
    def at(self) -> int:
        """The number of the row at the cursor, from 0."""
        return self._cursor

    def dress(self, look: Look) -> None:
        """Takes other colours."""
        self._look = look
        self._lines = self._painted()
        self.refresh()

    @property
    def text_width(self) -> int:
        """The columns that a row may have."""
        return max(self.size.width - GUTTER, 1)

    @property
    def text_height(self) -> int:
        """The rows that are visible at once."""
        return max(self.size.height - (1 if self._heading else 0), 1)

    @property
    def rows(self) -> tuple[Row, ...]:
        """All rows, visible or not."""
        return self._rows

    # What is shown

    def show(self, draw: Draw, heading: str = "", marked: Place | None = None) -> None:
        """Shows other rows; cursor and window stay with what they were at.

        Args:
            draw: makes the new rows; it is asked again when the pane gets another size.
            heading: the title above them; "" for none.
            marked: what the robot is at, or None.
        """
        at_end = self._top >= self._last_top
        moved, self._marked = marked != self._marked, marked
        self._draw, self._heading = draw, heading
        before = self._rows
        self._redraw()
        self._keep_cursor(before)
        if self._follows:
            self._top = self._last_top if at_end else self._top
        elif self._spanned:
            self._reveal(self._point)
        elif not self.has_focus and (moved or before != self._rows):
            news = [self._mark] if moved else self._news(before)
            self._point = news[0] if news else None
            self._reveal(self._point)
            if (
                self._point is not None and news[-1] is not None
            ):  # as much of it as there is room for
                self._top = max(self._top, min(self._point, news[-1] - self.text_height + 1))
        self._top = max(0, min(self._top, self._last_top))
        self._repaint()

    def _redraw(self) -> None:
        self._rows = tuple(self._draw(self.text_width, self.text_height))
        spans = [n for n, row in enumerate(self._rows) if row.span is not None]
        self._spanned = bool(spans)
        if spans:
            self._cursor = self._point = spans[0]
        self._mark = self._marked_row()

    def reset(self) -> None:
        """Goes back to the first row."""
        self._top = self._cursor = 0
        self._point = None

    def scroll_rows(self, pages: int) -> None:
        """Scrolls by windows; a row of the one before stays in sight."""
        self._point = None
        step = max(self.text_height - 1, 1) * pages
        self._top = max(0, min(self._top + step, self._last_top))
        self._cursor = max(self._top, min(self._cursor, self._top + self.text_height - 1))
        self._repaint()

    @property
    def _last_top(self) -> int:
        return max(len(self._rows) - self.text_height, 0)

    def _keep_cursor(self, before: tuple[Row, ...]) -> None:
        old = before[self._cursor] if self._cursor < len(before) else None
        if old is not None and old.checkpoint is not None:
            key = (old.checkpoint, old.action)
            same = [i for i, r in enumerate(self._rows) if (r.checkpoint, r.action) == key]
            if same:
                self._cursor = min(same, key=lambda i: abs(i - self._cursor))
        self._cursor = max(0, min(self._cursor, len(self._rows) - 1))

    def _news(self, before: tuple[Row, ...]) -> list[int | None]:
        known = {(row.text, row.checkpoint) for row in before}
        fresh = [i for i, r in enumerate(self._rows) if (r.text, r.checkpoint) not in known]
        return [fresh[0], fresh[-1]] if before and fresh else []

    def _marked_row(self) -> int | None:
        """The first of the last rows in a row that are about it: a conditional stands higher up."""
        rows = [i for i, r in enumerate(self._rows) if (r.checkpoint, r.action) == self._marked]
        return next((i for i in reversed(rows) if i - 1 not in rows), None)

    def _reveal(self, row: int | None) -> None:
        """Scrolls where a row is out of sight; by half a window, so that it happens seldom."""
        if row is None or self._top <= row < self._top + self.text_height:
            return
        self._top = max(0, min(row - self.text_height // 2, self._last_top))

    # Lines of the screen

    def _painted(self) -> list[Line]:
        width, height = self.size.width, self.size.height
        lines = [Line(self._title(width), self._look.style("strong"))] if self._heading else []
        numbers = range(self._top, self._top + height - len(lines))
        lines += [self._line(number, width) for number in numbers]
        return lines[:height]

    def _line(self, number: int, width: int) -> Line:
        if number >= len(self._rows):
            return Line(" " * width, self._look.style(""))
        row = self._rows[number]
        here = number == self._mark
        style = self._look.style(row.tone) + (MARK if here else Style())
        text = ("> "[not here]) + plain(row.text)
        if row.span is not None:
            start, end = row.span
            return Line(set_cell_size(text, width), style, (start + GUTTER, end + GUTTER))
        if self.has_focus and number == self._cursor and not self._spanned:
            style += CURSOR
        return Line(set_cell_size(text, width), style)

    def _title(self, width: int) -> str:
        dash = self._glyphs.dash
        sign = ">" if self.has_focus else dash
        title = f"{sign} {plain(self._heading)} "
        last = self._top + self.text_height
        hidden = len(self._rows) > self.text_height
        place = f" {self._top + 1}-{min(last, len(self._rows))}/{len(self._rows)} {dash}"
        room = max(width - len(place), 0) if hidden else width
        title = title + dash * max(room - cell_len(title), 0)
        return set_cell_size(set_cell_size(title, room) + (place if hidden else ""), width)

    def _repaint(self) -> None:
        before, self._lines = self._lines, self._painted()
        if len(before) != len(self._lines):
            self.refresh()
            return
        dirty = [
            Region(span[0], y, span[1] - span[0], 1)
            for y, (old, new) in enumerate(zip(before, self._lines, strict=True))
            if (span := _difference(old, new)) is not None
        ]
        if dirty:
            self.refresh(*dirty)

    def render_line(self, y: int) -> Strip:
        """One line, for Textual."""
        if y >= len(self._lines):
            return Strip.blank(self.size.width, self.rich_style)
        line = self._lines[y]
        style = self.rich_style + line.style
        if line.span is None:
            return Strip([Segment(line.text, style)], self.size.width)
        start, end = line.span
        parts = (line.text[:start], line.text[start:end], line.text[end:])
        styles = (style, style + CURSOR, style)
        segments = [Segment(t, s) for t, s in zip(parts, styles, strict=True) if t]
        return Strip(segments, self.size.width)

    def on_resize(self, event: events.Resize) -> None:
        """Draws for the new size."""
        before = self._rows
        self._redraw()
        self._keep_cursor(before)
        self._top = self._last_top if self._follows else min(self._top, self._last_top)
        self._reveal(self._cursor if self.has_focus else self._point)
        self._lines = self._painted()
        self.refresh()

    # Keys

    async def _on_key(self, event: events.Key) -> None:
        """Asks the owner what a key means; what means nothing goes on to what works everywhere."""
        focused = self.app.focused
        if isinstance(focused, Prompt):  # It was typed ahead, before the focus moved.
            await focused._on_key(event)
        elif self._owner.pane_key(self, event.key, event.character):
            event.stop()
            event.prevent_default()

    def on_click(self, event: events.Click) -> None:
        """Goes to the row that was clicked, where the mouse is in use."""
        row = self._top + event.y - (1 if self._heading else 0)
        self.move(row - self._cursor)

    def on_focus(self) -> None:
        """Shows the cursor, inside the window."""
        if self._follows:
            self._cursor = len(self._rows) - 1
        if not self._spanned:
            self._cursor = max(self._top, min(self._cursor, self._top + self.text_height - 1))
        self._cursor = max(0, min(self._cursor, len(self._rows) - 1))
        self._owner.pane_entered(self)
        self._repaint()

    def on_blur(self) -> None:
        """Hides the cursor; what it was at stays in sight."""
        self._point = None if self._follows else self._cursor
        self._owner.pane_left(self)
        self._repaint()

    def move(self, by: int) -> None:
        """Moves the cursor."""
        self._cursor = max(0, min(self._cursor + by, len(self._rows) - 1))
        self._reveal(self._cursor)
        self._owner.pane_moved(self)
        self._repaint()

    def go_to(self, row: int) -> None:
        """Moves the cursor to a row, counted from 0."""
        self.move(row - self._cursor)

    def pick(self, checkpoint: str) -> None:
        """Moves the cursor to the last row in a row of a checkpoint's own: its name."""
        rows = [n for n, r in enumerate(self._rows) if r.checkpoint == checkpoint and not r.action]
        if rows:
            self.go_to(next((n for n in reversed(rows) if n - 1 not in rows), rows[0]))


def _difference(old: Line, new: Line) -> tuple[int, int] | None:
    """The columns where two lines differ, from and to, or None."""
    if old == new:
        return None
    width = cell_len(new.text)
    wide = width != len(new.text) or cell_len(old.text) != len(old.text)
    if old.style != new.style or len(old.text) != len(new.text) or wide:
        return 0, width
    differ = [x for x, (a, b) in enumerate(zip(old.text, new.text, strict=True)) if a != b]
    if old.span != new.span:
        for span in (old.span, new.span):
            differ += [span[0], min(span[1], width) - 1] if span else []
    return min(differ), max(differ) + 1
