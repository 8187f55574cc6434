"""What went wrong in a run, and why: read from the events' structure, not from their sentences."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
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
    StateChanged,
    Understood,
)

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
    "undone": (
        "The program had brought this about before, and somebody has changed it since. If that is"
        ' meant to happen, let the program wait for it: "wait until ...".'
    ),
    "moved": "Somebody or something else changed this; the plan counted on it.",
    "unseen": "It wasn't seen any more, neither so nor otherwise: see what stands before the camera.",
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


def diagnoses(events: Sequence[Event]) -> list[Diagnosis]:
    """All that went wrong, in order; what ended the run comes last."""
    found = []
    for at, event in enumerate(events):
        before = _run_before(events, at)
        match event:
            case Halted():
                kind, health = _of_halt(event, before)
                found.append(_made(kind, event, event.reason, health))
            case Deviated() if _mended(event, events[at + 1 :]):
                kind = _of_deviation(event.expected, event.observed, before)
                found.append(_made(kind, event, event.text, mended=True))
            case RobotReported(report="failed") if not _halts(events[at + 1 :], event):
                text = f"The robot gave an action up{_because(event.reason)}, and tried again."
                found.append(_made("gave-up", event, text, mended=True))
            case Failed():
                found.append(_made("failure", event, event.text))
            case Understood(outcome="refused"):
                said = f'"{event.utterance}" was not understood: {event.text}'
                found.append(_made("not-understood", event, said))
            case RunEnded(outcome="stopped"):
                found.append(_made("stopped", event, event.reason))
    if _cut_off(events):
        last = events[-1]
        found.append(_made("no-end", last, "The run has no end in this log."))
    return found


def _made(kind: Kind, event: Event, what: str, health: str = "", mended: bool = False) -> Diagnosis:
    why = "" if mended and kind == "gave-up" else ADVICE[kind]
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


def _mended(event: Deviated, later: Sequence[Event]) -> bool:
    for following in later:
        if isinstance(following, Recovered | Replanned):
            return True
        if isinstance(following, Halted | RunEnded | RunStarted | CommandGiven):
            return False
    return False


def _halts(later: Sequence[Event], report: RobotReported) -> bool:
    """Whether a report ended the run at once."""
    return any(isinstance(e, Halted) and e.time == report.time for e in later[:2])


def _cut_off(events: Sequence[Event]) -> bool:
    started = any(isinstance(e, RunStarted) for e in events)
    return started and not any(isinstance(e, RunEnded) for e in events)


def _run_before(events: Sequence[Event], at: int) -> Sequence[Event]:
    """The events of the same run before one."""
    starts = [n for n in range(at) if isinstance(events[n], RunStarted)]
    return events[starts[-1] if starts else 0 : at]


def _because(reason: str) -> str:
    return f", because {reason}" if reason else ""
