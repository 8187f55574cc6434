"""Answers to "why" about a run: why it ended, did something, took a branch, or didn't do something."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import Any

from polaris_nl.execution.events import (
    CheckpointReached,
    Deviated,
    Edited,
    Event,
    GoalSent,
    Halted,
    Observed,
    PersonActed,
    Planned,
    Replanned,
    RunEnded,
    RunStarted,
    Skipped,
    TransitionTaken,
    Waiting,
)
from polaris_nl.logs.diagnosis import diagnoses
from polaris_nl.logs.replies import (
    Events,
    Reply,
    about,
    asked_words,
    best,
    fitting,
    last,
    name_of,
    program_of,
    said_words,
    tokens,
)
from polaris_nl.logs.sayings import action_words, clause, facts
from polaris_nl.model.errors import UsageError
from polaris_nl.model.text import listed, sentence
from polaris_nl.model.wording import Wording

_DEEDS: tuple[type[Event], ...] = (
    GoalSent, TransitionTaken, Replanned, Skipped, Deviated, Waiting, Halted,
)  # fmt: skip
_REST: tuple[type[Event], ...] = (CheckpointReached, Planned, Edited)
"""What a question is about where it fits no deed: "reached home" says less than "I go home"."""


def why_end(events: Events, words: str, wording: Wording | None) -> Reply | None:
    """Why the run came to its end."""
    ended = last(events, Halted) or last(events, RunEnded)
    found = diagnoses(events)
    if ended is None:
        if not found or found[-1].kind != "no-end":
            return Reply("There is no run in this log.")
        at = next(e for e in events if e.id == found[-1].number)
        return about(events, f"{found[-1].what} {found[-1].why}", at)
    if isinstance(ended, RunEnded) and ended.outcome == "done":
        return about(events, "It didn't halt: the program was carried out to its end.", ended)
    right = [d for d in found if d.number == ended.id]
    text = f"{right[-1].what} {right[-1].why}" if right else clause(ended, wording)
    return about(events, text, ended)


def why_else(events: Events, words: str, wording: Wording | None) -> Reply | None:
    """Why the else branch was taken: what its siblings waited for wasn't so."""
    outgoing: dict[str, list[list[str]]] = {}
    for transition in _transitions(events):
        outgoing.setdefault(transition["from"], []).append(list(transition.get("when", ())))
    taken = [
        e
        for e in events
        if isinstance(e, TransitionTaken) and not e.when and any(outgoing.get(e.source, ()))
    ]
    if not taken:
        return Reply(
            "It took no else branch: no transition without a condition stands beside others."
        )
    event = best(taken, words)
    return about(events, f"{clause(event)} {_as_else(events, event, wording)}", event)


def _as_else(events: Events, taken: TransitionTaken, wording: Wording | None) -> str:
    siblings = (t.get("when", ()) for t in _transitions(events) if t["from"] == taken.source)
    others = [facts(when, wording) for when in siblings if when]
    return (
        "That is the else branch: it is taken at once where none of its siblings' conditions holds,"
        f" and it was not so that {listed(others, 'or that')}."
    )


def why_event(events: Events, words: str, wording: Wording | None) -> Reply | None:
    """Why something was done or is so: the event whose sentence shares most with the question."""
    number = re.search(r"\bevent (\d+)\b", words)
    if number:
        event = next((e for e in events if e.id == int(number[1])), None)
        if event is None:
            raise UsageError(f"There is no event {number[1]}; the log has {len(events)}.")
        return about(events, clause(event, wording), event)
    found: list[Event] = []
    if re.match(r"why (is|was|are|were|has|had)\b", words):  # Of what is so.
        found = fitting([e for e in events if isinstance(e, Observed | PersonActed)], words)
    if not found:
        kinds = _kinds(words)
        candidates = [e for e in events if isinstance(e, kinds)]
        found = fitting(candidates, words) or (candidates if len(kinds) == 1 else [])
    if not found:
        found = fitting([e for e in events if isinstance(e, _REST)], words)
    if not found:
        return None
    event = best(found, words)
    text = clause(event, wording)
    reason = sentence(getattr(event, "reason", ""))
    because = reason if reason.lower().rstrip(".") not in text.lower() else ""
    return about(events, " ".join(filter(None, (text, because, _purpose(events, event)))), event)


