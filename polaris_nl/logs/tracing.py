"""What led to what: each event of a log gets the numbers of the events that it followed from.

An event's number is its place in the log, counted from 1. Its causes are at most a few: the step before
it in the program, and what was heard, seen or said that made it happen now.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from polaris_nl.execution.events import (
    CheckpointReached,
    CommandGiven,
    Deviated,
    Edited,
    Event,
    Failed,
    GoalConfirmed,
    GoalSent,
    Halted,
    Heard,
    Interpreted,
    Observed,
    PersonActed,
    Planned,
    Recovered,
    Replanned,
    RobotReported,
    RunEnded,
    RunStarted,
    Said,
    Skipped,
    StateChanged,
    TransitionTaken,
    Understood,
    Waiting,
)

_PROGRESS = (RunStarted, CheckpointReached, GoalConfirmed, Skipped, TransitionTaken, Recovered)
"""After each of these the run goes on from there."""
_TROUBLE = ("failed", "rejected", "cancelled")


class Tracer:
    """Finds the causes of events, given in their order."""

    def __init__(self) -> None:
        self._number = 0
        self._last: dict[type[Event], int] = {}
        self._changed: dict[str, int] = {}
        self._authored: dict[str, tuple[str, int]] = {}
        self._goals: dict[int, int] = {}
        self._aims: tuple[str, ...] = ()
        self._revisions: dict[int, int] = {}
        self._progress = self._words = self._question = self._trouble = self._latest = 0
        self._health = self._stop = 0

    def take(self, event: Event) -> tuple[int, list[int]]:
        """The number of the next event, and its causes, the weightiest first."""
        self._number += 1
        causes = [n for n in dict.fromkeys(self._causes(event)) if n]
        self._remember(event, self._number)
        return self._number, causes

    def _causes(self, event: Event) -> Iterator[int]:
        match event:
            case Heard():
                yield self._question
            case Interpreted() | Edited():
                yield self._words
            case Understood():
                yield self._words
                yield self._since(Edited, self._words)
            case Planned():
                yield self._revisions.get(event.revision, 0)
            case RunStarted():
                yield self._of(Planned)
                yield self._words
            case CommandGiven():
                yield self._words
            case GoalSent() | CheckpointReached() | Waiting():
                yield self._progress
            case RobotReported():
                yield self._goals.get(event.goal, 0)
            case GoalConfirmed():
                yield self._goals.get(event.goal, 0)
                yield from self._made(self._aims)
            case Skipped():
                yield self._progress
                yield from self._made(event.literals)
            case TransitionTaken():
                yield self._progress
                yield from self._made(event.when)
                for name in (event.transition, event.target):
                    yield self._authored.get(name, ("", 0))[1]
            case Observed():
                yield from self._people(event)
            case StateChanged() | Said():
                yield self._latest
            case _:
                yield from self._of_trouble(event)

    def _of_trouble(self, event: Event) -> Iterator[int]:
        match event:
            case Deviated():
                yield self._since(GoalSent, self._progress) or self._progress
                yield from self._made(map(_opposite, event.expected))
            case Recovered():
                yield self._of(Deviated)
                yield from self._made(event.expected)
            case Replanned():
                yield self._of(Deviated) if event.segment else self._goals.get(event.goal, 0)
            case Halted():
                yield self._since(Deviated, self._progress)
                yield self._since(Waiting, self._progress)
                yield self._trouble
                yield self._health
                yield self._since(GoalSent, self._progress) or self._progress
                yield from self._made(map(_opposite, event.expected))
            case RunEnded():
                yield self._of(Halted) or self._stop or self._progress
            case _:
                yield 0

    def _remember(self, event: Event, number: int) -> None:
        self._last[type(event)] = number
        if isinstance(event, _PROGRESS) or (isinstance(event, Replanned) and event.segment):
            self._progress = number
            self._trouble = 0
        if event.severity != "debug" and not isinstance(event, Failed | Said):
            self._latest = number
        match event:
            case Heard() | Interpreted():
                self._words = number
            case Understood():
                self._question = number if event.outcome == "question" else 0
                asked = event.interpretation.get("command") == "yes"
                self._words = number if asked else 0  # A yes leads to the run that follows.
            case Edited():
                self._revisions[event.revision] = number
                self._authors(event, number)
            case RunStarted():
                self._forget()
                self._progress = number
                self._changed = dict.fromkeys(event.beliefs, number)
            case GoalSent():
                self._goals[event.goal] = number
                self._aims = tuple(event.literals)
                self._trouble = 0
            case RobotReported() if event.report in _TROUBLE:
                self._trouble = number
            case Observed():
                self._changed |= dict.fromkeys(event.added, number)
                self._changed |= dict.fromkeys(map(_opposite, event.removed), number)
                if event.health is not None:
                    self._health = number if event.health != "ready" else 0
            case PersonActed() | CommandGiven():
                told = event.effect if isinstance(event, PersonActed) else event.literals
                self._changed |= dict.fromkeys(told, number)
                if isinstance(event, CommandGiven):
                    self._words = 0  # The words before it were this command.
                    self._stop = number if event.command == "stop" else self._stop

    def _authors(self, event: Edited, number: int) -> None:
        """Keeps who made each checkpoint and transition what it is."""
        for part in ("checkpoints", "transitions"):
            for value in event.program.get(part, ()):
                text = str(sorted(value.items()))
                if self._authored.get(value["id"], ("", 0))[0] != text:
                    self._authored[value["id"]] = text, number

    def _forget(self) -> None:
        """A new run begins."""
        for kind in (Halted, Deviated, Waiting, GoalSent):
            self._last.pop(kind, None)
        self._goals.clear()
        self._words = self._trouble = self._health = self._stop = 0

    def _of(self, kind: type[Event]) -> int:
        return self._last.get(kind, 0)

    def _since(self, kind: type[Event], number: int) -> int:
        found = self._last.get(kind, 0)
        return found if found > number else 0

    def _made(self, literals: Iterable[str]) -> Iterator[int]:
        """The events that made literals true last, the newest first."""
        yield from sorted({self._changed.get(x, 0) for x in literals}, reverse=True)

    def _people(self, event: Observed) -> Iterator[int]:
        changed = {*event.added, *map(_opposite, event.removed)}
        acted = self._of(PersonActed)
        if acted and any(self._changed.get(x) == acted for x in changed):
            yield acted
        else:
            yield self._since(GoalSent, self._progress)


def _opposite(literal: str) -> str:
    return literal[5:-1] if literal.startswith("(not ") else f"(not {literal})"
