"""What would have to be forgone for goals that can't be met at the end of a program."""

from __future__ import annotations

from collections.abc import Sequence

from polaris_nl.automaton.automaton import START, Automaton
from polaris_nl.model.formula import Goal
from polaris_nl.model.goals import ground_goals
from polaris_nl.planning.foils import Contrast
from polaris_nl.planning.insisting import insisting
from polaris_nl.planning.planner import Planner
from polaris_nl.planning.result import BranchingPlan


def earlier_place(
    planner: Planner, automaton: Automaton, plan: BranchingPlan, goals: Sequence[Goal], last: str
) -> Contrast | None:
    """The latest checkpoint before `last` after which goals can be met, and what that would forgo.

    For goals that can't be met after `last`: an earlier step may have used up what they need. After
    Eifler, Cashmore, Hoffmann, Magazzeni and Steinmetz, "A New Approach to Plan-Space Explanation"
    (AAAI 2020): to have one thing, others are forgone.

    Returns:
        A contrast with the checkpoint, the actions there in `prefix`, and `lost`; None where there
        is no such place.
    """
    path = [START, *(t.target for t in automaton.path(last))]
    for checkpoint in reversed(path[:-1]):
        segment = plan.segments.get(checkpoint)
        if segment is None and checkpoint != START:
            continue
        state = segment.after if segment else planner.world.initial
        wanted = ground_goals(goals, state, planner.world)
        found = planner.segment(state, wanted)
        if found.status == "solved":
            trial = planner.compile(insisting(automaton, checkpoint, None, found.actions))
            lost = tuple(c for c in plan.segments if c not in trial.segments)
            return Contrast("possible", checkpoint, found.actions, len(found.actions), lost=lost)
    return None
