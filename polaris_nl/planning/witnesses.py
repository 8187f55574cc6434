"""Goals that leave a choice ("a cup", "two cups"): which things to take, by planning for each.

Each choice of things is an ordinary set of goals. What takes the fewest actions is taken, the first
in the world's file among equals, so that plans don't flicker.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence

from polaris_nl.model.formula import Goal, Literal
from polaris_nl.model.goals import choices, ground_goals, leaves_a_choice
from polaris_nl.model.state import State
from polaris_nl.model.world import World
from polaris_nl.planning.budget import within
from polaris_nl.planning.segments import Segments

MOST_CHOICES = 500
"""Choices that are looked at; of more, the first."""
MOST_TRIED = 24
"""Choices that are planned for once one has a plan: those of which most holds already."""
BUDGET_S = 1.0
"""How long one choice may be planned for, in seconds."""
TOTAL_S = 3.0
"""How long all of them may be, in seconds."""


def grounded(
    goals: Sequence[Goal],
    state: State,
    world: World,
    segments: Segments,
    cancelled: Callable[[], bool],
) -> tuple[Literal, ...] | None:
    """The literals to plan for: all that goals ask for, the best things chosen where they leave a choice.

    Where no choice leads to a plan, the one of which most holds already stands for all. None, where
    there is nothing to choose from.

    Args:
        goals: a checkpoint's goals.
        state: where the segment starts.
        world: whose entities quantifiers run over.
        segments: plans each choice.
        cancelled: asked now and then; True ends the search.
    """
    if not any(map(leaves_a_choice, goals)):
        return ground_goals(goals, state, world)
    ways = list(itertools.islice(choices(goals, state, world), MOST_CHOICES))
    ways.sort(key=lambda way: sum(not state.holds(x) for x in way))
    if not ways or all(map(state.holds, ways[0])):
        return ways[0] if ways else None
    best, cost = ways[0], None
    over = within(TOTAL_S, cancelled)
    for number, way in enumerate(ways):
        enough = cost is not None and (cost == 1 or number >= MOST_TRIED)
        if enough or over():
            break
        result = segments.solve(state, way, BUDGET_S, cancelled)
        if result.status == "solved" and (cost is None or len(result.actions) < cost):
            best, cost = way, len(result.actions)
    return best


def nothing_to_choose(goals: Sequence[Goal], state: State, world: World) -> bool:
    """Whether some goal asks for one of a kind of which there is none."""
    asked = any(map(leaves_a_choice, goals))
    return asked and next(choices(goals, state, world), None) is None


def hopeless(
    goals: Sequence[Goal],
    state: State,
    world: World,
    segments: Segments,
    cancelled: Callable[[], bool],
) -> bool:
    """Whether it is certain that no choice of things leads to a plan (what was found out is remembered)."""
    ways = list(itertools.islice(choices(goals, state, world), MOST_CHOICES + 1))
    over = within(TOTAL_S, cancelled)
    for way in ways:
        if over():
            return False
        if segments.solve(state, way, BUDGET_S, cancelled).status != "unsolvable":
            return False
    return len(ways) <= MOST_CHOICES
