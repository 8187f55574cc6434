"""The scores of Porfirio, Roberts and Hiatt (HRI 2024), section 4.1.2: feasibility, human effort, runtime.

docs/score.md says how each is defined here, and works examples out by hand.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from polaris_nl.automaton.automaton import Automaton
from polaris_nl.execution.events import Event, Observed, RunStarted
from polaris_nl.execution.runner import objectives_met
from polaris_nl.model.formula import parse_literal
from polaris_nl.model.state import State
from polaris_nl.model.world import Objective, World
from polaris_nl.planning.planner import Planner
from polaris_nl.planning.result import BranchingPlan
from polaris_nl.scoring.people import Hands, listed_acts
from polaris_nl.scoring.play import Play
from polaris_nl.scoring.search import MOST_MOMENTS, Best, best_run


@dataclass(frozen=True, slots=True)
class Score:
    """What a program could achieve, before it runs.

    Attributes:
        feasible: the best run with the world's human actions: its count is the feasibility score.
        least: the run that meets most, by hand too, with the fewest human actions.
    """

    feasible: Best
    least: Best

    @property
    def human_effort(self) -> int | None:
        """The fewest human actions with which all objectives are met; None where none are known to do."""
        return len(self.least.chosen) if all(self.least.met) else None


def score(
    automaton: Automaton, plan: BranchingPlan, planner: Planner, most: int = MOST_MOMENTS
) -> Score:
    """Scores a program by looking at every way in which people could act.

    Args:
        automaton: the program.
        plan: its plan.
        planner: of the world whose scenario lists objectives and human actions.
        most: moments to look at, at most, for each of the two figures.
    """
    play = Play(automaton, plan, planner.world, planner.segment)
    hands = Hands(planner.world, planner.mutexes)
    listed = listed_acts(planner.world)
    feasible = best_run(play, listed, hands, planner.mutexes, most)
    acts = (*listed, *hands.acts(play))
    if len(acts) == len(listed):
        return Score(feasible, feasible)
    return Score(feasible, best_run(play, acts, hands, planner.mutexes, most))


def final_beliefs(events: Sequence[Event]) -> State | None:
    """What was perceived last in a log's last run; None where the log has no run."""
    state: State | None = None
    for event in events:
        if isinstance(event, RunStarted):
            state = State(frozenset(map(parse_literal, event.beliefs)))
        elif isinstance(event, Observed) and state is not None:
            state = state.change(map(parse_literal, event.removed), map(parse_literal, event.added))
    return state


def runtime_score(
    events: Sequence[Event], world: World
) -> tuple[tuple[Objective, bool], ...] | None:
    """Which objectives a logged run had met at its end; None where the log has no run."""
    state = final_beliefs(events)
    return None if state is None else objectives_met(world, state)
