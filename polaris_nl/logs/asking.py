"""Questions about a run, asked in words: "why did it halt", "why did it take the else branch".

A question is taken apart into what kind of event it is about, which one of those (by the words that it
shares with the event's sentence, by "first", "last", or a time), and what is asked of it. What comes back
are events and sentences; nothing is made up that isn't in the log.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TypeVar

from polaris_nl.execution.events import (
    CheckpointReached,
    CommandGiven,
    Deviated,
    Edited,
    Event,
    GoalSent,
    Halted,
    Heard,
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
from polaris_nl.logs.chain import chain
from polaris_nl.logs.diagnosis import diagnoses
from polaris_nl.logs.sayings import clause, facts
from polaris_nl.logs.spans import spans
from polaris_nl.model.errors import UsageError
from polaris_nl.model.text import listed
from polaris_nl.model.wording import Wording

Events = Sequence[Event]

HELP = (
    "Ask, for instance: why did it halt; why did it go to the hall; why did it take the else branch;"
    " what did it wait for; what did it see after 20 s; what happened to the tray; how long did it take."
)


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


def ask(events: Events, question: str, wording: Wording | None = None) -> Reply:
    """Answers a question about a log.

    Args:
        events: of the log.
        question: in words.
        wording: how facts are put into words.

    Raises:
        UsageError: the question isn't understood; the text says what can be asked.
    """
    words = question.lower().strip(" ?!.")
    for pattern, answer in _QUESTIONS:
        if re.search(pattern, words):
            return answer(events, words, wording)
    raise UsageError(f"I don't know how to answer {question!r} from a log. {HELP}")


def _why_end(events: Events, words: str, wording: Wording | None) -> Reply:
    ended = _last(events, Halted) or _last(events, RunEnded)
    found = diagnoses(events)
    if ended is None:
        return Reply(
            f"{found[-1].what} {found[-1].why}" if found else "There is no run in this log."
        )
    if isinstance(ended, RunEnded) and ended.outcome == "done":
        return Reply(
            "It didn't halt: the program was carried out to its end.", _of(events, ended), ended.id
        )
    right = [d for d in found if d.number == ended.id]
    text = f"{right[-1].what} {right[-1].why}" if right else clause(ended, wording)
    return Reply(text.strip(), _of(events, ended), ended.id)


def _why_else(events: Events, words: str, wording: Wording | None) -> Reply:
    run = _last(events, RunStarted)
    program = run.program if isinstance(run, RunStarted) else {}
    outgoing: dict[str, list[list[str]]] = {}
    for transition in program.get("transitions", ()):
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
    event = _best(taken, words)
    others = [facts(when, wording) for when in outgoing[event.source] if when]
    text = (
        f"{clause(event)} That is the else branch: it is taken at once where none of its siblings'"
        f" conditions holds, and it was not so that {listed(others, 'or that')}."
    )
    return Reply(text, _of(events, event), event.id)


def _waited(events: Events, words: str, wording: Wording | None) -> Reply:
    found = [e for e in events if isinstance(e, Waiting)]
    if not found:
        return Reply("It waited for nobody.")
    event = _best(found, words)
    span = next((s for s in spans(events) if s.number == event.id), None)
    took = f" It waited for {span.seconds:.1f} s" if span else ""
    end = next(
        (e for e in events if e.id > event.id and isinstance(e, TransitionTaken | Halted)), None
    )
    until = f"{took}, until: {clause(end, wording)}" if took and end else f"{took}." if took else ""
    return Reply(f"{event.text}{until}", _of(events, event), event.id)


def _how_long(events: Events, words: str, wording: Wording | None) -> Reply:
    found = spans(events)
    if not found:
        return Reply("There is no run in this log.")
    asked = _shared(words, _STOP)
    fitting = [s for s in found if asked & _tokens(s.label)]
    if not fitting:
        total = max(s.end for s in found) - min(s.start for s in found)
        return Reply(f"The run took {total:.1f} s.")
    longest = max(len(asked & _tokens(s.label)) for s in fitting)
    best = [s for s in fitting if len(asked & _tokens(s.label)) == longest]
    parts = [f"{s.label}: {s.seconds:.1f} s, from {s.start:.1f} s on" for s in best]
    return Reply(". ".join(parts) + ".", (), best[0].number)


def _saw(events: Events, words: str, wording: Wording | None) -> Reply:
    number = _moment(events, words)
    seen = [e for e in events if isinstance(e, Observed) and e.id <= number]
    if not seen:
        return Reply("Nothing was seen to change before that.")
    last = seen[-1]
    return Reply(clause(last, wording), _of(events, last), last.id)


def _happened_to(events: Events, words: str, wording: Wording | None) -> Reply:
    thing = re.sub(r"^.*\bto (the |a |an )?", "", words).strip().replace(" ", "-")
    pattern = re.compile(rf"(?<![\w-]){re.escape(thing)}(?![\w-])")
    found = [
        e
        for e in events
        if (isinstance(e, Observed) and any(map(pattern.search, (*e.added, *e.removed))))
        or (isinstance(e, PersonActed) and any(map(pattern.search, e.effect)))
        or (isinstance(e, GoalSent) and pattern.search(e.action))
    ]
    if not found:
        return Reply(f"Nothing in this log is about {thing.replace('-', ' ')}.")
    return Reply(f"{len(found)} events are about it.", tuple(found), found[-1].id)


def _said_what(events: Events, words: str, wording: Wording | None) -> Reply:
    found = tuple(e for e in events if isinstance(e, Heard | CommandGiven))
    return Reply("This was said:" if found else "Nothing was said.", found)


def _why_event(events: Events, words: str, wording: Wording | None) -> Reply:
    """Why something was done: the event whose sentence shares most with the question."""
    kinds: tuple[type[Event], ...] = (
        GoalSent, TransitionTaken, Replanned, Skipped, CheckpointReached, Deviated, Waiting,
        Planned, Edited, Halted,
    )  # fmt: skip
    number = re.search(r"\bevent (\d+)\b", words)
    if number:
        event = next((e for e in events if e.id == int(number[1])), None)
        if event is None:
            raise UsageError(f"There is no event {number[1]}; the log has {len(events)}.")
        return Reply(clause(event, wording), _of(events, event), event.id)
    if re.search(r"anothe?r way|re-?plan|plan anew|new plan|detour", words):
        kinds = (Replanned,)
    elif re.search(r"skip|leave out|left out|not (do|need)", words):
        kinds = (Skipped,)
    candidates = [e for e in events if isinstance(e, kinds)]
    asked = _shared(words, _STOP)
    fitting = [e for e in candidates if asked & _tokens(said_words(e))]
    if not fitting and len(kinds) == 1:
        fitting = candidates
    if not fitting:
        raise UsageError(f"Nothing in this log fits {words!r}. {HELP}")
    event = _best(fitting, words)
    reason = getattr(event, "reason", "")
    because = f" {reason[:1].upper()}{reason[1:].rstrip('.')}." if reason else ""
    then = ""
    if isinstance(event, GoalSent):
        rest = len(event.plan) - 1
        more = f", with {rest} more action{'s' if rest > 1 else ''} to go" if rest > 0 else ""
        then = f" It is for {_name(events, event)}{more}."
    return Reply(f"{clause(event, wording)}{because}{then}", _of(events, event), event.id)


def said_words(event: Event) -> str:
    """What a question about an event may share words with."""
    return f"{clause(event)} {getattr(event, 'name', '')} {'' if event.text else getattr(event, 'action', '')}"


_QUESTIONS: tuple[tuple[str, Callable[[Events, str, Wording | None], Reply]], ...] = (
    (r"\belse\b|\botherwise\b|the other branch", _why_else),
    (
        r"\bwhy\b.*\b(halt|stop|end|fail|abort|give up|not finish|not done)|what went wrong",
        _why_end,
    ),
    (r"\b(wait|waited|waiting)\b", _waited),
    (r"^how long", _how_long),
    (r"what (happened|became|was done) (to|of|with)\b", _happened_to),
    (r"\bwho said|what (was|did (i|we|they|you|she|he)) (say|said|ask)", _said_what),
    (r"\bwhat did (it|the robot) (see|perceive|observe)|what was seen", _saw),
    (r"\bwhy\b", _why_event),
)

_STOP = frozenset(
    (
        *("why", "did", "does", "do", "how", "long", "what", "was", "first", "last", "time"),
        *(
            "a",
            "an",
            "the",
            "it",
            "its",
            "you",
            "i",
            "robot",
            "of",
            "in",
            "at",
            "on",
            "to",
            "for",
            "is",
        ),
        *("and", "then", "go", "went", "take", "took", "bring", "branch", "transition", "step"),
    )
)


def _tokens(text: str) -> set[str]:
    return {_stem(x) for x in re.findall(r"[a-z0-9]+", text.lower())}


def _shared(words: str, stop: frozenset[str]) -> set[str]:
    return {_stem(x) for x in re.findall(r"[a-z0-9]+", words) if x not in stop}


def _stem(word: str) -> str:
    return re.sub(r"(ing|ed|es|s)$", "", word) if len(word) > 4 else word


E = TypeVar("E", bound=Event)


def _best(found: Sequence[E], words: str) -> E:
    """The event that a question is about: most words shared; then "first", else the last."""
    asked = _shared(words, _STOP)
    most = max(len(asked & _tokens(said_words(e))) for e in found)
    fitting = [e for e in found if len(asked & _tokens(said_words(e))) == most]
    return fitting[0 if re.search(r"\bfirst\b", words) else -1]


def _moment(events: Events, words: str) -> int:
    """The number of the last event by a time in a question; of all events without one."""
    found = re.search(r"(\d+(?:\.\d+)?) ?s(?:ec\w*)?\b", words)
    if not found:
        return events[-1].id if events else 0
    run = _last(events, RunStarted)
    until = (run.time if run else events[0].time) + float(found[1])
    return max((e.id for e in events if e.time <= until), default=0)


def _name(events: Events, goal: GoalSent) -> str:
    run = _last(events, RunStarted)
    program = run.program if isinstance(run, RunStarted) else {}
    names = {c["id"]: c["name"] for c in program.get("checkpoints", ())}
    return f'the checkpoint "{names.get(goal.checkpoint, goal.checkpoint)}"'


def _of(events: Events, event: Event) -> tuple[Event, ...]:
    return tuple(chain(events, event.id))


def _last(events: Events, kind: type[Event]) -> Event | None:
    return next((e for e in reversed(events) if isinstance(e, kind)), None)
