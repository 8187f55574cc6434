"""What an action needs that only people change behind the robot's back, and what is seen instead."""

from __future__ import annotations

from collections.abc import Sequence

from polaris_nl.execution.backend import Observation
from polaris_nl.model.domain import Action, Operator, conjuncts
from polaris_nl.model.evaluate import after, effects
from polaris_nl.model.formula import Literal, bind
from polaris_nl.model.world import World
from polaris_nl.planning.result import Segment

PLACES = ("at", "in", "has")
"""Where objects are: if that is not as planned, somebody has moved one."""
SEEN_AS = (*PLACES, "holding")


def needed_places(action: Action, operator: Operator) -> tuple[Literal, ...]:
    """The places of objects that an action's precondition asks for."""
    return tuple(x for x in needed(action, operator) if x.predicate in PLACES)


def needed(action: Action, operator: Operator) -> tuple[Literal, ...]:
    """The facts that an action's precondition asks for."""
    bound = bind(operator.precondition, operator.binding(action))
    parts = (part for part in conjuncts(bound) if isinstance(part, Literal))
    return tuple(part for part in parts if part.positive)


def kept_goals(segment: Segment, world: World) -> tuple[Literal, ...]:
    """The segment's goals that held before, so that no action brings them about; they are to hold still.

    The others were perceived when their actions were done, and may have served since: a dish may be
    washed before the next one is brought.
    """
    brought: set[Literal] = set()
    state = segment.before
    for action in segment.actions:
        operator = world.domain.operators[action.operator]
        brought.update(effects(action, operator, state, world))
        state = after(action, operator, state, world)
    return tuple(x for x in segment.goals if x not in brought)


def perceived_instead(expected: Sequence[Literal], observation: Observation) -> tuple[Literal, ...]:
    """The facts perceived about the things of which something else was expected."""
    found: dict[Literal, None] = {}
    for literal in expected:
        thing = (
            literal.args[-1]
            if literal.predicate == "has"
            else (literal.args[0] if literal.args else "")
        )
        if not literal.positive and observation.holds(literal.atom):
            found[literal.atom] = None
        for fact in sorted(observation.certain):
            about = (
                fact.args[-1] if fact.predicate == "has" else (fact.args[0] if fact.args else "")
            )
            if thing and about == thing and _comparable(literal, fact):
                found[fact] = None
    return tuple(found)


def _comparable(expected: Literal, fact: Literal) -> bool:
    if expected.predicate in SEEN_AS:
        return fact.predicate in SEEN_AS
    return fact.predicate == expected.predicate
