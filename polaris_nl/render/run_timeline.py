"""A run drawn over time: a row for each span, with a bar where it was."""

from __future__ import annotations

from collections.abc import Sequence

from polaris_nl.logs.spans import Span
from polaris_nl.render.glyphs import ASCII, Glyphs
from polaris_nl.render.layout import Row, Tone, cut

_STEPS = (1, 2, 5, 10, 20, 30, 60, 120, 300, 600, 1200, 1800, 3600, 7200, 14400)
"""Seconds between marks on the scale."""
_INDENT = {"segment": 0, "action": 2, "wait": 0, "deviation": 2, "pause": 2}
_BARS = {"segment": "━", "action": "─", "wait": "┄", "deviation": "!", "pause": "┄"}
_PLAIN = {"segment": "=", "action": "-", "wait": ".", "deviation": "!", "pause": "."}


def timeline_rows(spans: Sequence[Span], glyphs: Glyphs, width: int) -> list[Row]:
    """The timeline, its scale first.

    Args:
        spans: in the order in which they began.
        glyphs: the signs to draw with.
        width: characters in a row, 40 or more.
    """
    if not spans:
        return [Row("Nothing was done.", "faint")]
    names = min(width // 2 - 6, max(len(s.label) + _INDENT[s.kind] for s in spans))
    room = width - names - 11
    end = max(max(s.end for s in spans), 0.001)
    bars = _PLAIN if glyphs is ASCII else _BARS
    rows = [Row(" " * (names + 10) + _scale(end, room), "faint")]
    for span in spans:
        label = cut(" " * _INDENT[span.kind] + span.label, names, glyphs.more)
        first = min(int(span.start / end * room), room - 1)
        length = max(1, round(span.end / end * room) - first)
        bar = " " * first + bars[span.kind] * min(length, room - first)
        sign = " " if span.done else glyphs.bad
        tone: Tone = "strong" if span.kind == "segment" else "" if span.done else "bad"
        rows.append(Row(f"{label:<{names}} {span.seconds:5.1f} s{sign} {bar}", tone))
    return rows


def _scale(end: float, room: int) -> str:
    """Marks in seconds, as many as there is room for."""
    step = next((s for s in _STEPS if end / s * 8 <= room), _STEPS[-1])
    row = [" "] * (room + 8)
    for mark in range(0, int(end) + 1, step):
        at, text = int(mark / end * room), f"{mark} s"
        if at + len(text) <= room:
            row[at : at + len(text)] = text
    return "".join(row).rstrip()
