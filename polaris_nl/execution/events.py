"""Event records: everything that a session and a run report, as values.

They are what is logged (each class is a topic), what the screens show, and what a replay compares.
Fields are JSON values, so that `dataclasses.asdict` is the message and the schema follows from the
annotations. Literals and actions are PDDL text.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, ClassVar
from typing import Literal as OneOf

Severity = OneOf["debug", "info", "warning", "error"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Event:
    """Base of all records.

    Attributes:
        time: seconds since the epoch; in virtual time, seconds since the run's start plus the
            start's time.
        text: one sentence for a person, or "".
        id: its number in its log, counted from 1; 0 before it is in one.
        causes: the numbers of the events that it followed from, the weightiest first.

    Events are equal where they say the same, whatever their place in a log.
    """

    topic: ClassVar[str] = "/polaris/event"
    severity: ClassVar[Severity] = "info"

    time: float
    text: str = ""
    id: int = field(default=0, compare=False)
    causes: list[int] = field(default_factory=list, compare=False)


@dataclass(frozen=True, slots=True, kw_only=True)
class Heard(Event):
    """Speech was recognised, or a sentence typed (`source` is `typed`, a device or a file).

    Attributes:
        alternatives: what it may have been, the likeliest first.
        free: what a recogniser that expects nothing in particular heard.
        again: what a second recogniser heard, where it was asked; or "".
        repaired: the likeliest words, where others were put in their place.
        decision: `accepted`, or why the words were left alone.
        audio: the attachment with the sound, where it was asked for.
        pause_s: the silence that was taken for the end.
        ms: from the end of the sound to the words.
    """

    topic: ClassVar[str] = "/polaris/heard"

    utterance: str
    source: str = "typed"
    alternatives: list[str] = field(default_factory=list)
    audio_s: float = 0.0
    ms: float = 0.0
    free: str = ""
    again: str = ""
    repaired: str = ""
    decision: str = "accepted"
    audio: str = ""
    pause_s: float = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Interpreted(Event):
    """An utterance was taken to mean something, before anything was done about it.

    Attributes:
        readings: all that it may have meant, the one that was chosen first: text, score, and what
            spoke for and against it.
    """

    topic: ClassVar[str] = "/polaris/interpreted"
    severity: ClassVar[Severity] = "debug"

    utterance: str
    outcome: str
    readings: list[dict[str, Any]] = field(default_factory=list)


@dataclass(frozen=True, slots=True, kw_only=True)
class Understood(Event):
    """An utterance was answered; `interpretation` is what `say --json` prints, without program."""

    topic: ClassVar[str] = "/polaris/understood"

    utterance: str
    outcome: str
    interpretation: dict[str, Any] = field(default_factory=dict)
    ms: float = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Edited(Event):
    """The program changed. `program` is the whole new program, so that any revision can be read back."""

    topic: ClassVar[str] = "/polaris/edited"

    revision: int
    label: str
    edits: list[dict[str, Any]] = field(default_factory=list)
    program: dict[str, Any] = field(default_factory=dict)


@dataclass(frozen=True, slots=True, kw_only=True)
class Planned(Event):
    """A revision of the program was planned; `plan` is the object that `plan --json` prints."""

    topic: ClassVar[str] = "/polaris/planned"

    revision: int
    status: str
    plan: dict[str, Any] = field(default_factory=dict)
    ms: float = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class RunStarted(Event):
    """The robot starts to carry a program out, after a yes.

    Attributes:
        resumed: where an earlier run had come to.
        segments: the plan that is followed: of each segment the transition, goals and actions.
    """

    topic: ClassVar[str] = "/polaris/run"

    robot: str
    program: dict[str, Any] = field(default_factory=dict)
    beliefs: list[str] = field(default_factory=list)
    resumed: dict[str, Any] = field(default_factory=dict)
    segments: list[dict[str, Any]] = field(default_factory=list)


@dataclass(frozen=True, slots=True, kw_only=True)
class RunEnded(Event):
    """A run is over: `done`, `halted` or `stopped`; `reason` says why in one sentence."""

    topic: ClassVar[str] = "/polaris/run-ended"

    outcome: str
    reason: str = ""
    checkpoints: list[str] = field(default_factory=list)
    seconds: float = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class StateChanged(Event):
    """The executor went from one of its states to another (idle, sending, pursuing, ...)."""

    topic: ClassVar[str] = "/polaris/executor"
    severity: ClassVar[Severity] = "debug"

    before: str
    after: str
    reason: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class CheckpointReached(Event):
    """All goals of a checkpoint were perceived."""

    topic: ClassVar[str] = "/polaris/checkpoint"

    checkpoint: str
    name: str


@dataclass(frozen=True, slots=True, kw_only=True)
class GoalSent(Event):
    """An action was sent to the robot as a goal: its effects (DESIGN section 5 point 9)."""

    topic: ClassVar[str] = "/polaris/goal-sent"

    goal: int
    action: str
    literals: list[str]
    checkpoint: str
    plan: list[str] = field(default_factory=list)
    reason: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class GoalConfirmed(Event):
    """A goal's literals were perceived for the confirmation time. `reported` is what the robot had said."""

    topic: ClassVar[str] = "/polaris/goal-confirmed"

    goal: int
    action: str
    seconds: float
    reported: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class Skipped(Event):
    """Actions needn't be done, since what they are for is so already (somebody helped, say).

    `literals` are those of their effects that are perceived.
    """

    topic: ClassVar[str] = "/polaris/skipped"

    checkpoint: str
    actions: list[str] = field(default_factory=list)
    literals: list[str] = field(default_factory=list)


