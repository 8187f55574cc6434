"""Open menus: a stack of questions, with what is typed to filter the last one."""

from __future__ import annotations

from dataclasses import dataclass, replace

from polaris_nl.render.glyphs import Glyphs
from polaris_nl.render.layout import Row, Tone, cut, wrapped
from polaris_tui.menus import Ask, Menu, Option


@dataclass(frozen=True)
class Choosing:
    """The questions that are open.

    Attributes:
        open: the menus and texts that led here; the last one is shown.
        text: what is typed to filter a menu.
        at: the place of the option that is picked, among those that match.
    """

    open: tuple[Menu | Ask, ...] = ()
    text: str = ""
    at: int = 0

    @property
    def last(self) -> Menu | Ask | None:
        """The question that is shown."""
        return self.open[-1] if self.open else None

    @property
    def options(self) -> tuple[Option, ...]:
        """The options that match what is typed."""
        return self.last.matching(self.text) if isinstance(self.last, Menu) else ()

    @property
    def picked(self) -> Option | None:
        """The option that is picked, or None where none matches."""
        return self.options[self.at] if self.at < len(self.options) else None

    def asked(self, question: Menu | Ask) -> Choosing:
        """With one more question."""
        return Choosing((*self.open, question))

    def back(self) -> Choosing:
        """Without the last question."""
        return Choosing(self.open[:-1])

    def filtered(self, text: str) -> Choosing:
        """With another filter."""
        return replace(self, text=text, at=0)

    def moved(self, by: int) -> Choosing:
        """With another option."""
        return replace(self, at=max(0, min(self.at + by, len(self.options) - 1)))

    def rows(self, width: int, glyphs: Glyphs) -> list[Row]:
        """The options, the picked one picked out."""
        if isinstance(self.last, Ask):
            return [Row("Type it, and press Enter; Esc goes back.", "faint")]
        about = self.last.about if isinstance(self.last, Menu) else ""
        rows = wrapped(about, width) if about else []
        everything = self.last.options if isinstance(self.last, Menu) else ()
        for place, option in enumerate(self.options):
            number = everything.index(option) + 1
            note = option.reason or option.note
            text = f"{number:>2}. {option.text}" + (f"  ({note})" if note else "")
            tone: Tone = "faint" if option.reason else ""
            if place == self.at:  # in full
                found = wrapped(text, width, "", "    ", tone)
                rows += [replace(row, span=(0, len(row.text))) for row in found]
            else:
                rows.append(Row(cut(text, width, glyphs.more), tone))
        if not self.options:
            text = "Nothing matches. Enter says it as a sentence; Esc goes back."
            rows.append(Row(text, "faint"))
        return rows

    def heading(self) -> str:
        """The question, below those that led to it."""
        return self.last.title if self.last else ""
