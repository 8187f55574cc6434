"""What was expected at a moment of a run, beside what was believed then."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from polaris_nl.execution.events import (
    CheckpointReached,
    Deviated,
    Event,
    GoalConfirmed,
    GoalSent,
    Halted,
    Observed,
    RunStarted,
    TransitionTaken,
    Waiting,
)


@dataclass(frozen=True, slots=True)
class Expectation:
    """A literal that was expected.

    Attributes:
        holds: whether it was believed.
        stale: it wasn't seen for so long that nothing was known of it.
        why: what it was expected for: `goal`, `condition` or `plan`.
        instead: what was believed of the same things, where it doesn't hold.
    """

    literal: str
    holds: bool
    stale: bool
    why: str
    instead: tuple[str, ...] = ()


def beliefs_at(events: Sequence[Event], number: int) -> tuple[set[str], set[str]]:
    """What was believed after an event, and what of it was stale."""
    facts: set[str] = set()
    stale: set[str] = set()
    for event in events:
        if event.id > number:
            break
        if isinstance(event, RunStarted):
            facts, stale = set(event.beliefs), set()
        elif isinstance(event, Observed):
            facts = (facts - set(event.removed)) | set(event.added)
            stale = ((stale - set(event.added)) | set(event.stale)) & facts
    return facts, stale


def expectations(events: Sequence[Event], number: int) -> list[Expectation]:
    """What was expected after an event, and what was believed instead.

    That is the goal of the action under way, the conditions of a wait, and what a deviation or a halt
    missed.
    """
    facts, stale = beliefs_at(events, number)
    wanted: dict[str, str] = {}
    for event in events:
        if event.id > number:
            break
        match event:
            case GoalSent():
                wanted = dict.fromkeys(event.literals, "goal")
            case Waiting():
                wanted = {x: "condition" for when in event.conditionals for x in when}
            case GoalConfirmed() | TransitionTaken() | CheckpointReached() | RunStarted():
                wanted = {}
            case Deviated() | Halted():
                wanted |= dict.fromkeys(event.expected, "plan")
    return [
        Expectation(x, _holds(x, facts), x in stale, why, _instead(x, facts))
        for x, why in wanted.items()
    ]


def _holds(literal: str, facts: set[str]) -> bool:
    if literal.startswith("(not "):
        return literal[5:-1].strip() not in facts
    return literal in facts


def _instead(literal: str, facts: set[str]) -> tuple[str, ...]:
    """Facts about the first thing of a literal that doesn't hold: where the tray is instead."""
    words = literal.removeprefix("(not ").strip("()").split()
    if _holds(literal, facts) or len(words) < 2 or literal.startswith("(not "):
        return ()
    about = words[0] if words[0] == "robot-at" else words[1]
    places = ("at", "in", "holding", "has", "person-in", words[0])
    found = [f.strip("()").split() for f in sorted(facts)]
    return tuple(f"({' '.join(f)})" for f in found if f[0] in places and about in f)
