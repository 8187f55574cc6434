"""What answers to questions about logs are made of: the reply, and how words pick an event."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TypeVar

from polaris_nl.execution.events import Event, RunStarted
from polaris_nl.logs.chain import chain
from polaris_nl.logs.sayings import clause
from polaris_nl.model.wording import Wording

Events = Sequence[Event]
E = TypeVar("E", bound=Event)

HELP = (
    "Ask, for instance: what happened; why did it halt; why did it go to the hall; why did it take the else"
    " branch; why didn't it bring the tray; what did it wait for; what did it expect; what did it see after"
    " 20 s; what happened to the tray; when did it reach home; how long did it take; what was said."
)
_STOP = frozenset(
    """
    a an and are at been come came did didn do does first for from get go got had has have how i in is it its
    last long never not of on reach robot step t take that the then time to took transition was went were
    what when why you branch bring brought
    """.split()  # noqa: SIM905 - a list of strings takes a page
)
"""Words that say nothing of what a question is about."""


@dataclass(frozen=True, slots=True)
class Reply:
    """What a log answers.

    Attributes:
        text: sentences.
        chain: the events that led to it, oldest first.
        number: of the event that the question was about, or None.
    """

    text: str
    chain: tuple[Event, ...] = ()
    number: int | None = None


Answer = Callable[[Events, str, Wording | None], Reply | None]
"""Answers a question, in lower case and without its mark; None where that isn't in the log."""


def about(events: Events, text: str, event: Event) -> Reply:
    """A reply about an event, with what led to it."""
    return Reply(text.strip(), tuple(chain(events, event.id)), event.id)


def last(events: Events, kind: type[E]) -> E | None:
    """The last event of a kind."""
    return next((e for e in reversed(events) if isinstance(e, kind)), None)


def program_of(events: Events) -> dict[str, list[dict[str, object]]]:
    """The program of the last run, as it is logged; empty where there was no run."""
    run = last(events, RunStarted)
    return run.program if run is not None else {}


def name_of(events: Events, checkpoint: str) -> str:
    """A checkpoint's name by its id."""
    names = {c["id"]: c["name"] for c in program_of(events).get("checkpoints", ())}
    return str(names.get(checkpoint, checkpoint))


def best(found: Sequence[E], words: str) -> E:
    """The event that a question is about: most words shared; then "first", else the last."""
    asked = asked_words(words)
    most = max(len(asked & tokens(said_words(e))) for e in found)
    fitting = [e for e in found if len(asked & tokens(said_words(e))) == most]
    return fitting[0 if re.search(r"\bfirst\b", words) else -1]


def fitting(found: Sequence[E], words: str) -> list[E]:
    """The events that share a word with a question."""
    asked = asked_words(words)
    return [e for e in found if asked & tokens(said_words(e))]


def said_words(event: Event) -> str:
    """What a question about an event may share words with."""
    action = "" if event.text else getattr(event, "action", "")
    return f"{clause(event)} {getattr(event, 'name', '')} {action}"


def asked_words(words: str) -> set[str]:
    """The words of a question that say what it is about."""
    return {_stem(x) for x in re.findall(r"[a-z0-9]+", words) if x not in _STOP}


def tokens(text: str) -> set[str]:
    """The words of a text, without their endings."""
    return {_stem(x) for x in re.findall(r"[a-z0-9]+", text.lower())}


def _stem(word: str) -> str:
    return re.sub(r"(ing|ed|es|s)$", "", word) if len(word) > 4 else word
