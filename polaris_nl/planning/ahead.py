"""Planning ahead: other ways through a segment, for when the first way leads into a dead end.

A shortest segment may use up what a later one needs (DESIGN section 5 point 6). What it changed
besides its goals is what may be missed, so each such change is ruled out in turn and the segment
planned again.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

from polaris_nl.model.formula import Literal
from polaris_nl.planning.result import Segment
from polaris_nl.planning.segments import SegmentResult, Segments

MOST_WAYS = 16
"""Changes of a segment that are ruled out, one at a time, before it is given up."""
BUDGET_S = 2.0
"""Seconds for each attempt: looking ahead improves a plan that is there already."""


def other_ways(
    segment: Segment, segments: Segments, cancelled: Callable[[], bool]
) -> Iterator[SegmentResult]:
    """Plans for a segment that end in other states, the shortest first.

    Args:
        segment: the segment as it was planned.
        segments: plans single segments.
        cancelled: asked now and then; True ends the search for ways.
    """
    found: dict[tuple[str, ...], SegmentResult] = {}
    for kept in _side_effects(segment)[:MOST_WAYS]:
        if cancelled():
            return
        result = segments.solve(segment.before, (*segment.goals, kept), BUDGET_S, cancelled)
        if result.status == "solved":
            found.setdefault(tuple(map(str, result.actions)), result)
    yield from sorted(found.values(), key=lambda r: len(r.actions))


def _side_effects(segment: Segment) -> Sequence[Literal]:
    """The opposites of what a segment changed without being asked to."""
    removed, added = segment.before.difference(segment.after)
    wanted = set(segment.goals)
    lost = [fact for fact in removed if fact.negation not in wanted]
    gained = [fact.negation for fact in added if fact not in wanted]
    return (*lost, *gained)
