"""Rows of text and how they are cut to a width."""

from __future__ import annotations

import textwrap
from dataclasses import dataclass
from typing import Literal as OneOf

from polaris_nl.render.glyphs import plain

NO_BREAK = "\u00a0"
"""Stands for a blank where `wrapped` may not break the row."""

Tone = OneOf["", "strong", "good", "bad", "faint"]


@dataclass(frozen=True, slots=True)
class Row:
    """A line of a drawing.

    Attributes:
        tone: how it is meant; colour is never the only sign of it.
        checkpoint, action: what it is about: a checkpoint's id, the number of an action of the plan.
    """

    text: str
    tone: Tone = ""
    checkpoint: str | None = None
    action: int | None = None


def wrapped(
    text: str,
    width: int,
    first: str = "",
    rest: str | None = None,
    tone: Tone = "",
    checkpoint: str | None = None,
    action: int | None = None,
) -> list[Row]:
    """Text as rows of at most `width` characters.

    Args:
        text: what to show; made harmless by `plain`.
        width: characters in a row.
        first: stands before the first row.
        rest: stands before the others; as many spaces as `first` is long by default.
        tone: of all rows.
        checkpoint: that all rows are about.
        action: that all rows are about, by its number.
    """
    rest = " " * len(first) if rest is None else rest
    lines = textwrap.wrap(
        plain(text),
        max(width, len(rest) + 20),
        initial_indent=first,
        subsequent_indent=rest,
        break_on_hyphens=False,
    )
    shown = (line.replace(NO_BREAK, " ") for line in lines or [first.rstrip()])
    return [Row(line, tone, checkpoint, action) for line in shown]


def text_of(rows: list[Row]) -> str:
    """Rows as one text."""
    return "\n".join(row.text.rstrip() for row in rows)


def cut(text: str, width: int, more: str = "…") -> str:
    """Text in one row of at most `width` characters."""
    text = plain(text)
    return text if len(text) <= width else text[: max(width - len(more), 0)] + more
