"""What goals ask for in a world: quantifiers expanded, and the ways to meet goals that leave a choice.

`for all` is expanded where a goal is planned for, and so follows the world and the state.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator, Sequence

from polaris_nl.model.domain import KIND
from polaris_nl.model.errors import FormatError
from polaris_nl.model.evaluate import holds, instances_of
from polaris_nl.model.formula import (
    And,
    Equal,
    Formula,
    Goal,
    Imply,
    Literal,
    Not,
    Quantified,
    bind,
)
from polaris_nl.model.state import State
from polaris_nl.model.world import World

MOST_FIRST = 1_000
"""Choices of things that are put in order; more come in the order of the world's file."""


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
        Different sets, none of them twice, first those of which most holds already, then in the order
        of the world's file; nothing at all where there is nothing to choose from. There may be very
        many: they are made one by one.

    Raises:
        FormatError: a goal is none, such as an `or`.
    """
    seen: set[frozenset[Literal]] = set()
    for literals in _all_of(tuple(goals), state, world, False):
        way = tuple(dict.fromkeys(literals))
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
        for body in _witnesses(goal, state, world):
            yield from _ways(body, state, world, True)
    else:
        raise FormatError(f"{goal} is no goal: a goal is a fact, or one for all or some of a kind.")


def _all_of(
    parts: Sequence[Goal], state: State, world: World, chosen: bool
) -> Iterator[tuple[Literal, ...]]:
    """The ways to meet all of some goals, one by one."""
    fixed: list[Literal] = []
    open_parts: list[Goal] = []
    for part in parts:
        if leaves_a_choice(part):
            open_parts.append(part)
            continue
        way = next(_ways(part, state, world, chosen), None)
        if way is None:
            return
        fixed.extend(way)
    # Without recursion, since there may be a choice for each of a thousand things.
    picked: list[tuple[Literal, ...]] = [tuple(fixed)]
    left = [_ways(open_parts[0], state, world, chosen)] if open_parts else []
    if not open_parts:
        yield picked[0]
    while left:
        way = next(left[-1], None)
        if way is None:
            left.pop()
            picked.pop()
        elif len(left) == len(open_parts):
            yield tuple(itertools.chain(*picked, way))
        else:
            picked.append(way)
            left.append(_ways(open_parts[len(left)], state, world, chosen))


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


def _witnesses(goal: Quantified, state: State, world: World) -> Iterator[Formula]:
    """The body for every choice of entities that fit the types and kinds that are asked for.

    What holds already of an entity alone makes it likelier to be chosen, and so it comes first.
    """
    parts = [p for p in _parts(goal.body) if isinstance(p, Literal)]
    names = [v.name for v in goal.variables]
    fitting = []
    for variable in goal.variables:
        own = [p for p in parts if {a for a in p.args if a in names} == {variable.name}]
        kinds = [p for p in own if p.predicate == KIND]
        bound = {e.name: {variable.name: e.name} for e in world.of_type(*variable.types)}
        held = {
            entity: sum(holds(p.bind(binding), state, world) for p in own)
            for entity, binding in bound.items()
            if all(holds(k.bind(binding), state, world) for k in kinds)
        }
        fitting.append(sorted(held, key=held.__getitem__, reverse=True))
    for values in itertools.chain(_diagonal(fitting), itertools.product(*fitting)):
        yield bind(goal.body, dict(zip(names, values, strict=True)))


def _parts(body: Formula) -> tuple[Formula, ...]:
    return body.parts if isinstance(body, And) else (body,)


def _diagonal(fitting: Sequence[Sequence[str]]) -> Iterator[tuple[str, ...]]:
    """Choices of one name from each list, those from the lists' beginnings first."""
    most = max(1, int(MOST_FIRST ** (1 / len(fitting))))
    ranges = (range(min(len(names), most)) for names in fitting)
    for places in sorted(itertools.product(*ranges), key=sum):
        yield tuple(names[at] for names, at in zip(fitting, places, strict=True))
