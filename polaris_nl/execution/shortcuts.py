"""Where a plan can be taken up in the perceived state.

Fikes, Hart and Nilsson (1972), "Learning and executing generalized robot plans": PLANEX looks for the
last action of a plan whose kernel (what the rest of the plan needs, and keeps) holds in the world, so
that help saves work and what was undone is done again. Kernels needn't be tabulated here: carrying the
rest of a plan out in thought costs microseconds.
"""

from __future__ import annotations

from collections.abc import Sequence

from polaris_nl.execution.backend import Observation
from polaris_nl.model.domain import Action
from polaris_nl.model.formula import Literal
from polaris_nl.model.state import State
from polaris_nl.planning.simulate import Simulator


def shortcut(
    simulator: Simulator, state: State, actions: Sequence[Action], goals: Sequence[Literal]
) -> int | None:
    """The number of actions at the beginning that aren't needed any more, the most there are.

    Args:
        simulator: carries actions out in thought.
        state: what is so.
        actions: what is left of a plan.
        goals: what is to hold at its end.

    Returns:
        The first index from which the rest can be done from `state` and ends in all `goals`;
        `len(actions)` where they hold already, None where no rest leads there.
    """
    starts = range(len(actions), -1, -1)
    return next((n for n in starts if _works(simulator, state, actions[n:], goals)), None)


def seen_shortcut(
    simulator: Simulator,
    observation: Observation,
    actions: Sequence[Action],
    goals: Sequence[Literal],
) -> int:
    """The same for what is perceived; 0 where nothing is certain to be saved.

    What is unknown may be true or false, and the rest has to work either way.
    """
    if observation.blind:
        return 0
    facts, unknown = observation.state.facts, observation.unknown
    found = shortcut(simulator, State(facts - unknown), actions, goals) or 0
    if found and unknown:
        most = State(facts | unknown)
        return found if _works(simulator, most, actions[found:], goals) else 0
    return found


def _works(
    simulator: Simulator, state: State, actions: Sequence[Action], goals: Sequence[Literal]
) -> bool:
    steps = simulator.run(state, actions)
    if steps is None:
        return False
    end = steps[-1].state if steps else state
    return all(map(end.holds, goals))
