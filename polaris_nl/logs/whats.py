"""Answers to "what", "when" and "how long" about a run."""

from __future__ import annotations

import re
import time

from polaris_nl.execution.events import (
    CheckpointReached,
    CommandGiven,
    Deviated,
    Event,
    GoalSent,
    Halted,
    Heard,
    Observed,
    PersonActed,
    Replanned,
    RunEnded,
    RunStarted,
    Skipped,
    TransitionTaken,
    Waiting,
)
from polaris_nl.logs.expected import Expectation, expectations
from polaris_nl.logs.filters import start_of
from polaris_nl.logs.replies import Events, Reply, about, asked_words, best, fitting, last, tokens
from polaris_nl.logs.sayings import clause, fact, facts
from polaris_nl.logs.spans import spans
from polaris_nl.model.wording import Wording

_TURNS: tuple[type[Event], ...] = (
    RunStarted, TransitionTaken, CheckpointReached, Waiting, Skipped, Deviated, Replanned, Halted,
    CommandGiven, PersonActed, RunEnded,
)  # fmt: skip
"""What somebody is told who asks what happened."""
NO_RUN = "There is no run in this log."


def happened(events: Events, words: str, wording: Wording | None) -> Reply | None:
    """What happened, from turn to turn."""
    ended = last(events, RunEnded)
    found = tuple(e for e in events if isinstance(e, _TURNS))
    if not found:
        return Reply(NO_RUN)
    if ended is None:
        return Reply("The run has no end in this log.", found)
    return Reply(f"The run was {ended.outcome}. {ended.reason}".strip(), found, ended.id)


def ended_how(events: Events, words: str, wording: Wording | None) -> Reply | None:
    """Whether the run came to its end, and which."""
    ended = last(events, RunEnded)
    if ended is None:
        return happened(events, words, wording)
    lead = "Yes" if ended.outcome == "done" else "No"
    return about(events, f"{lead}: it was {ended.outcome}. {ended.reason}", ended)


def waited(events: Events, words: str, wording: Wording | None) -> Reply | None:
    """What it waited for, how long, and what ended that."""
    found = [e for e in events if isinstance(e, Waiting)]
    if not found:
        return Reply("It waited for nobody.")
    event = best(found, words)
    span = next((s for s in spans(events) if s.number == event.id), None)
    took = f" It waited for {span.seconds:.1f} s" if span else ""
    end = next(
        (e for e in events if e.id > event.id and isinstance(e, TransitionTaken | Halted)), None
    )
    until = f"{took}, until: {clause(end, wording)}" if took and end else f"{took}." if took else ""
    return about(events, f"{event.text}{until}", event)


def how_long(events: Events, words: str, wording: Wording | None) -> Reply | None:
    """How long the run took, or parts of it."""
    found = spans(events)
    if not found:
        return Reply(NO_RUN)
    asked = asked_words(words)
    some = [s for s in found if asked & tokens(s.label)]
    if not some:
        total = max(s.end for s in found) - min(s.start for s in found)
        return Reply(f"The run took {total:.1f} s.")
    longest = max(len(asked & tokens(s.label)) for s in some)
    some = [s for s in some if len(asked & tokens(s.label)) == longest]
    parts = [f"{s.label}: {s.seconds:.1f} s, from {s.start:.1f} s on" for s in some]
    return Reply(". ".join(parts) + ".", (), some[0].number)


def when(events: Events, words: str, wording: Wording | None) -> Reply | None:
    """When something happened: on the run's clock, and on the wall's."""
    kinds = (*_TURNS, GoalSent, Observed)
    found = fitting([e for e in events if isinstance(e, kinds)], words)
    if not found:
        return None
    event = best(found, words)
    wall = time.strftime("%H:%M:%S", time.localtime(event.time))
    since = event.time - start_of(events)
    return about(events, f"At {since:.1f} s, that is at {wall}: {clause(event, wording)}", event)


def saw(events: Events, words: str, wording: Wording | None) -> Reply | None:
    """What was seen last by a moment."""
    number = _moment(events, words)
    seen = [e for e in events if isinstance(e, Observed) and e.id <= number]
    if not seen:
        return Reply("Nothing was seen to change before that.")
    return about(events, clause(seen[-1], wording), seen[-1])


def expected(events: Events, words: str, wording: Wording | None) -> Reply | None:
    """What was expected beside what was seen, where something went otherwise, or at a moment."""
    event: Event | None = last(events, Halted) or last(events, Deviated)
    if re.search(r"\d", words) or event is None:
        number = _moment(events, words)
        event = next((e for e in events if e.id == number), None)
    found = expectations(events, event.id) if event is not None else []
    if event is None or not found:
        return Reply("Nothing in particular was expected at that moment.")
    return about(events, " ".join(expectation_text(x, wording) for x in found), event)


def expectation_text(one: Expectation, wording: Wording | None) -> str:
    """What was expected, and what was seen instead, as two sentences."""
    lead = f"Expected: {fact(one.literal, wording)}."
    if one.stale:
        return f"{lead} It had not been seen for a while."
    if one.holds:
        return f"{lead} So it was."
    if one.instead:
        return f"{lead} Seen: {facts(one.instead, wording)}."
    return f"{lead} It was not so."


def happened_to(events: Events, words: str, wording: Wording | None) -> Reply | None:
    """All that was done to a thing, or seen of it."""
    named = re.sub(r"^.*\b(to|of|with) ", "", words).strip()
    thing = re.sub(r"^(the|a|an) ", "", named).replace(" ", "-")
    pattern = re.compile(rf"(?<![\w-]){re.escape(thing)}(?![\w-])")
    found = [
        e
        for e in events
        if (isinstance(e, Observed) and any(map(pattern.search, (*e.added, *e.removed))))
        or (isinstance(e, PersonActed) and any(map(pattern.search, e.effect)))
        or (isinstance(e, GoalSent) and pattern.search(e.action))
    ]
    if not found:
        return Reply(f"Nothing in this log is about {named}.")
    count = "One event is" if len(found) == 1 else f"{len(found)} events are"
    return Reply(f"{count} about it.", tuple(found), found[-1].id)


def was_said(events: Events, words: str, wording: Wording | None) -> Reply | None:
    """What people said, typed or told the run."""
    found = tuple(e for e in events if isinstance(e, Heard | CommandGiven))
    return Reply("This was said:" if found else "Nothing was said.", found)


def _moment(events: Events, words: str) -> int:
    """The number of the last event by a time in a question; of all events without one."""
    found = re.search(r"(\d+(?:\.\d+)?) ?s(?:ec\w*)?\b", words)
    if not found:
        return events[-1].id if events else 0
    until = start_of(events) + float(found[1])
    return max((e.id for e in events if e.time <= until), default=0)
