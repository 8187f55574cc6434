"""Why an action is in a plan: the causal links from what it brings about to what needs it later."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from polaris_nl.automaton.automaton import Automaton
from polaris_nl.model.domain import Action
from polaris_nl.model.evaluate import after, applicable, effects
from polaris_nl.model.formula import Literal
from polaris_nl.model.state import State
from polaris_nl.model.world import World
from polaris_nl.planning.result import BranchingPlan, Segment


@dataclass(frozen=True, slots=True)
class Reason:
    """A causal link.

    Attributes:
        fact: what the action makes true.
        needed_by: the first later action that needs it, or None where it is a goal itself.
        checkpoint: the checkpoint whose segment or goal needs it.
    """

    fact: Literal
    needed_by: Action | None
    checkpoint: str


def reasons_for(
    plan: BranchingPlan, automaton: Automaton, world: World, segment: Segment, at: int
) -> tuple[Reason, ...]:
    """What an action is for, followed down the first way at every fork.

    Args:
        plan: the whole plan.
        automaton: its program.
        world: the world it is planned in.
        segment: the segment of the action.
        at: the action's place in it, from 0.
    """
    states = _states(segment, world)
    _, added = states[at].difference(states[at + 1])
    found = (_first_use(fact, plan, automaton, world, segment, at) for fact in added)
    return tuple(reason for reason in found if reason is not None)


def _states(segment: Segment, world: World) -> list[State]:
    states = [segment.before]
    for action in segment.actions:
        operator = world.domain.operators[action.operator]
        states.append(after(action, operator, states[-1], world))
    return states


def _first_use(
    fact: Literal,
    plan: BranchingPlan,
    automaton: Automaton,
    world: World,
    segment: Segment,
    at: int,
) -> Reason | None:
    remaining: Sequence[Action] = segment.actions[at + 1 :]
    state = _states(segment, world)[at + 1]
    while True:
        for action in remaining:
            operator = world.domain.operators[action.operator]
            if applicable(action, operator, state, world) and not applicable(
                action, operator, state.change((fact,), ()), world
            ):
                return Reason(fact, action, segment.target)
            if fact.negation in effects(action, operator, state, world):
                return None
            state = after(action, operator, state, world)
        if fact in segment.goals:
            return Reason(fact, None, segment.target)
        onward = [
            plan.segments[t.target]
            for t in automaton.outgoing(segment.target)
            if t.target in plan.segments
        ]
        if not onward or fact not in onward[0].before:
            return None
        segment, state = onward[0], onward[0].before
        remaining = segment.actions
