"""A log as something to go through: how things were after any event, and what led to it."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from polaris_nl.automaton.automaton import Automaton
from polaris_nl.automaton.program import parse_action, program_of
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
    RunStarted,
    TransitionTaken,
    Understood,
    Waiting,
)
from polaris_nl.logs.reader import Log, filtered, read_log
from polaris_nl.logs.review import PROBLEMS, matcher
from polaris_nl.model.errors import LogError, PolarisError
from polaris_nl.model.formula import Literal, parse_formula
from polaris_nl.model.state import State
from polaris_nl.model.world import World
from polaris_nl.model.world_file import world_of_texts
from polaris_nl.planning.result import BranchingPlan, Segment
from polaris_tui.progress import Progress, advanced

EVERY = 100
"""Events between two moments that are kept, so that going to any event is quick in a long log."""

BEFORE_A_RUN: tuple[type[Event], ...] = (Heard, Understood, Edited, Planned, RunStarted)
SINCE_A_DECISION: tuple[type[Event], ...] = (CheckpointReached, Replanned, Deviated, Halted)


@dataclass
class Replay:
    """A log with its program, plan and world.

    Attributes:
        events: all of them, in the order of the log.
        complete: False where the file is cut off.
    """

    path: Path
    events: Sequence[Event]
    world: World
    automaton: Automaton
    plan: BranchingPlan
    complete: bool = True
    _kept: dict[int, Progress] = field(default_factory=dict)

    def progress(self, number: int) -> Progress:
        """How things were after an event, counted from 1; 0 for before the first."""
        start = number - number % EVERY
        while start and start not in self._kept:
            start -= EVERY
        now = self._kept.get(start) or Progress(self.world.initial)
        for at in range(start, min(number, len(self.events))):
            now = advanced(now, self.events[at], self.plan)
            if (at + 1) % EVERY == 0:
                self._kept[at + 1] = now
        return now

    def shown(self, words: str) -> list[int]:
        """The numbers of the events that a filter lets through, in order.

        Without one, events that say nothing to a person are left out.
        """
        if words:
            tests = matcher(words.split())
            return [number for number, _ in filtered(list(self.events), tests)]
        told = (n for n, e in enumerate(self.events, 1) if e.text or isinstance(e, Heard))
        return [n for n in told if self.events[n - 1].severity != "debug"]

    def problem(self, after: int, step: int) -> int | None:
        """The next problem after an event, or with a step of -1 the last one before it."""
        numbers = [n for n, e in enumerate(self.events, 1) if isinstance(e, PROBLEMS)]
        if step > 0:
            return next((n for n in numbers if n > after), None)
        return next((n for n in reversed(numbers) if n < after), None)

    def chain(self, number: int) -> list[int]:
        """What led to an event, oldest first, itself last.

        The words and the plan that the run came from, the last decision on the way, what was seen
        or said that made it, and the goals that were sent since.
        """
        before = list(enumerate(self.events[: number - 1], 1))
        found: set[int] = {number}
        started = next((n for n, e in reversed(before) if isinstance(e, RunStarted)), 0)
        for kind in BEFORE_A_RUN:
            found.update(_last(before, kind, started or number))
        # The last words before a run are the yes to it; those that made the program came earlier.
        for edited in _last(before, Edited, started or number):
            found.update(_last(before, Heard, edited))
        decided = max(_last(before, TransitionTaken, number), default=0)
        if isinstance(self.events[number - 1], TransitionTaken):
            decided = number
        if decided:
            found.add(decided)
            found.update(_made_by(self.events, decided))
        for kind in SINCE_A_DECISION:
            found.update(n for n in _last(before, kind, number) if n > decided)
        found.update(_last(before, GoalSent, number))
        return sorted(found)

    def differences(self, number: int) -> list[tuple[Literal, bool]]:
        """What was expected after an event, and whether each of it was perceived."""
        event, now = self.events[number - 1], self.progress(number)
        expected = (*now.expected, *now.missed)
        if isinstance(event, Deviated | Halted):
            expected = (*expected, *_literals(event.expected))
        return [(x, now.state.holds(x)) for x in dict.fromkeys(expected)]


def _last(before: Sequence[tuple[int, Event]], kind: type[Event], end: int) -> list[int]:
    found = [n for n, e in before if n <= end and isinstance(e, kind)]
    return found[-1:]


def _made_by(events: Sequence[Event], decided: int) -> Iterator[int]:
    """What a person said, or what was perceived, that made a conditional true; and the wait for it."""
    event = events[decided - 1]
    wanted = set(event.when) if isinstance(event, TransitionTaken) else set()
    for number in range(decided - 1, 0, -1):
        earlier = events[number - 1]
        changed: set[str] = set()
        if isinstance(earlier, Observed):
            changed = {*earlier.added, *earlier.removed}
        elif isinstance(earlier, CommandGiven):
            changed = set(earlier.literals)
        elif isinstance(earlier, PersonActed):
            changed = set(earlier.effect)
        if wanted & changed:
            yield number
        elif isinstance(earlier, Waiting):
            yield number
            return
        elif isinstance(earlier, CheckpointReached | RunStarted):
            return


def open_replay(path: Path, world: World) -> Replay:
    """Opens a log.

    Args:
        path: of the log.
        world: used where the log holds none.

    Raises:
        LogError: the file can't be read, or is no log.
    """
    log = read_log(path)
    own = _world(log) or world
    automaton = _program(log)
    planned = next((e for e in reversed(log.events) if isinstance(e, Planned)), None)
    plan = plan_of(planned.plan if planned else {}, automaton)
    return Replay(path, log.events, own, automaton, plan, log.complete)


def _world(log: Log) -> World | None:
    texts = log.attachments.get("world.yaml"), log.attachments.get("domain.pddl")
    if texts[0] is None or texts[1] is None:
        return None
    try:
        return world_of_texts(texts[0], texts[1])
    except PolarisError:
        return None


def _program(log: Log) -> Automaton:
    try:
        text = log.attachments.get("program.polaris.json")
        value = json.loads(text) if text else {}
        started = next((e for e in log.events if isinstance(e, RunStarted)), None)
        if started is not None and started.program:
            value = started.program
        return program_of(value).automaton if value else Automaton()
    except (PolarisError, ValueError) as error:
        raise LogError(
            f"The program in {log.path} can't be read ({error}); polaris-nl review reads the events."
        ) from error


def plan_of(value: Mapping[str, Any], automaton: Automaton) -> BranchingPlan:
    """The plan of what `plan --json` prints, as far as it can be drawn: without states."""
    segments = {}
    for item in value.get("segments", ()):
        segment = Segment(
            transition=item["transition"],
            source=item["from"],
            target=item["to"],
            when=tuple(_literals(item["when"])),
            goals=(),
            actions=tuple(parse_action(a) for a in item["actions"]),
            optimal=bool(item["optimal"]),
            before=State(frozenset()),
            after=State(frozenset()),
        )
        if segment.target in automaton.checkpoints:
            segments[segment.target] = segment
    status = value.get("status", "ok")
    return BranchingPlan("partial" if status != "ok" else "ok", segments, None)


def _literals(texts: Sequence[str]) -> list[Literal]:
    return [x for text in texts if isinstance(x := parse_formula(text), Literal)]
