"""How the rows of the screen are shared out."""

from __future__ import annotations

from dataclasses import dataclass

WIDE = 120
"""Columns from which the answers stand beside the program instead of below it."""
FIXED = 3
"""Title, input line and status line."""


@dataclass(frozen=True, slots=True)
class Heights:
    """Rows of the problems and the answers, headings included; the program has the rest."""

    trouble: int
    answers: int


def heights(height: int, trouble_rows: int) -> Heights:
    """Shares the rows of a screen out.

    Args:
        height: of the screen.
        trouble_rows: problems and their ways out; 0 for none.
    """
    room = max(height - FIXED, 3)
    if not trouble_rows:
        return Heights(0, max(2, min(room // 3, 12)))
    return Heights(min(trouble_rows + 1, max(room // 3, 3)), max(2, min(room // 4, 12)))
