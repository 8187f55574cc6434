"""What a plan does to the whole world, action by action: every plan is checked so before it is shown."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from polaris_nl.model.domain import Action, conjuncts
from polaris_nl.model.evaluate import effects, holds
from polaris_nl.model.formula import Formula, Literal, bind
from polaris_nl.model.state import State
from polaris_nl.model.world import World
from polaris_nl.planning.memory import Memory
from polaris_nl.planning.result import Step

MOST_ACTIONS = 20_000
"""Ground actions that are remembered."""


@dataclass(frozen=True, slots=True)
class _Ground:
    """An action with its values put in; `changes` is None where they depend on the state."""

    precondition: Formula
    changes: tuple[Literal, ...] | None


class Simulator:
    """Carries actions out in one world, in thought."""

    def __init__(self, world: World) -> None:
        self._world = world
        self._known: Memory[Action, _Ground] = Memory(MOST_ACTIONS)

    def run(self, state: State, actions: Iterable[Action]) -> tuple[Step, ...] | None:
        """What each action leads to, or None where one of them can't be done."""
        steps = []
        for action in actions:
            ground = self._ground(action)
            if ground is None or not holds(ground.precondition, state, self._world):
                return None
            changes = ground.changes
            if changes is None:
                operator = self._world.domain.operators[action.operator]
                changes = effects(action, operator, state, self._world)
            removed = [e.atom for e in changes if not e.positive and e.atom in state.facts]
            added = [e for e in changes if e.positive and e not in state.facts]
            # PDDL's order: what is removed and added again stays.
            kept = {e for e in changes if e.positive}
            removed = sorted(e for e in removed if e not in kept)
            state = state.change(removed, added)
            steps.append(Step(state, tuple(removed), tuple(sorted(added))))
        return tuple(steps)

    def _ground(self, action: Action) -> _Ground | None:
        """The action's conditions and changes; None where there is no such action."""
        known = self._known.get(action)
        if known is None:
            operator = self._world.domain.operators.get(action.operator)
            if operator is None or len(operator.parameters) != len(action.args):
                return None
            binding = operator.binding(action)
            parts = tuple(conjuncts(bind(operator.effect, binding)))
            literals = tuple(p for p in parts if isinstance(p, Literal))
            plain = literals if len(literals) == len(parts) else None
            known = _Ground(bind(operator.precondition, binding), plain)
            self._known.put(action, known)
        return known
