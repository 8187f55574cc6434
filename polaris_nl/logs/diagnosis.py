"""What went wrong in a run, and why: read from the events' structure, not from their sentences."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal as OneOf

from polaris_nl.execution.events import (
    CheckpointReached,
    CommandGiven,
    Deviated,
    Event,
    Failed,
    GoalConfirmed,
    GoalSent,
    Halted,
    Observed,
    Recovered,
    Replanned,
    RobotReported,
    RunEnded,
    RunStarted,
    Skipped,
    StateChanged,
    Understood,
)
from polaris_nl.logs.spans import words_of

Kind = OneOf[
    "robot", "refused", "gave-up", "no-answer", "too-slow", "not-as-reported", "undone", "moved",
    "unseen", "nobody-came", "too-short", "doubtful", "nobody-resumed", "unsettled", "stopped", "no-end",
    "failure", "not-understood",
]  # fmt: skip

ADVICE: Mapping[Kind, str] = {
    "robot": "It is the robot itself: put it right, then go on with run --resume.",
    "refused": "The robot didn't take the task: see what it says, and whether it can do that at all.",
    "gave-up": "The robot tried as often as it may, and gave up each time.",
    "no-answer": "The robot's side didn't react at all: see whether its programs are running.",
    "too-slow": "The robot was still at it when the time was over.",
    "not-as-reported": "The robot said that it had done it, but that isn't what was seen afterwards.",
    "undone": ("The program had brought this about before, and somebody has changed it since."),
    "moved": "Somebody or something else changed this; the plan counted on it.",
    "unseen": (
        "It wasn't seen any more, neither so nor otherwise: see whether the robot's camera and its sense"
        " of place work."
    ),
    "nobody-came": "Nobody did what the program waited for. An else branch says what to do then.",
    "too-short": "It was seen, but never for long enough to count.",
    "doubtful": "What was seen of it contradicted itself, so it counted neither as so nor as not so.",
    "nobody-resumed": "It stayed in its pause.",
    "unsettled": "Things were out of place too often on the way to one checkpoint.",
    "stopped": "",
    "no-end": (
        "The log ends in the middle of the run: the program was ended from outside, or the disk was"
        " full. What was begun goes on with run --resume."
    ),
    "failure": "",
    "not-understood": "",
}


@dataclass(frozen=True, slots=True)
class Diagnosis:
    """One thing that went wrong.

    Attributes:
        number: of the event that shows it.
        what: what happened, in a sentence.
        why: what that means, and what can be done about it, or "".
        health: for `robot`, what was the matter with it.
        mended: whether the run went on well after it.
    """

    kind: Kind
    number: int
    what: str
    why: str
    health: str = ""
    mended: bool = False


_SHORT: Mapping[Kind, str] = {
    "too-short": "not long enough", "doubtful": "contradictory", "moved": "things moved",
    "undone": "work undone", "unseen": "not seen", "nobody-resumed": "not resumed",
}  # fmt: skip


def in_short(found: Diagnosis) -> str:
    """A diagnosis in a word or two, for tables."""
    if found.kind == "robot":
        return f"robot {found.health}"
    return _SHORT.get(found.kind, found.kind.replace("-", " "))


def diagnoses(events: Sequence[Event]) -> list[Diagnosis]:
    """All that went wrong, in order; what ended a run comes last of it."""
    found: list[Diagnosis] = []
    start = 0
    for at, event in enumerate(events):
        if isinstance(event, RunStarted):
            found += _cut_off(events[start:at])
            start = at
        elif isinstance(event, _TELLING) and getattr(event, "report", "failed") == "failed":
            found += _of_event(event, events[start:at], events[at + 1 :])
    return found + _cut_off(events[start:])


_TELLING = (Halted, Deviated, RobotReported, Failed, Understood, RunEnded)


def _of_event(event: Event, before: Sequence[Event], later: Sequence[Event]) -> Iterator[Diagnosis]:
    """What an event tells of, among those of its run before it and all after it."""
    match event:
        case Halted():
            kind, health = _of_halt(event, before)
            yield _made(kind, event, event.reason, health)
        case Deviated() if _put_right(later):
            kind = _of_deviation(event.expected, event.observed, before)
            yield _made(kind, event, event.text, mended=_went_on(later))
        case RobotReported(report="failed") if not _halts(later, event):
            goal = next(
                (e for e in reversed(before) if isinstance(e, GoalSent) and e.goal == event.goal),
                None,
            )
            what = words_of(goal) if goal else "do that"
            text = f"The robot couldn't {what}{_because(event.reason)}, and tried again."
            yield _made("gave-up", event, text, mended=_went_on(later))
        case Failed():
            yield _made("failure", event, event.text)
        case Understood(outcome="refused"):
            said = f'"{event.utterance}" was not understood: {event.text}'
            yield _made("not-understood", event, said)
        case RunEnded(outcome="stopped"):
            yield _made("stopped", event, _stopped(event, before))


def _made(kind: Kind, event: Event, what: str, health: str = "", mended: bool = False) -> Diagnosis:
    why = "" if isinstance(event, RobotReported) else ADVICE[kind]
    if kind == "undone" and isinstance(event, Deviated):
        why += ' If that is meant to happen, let the program wait for it: "wait until ...".'
    return Diagnosis(kind, event.id, what, why, health, mended)


def _of_halt(halted: Halted, before: Sequence[Event]) -> tuple[Kind, str]:
    health = next(
        (e.health for e in reversed(before) if isinstance(e, Observed) and e.health), "ready"
    )
    if health != "ready":
        return "robot", health
    phase = next((e.after for e in reversed(before) if isinstance(e, StateChanged)), "idle")
    report = next((e.report for e in reversed(before) if isinstance(e, RobotReported)), "")
    match phase:
        case "waiting":
            return _of_wait(halted, before), ""
        case "deviating":
            return _of_deviation(halted.expected, halted.observed, before), ""
        case "paused":
            return "nobody-resumed", ""
        case "sending" | "pursuing" | "confirming" if report in ("rejected", "failed", "cancelled"):
            return ("refused" if report == "rejected" else "gave-up"), ""
        case "sending":
            return "no-answer", ""
        case "pursuing" | "confirming":
            return "too-slow", ""
    return "unsettled", ""


def _of_deviation(
    expected: Sequence[str], observed: Sequence[str], before: Sequence[Event]
) -> Kind:
    goal = next((e for e in reversed(before) if isinstance(e, GoalSent)), None)
    if goal is not None and set(expected) & set(goal.literals):
        reports = [e.report for e in before if isinstance(e, RobotReported) and e.goal == goal.goal]
        confirmed = any(isinstance(e, GoalConfirmed) and e.goal == goal.goal for e in before)
        if "succeeded" in reports and not confirmed:
            return "unseen" if not observed and _stale_since(goal, before) else "not-as-reported"
    if set(expected) & _brought_about(before):
        return "undone"
    return "moved" if observed or _seen_gone(expected, before) else "unseen"


def _brought_about(before: Sequence[Event]) -> set[str]:
    """What the robot's actions had made true by the last checkpoint."""
    reached = max((n for n, e in enumerate(before) if isinstance(e, CheckpointReached)), default=0)
    literals = {e.goal: e.literals for e in before[:reached] if isinstance(e, GoalSent)}
    done = [e.goal for e in before[:reached] if isinstance(e, GoalConfirmed)]
    return {x for goal in done for x in literals.get(goal, [])}


