"""The truth of formulas in states, what actions do, and goals without quantifiers."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator, Sequence

from polaris_nl.model.domain import KIND, Action, Operator
from polaris_nl.model.errors import FormatError
from polaris_nl.model.formula import (
    And,
    Equal,
    Formula,
    Goal,
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


def ground_goals(goals: Iterable[Goal], state: State, world: World) -> tuple[Literal, ...]:
    """The literals that goals ask for, quantifiers expanded (DESIGN section 5 point 7).

    A condition inside `for all` is read in the given state: "put every dirty dish on the
    countertop" is about the dishes that are dirty when the robot gets there.

    Raises:
        FormatError: a goal leaves a choice (`exists`, see `choices`) or is none (`or`).
    """
    goals = tuple(goals)
    for goal in goals:
        if leaves_a_choice(goal):
            raise FormatError(f"{goal} leaves a choice; see which of its things are nearest.")
    return next(iter(choices(goals, state, world)), ())


def leaves_a_choice(goal: Goal) -> bool:
    """Whether a goal can be met in several ways, as it says `exists` somewhere."""
    if isinstance(goal, And):
        return any(map(leaves_a_choice, goal.parts))
    if isinstance(goal, Imply):
        return leaves_a_choice(goal.conclusion)
    if isinstance(goal, Quantified):
        return goal.quantifier == "exists" or leaves_a_choice(goal.body)
    return False


def choices(goals: Iterable[Goal], state: State, world: World) -> Iterator[tuple[Literal, ...]]:
    """The sets of literals each of which meets some goals: one, but for goals that say `exists`.

    `(exists (?a ?b - object) (and (kind ?a cup) (kind ?b cup) (not (= ?a ?b)) (at ?a table) (at ?b
    table)))` is how two cups are asked for. What never changes (kinds, equality, facts that neither
    the robot nor people bring about) picks the things there, and isn't asked for.

    Yields:
        Different sets, none of them twice, in the order of the world's file; nothing at all where
        there is nothing to choose from.

    Raises:
        FormatError: a goal is none, such as an `or`.
    """
    seen: set[frozenset[Literal]] = set()
    for parts in itertools.product(*(tuple(_ways(goal, state, world, False)) for goal in goals)):
        way = tuple(dict.fromkeys(itertools.chain.from_iterable(parts)))
        if frozenset(way) not in seen:
            seen.add(frozenset(way))
            yield way


def _ways(goal: Goal, state: State, world: World, chosen: bool) -> Iterator[tuple[Literal, ...]]:
    """The ways to meet one goal; `chosen` inside `exists`, where what never changes is a condition."""
    if chosen and _is_condition(goal, world):
        if holds(goal, state, world):
            yield ()
    elif isinstance(goal, Literal):
        yield (goal,)
    elif isinstance(goal, And):
        yield from _all_of(goal.parts, state, world, chosen)
    elif isinstance(goal, Imply):
        if holds(goal.condition, state, world):
            yield from _ways(goal.conclusion, state, world, chosen)
        else:
            yield ()
    elif isinstance(goal, Quantified) and goal.quantifier == "forall":
        yield from _all_of(tuple(instances_of(goal, world)), state, world, chosen)
    elif isinstance(goal, Quantified):
        for body in _witnesses(goal, world):
            yield from _ways(body, state, world, True)
    else:
        raise FormatError(f"{goal} is no goal: a goal is a fact, or one for all or some of a kind.")


def _all_of(
    parts: Sequence[Goal], state: State, world: World, chosen: bool
) -> Iterator[tuple[Literal, ...]]:
    ways = [tuple(_ways(part, state, world, chosen)) for part in parts]
    for some in itertools.product(*ways):
        yield tuple(itertools.chain.from_iterable(some))


def _is_condition(goal: Goal, world: World) -> bool:
    """Whether nothing can change if a part of a goal holds."""
    if isinstance(goal, Not):
        return _is_condition(goal.part, world)
    if isinstance(goal, Literal):
        domain = world.domain
        changes = domain.robot_can_change(goal.predicate) or domain.people_can_change(
            goal.predicate
        )
        return not changes
    return isinstance(goal, Equal)


def _witnesses(goal: Quantified, world: World) -> Iterator[Formula]:
    """The body for every choice of entities that fit the types and kinds that are asked for."""
    parts = goal.body.parts if isinstance(goal.body, And) else (goal.body,)
    kinds = [p for p in parts if isinstance(p, Literal) and p.predicate == KIND and p.positive]
    names = [v.name for v in goal.variables]
    fitting = []
    for variable in goal.variables:
        asked = [k.args[1] for k in kinds if k.args[0] == variable.name]
        entities = (e.name for e in world.of_type(*variable.types))
        fitting.append([e for e in entities if all(world.is_kind(e, kind) for kind in asked)])
    for values in itertools.product(*fitting):
        yield bind(goal.body, dict(zip(names, values, strict=True)))


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
