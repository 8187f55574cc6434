"""What acting on an utterance would cost if it hadn't been said."""

from __future__ import annotations

from collections.abc import Callable
from enum import IntEnum


class Weight(IntEnum):
    """How much a mistake costs; the more, the more must speak for the words.

    HARMLESS: something is answered or asked, or the robot stops.
    CHANGING: the program changes, and can be changed back.
    MOVING: the robot may move, or work is lost.
    """

    HARMLESS = 0
    CHANGING = 1
    MOVING = 2


Weigh = Callable[[str], Weight | None]
"""What words weigh, in their place after what was said before; None for words that aren't understood."""
