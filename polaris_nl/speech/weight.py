"""What acting on an utterance would cost if it hadn't been said."""

from __future__ import annotations

from collections.abc import Callable
from enum import IntEnum


class Weight(IntEnum):
    """How much a mistake costs; the more, the more must speak for the words.

    ASKING: the program asks back, since the words make sense only in part. Other people's talk ends
        up here more often than anywhere else, so much must speak for these words, too.
    HARMLESS: something is answered or asked, or the robot stops.
    CHANGING: the program changes, and can be changed back.
    MOVING: the robot may move, or work is lost.
    """

    ASKING = 0
    HARMLESS = 1
    CHANGING = 2
    MOVING = 3


Weigh = Callable[[str], Weight | None]
"""What words weigh, in their place after what was said before; None for words that aren't understood."""
