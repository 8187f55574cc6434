"""Trying an edit before it is offered: which checkpoints would have no plan after it.

Only what the edit touches, and what comes after that, is planned again: all else is a pure function
of what stays the same (DESIGN section 5 point 1).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from polaris_nl.automaton.automaton import START, Automaton, Checkpoint
from polaris_nl.automaton.edits import Edit, apply_all
from polaris_nl.automaton.validation import Fault, validate
from polaris_nl.model.domain import Action
from polaris_nl.model.errors import EditError, FormatError
from polaris_nl.model.evaluate import after, holds
from polaris_nl.model.formula import Formula, bind
from polaris_nl.model.state import Mutexes, State
from polaris_nl.model.world import World
from polaris_nl.planning.result import Segment
from polaris_nl.planning.segments import Segments
from polaris_nl.planning.witnesses import grounded

BUDGET_S = 1.0
"""How long one segment of a way out may take, in seconds."""


@dataclass(frozen=True, slots=True)
class Outcome:
    """What an edit leads to.

    Attributes:
        program: the program after it.
        failed: the checkpoints that have no plan there, of those that the edit touches.
        faults: what is wrong with its names and shape, in which case nothing was planned.
    """

    program: Automaton
    failed: frozenset[str] = frozenset()
    faults: tuple[Fault, ...] = ()


class Trial:
    """Tries edits of one world's programs."""

    def __init__(self, world: World, mutexes: Mutexes, segments: Segments) -> None:
        self._world = world
        self._mutexes = mutexes
        self._segments = segments

    def of(
        self,
        automaton: Automaton,
        edits: Sequence[Edit],
        known: Mapping[str, Segment] | None,
        cancelled: Callable[[], bool],
    ) -> Outcome | None:
        """What a program would be after some edits; None where they don't fit it.

        Args:
            automaton: the program before.
            edits: applied one after the other, as one.
            known: the segments of the program before that have a plan; None where nothing was planned
                yet, and all has to be.
            cancelled: True ends the trial; what isn't planned by then counts as failed.
        """
        try:
            changed = apply_all(automaton, edits)
        except EditError:
            return None
        faults = validate(changed, self._world)
        if faults:
            return Outcome(changed, faults=faults)
        failed: set[str] = set()
        waiting = [(START, self._world.initial, known is None)]
        while waiting:
            here, before, touched_before = waiting.pop()
            for transition in changed.outgoing(here):
                target = changed.checkpoints[transition.target]
                touched = (
                    touched_before
                    or automaton.checkpoints.get(target.id) != target
                    or automaton.transitions.get(transition.id) != transition
                )
                end: State | None = None
                if touched:
                    state = before.after_event(transition.when, self._mutexes)
                    end = self._end(target, state, cancelled)
                    if end is None:
                        failed.add(target.id)
                elif known is not None and target.id in known:
                    end = known[target.id].after
                if end is not None:
                    waiting.append((target.id, end, touched))
        return Outcome(changed, frozenset(failed))

    def _end(
        self, checkpoint: Checkpoint, state: State, cancelled: Callable[[], bool]
    ) -> State | None:
        """The state in which a checkpoint is reached; None where it isn't."""
        goals: tuple[Formula, ...]
        if checkpoint.action is not None:
            operator = self._world.domain.operators[checkpoint.action.operator]
            goals = (bind(operator.precondition, operator.binding(checkpoint.action)),)
        else:
            try:
                found = grounded(checkpoint.goals, state, self._world, self._segments, cancelled)
            except FormatError:
                return None
            if found is None:
                return None
            goals = found
        actions: tuple[Action, ...] = ()
        if not all(holds(goal, state, self._world) for goal in goals):
            result = self._segments.solve(state, goals, BUDGET_S, cancelled)
            if result.status != "solved":
                return None
            actions = result.actions
        if checkpoint.action is not None:
            actions = (*actions, checkpoint.action)
        for action in actions:
            state = after(action, self._world.domain.operators[action.operator], state, self._world)
        return state