def _kinds(words: str) -> tuple[type[Event], ...]:
    """The kinds of events that a question can be about."""
    if re.search(r"another way|re-?plan|plan anew|new plan|detour", words):
        return (Replanned,)
    if re.search(r"skip|leave out|left out|not need", words):
        return (Skipped,)
    return _DEEDS


def _purpose(events: Events, event: Event) -> str:
    if not isinstance(event, GoalSent):
        return ""
    rest = len(event.plan) - 1
    more = f", with {rest} more action{'s' if rest > 1 else ''} to go" if rest > 0 else ""
    return f'It is for the checkpoint "{name_of(events, event.checkpoint)}"{more}.'


def why_not(events: Events, words: str, wording: Wording | None) -> Reply | None:
    """Why something that was planned wasn't done: left out, another branch, or the run was over before."""
    skipped = fitting([e for e in events if isinstance(e, Skipped)], words)
    if skipped:
        return about(events, clause(best(skipped, words), wording), best(skipped, words))
    asked = asked_words(words)
    sent = [len(asked & tokens(said_words(e))) for e in events if isinstance(e, GoalSent)]
    shared, transition, action = _not_done(events, asked)
    done = max(sent, default=0)
    if done and done >= shared:
        reply = why_event(events, words, wording)
        return reply and Reply(f"It did. {reply.text}", reply.chain, reply.number)
    if not shared:
        return None
    name = name_of(events, transition["to"])
    lead = f'To {action_words(action, wording)} is for the checkpoint "{name}".'
    for at in _way_to(events, transition):
        other = next(
            (e for e in events if isinstance(e, TransitionTaken) and e.source == at["from"]), None
        )
        if other is not None and other.transition != at["id"]:
            text = f'{lead} From "{name_of(events, other.source)}" it went another way: {clause(other)}'
            more = "" if other.when else f" {_as_else(events, other, wording)}"
            return about(events, f"{text}{more}", other)
    end = why_end(events, words, wording)
    if end is None:
        return None
    return Reply(f"{lead} The run was over before. {end.text}", end.chain, end.number)


def _not_done(events: Events, asked: set[str]) -> tuple[int, Mapping[str, Any], str]:
    """The planned action that a question fits best and that was never sent.

    Returns:
        How many words they share, 0 where there is no such action; its transition; the action.
    """
    run = last(events, RunStarted)
    if run is None:
        return 0, {}, ""
    sent = {(e.checkpoint, e.action) for e in events if isinstance(e, GoalSent)}
    transitions = {t["id"]: t for t in _transitions(events)}
    found: list[tuple[int, Mapping[str, Any], str]] = [(0, {}, "")]
    for segment in run.segments:
        transition = transitions.get(segment["transition"])
        if transition is None:
            continue
        name = tokens(name_of(events, transition["to"]))
        for action in segment["actions"]:
            shared = len(asked & (tokens(action) | name))
            if shared and (transition["to"], action) not in sent:
                found.append((shared, transition, action))
    return max(found, key=lambda x: x[0])


def _way_to(events: Events, transition: Mapping[str, Any]) -> Iterator[Mapping[str, Any]]:
    """A transition and those before it, up to the start."""
    into = {t["to"]: t for t in _transitions(events)}
    at: Mapping[str, Any] | None = transition
    while at is not None:
        yield at
        at = into.get(at["from"])


def _transitions(events: Events) -> list[dict[str, Any]]:
    return list(program_of(events).get("transitions", ()))
