"""Events of a log as rows: time, sign and sentence."""

from __future__ import annotations

from polaris_nl.render.glyphs import Glyphs
from polaris_nl.render.layout import Row, Tone, wrapped


def event_rows(
    seconds: float, severity: str, text: str, glyphs: Glyphs, width: int, number: int | None = None
) -> list[Row]:
    """One event.

    Args:
        seconds: since the start.
        severity: `debug`, `info`, `warning` or `error`.
        text: its sentence.
        glyphs: the signs to draw with.
        width: characters in a row.
        number: its number in the log, or None.
    """
    sign = {"warning": "!", "error": glyphs.bad}.get(severity, " ")
    tone: Tone = (
        "bad" if severity in ("warning", "error") else "faint" if severity == "debug" else ""
    )
    lead = f"{seconds:7.1f} s {sign} "
    if number is not None:
        lead = f"{number:4} {lead}"
    return wrapped(text, width, lead, tone=tone)
