"""Goes through a program from the start and plans each checkpoint (DESIGN section 5 points 1 and 2).

A checkpoint's segment is a pure, remembered function of the checkpoint, its transition and the state
that it is reached in. So after an edit only what hangs on the edit is planned again, and only as far
as the states differ from those before.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

from polaris_nl.automaton.automaton import Automaton, Checkpoint, Transition
from polaris_nl.model.domain import Action
from polaris_nl.model.evaluate import applicable
from polaris_nl.model.formula import Formula, Literal, bind
from polaris_nl.model.goals import ground_goals, leaves_a_choice
from polaris_nl.model.state import Mutexes, State
from polaris_nl.model.wording import Wording
from polaris_nl.model.world import World
from polaris_nl.planning.memory import Memory
from polaris_nl.planning.place import Place, inside
from polaris_nl.planning.problems import Diagnosis
from polaris_nl.planning.result import Problem, Segment, Warning
from polaris_nl.planning.segments import MOST_FACTS, SegmentResult, Segments
from polaris_nl.planning.witnesses import grounded

Key = tuple[Checkpoint, Transition, State]
Waiting = tuple[Transition, State]


@dataclass
class Work:
    """What has been planned of a program.

    Attributes:
        segments: by the checkpoint that they end at.
        notes: what was planned ahead, in words.
        cancelled: the work was broken off.
        ahead: the checkpoints whose segments were planned with an eye to what follows.
    """

    segments: dict[str, Segment] = field(default_factory=dict)
    problems: list[Problem] = field(default_factory=list)
    notes: list[Warning] = field(default_factory=list)
    cancelled: bool = False
    ahead: set[str] = field(default_factory=set)

    def action_count(self) -> int:
        """All actions, each segment counted once."""
        return sum(len(s.actions) for s in self.segments.values())

    def plain(self) -> dict[str, Segment]:
        """The segments that were planned for themselves alone."""
        return {k: s for k, s in self.segments.items() if k not in self.ahead}

    def own_problems(self) -> int:
        """How many checkpoints fail by themselves, not because of one above them."""
        return sum(p.cause != "inside" for p in self.problems)

    def without(self, checkpoints: Collection[str]) -> Work:
        """A copy in which some checkpoints are still to be planned."""
        segments = {k: s for k, s in self.segments.items() if k not in checkpoints}
        problems = [p for p in self.problems if p.checkpoint not in checkpoints]
        return Work(segments, problems, list(self.notes), ahead=self.ahead - set(checkpoints))


@dataclass(frozen=True)
class Errand:
    """What is asked of a walk.

    Attributes:
        cancelled: asked now and then; True ends the work.
        quick: any plan will do where a shortest one isn't found at once.
        first: checkpoints that are planned before others.
        kept: the segments shown until now, kept where they still work and are as short, so that
            plans don't flicker.
        ways: actions for some checkpoints, to be taken instead of the shortest.
        only: the only checkpoints to be planned, where not all are.
    """

    automaton: Automaton
    cancelled: Callable[[], bool]
    quick: bool = False
    first: frozenset[str] = frozenset()
    kept: Mapping[str, Segment] = field(default_factory=dict)
    ways: Mapping[str, tuple[Action, ...]] = field(default_factory=dict)
    only: frozenset[str] | None = None

    def onward(self, checkpoint: str) -> tuple[Transition, ...]:
        """The transitions from a checkpoint to those that are to be planned, the last first."""
        only = self.only
        outgoing = reversed(self.automaton.outgoing(checkpoint))
        return tuple(t for t in outgoing if only is None or t.target in only)


class Walker:
    """Plans the checkpoints of programs in one world."""

    def __init__(
        self, world: World, mutexes: Mutexes, segments: Segments, wording: Wording
    ) -> None:
        self._world = world
        self._mutexes = mutexes
        self._segments = segments
        self._wording = wording
        self._diagnosis = Diagnosis(world, mutexes, segments, wording)
        self._known: Memory[Key, Segment] = Memory(MOST_FACTS, _weight)

    def walk(self, errand: Errand, starts: Sequence[Waiting], work: Work) -> Iterator[None]:
        """Plans everything from some transitions on, each given with the state that it leaves.

        What is known is filled in first, then what was asked for first, then the rest in the order
        of the program. Yields after each checkpoint that may have taken long.
        """
        automaton = errand.automaton
        waiting = list(reversed(starts))
        slow: list[Waiting] = []
        while waiting or slow:
            known = bool(waiting)
            transition, before = waiting.pop() if known else _next(slow, errand.first)
            if known and not self._is_known(errand, transition, before):
                slow.insert(0, (transition, before))
                continue
            if errand.cancelled():
                work.cancelled = True
                return
            checkpoint = automaton.checkpoints[transition.target]
            segment = self._segment(errand, checkpoint, transition, before, work)
            if work.cancelled:
                return
            if segment is None:
                below = automaton.subtree(checkpoint.id)[1:]
                work.problems.extend(
                    inside(automaton.checkpoints[c], automaton.incoming(c), checkpoint)
                    for c in below
                )
            else:
                work.segments[checkpoint.id] = segment
                waiting.extend((t, segment.after) for t in errand.onward(checkpoint.id))
            if not known:
                yield

    def again(self, errand: Errand, checkpoint: str, state: State, work: Work) -> Work:
        """A copy of the work in which a checkpoint, reached from a state, is planned once more.

        What follows it is too, or else what the errand is limited to.
        """
        automaton = errand.automaton
        below = automaton.subtree(checkpoint) if errand.only is None else tuple(errand.only)
        trial = work.without(below)
        transition = automaton.incoming(checkpoint)
        assert transition is not None
        for _ in self.walk(errand, [(transition, state)], trial):
            pass
        return trial

    def before(self, state: State, transition: Transition) -> State:
        """The state before a segment: its transition's conditional made true."""
        return state.after_event(transition.when, self._mutexes) if transition.when else state

    def made(
        self,
        transition: Transition,
        before: State,
        goals: tuple[Literal, ...],
        result: SegmentResult,
    ) -> Segment:
        """The segment of a plan that has been found."""
        state = result.steps[-1].state if result.steps else before
        return Segment(
            transition.id,
            transition.source,
            transition.target,
            transition.when,
            goals,
            result.actions,
            result.optimal,
            before,
            state,
            result.steps,
        )

    def _is_known(self, errand: Errand, transition: Transition, state: State) -> bool:
        checkpoint = errand.automaton.checkpoints[transition.target]
        if self._known.get((checkpoint, transition, state)) is not None:
            return True
        if checkpoint.action is not None or any(map(leaves_a_choice, checkpoint.goals)):
            return False
        before = self.before(state, transition)
        return all(map(before.holds, ground_goals(checkpoint.goals, before, self._world)))

    def _segment(
        self,
        errand: Errand,
        checkpoint: Checkpoint,
        transition: Transition,
        state: State,
        work: Work,
    ) -> Segment | None:
        key = (checkpoint, transition, state)
        segment = self._known.get(key)
        if segment is None or not (segment.optimal or errand.quick):
            segment = self._planned(errand, checkpoint, transition, state, work)
            if segment is None:
                return None
            self._known.put(key, segment)
        way = errand.ways.get(checkpoint.id)
        if way is not None and way != segment.actions:
            other = self._in_another_way(segment, way)
            work.ahead.update({checkpoint.id} if other else ())
            return other or segment
        kept = errand.kept.get(checkpoint.id)
        if kept is not None and kept.actions != segment.actions and _may_stay(kept, segment):
            return self._in_another_way(segment, kept.actions) or segment
        return segment

    def _planned(
        self,
        errand: Errand,
        checkpoint: Checkpoint,
        transition: Transition,
        state: State,
        work: Work,
    ) -> Segment | None:
        before = self.before(state, transition)
        place = Place(errand.automaton, checkpoint, transition, before, (), work.segments)
        if checkpoint.action is not None:
            return self._insisted(errand, place, work)
        goals = grounded(checkpoint.goals, before, self._world, self._segments, errand.cancelled)
        if goals is not None and all(map(before.holds, goals)):
            return self.made(transition, before, goals, SegmentResult("solved", (), True))
        goals = goals or ()
        place = replace(place, goals=goals)
        problem = self._diagnosis.conflict(place, errand.cancelled)
        if problem is None:
            result = self._solve(errand, before, goals)
            if result.status == "solved":
                return self.made(transition, before, goals, result)
            if result.status == "cancelled":
                work.cancelled = True
                return None
            problem = self._diagnosis.failure(place, result, errand.cancelled)
        work.problems.append(problem)
        return None

    def _insisted(self, errand: Errand, place: Place, work: Work) -> Segment | None:
        """A checkpoint whose action the user insists on: get to where it can be done, then do it."""
        action, before = place.checkpoint.action, place.state
        assert action is not None
        operator = self._world.domain.operators[action.operator]
        needed: tuple[Formula, ...] = (bind(operator.precondition, operator.binding(action)),)
        result = SegmentResult("solved", (), True)
        if not applicable(action, operator, before, self._world):
            result = self._solve(errand, before, needed)
        if result.status == "cancelled":
            work.cancelled = True
            return None
        actions = (*result.actions, action)
        steps = self._segments.steps(before, (), actions) if result.status == "solved" else None
        if steps is None:
            problem = self._diagnosis.insisted(place, action, result, errand.cancelled)
            work.problems.append(problem)
            return None
        whole = SegmentResult("solved", actions, result.optimal, steps=steps)
        return self.made(place.transition, before, (), whole)

    def _solve(self, errand: Errand, state: State, goals: tuple[Formula, ...]) -> SegmentResult:
        return self._segments.solve(state, goals, cancelled=errand.cancelled, quick=errand.quick)

    def _in_another_way(self, segment: Segment, actions: tuple[Action, ...]) -> Segment | None:
        """The segment with other actions, or None where they don't lead to its goals."""
        steps = self._segments.steps(segment.before, segment.goals, actions)
        if steps is None:
            return None
        optimal = segment.optimal and len(actions) == len(segment.actions)
        end = steps[-1].state if steps else segment.before
        return replace(segment, actions=actions, optimal=optimal, after=end, steps=steps)


def _may_stay(kept: Segment, new: Segment) -> bool:
    """Whether a plan that was shown is as short as a new one and for the same goals."""
    return bool(kept.goals) and kept.goals == new.goals and len(kept.actions) <= len(new.actions)


def _next(slow: list[Waiting], first: frozenset[str]) -> Waiting:
    """Takes what is most urgent out of the list (in which the earliest is last)."""
    for place in range(len(slow) - 1, -1, -1):
        if slow[place][0].target in first:
            return slow.pop(place)
    return slow.pop()


def _weight(key: Key, segment: Segment) -> int:
    """The facts that a memory keeps alive, most of them in the states."""
    return 50 + len(key[2].facts) * (2 + len(segment.steps))
