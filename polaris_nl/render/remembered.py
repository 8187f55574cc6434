"""Words that are made once: screens say the same things again and again."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache

from polaris_nl.model.formula import Formula, Literal
from polaris_nl.model.wording import Wording


class RememberedWording:
    """A wording that remembers what it has said. Of one world, so that there is an end to it.

    Args:
        wording: the one that knows.
    """

    def __init__(self, wording: Wording) -> None:
        self.entity = cache(wording.entity)
        self.fact = cache(wording.fact)
        self.goal = cache(wording.goal)
        self.event = cache(wording.event)
        self.action = cache(wording.action)
        self._goals = cache(wording.goals)
        self._events = cache(wording.events)

    def goals(self, goals: Sequence[Formula]) -> str:
        """Imperatives in one."""
        return self._goals(tuple(goals))

    def events(self, when: Sequence[Literal]) -> str:
        """Clauses for after "once", in one."""
        return self._events(tuple(when))


def remembered(wording: Wording) -> Wording:
    """The same wording, but quicker."""
    return RememberedWording(wording)
