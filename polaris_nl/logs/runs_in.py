"""The runs that a log holds: one in the log of a run, any number in the log of a session."""

from __future__ import annotations

import re
from collections.abc import Sequence
from itertools import pairwise

from polaris_nl.execution.events import Event, RunEnded, RunStarted, StateChanged


def runs_in(events: Sequence[Event]) -> list[Sequence[Event]]:
    """The events of each run, from its start to its end, or to where the log or the next run cuts it off."""
    return [events[first:stop] for first, stop in _places(events)]


def only_run(events: Sequence[Event], number: int) -> list[Event]:
    """A log without its other runs: one run, and what was said and done outside of runs.

    Args:
        events: of the log.
        number: of the run, counted from 0; from the end where it is negative.
    """
    places = _places(events)
    if not places:
        return list(events)
    kept = places[number]
    others = [range(*place) for place in places if place != kept]
    return [e for n, e in enumerate(events) if not any(n in other for other in others)]


def run_asked(words: str, count: int) -> int:
    """Which run a question is about, as `only_run` counts: "in the first run", "in run 2"; else the last.

    Args:
        words: the question, in lower case.
        count: how many runs there are.
    """
    found = re.search(r"\b(?:run (\d+)|(first|second|third) run)\b", words)
    if not found:
        return -1
    number = int(found[1]) if found[1] else ("first", "second", "third").index(found[2]) + 1
    return number - 1 if 1 <= number <= count else -1


def _places(events: Sequence[Event]) -> list[tuple[int, int]]:
    starts = [n for n, e in enumerate(events) if isinstance(e, RunStarted)]
    found = []
    for first, limit in pairwise((*starts, len(events))):
        ended = (n for n in range(first, limit) if isinstance(events[n], RunEnded))
        stop = next(ended, limit - 1) + 1
        if stop < limit and isinstance(events[stop], StateChanged):
            stop += 1  # The executor's last state is told after the end.
        found.append((first, stop))
    return found
