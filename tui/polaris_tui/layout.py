"""How the rows of the screen are shared out."""

from __future__ import annotations

from dataclasses import dataclass

WIDE = 120
"""Columns from which the answers stand beside the program instead of below it."""
TREE = 140
"""Columns from which the program is drawn as a tree, unless the user wants the outline."""
FIXED = 3
"""Title, input line and status line."""


@dataclass(frozen=True, slots=True)
class Heights:
    """Rows of the problems, the answers and an open menu, headings included; the program has the rest."""

    trouble: int
    answers: int
    menu: int = 0


def heights(height: int, trouble_rows: int, large: bool = False) -> Heights:
    """Shares the rows of a screen out.

    Args:
        height: of the screen.
        trouble_rows: problems and their ways out; 0 for none.
        large: the largest pane needs what room there is: steps, a run, a log.
    """
    room = max(height - FIXED, 3)
    menu = max(room // 2, 3)
    if large:
        return Heights(0, max(2, min(room // 5, 12)), menu)
    if not trouble_rows:
        return Heights(0, max(2, min(room // 3, 12)), menu)
    return Heights(min(trouble_rows + 1, max(room // 3, 3)), max(2, min(room // 4, 12)), menu)