@dataclass(frozen=True, slots=True, kw_only=True)
class RobotReported(Event):
    """The robot reported on a goal: accepted, rejected, succeeded, ...; never believed alone."""

    topic: ClassVar[str] = "/polaris/robot"

    goal: int
    report: str
    reason: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class Observed(Event):
    """What is believed changed: literals that became true or false, and those whose belief grew stale.

    Attributes:
        health: how the robot is since now, where that changed: `ready`, or what is the matter.
    """

    topic: ClassVar[str] = "/polaris/beliefs"
    severity: ClassVar[Severity] = "debug"

    added: list[str] = field(default_factory=list)
    removed: list[str] = field(default_factory=list)
    stale: list[str] = field(default_factory=list)
    source: str = ""
    health: str | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Waiting(Event):
    """The robot waits at a checkpoint for one of several conditionals."""

    topic: ClassVar[str] = "/polaris/waiting"

    checkpoint: str
    conditionals: list[list[str]] = field(default_factory=list)


@dataclass(frozen=True, slots=True, kw_only=True)
class TransitionTaken(Event):
    """A transition was taken, because its conditional holds or because it is the else."""

    topic: ClassVar[str] = "/polaris/transition"

    transition: str
    source: str
    target: str
    when: list[str] = field(default_factory=list)
    reason: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class Deviated(Event):
    """What was expected isn't perceived; the grace time runs."""

    topic: ClassVar[str] = "/polaris/deviation"
    severity: ClassVar[Severity] = "warning"

    expected: list[str]
    observed: list[str]
    grace_s: float = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Recovered(Event):
    """A deviation was put right within the grace time."""

    topic: ClassVar[str] = "/polaris/recovery"

    expected: list[str]
    seconds: float = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Replanned(Event):
    """The way on was planned anew from the perceived state.

    By the robot on the way to one goal, or by the executor for the rest of a segment (`segment`).
    """

    topic: ClassVar[str] = "/polaris/replanned"

    goal: int
    before: list[str] = field(default_factory=list)
    after: list[str] = field(default_factory=list)
    reason: str = ""
    segment: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class Halted(Event):
    """The run halted: why, what was expected and what was seen."""

    topic: ClassVar[str] = "/polaris/halt"
    severity: ClassVar[Severity] = "error"

    reason: str
    expected: list[str] = field(default_factory=list)
    observed: list[str] = field(default_factory=list)


@dataclass(frozen=True, slots=True, kw_only=True)
class CommandGiven(Event):
    """A person commanded the run: yes, stop, pause, resume, or told it that a fact holds."""

    topic: ClassVar[str] = "/polaris/command"

    command: str
    literals: list[str] = field(default_factory=list)
    source: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class PersonActed(Event):
    """A simulated person did something (`human_actions` of the world)."""

    topic: ClassVar[str] = "/polaris/person"

    action: str
    effect: list[str] = field(default_factory=list)


@dataclass(frozen=True, slots=True, kw_only=True)
class Said(Event):
    """The program said something aloud or on the screen."""

    topic: ClassVar[str] = "/polaris/said"

    aloud: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class Failed(Event):
    """Something of the program's own went wrong (planner, disk), and what it did about it."""

    topic: ClassVar[str] = "/polaris/failure"
    severity: ClassVar[Severity] = "error"

    what: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Stepped(Event):
    """What one step of the executor was given, as far as it differs from the step before.

    These are for replaying a run, not for reading: a log keeps them beside its events.

    Attributes:
        added, removed: facts that are believed, or no longer.
        doubted, settled: atoms of which nothing is known just now, or something again.
        blind: predicates of which nothing is known; None where that didn't change.
        health, health_text, moving: of the robot; None where they didn't change.
        reports, commands, plans: all of this step.
    """

    topic: ClassVar[str] = "/polaris/inputs"
    severity: ClassVar[Severity] = "debug"

    added: list[str] = field(default_factory=list)
    removed: list[str] = field(default_factory=list)
    doubted: list[str] = field(default_factory=list)
    settled: list[str] = field(default_factory=list)
    blind: list[str] | None = None
    health: str | None = None
    health_text: str | None = None
    moving: str | None = None
    reports: list[dict[str, Any]] = field(default_factory=list)
    commands: list[dict[str, Any]] = field(default_factory=list)
    plans: list[dict[str, Any]] = field(default_factory=list)


EVENTS: tuple[type[Event], ...] = (
    Heard, Interpreted, Understood, Edited, Planned, RunStarted, RunEnded, StateChanged, CheckpointReached,
    GoalSent, GoalConfirmed, Skipped, RobotReported, Observed, Waiting, TransitionTaken, Deviated, Recovered,
    Replanned, Halted, CommandGiven, PersonActed, Said, Failed,
)  # fmt: skip
"""Every record class that a person may want to see; a log has one channel for each that occurs."""
