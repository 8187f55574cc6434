"""Why a checkpoint has no plan, in words, with ways out (DESIGN section 5 point 4).

Cheapest first: goals that exclude each other by a mutex group, then each goal alone, then ever
larger sets of goals. What isn't decided in its time is said to be undecided, and never called a
conflict.
"""

from __future__ import annotations

import itertools
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

from polaris_nl.automaton.automaton import Automaton, Checkpoint, Transition
from polaris_nl.model.domain import Action
from polaris_nl.model.formula import Literal
from polaris_nl.model.state import ANY, Mutexes, MutexGroup, State
from polaris_nl.model.text import listed, sentence
from polaris_nl.model.wording import Wording
from polaris_nl.model.world import World
from polaris_nl.planning.repairs import Repairs
from polaris_nl.planning.result import Problem
from polaris_nl.planning.segments import SegmentResult, Segments

CORE_BUDGET_S = 3.0
"""How long minimal conflicting sets of one checkpoint are looked for, in seconds."""
LARGEST_CORE_SEARCH = 8
"""With more goals than this, the subsets are too many to try."""


@dataclass(frozen=True, slots=True)
class Place:
    """Where in a program a problem stands.

    Attributes:
        state: the state before the segment, the conditional made true.
        goals: the literals that the checkpoint asks for.
    """

    automaton: Automaton
    checkpoint: Checkpoint
    transition: Transition
    state: State
    goals: tuple[Literal, ...]

    def undecided(self, reason: str) -> Problem:
        """The problem of not knowing in time whether there is a plan here."""
        text = f"For {self.checkpoint.name}: {reason or 'The planning was broken off.'}"
        return Problem("undecided", text, self.checkpoint.id, self.transition.id)