def _seen_gone(expected: Sequence[str], before: Sequence[Event]) -> bool:
    return any(isinstance(e, Observed) and set(expected) & set(e.removed) for e in before)


def _stale_since(goal: GoalSent, before: Sequence[Event]) -> bool:
    """Whether things were out of sight while a goal was pursued."""
    later = (e for e in before if e.time >= goal.time)
    return any(isinstance(e, Observed) and e.stale for e in later)


def _of_wait(halted: Halted, before: Sequence[Event]) -> Kind:
    """Whether what was waited for was never seen, not for long enough, or in contradiction."""
    began = max(
        (n for n, e in enumerate(before) if isinstance(e, StateChanged) and e.after == "waiting"),
        default=0,
    )
    seen = [e for e in before[began:] if isinstance(e, Observed)]
    wanted = set(halted.expected)
    if any(wanted & set(e.stale) for e in seen):
        return "doubtful"
    return "too-short" if any(wanted & set(e.added) for e in seen) else "nobody-came"


def _put_right(later: Sequence[Event]) -> bool:
    """Whether a deviation passed, or a way around it was found; whatever came then."""
    for following in later:
        if isinstance(following, Recovered | Replanned):
            return True
        if isinstance(following, Halted | RunEnded | RunStarted | CommandGiven):
            return False
    return False


def _went_on(later: Sequence[Event]) -> bool:
    """Whether a run got anything done before it came to its end."""
    for following in later:
        if isinstance(following, GoalConfirmed | Skipped | CheckpointReached):
            return True
        if isinstance(following, Halted | RunEnded | RunStarted):
            return isinstance(following, RunEnded) and following.outcome == "done"
    return False


def _stopped(ended: RunEnded, before: Sequence[Event]) -> str:
    stop = next(
        (e for e in reversed(before) if isinstance(e, CommandGiven) and e.command == "stop"), None
    )
    return (
        f"A person stopped the run {_FROM.get(stop.source, f'from {stop.source}')}."
        if stop
        else ended.reason
    )


_FROM = {"keyboard": "at the keyboard", "voice": "by voice", "": "at the keyboard"}


def _halts(later: Sequence[Event], report: RobotReported) -> bool:
    """Whether a report ended the run at once."""
    return any(isinstance(e, Halted) and e.time == report.time for e in later[:2])


def _cut_off(run: Sequence[Event]) -> list[Diagnosis]:
    """That a run has no end in the log, where it has none."""
    started = bool(run) and isinstance(run[0], RunStarted)
    if not started or any(isinstance(e, RunEnded) for e in run):
        return []
    return [_made("no-end", run[-1], "The run has no end in this log.")]


def _because(reason: str) -> str:
    return f", because {reason}" if reason else ""
