"""The signs that screens are drawn with, as Unicode or ASCII, and making foreign text harmless."""

from __future__ import annotations

import locale
import os
import sys
import unicodedata
from dataclasses import dataclass
from typing import TextIO

DEFAULT_WIDTH = 80
_INVISIBLE = ("Cc", "Cf", "Cs", "Co", "Cn", "Zl", "Zp")


@dataclass(frozen=True, slots=True)
class Glyphs:
    """One sign for each thing that is drawn.

    Attributes:
        start, checkpoint: at their names; `wait` at a conditional.
        tee, elbow, bar: a branch that others follow, the last branch, a branch that goes on.
        good, bad, open, left_out: a checkpoint with a plan, with a problem, not planned yet, below a problem.
        arrow, dash, more: between names, for lines, for what is cut off.
        step: between two steps of a timeline.
        picked: left and right of the step that is picked.
        tee_down, fork, corner, down: where a drawn tree parts: its first way, the others, the last, a
            way that goes on below.
        below: where a part of a drawing goes on further down.
    """

    start: str
    checkpoint: str
    wait: str
    tee: str
    elbow: str
    bar: str
    good: str
    bad: str
    open: str
    left_out: str
    arrow: str
    dash: str
    more: str
    step: str
    picked: str
    tee_down: str
    fork: str
    corner: str
    down: str
    below: str


UNICODE = Glyphs(
    "○", "●", "◇", "├─ ", "└─ ", "│  ", "✓", "✗", "…", "·", "→", "─", "…",
    "─▸", "«»", "┬", "├─", "└─", "│ ", "↴",
)  # fmt: skip
ASCII = Glyphs(
    "o", "*", "?", "|- ", "`- ", "|  ", "+", "!", "...", "-", "->", "-", "...",
    "->", "><", "+", "|-", "`-", "| ", "v",
)  # fmt: skip


def glyphs_for(stream: TextIO | None = None) -> Glyphs:
    """Unicode where the terminal shows it, ASCII elsewhere; `POLARIS_NL_ASCII` asks for ASCII."""
    if os.environ.get("POLARIS_NL_ASCII") or os.environ.get("TERM") == "linux":
        return ASCII
    encoding = getattr(stream or sys.stdout, "encoding", None) or locale.getpreferredencoding(False)
    return UNICODE if "utf" in encoding.lower() else ASCII


def cells(text: str) -> int:
    """How many columns of a terminal a text takes: wide characters take two, combining ones none."""
    if text.isascii():
        return len(text)
    return sum(_cells(c) for c in text)


def _cells(character: str) -> int:
    if unicodedata.combining(character):
        return 0
    return 2 if unicodedata.east_asian_width(character) in "WF" else 1


def fitting(text: str, width: int) -> str:
    """The longest beginning of a text that takes at most `width` columns."""
    taken = 0
    for at, character in enumerate(text):
        taken += _cells(character)
        if taken > width:
            return text[:at]
    return text


def plain(text: str) -> str:
    """Text without what could move the cursor, change colours or break a line.

    Everything that a user, a file or a robot said passes through here before it is shown.
    """
    if text.isascii() and text.isprintable():
        return text
    return "".join(
        " " if c in "\t\n\r" else c
        for c in text
        if c in "\t\n\r" or unicodedata.category(c) not in _INVISIBLE
    )
