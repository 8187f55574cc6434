"""From a goal automaton to a branching plan (DESIGN section 5 points 1 to 5, 7)."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

from polaris_nl.automaton.automaton import START, Automaton, Checkpoint, Transition
from polaris_nl.automaton.validation import validate
from polaris_nl.model.domain import KIND
from polaris_nl.model.evaluate import after, applicable, ground_goals
from polaris_nl.model.formula import And, Formula, Imply, Literal, Quantified, bind
from polaris_nl.model.state import Mutexes, State
from polaris_nl.model.wording import Wording
from polaris_nl.model.world import World
from polaris_nl.planning.problems import Diagnosis, Place, inside, without_a_way
from polaris_nl.planning.result import BranchingPlan, Problem, Segment, Status, Warning
from polaris_nl.planning.segments import SegmentResult, Segments
from polaris_nl.planning.tree import plan_tree
from polaris_nl.planning.warnings import warnings_of


@dataclass
class _Work:
    segments: dict[str, Segment] = field(default_factory=dict)
    problems: list[Problem] = field(default_factory=list)
    cancelled: bool = False


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
        self._diagnosis = Diagnosis(world, mutexes, segments, wording)
        self._wording = wording

    def compile(self, automaton: Automaton, cancelled: Callable[[], bool]) -> BranchingPlan:
        """Plans every checkpoint that can be planned.

        A cancelled compile returns what it has, with status `undecided`.
        """
        started = time.perf_counter()
        faults = validate(automaton, self._world)
        if faults:
            problems = tuple(Problem(f.cause, f.text, f.checkpoint, f.transition) for f in faults)
            # Names and shape come first: until they are right, the same conditional may not be the same.
            only_under = all(f.cause == "underspecified" for f in faults)
            status: Status = "underspecified" if only_under else "invalid"
            return BranchingPlan(status, {}, None, problems, (), _ms(started))
        no_goals = tuple(_no_goals(automaton))
        if no_goals:
            return BranchingPlan("invalid", {}, None, no_goals, (), _ms(started))
        work = _Work()
        self._walk(automaton, work, cancelled)
        tree = plan_tree(automaton, work.segments, self._world)
        warnings = self._warnings(automaton, work)
        status = _status(work)
        return BranchingPlan(
            status, work.segments, tree, tuple(work.problems), warnings, _ms(started)
        )

    def _walk(self, automaton: Automaton, work: _Work, cancelled: Callable[[], bool]) -> None:
        waiting = [(t, self._world.initial) for t in reversed(automaton.outgoing(START))]
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
            return self._insisted(checkpoint, transition, state, work, cancelled)
        goals = ground_goals(checkpoint.goals, state, self._world)
        place = Place(automaton, checkpoint, transition, state, goals)
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

    def _insisted(
        self,
        checkpoint: Checkpoint,
        transition: Transition,
        state: State,
        work: _Work,
        cancelled: Callable[[], bool],
    ) -> Segment | None:
        """A checkpoint whose action the user insists on: get to where it can be done, then do it."""
        action = checkpoint.action
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
            work.problems.append(
                without_a_way(checkpoint, transition, action, result, self._wording)
            )
            return None
        whole = SegmentResult("solved", (*result.actions, action), result.optimal)
        return self._made(transition, checkpoint, state, (), whole)

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
        return warnings_of(automaton, states, self._mutexes, self._world, self._wording)


def _no_goals(automaton: Automaton) -> Iterator[Problem]:
    for checkpoint in automaton.checkpoints.values():
        for goal in checkpoint.goals:
            part = _no_goal(goal)
            if part is None:
                continue
            why = "a goal is a fact, or one for all of a kind; ask for one of the facts in it"
            if isinstance(part, Literal):
                why = "the world's file says what kind a thing is, and no action changes it"
            text = f"In {checkpoint.name}: {part} is no goal, as {why}."
            yield Problem("invalid", text, checkpoint.id)
    for transition in automaton.transitions.values():
        for literal in transition.when:
            if literal.predicate == KIND:
                text = f"{literal} is no conditional, as what kind a thing is never changes."
                yield Problem("invalid", text, transition.target, transition.id)


def _no_goal(goal: Formula) -> Formula | None:
    """The first part of a goal that asks for no fact, such as an `or`; None where all of it does."""
    if isinstance(goal, Literal):
        return goal if goal.predicate == KIND else None
    if isinstance(goal, And):
        return next((p for p in map(_no_goal, goal.parts) if p is not None), None)
    if isinstance(goal, Imply):
        return _no_goal(goal.conclusion)
    if isinstance(goal, Quantified) and goal.quantifier == "forall":
        return _no_goal(goal.body)
    return goal


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