class Diagnosis:
    """Finds out why goals can't be met in one world."""

    def __init__(
        self, world: World, mutexes: Mutexes, segments: Segments, wording: Wording
    ) -> None:
        self._world = world
        self._mutexes = mutexes
        self._segments = segments
        self._wording = wording
        self._repairs = Repairs(world, mutexes, segments, wording)

    def conflict(self, place: Place, cancelled: Callable[[], bool]) -> Problem | None:
        """The problem of goals that exclude each other by a rule of the domain, or None."""
        cores: dict[tuple[Literal, ...], MutexGroup | None] = {}
        for a, b in itertools.combinations(place.goals, 2):
            group = self._mutexes.exclusive(a, b) if a.positive and b.positive else None
            if group is not None or a == b.negation:
                cores[(a, b)] = group
        return self._conflict(place, cores, cancelled) if cores else None

    def failure(
        self, place: Place, result: SegmentResult, cancelled: Callable[[], bool]
    ) -> Problem:
        """The problem of goals for which no plan was found."""
        if result.status != "unsolvable":
            return place.undecided(result.reason)
        for goal in place.goals:
            alone = self._segments.solve(place.state, (goal,), cancelled=cancelled)
            if alone.status == "unsolvable" and not place.state.holds(goal):
                return self._unreachable(place, goal, cancelled)
            if alone.status in ("undecided", "cancelled"):
                return place.undecided(alone.reason)
        cores = dict.fromkeys(self._cores(place, cancelled))
        return self._conflict(place, cores or {self._one_core(place, cancelled): None}, cancelled)

    def _cores(self, place: Place, cancelled: Callable[[], bool]) -> Iterator[tuple[Literal, ...]]:
        """All minimal sets of goals that can't be met together, smallest first, while time is left."""
        deadline = time.monotonic() + CORE_BUDGET_S
        found: list[frozenset[Literal]] = []
        if len(place.goals) > LARGEST_CORE_SEARCH:
            return
        for size in range(2, len(place.goals) + 1):
            for some in itertools.combinations(place.goals, size):
                if any(core <= set(some) for core in found):
                    continue
                if time.monotonic() > deadline or cancelled():
                    return
                if (
                    self._segments.solve(place.state, some, cancelled=cancelled).status
                    == "unsolvable"
                ):
                    found.append(frozenset(some))
                    yield some

    def _one_core(self, place: Place, cancelled: Callable[[], bool]) -> tuple[Literal, ...]:
        """One minimal set, by leaving out goal after goal; larger where the time is over."""
        deadline = time.monotonic() + CORE_BUDGET_S
        core = place.goals
        for goal in place.goals:
            fewer = tuple(g for g in core if g != goal)
            left = deadline - time.monotonic()
            if left <= 0 or cancelled():
                break
            if self._segments.solve(place.state, fewer, left, cancelled).status == "unsolvable":
                core = fewer
        return core

    def _conflict(
        self,
        place: Place,
        cores: dict[tuple[Literal, ...], MutexGroup | None],
        cancelled: Callable[[], bool],
    ) -> Problem:
        first, group = next(iter(cores.items()))
        facts = listed([self._wording.fact(goal) for goal in first])
        why = self._reason(first, group)
        text = f"I can't do \"{place.checkpoint.name}\": it can't be that {facts} at once{why}."
        repairs = self._repairs.for_conflict(
            place.automaton, place.checkpoint, place.state, place.goals, first, cancelled
        )
        return Problem(
            "conflict",
            f"{sentence(text)} {_way_out(repairs, 'Split it in two steps, or leave one of them out.')}",
            place.checkpoint.id,
            place.transition.id,
            tuple(cores),
            repairs,
        )

    def _reason(self, core: Sequence[Literal], group: MutexGroup | None) -> str:
        if group is None:
            return ""
        if any(not pattern.args for pattern in group.patterns):
            return ", as the robot has one hand"
        shared = [arg for arg in core[0].args if arg in core[1].args]
        if not any(ANY in pattern.args for pattern in group.patterns):
            return ""  # Not about places: acknowledged and dismissed just exclude each other.
        if shared:
            return f", as {self._wording.entity(shared[0])} is in one place at a time"
        if len(group.patterns) == 1:
            return ", as the robot is in one place at a time"
        return ""

    def _unreachable(self, place: Place, goal: Literal, cancelled: Callable[[], bool]) -> Problem:
        domain = self._world.domain
        fact = self._wording.fact(goal)
        repairs = self._repairs.for_unreachable(
            place.automaton, place.transition, place.state, place.goals, goal, cancelled
        )
        if domain.achievers(goal):
            lost = [a for a in goal.args if self._lost(a, place.state)]
            if lost:
                why = f"I don't know where {self._wording.entity(lost[0])} is; tell me when it is seen"
            else:
                why = f"the robot can't bring it about that {fact}: something it needs is out of its reach"
            way = "Ask for something else, or let a person do it."
        elif domain.people_can_change(goal.predicate):
            why = f"only a person can bring it about that {fact}"
            way = _way_out(repairs, f'Say "wait until {self._wording.event(goal)}" before it.')
        else:
            why = f"nothing can change whether {fact}"
            way = "Leave it out."
        cannot = sentence(f'I can\'t do "{place.checkpoint.name}": {why}')
        text = f"{cannot} {way}"
        return Problem(
            "unreachable", text, place.checkpoint.id, place.transition.id, ((goal,),), repairs
        )

    def _lost(self, entity: str, state: State) -> bool:
        known = self._world.entities.get(entity)
        if known is None or known.type not in ("object", "person"):
            return False
        return self._world.place_of(entity, state) is None


def inside(checkpoint: Checkpoint, transition: Transition | None, omitted: Checkpoint) -> Problem:
    """The problem of a checkpoint that comes after one that is left out."""
    text = f'"{checkpoint.name}" waits for "{omitted.name}", which I can\'t do.'
    return Problem("inside", sentence(text), checkpoint.id, transition.id if transition else None)


def without_a_way(
    checkpoint: Checkpoint,
    transition: Transition,
    action: Action,
    result: SegmentResult,
    wording: Wording,
) -> Problem:
    """The problem of an action that the user insists on and that can't be done there."""
    if result.status == "unsolvable":
        text = f'I can\'t do "{checkpoint.name}": there is no way to {wording.action(action)} then.'
        text = f"{sentence(text)} Say what it is for instead."
        return Problem("unreachable", text, checkpoint.id, transition.id)
    text = f"For {checkpoint.name}: {result.reason or 'The planning was broken off.'}"
    return Problem("undecided", text, checkpoint.id, transition.id)


def _way_out(repairs: Sequence[object], otherwise: str) -> str:
    if repairs:
        return sentence(f"you could {getattr(repairs[0], 'text', '')}")
    return otherwise
