"""Ways out of a problem, each tried before it is offered: small edits after which the checkpoint has a plan."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from polaris_nl.automaton.automaton import Automaton, Checkpoint, Transition
from polaris_nl.automaton.edits import Edit, InsertCheckpoint, SetConditional, SetGoals, apply_all
from polaris_nl.automaton.validation import validate
from polaris_nl.model.errors import EditError
from polaris_nl.model.evaluate import after
from polaris_nl.model.formula import Literal
from polaris_nl.model.state import Mutexes, State
from polaris_nl.model.text import listed
from polaris_nl.model.wording import Wording
from polaris_nl.model.world import World
from polaris_nl.planning.result import Repair
from polaris_nl.planning.segments import SegmentResult, Segments

MOST = 4
"""Ways out that are offered at most."""
BUDGET_S = 1.0
"""How long one segment of a way out may take, in seconds."""


class Repairs:
    """Finds and tries repairs in one world."""

    def __init__(
        self, world: World, mutexes: Mutexes, segments: Segments, wording: Wording
    ) -> None:
        self._world = world
        self._mutexes = mutexes
        self._segments = segments
        self._wording = wording

    def for_conflict(
        self,
        automaton: Automaton,
        checkpoint: Checkpoint,
        state: State,
        goals: tuple[Literal, ...],
        core: Sequence[Literal],
        cancelled: Callable[[], bool],
    ) -> tuple[Repair, ...]:
        """Splitting the goals into two ordered checkpoints, or dropping one of them."""
        if tuple(checkpoint.goals) != goals:
            return ()  # Quantified goals are split by rewording, not by taking literals out of them.
        found: list[Repair] = []
        for goal in reversed(core):
            found.extend(self._split(automaton, checkpoint, state, goals, goal, cancelled))
        for goal in reversed(core):
            found.extend(self._drop(automaton, checkpoint, state, goals, goal, cancelled))
        return tuple(found[:MOST])

    def for_unreachable(
        self,
        automaton: Automaton,
        transition: Transition,
        state: State,
        goals: tuple[Literal, ...],
        goal: Literal,
        cancelled: Callable[[], bool],
    ) -> tuple[Repair, ...]:
        """Waiting for a person to bring the goal about, and all else that only people can."""
        domain = self._world.domain
        awaited = tuple(
            g
            for g in goals
            if g == goal or not (state.holds(g) or domain.achievers(g) or g in transition.when)
        )
        if goal in transition.when or not all(
            domain.people_can_change(g.predicate) for g in awaited
        ):
            return ()
        if not self._solvable(state.after_event(awaited, self._mutexes), goals, cancelled):
            return ()
        edit = SetConditional(transition.id, (*transition.when, *awaited))
        text = f"wait until {listed([self._wording.event(g) for g in awaited])}"
        return self._sound(automaton, Repair(text, (edit,)))

    def _split(
        self,
        automaton: Automaton,
        checkpoint: Checkpoint,
        state: State,
        goals: tuple[Literal, ...],
        last: Literal,
        cancelled: Callable[[], bool],
    ) -> tuple[Repair, ...]:
        first = tuple(g for g in goals if g != last)
        result = self._segments.solve(state, first, BUDGET_S, cancelled)
        if result.status != "solved":
            return ()
        between = self._after(state, result)
        if not self._solvable(between, (last,), cancelled):
            return ()
        incoming = automaton.incoming(checkpoint.id)
        if incoming is None:
            return ()
        name = automaton.fresh_name(f"before {checkpoint.name}")
        earlier = Checkpoint(automaton.fresh_checkpoint_id(), name, first)
        edits: tuple[Edit, ...] = (
            InsertCheckpoint(earlier, incoming.id, automaton.fresh_transition_id()),
            SetGoals(checkpoint.id, (last,)),
        )
        before = listed([self._wording.goal(g) for g in first])
        text = f"{before} first, and then {self._wording.goal(last)}"
        return self._sound(automaton, Repair(text, edits))

    def _drop(
        self,
        automaton: Automaton,
        checkpoint: Checkpoint,
        state: State,
        goals: tuple[Literal, ...],
        dropped: Literal,
        cancelled: Callable[[], bool],
    ) -> tuple[Repair, ...]:
        kept = tuple(g for g in goals if g != dropped)
        if not kept or not self._solvable(state, kept, cancelled):
            return ()
        text = f"leave out that {self._wording.fact(dropped)}"
        return self._sound(automaton, Repair(text, (SetGoals(checkpoint.id, kept),)))

    def _solvable(
        self, state: State, goals: tuple[Literal, ...], cancelled: Callable[[], bool]
    ) -> bool:
        return self._segments.solve(state, goals, BUDGET_S, cancelled).status == "solved"

    def _sound(self, automaton: Automaton, repair: Repair) -> tuple[Repair, ...]:
        """The repair, unless its edits don't fit or break the program's shape."""
        try:
            changed = apply_all(automaton, repair.edits)
        except EditError:
            return ()
        return () if validate(changed, self._world) else (repair,)

    def _after(self, state: State, result: SegmentResult) -> State:
        for action in result.actions:
            state = after(action, self._world.domain.operators[action.operator], state, self._world)
        return state
