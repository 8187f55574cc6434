"""How long actions took, learned from confirmed goals; what later plans make of it is in `planning.costs`.

The paper leaves it to future work to learn action costs (Limitations). Here it is bounded in size (so many
actions, the least recent ones are forgotten) and in effect (only between plans of the same length).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from statistics import fmean
from typing import Any

from polaris_nl.execution.events import Event, GoalConfirmed, GoalSent, Replanned
from polaris_nl.planning.costs import MOST_EXTRA, Extra

SCHEMA = "polaris-durations/1"
LEARNED_FROM = (GoalSent, GoalConfirmed, Replanned)
"""The events that tell how long actions took."""
MOST_ACTIONS = 500
MOST_S = 600.0
LAST_RUNS = 5
"""The newest so many times count as much as all before them."""
STEP_S = 5
"""Durations that differ by less than this, in seconds, are the same to a plan, so that plans don't flicker."""


@dataclass(frozen=True, slots=True)
class Duration:
    """How long an action takes, in seconds, and how often it was seen to."""

    seconds: float
    times: int


@dataclass(frozen=True)
class Durations:
    """What is known of one world's actions.

    Attributes:
        known: by the action's PDDL text, the least recently learned first.
    """

    known: Mapping[str, Duration] = field(default_factory=dict)

    def after(self, events: Iterable[Event]) -> Durations:
        """What is known after a run.

        Only goals count that went as planned: where the robot found another way, the time was the
        way's.

        Args:
            events: of the run, in order.
        """
        known = dict(self.known)
        sent: dict[int, str] = {}
        for event in events:
            if isinstance(event, GoalSent):
                sent[event.goal] = event.action
            elif isinstance(event, Replanned):
                sent.pop(event.goal, None)
            elif isinstance(event, GoalConfirmed) and sent.pop(event.goal, "") == event.action:
                before = known.pop(event.action, Duration(0.0, 0))
                known[event.action] = _averaged(before, event.seconds)
        surplus = len(known) - MOST_ACTIONS
        return Durations(dict(list(known.items())[max(surplus, 0) :]))

    @property
    def extra(self) -> Extra:
        """What actions cost a plan; what isn't known of an action is taken from others of its operator."""
        found: dict[str, int] = {}
        by_operator: dict[str, list[float]] = {}
        for text, duration in self.known.items():
            name = text.strip("()")
            found[name] = _extra(duration.seconds)
            by_operator.setdefault(name.partition(" ")[0], []).append(duration.seconds)
        return found | {name: _extra(fmean(times)) for name, times in by_operator.items()}

    def to_json(self) -> dict[str, Any]:
        """As a JSON value."""
        known = {a: [round(d.seconds, 2), d.times] for a, d in self.known.items()}
        return {"schema": SCHEMA, "actions": known}

    @classmethod
    def of_json(cls, value: Any) -> Durations:
        """From a JSON value.

        Raises:
            ValueError: it isn't one of durations.
        """
        try:
            if value["schema"] != SCHEMA:
                raise ValueError(f"its schema is {value['schema']!r}, not {SCHEMA}")
            known = {
                str(action): Duration(float(seconds), int(times))
                for action, (seconds, times) in value["actions"].items()
            }
        except (AttributeError, KeyError, TypeError) as error:
            raise ValueError("it isn't a file of durations") from error
        return cls(known)


def _averaged(before: Duration, seconds: float) -> Duration:
    seconds = min(max(seconds, 0.0), MOST_S)
    times = before.times + 1
    weight = 1 / min(times, LAST_RUNS)
    return Duration(before.seconds + (seconds - before.seconds) * weight, times)


def _extra(seconds: float) -> int:
    return min(round(seconds / STEP_S) * STEP_S, MOST_EXTRA)
