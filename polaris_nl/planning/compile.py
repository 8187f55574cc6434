"""From a goal automaton to a branching plan (DESIGN section 5 points 1 to 7)."""

from __future__ import annotations

import time
from collections.abc import Callable, Collection, Iterable, Iterator
from dataclasses import dataclass, field

from polaris_nl.automaton.automaton import START, Automaton, Checkpoint, Transition
from polaris_nl.automaton.validation import validate
from polaris_nl.model.evaluate import after, applicable
from polaris_nl.model.formula import Formula, Literal, bind
from polaris_nl.model.state import Mutexes, State
from polaris_nl.model.wording import Wording
from polaris_nl.model.world import World
from polaris_nl.planning.ahead import BUDGET_S as AHEAD_S
from polaris_nl.planning.ahead import other_ways
from polaris_nl.planning.faults import Faults
from polaris_nl.planning.place import Place
from polaris_nl.planning.problems import Diagnosis, inside
from polaris_nl.planning.result import BranchingPlan, Problem, Segment, Status, Warning
from polaris_nl.planning.segments import SegmentResult, Segments
from polaris_nl.planning.tree import plan_tree
from polaris_nl.planning.warnings import warnings_of
from polaris_nl.planning.witnesses import grounded

MOST_DETOURS = 3
"""Dead ends of one program that are planned around."""
LOOK_BACK = 3
"""Segments before a failed one that may be planned another way."""


@dataclass
class _Work:
    segments: dict[str, Segment] = field(default_factory=dict)
    problems: list[Problem] = field(default_factory=list)
    notes: list[Warning] = field(default_factory=list)
    cancelled: bool = False

    def own_problems(self) -> int:
        """How many checkpoints fail by themselves, not because of one above them."""
        return sum(p.cause != "inside" for p in self.problems)

    def without(self, checkpoints: Collection[str]) -> _Work:
        """A copy in which some checkpoints are still to be planned."""
        segments = {k: s for k, s in self.segments.items() if k not in checkpoints}
        problems = [p for p in self.problems if p.checkpoint not in checkpoints]
        return _Work(segments, problems, list(self.notes))


