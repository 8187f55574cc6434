"""Events in words: those too that say nothing by themselves."""

from __future__ import annotations

from collections.abc import Iterable

from polaris_nl.execution.events import (
    CommandGiven,
    Event,
    GoalConfirmed,
    Heard,
    Interpreted,
    Observed,
    Planned,
    RobotReported,
    StateChanged,
)
from polaris_nl.model.domain import Action
from polaris_nl.model.errors import PolarisError
from polaris_nl.model.formula import parse_literal
from polaris_nl.model.text import capital, listed, sentence
from polaris_nl.model.wording import Wording

_REPORTS = {
    "accepted": "takes the task",
    "rejected": "refuses the task",
    "succeeded": "says that it has done it",
    "failed": "says that it couldn't do it",
    "cancelled": "has given the task up",
}
_MOST = 4
"""Facts that are named in a sentence."""


def said(event: Event, wording: Wording | None = None) -> str:
    """An event as a sentence or two.

    Args:
        event: of a log.
        wording: how facts are put into words; without one they stay as they are written.
    """
    if event.text:
        return event.text
    match event:
        case Heard():
            return f'"{event.utterance}"'
        case Interpreted():
            best = next((str(r.get("text", "")) for r in event.readings), "")
            return sentence(f"Taken as: {best or event.outcome}")
        case Planned():
            return f"Planned: {_plan_words(event)}."
        case StateChanged():
            why = f" ({event.reason.rstrip('.')})" if event.reason else ""
            return f"The executor goes from {event.before} to {event.after}{why}."
        case RobotReported():
            because = f", because {event.reason}" if event.reason else ""
            return f"The robot {_REPORTS.get(event.report, event.report)}{because}."
        case GoalConfirmed():
            return f"Seen to be done, after {event.seconds:.1f} s."
        case CommandGiven():
            if event.command == "happened":
                return f"Somebody told it: {facts(event.literals, wording)}."
            return f"Somebody told it to {event.command}."
        case Observed():
            return _observed(event, wording)
    return capital(type(event).topic.rsplit("/", 1)[-1].replace("-", " ")) + "."


def _observed(event: Observed, wording: Wording | None) -> str:
    parts = []
    if event.added:
        parts.append(f"Seen: {facts(event.added, wording)}.")
    elif event.removed:
        parts.append(f"No longer so: {facts(event.removed, wording)}.")
    if event.stale:
        parts.append(f"Not seen for a while: {facts(event.stale, wording)}.")
    if event.health is not None:
        parts.append(
            "The robot is ready." if event.health == "ready" else f"The robot: {event.health}."
        )
    return " ".join(parts) or "Nothing new is seen."


def facts(texts: Iterable[str], wording: Wording | None) -> str:
    """Facts as clauses in a list."""
    texts = list(texts)
    words = [fact(text, wording) for text in texts[:_MOST]]
    if len(texts) > _MOST:
        words.append(f"{len(texts) - _MOST} more")
    return listed(words)


def fact(text: str, wording: Wording | None) -> str:
    """A fact as a clause; as it is written where there are no words for it."""
    if wording is None:
        return text
    try:
        return wording.fact(parse_literal(text))
    except (PolarisError, KeyError, ValueError):
        return text


def action_words(text: str, wording: Wording | None) -> str:
    """An action as an imperative; as it is written where there are no words for it."""
    name, *arguments = text.strip("()").split() or [""]
    if wording is None or not name:
        return text
    try:
        return wording.action(Action(name, tuple(arguments)))
    except (PolarisError, KeyError, ValueError, IndexError):
        return text


_STATUS = {
    "partial": "only a part of it, ",
    "underspecified": "nothing, since it is ambiguous where the program goes on",
    "invalid": "nothing, since the program isn't valid",
    "undecided": "only what could be decided in time, ",
}


def _plan_words(event: Planned) -> str:
    counts = [int(b.get("actions", 0)) for b in event.plan.get("branches", ())]
    status = _STATUS.get(event.status, "")
    if not counts or event.status in ("underspecified", "invalid"):
        return status.rstrip(", ") or "nothing"
    actions = f"{max(counts)} action{'' if max(counts) == 1 else 's'}"
    more = f" on the longest of {len(counts)} branches" if len(counts) > 1 else ""
    return f"{status}{actions}{more}"


def clause(event: Event, wording: Wording | None = None) -> str:
    """An event as a sentence that ends in a full stop."""
    return sentence(said(event, wording))
