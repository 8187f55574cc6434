"""The truth of formulas in states, and what actions do."""

from __future__ import annotations

import itertools
from collections.abc import Iterator

from polaris_nl.model.domain import Action, Operator
from polaris_nl.model.errors import FormatError
from polaris_nl.model.formula import (
    And,
    Equal,
    Formula,
    Imply,
    Literal,
    Not,
    Or,
    Quantified,
    When,
    bind,
)
from polaris_nl.model.state import State
from polaris_nl.model.world import World


def holds(formula: Formula, state: State, world: World) -> bool:
    """Whether a closed formula is true in a state (closed world, quantifiers over the world's entities)."""
    if isinstance(formula, Literal):
        return world.holds(formula.atom, state) is formula.positive
    if isinstance(formula, And):
        return all(holds(part, state, world) for part in formula.parts)
    if isinstance(formula, Or):
        return any(holds(part, state, world) for part in formula.parts)
    if isinstance(formula, Not):
        return not holds(formula.part, state, world)
    if isinstance(formula, Imply):
        return not holds(formula.condition, state, world) or holds(formula.conclusion, state, world)
    if isinstance(formula, Quantified):
        instances = (holds(body, state, world) for body in instances_of(formula, world))
        return all(instances) if formula.quantifier == "forall" else any(instances)
    if isinstance(formula, Equal):
        return formula.left == formula.right
    raise FormatError(f"{formula} has no truth value.")


def instances_of(formula: Quantified, world: World) -> Iterator[Formula]:
    """The body for every choice of entities that fits the variables' types, in file order."""
    choices = [[e.name for e in world.of_type(*v.types)] for v in formula.variables]
    names = [v.name for v in formula.variables]
    for values in itertools.product(*choices):
        yield bind(formula.body, dict(zip(names, values, strict=True)))


def applicable(action: Action, operator: Operator, state: State, world: World) -> bool:
    """Whether an action's precondition holds in a state."""
    return holds(bind(operator.precondition, operator.binding(action)), state, world)


def effects(action: Action, operator: Operator, state: State, world: World) -> tuple[Literal, ...]:
    """What an action makes true, started in a state: negative literals first, as PDDL applies them."""
    found = tuple(
        dict.fromkeys(_effects(bind(operator.effect, operator.binding(action)), state, world))
    )
    added = tuple(e for e in found if e.positive)
    return (*(e for e in found if not e.positive and e.atom not in added), *added)


def _effects(effect: Formula, state: State, world: World) -> Iterator[Literal]:
    if isinstance(effect, Literal):
        yield effect
    elif isinstance(effect, And):
        for part in effect.parts:
            yield from _effects(part, state, world)
    elif isinstance(effect, When):
        if holds(effect.condition, state, world):
            yield from _effects(effect.effect, state, world)
    elif isinstance(effect, Quantified):
        for body in instances_of(effect, world):
            yield from _effects(body, state, world)


def after(action: Action, operator: Operator, state: State, world: World) -> State:
    """The state that an action leads to."""
    made = effects(action, operator, state, world)
    return state.change((e.atom for e in made if not e.positive), (e for e in made if e.positive))