class Compiler:
    """Compiles the programs of one world.

    Args:
        world: the world, whose facts are the state at the start.
        mutexes: what excludes what in it.
        segments: plans single segments, and remembers them.
        wording: words for problems and warnings.
    """

    def __init__(
        self, world: World, mutexes: Mutexes, segments: Segments, wording: Wording
    ) -> None:
        self._world = world
        self._mutexes = mutexes
        self._segments = segments
        self._faults = Faults(world, mutexes, segments, wording)
        self._diagnosis = Diagnosis(world, mutexes, segments, wording)
        self._wording = wording

    def compile(self, automaton: Automaton, cancelled: Callable[[], bool]) -> BranchingPlan:
        """Plans every checkpoint that can be planned.

        A cancelled compile returns what it has, with status `undecided`.
        """
        started = time.perf_counter()
        faults = validate(automaton, self._world)
        if faults:
            problems = self._faults.problems(automaton, faults, cancelled)
            # Names and shape come first: until they are right, the same conditional may not be the same.
            only_under = all(f.cause == "underspecified" for f in faults)
            status: Status = "underspecified" if only_under else "invalid"
            return BranchingPlan(status, {}, None, problems, (), _ms(started))
        work = _Work()
        self._walk(automaton, ((START, self._world.initial),), work, cancelled)
        for _ in range(MOST_DETOURS):
            better = self._detour(automaton, work, cancelled)
            if better is None:
                # A problem that planning ahead might have solved is none yet.
                work.cancelled = work.cancelled or (bool(work.problems) and cancelled())
                break
            work = better
        tree = plan_tree(automaton, work.segments, self._world)
        warnings = self._warnings(automaton, work)
        status = _status(work)
        return BranchingPlan(
            status, work.segments, tree, tuple(work.problems), warnings, _ms(started)
        )

    def _walk(
        self,
        automaton: Automaton,
        starts: Iterable[tuple[str, State]],
        work: _Work,
        cancelled: Callable[[], bool],
    ) -> None:
        """Plans everything below some checkpoints, each with the state that it ends in."""
        waiting = [(t, state) for c, state in starts for t in reversed(automaton.outgoing(c))]
        while waiting:
            transition, before = waiting.pop()
            if cancelled():
                work.cancelled = True
                return
            checkpoint = automaton.checkpoints[transition.target]
            state = before.after_event(transition.when, self._mutexes)
            segment = self._segment(automaton, checkpoint, transition, state, work, cancelled)
            if work.cancelled:
                return
            if segment is None:
                work.problems.extend(self._inside(automaton, checkpoint))
                continue
            work.segments[checkpoint.id] = segment
            waiting.extend((t, segment.after) for t in reversed(automaton.outgoing(checkpoint.id)))

    def _detour(
        self, automaton: Automaton, work: _Work, cancelled: Callable[[], bool]
    ) -> _Work | None:
        """The work with another way through an earlier segment, where that lets a later one succeed."""
        for problem in work.problems:
            if problem.cause not in ("unreachable", "conflict") or problem.checkpoint is None:
                continue
            for earlier in self._to_blame(automaton, problem.checkpoint, work, cancelled):
                for way in other_ways(earlier, self._segments, cancelled):
                    better = self._retried(automaton, earlier, way, work, cancelled)
                    if better is not None:
                        better.notes.append(self._note(automaton, earlier, problem.checkpoint))
                        return better
        return None

    def _to_blame(
        self, automaton: Automaton, failed: str, work: _Work, cancelled: Callable[[], bool]
    ) -> Iterator[Segment]:
        """Earlier segments, the nearest first, before which the failed goals could still be reached."""
        transition = automaton.incoming(failed)
        checkpoint = automaton.parent(failed)
        for _ in range(LOOK_BACK):
            earlier = work.segments.get(checkpoint or "")
            if transition is None or earlier is None:
                return
            insisted = automaton.checkpoints[earlier.target].action is not None
            if earlier.actions and not insisted and not cancelled():
                state = earlier.before.after_event(transition.when, self._mutexes)
                asked = automaton.checkpoints[failed].goals
                goals = grounded(asked, state, self._world, self._segments, cancelled)
                result = self._segments.solve(state, goals, AHEAD_S, cancelled)
                if result.status == "solved":
                    yield earlier
            checkpoint = automaton.parent(earlier.target)

    def _retried(
        self,
        automaton: Automaton,
        earlier: Segment,
        way: SegmentResult,
        work: _Work,
        cancelled: Callable[[], bool],
    ) -> _Work | None:
        if way.actions == earlier.actions:
            return None
        trial = work.without(automaton.subtree(earlier.target))
        transition = automaton.transitions[earlier.transition]
        checkpoint = automaton.checkpoints[earlier.target]
        shortest = earlier.optimal and len(way.actions) == len(earlier.actions)
        made = SegmentResult("solved", way.actions, shortest)
        segment = self._made(transition, checkpoint, earlier.before, earlier.goals, made)
        trial.segments[checkpoint.id] = segment
        self._walk(automaton, ((checkpoint.id, segment.after),), trial, cancelled)
        better = not trial.cancelled and trial.own_problems() < work.own_problems()
        return trial if better else None

    def _note(self, automaton: Automaton, earlier: Segment, failed: str) -> Warning:
        names = automaton.checkpoints
        text = (
            f"On the way to {names[earlier.target].name} I plan ahead: the first way that I found would have "
            f"kept me from {names[failed].name}."
        )
        return Warning(text, earlier.transition)

    def _segment(
        self,
        automaton: Automaton,
        checkpoint: Checkpoint,
        transition: Transition,
        state: State,
        work: _Work,
        cancelled: Callable[[], bool],
    ) -> Segment | None:
        if checkpoint.action is not None:
            place = Place(automaton, checkpoint, transition, state, (), work.segments)
            return self._insisted(place, work, cancelled)
        goals = grounded(checkpoint.goals, state, self._world, self._segments, cancelled)
        place = Place(automaton, checkpoint, transition, state, goals, work.segments)
        problem = self._diagnosis.conflict(place, cancelled)
        if problem is None:
            result = self._solve(state, goals, cancelled)
            if result.status == "solved":
                return self._made(transition, checkpoint, state, goals, result)
            if result.status == "cancelled":
                work.cancelled = True
                return None
            problem = self._diagnosis.failure(place, result, cancelled)
        work.problems.append(problem)
        return None

    def _insisted(self, place: Place, work: _Work, cancelled: Callable[[], bool]) -> Segment | None:
        """A checkpoint whose action the user insists on: get to where it can be done, then do it."""
        action, state = place.checkpoint.action, place.state
        assert action is not None
        operator = self._world.domain.operators[action.operator]
        needed: tuple[Formula, ...] = (bind(operator.precondition, operator.binding(action)),)
        result = SegmentResult("solved", (), True)
        if not applicable(action, operator, state, self._world):
            result = self._segments.solve(state, needed, cancelled=cancelled)
        if result.status == "cancelled":
            work.cancelled = True
            return None
        if result.status != "solved":
            work.problems.append(self._diagnosis.insisted(place, action, result, cancelled))
            return None
        whole = SegmentResult("solved", (*result.actions, action), result.optimal)
        return self._made(place.transition, place.checkpoint, state, (), whole)

    def _solve(
        self, state: State, goals: tuple[Literal, ...], cancelled: Callable[[], bool]
    ) -> SegmentResult:
        if all(state.holds(goal) for goal in goals):
            return SegmentResult("solved", (), True)
        return self._segments.solve(state, goals, cancelled=cancelled)

    def _made(
        self,
        transition: Transition,
        checkpoint: Checkpoint,
        before: State,
        goals: tuple[Literal, ...],
        result: SegmentResult,
    ) -> Segment:
        state = before
        for action in result.actions:
            state = after(action, self._world.domain.operators[action.operator], state, self._world)
        return Segment(
            transition.id,
            transition.source,
            checkpoint.id,
            transition.when,
            goals,
            result.actions,
            result.optimal,
            before,
            state,
        )

    def _inside(self, automaton: Automaton, omitted: Checkpoint) -> list[Problem]:
        below = automaton.subtree(omitted.id)[1:]
        return [inside(automaton.checkpoints[c], automaton.incoming(c), omitted) for c in below]

    def _warnings(self, automaton: Automaton, work: _Work) -> tuple[Warning, ...]:
        states = {START: self._world.initial, **{k: s.after for k, s in work.segments.items()}}
        found = warnings_of(automaton, states, self._mutexes, self._world, self._wording)
        return (*work.notes, *found)


def _status(work: _Work) -> Status:
    if work.cancelled:
        return "undecided"
    if not work.problems:
        return "ok"
    own = [p for p in work.problems if p.cause != "inside"]
    if not work.segments and all(p.cause == "undecided" for p in own):
        return "undecided"
    return "partial"


def _ms(started: float) -> float:
    return (time.perf_counter() - started) * 1000
