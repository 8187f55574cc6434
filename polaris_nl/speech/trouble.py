"""What a source of sound says when it can't be heard, and when it can be again."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Trouble:
    """Something is wrong with the source, or right again.

    Attributes:
        text: one sentence with a way out.
        over: whether sound comes again.
    """

    text: str
    over: bool = False
