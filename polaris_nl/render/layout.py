"""Rows of text and how they are cut to a width."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal as OneOf

from polaris_nl.render.glyphs import cells, fitting, plain

NO_BREAK = "\u00a0"
"""Stands for a blank where `wrapped` may not break the row."""

Tone = OneOf["", "strong", "good", "bad", "faint"]


@dataclass(frozen=True, slots=True)
class Row:
    """A line of a drawing.

    Attributes:
        tone: how it is meant; colour is never the only sign of it.
        checkpoint, action: what it is about: a checkpoint's id, the number of an action of the plan.
        span: the characters from one to another that are picked out, or None.
        repair: the number of the way out that it offers, from 1, or None.
    """

    text: str
    tone: Tone = ""
    checkpoint: str | None = None
    action: int | None = None
    span: tuple[int, int] | None = None
    repair: int | None = None


def wrapped(
    text: str,
    width: int,
    first: str = "",
    rest: str | None = None,
    tone: Tone = "",
    checkpoint: str | None = None,
    action: int | None = None,
) -> list[Row]:
    """Text as rows of at most `width` columns of a terminal.

    Args:
        text: what to show; made harmless by `plain`.
        width: columns in a row.
        first: stands before the first row.
        rest: stands before the others; as many spaces as `first` is long by default.
        tone: of all rows.
        checkpoint: that all rows are about.
        action: that all rows are about, by its number.
    """
    rest = " " * len(first) if rest is None else rest
    text, width = plain(text), max(width, len(rest) + 20)
    whole = f"{first}{text}".rstrip()
    if cells(whole) <= width:
        return [Row(whole.replace(NO_BREAK, " "), tone, checkpoint, action)]
    lines = _folded(text, width, first, rest)
    shown = (line.replace(NO_BREAK, " ") for line in lines or [first.rstrip()])
    return [Row(line, tone, checkpoint, action) for line in shown]


def text_of(rows: list[Row]) -> str:
    """Rows as one text."""
    return "\n".join(row.text.rstrip() for row in rows)


def cut(text: str, width: int, more: str = "…") -> str:
    """Text in one row of at most `width` columns."""
    text = plain(text)
    return text if cells(text) <= width else fitting(text, max(width - len(more), 0)) + more


def _folded(text: str, width: int, first: str, rest: str) -> list[str]:
    if cells(text) == len(text):
        return textwrap.wrap(
            text,
            width,
            initial_indent=first,
            subsequent_indent=rest,
            break_on_hyphens=False,
        )
    return list(_folded_by_cells(text, width, first, rest))


def _folded_by_cells(text: str, width: int, first: str, rest: str) -> Iterator[str]:
    """As `textwrap` does, which counts characters: a wide one takes two columns."""
    line = start = first
    for piece in re.findall("[^ ]+| +", text.strip(" ")):
        if cells(line) + cells(piece) <= width:
            line += piece
            continue
        if line.strip() and line != start:
            yield line.rstrip()
            line = start = rest
        piece = piece.strip(" ")
        while cells(line) + cells(piece) > width:
            head = fitting(piece, width - cells(line)) or piece[0]
            yield line + head
            piece, line, start = piece[len(head) :], rest, rest
        line += piece
    if line != start:
        yield line.rstrip()
