"""A world in which one fact can't come about, or not before another one: what a plan is without it.

The order of two facts is compiled into the operators, as trajectory constraints are (Gerevini, Haslum,
Long, Saetti and Dimopoulos, "Deterministic planning in the fifth international planning competition",
Artificial Intelligence 2009), so that an ordinary shortest plan of the changed world is a shortest plan
that keeps the order.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace

from polaris_nl.model.domain import Action, Operator, Predicate, conjuncts, effect_literals
from polaris_nl.model.formula import And, Formula, Literal, Or
from polaris_nl.model.world import World

BARRED, WANTED, DONE = "barred-here", "wanted-here", "done-here"
"""Predicates of the facts that can't come about yet, that come first, and that have come."""
REACHED = Literal(DONE)
"""Holds once the fact that comes first has come about."""
_MARK = "-wanted-here"


def barred(
    world: World, literal: Literal, until: Literal | None = None, ever: bool = True
) -> World | None:
    """The world without every action that makes a fact true, or false where the literal is negative.

    Planning there finds out whether something can be done without the fact, exactly: the two worlds
    have the same actions otherwise.

    Args:
        world: the world.
        literal: what can't come about.
        until: with it, the fact comes about only after this one has, and `REACHED` as a goal asks
            for that; the plan's actions are to be read with `unmarked`.
        ever: with False, the fact doesn't come about after `until` either.

    Returns:
        The world, or None where an operator brings a fact about only on a condition or for all of a
        kind, so that the action can't be told from its other effects, or where the domain derives
        facts.
    """
    domain = world.domain
    if ":derived" in domain.source:
        return None
    operators: dict[str, Operator] = {}
    predicates = {**domain.predicates, BARRED: _like(BARRED, literal, world)}
    facts = {Literal(BARRED, literal.args)}
    try:
        for operator in domain.operators.values():
            held = operators[operator.name] = _held_back(
                operator, literal, until is not None and ever
            )
            if until is not None:
                operators.update((o.name, o) for o in _reaching(held, until))
    except ValueError:
        return None
    if until is not None:
        predicates |= {WANTED: _like(WANTED, until, world), DONE: Predicate(DONE)}
        facts.add(Literal(WANTED, until.args))
    changed = replace(domain, operators=operators, predicates=predicates, source="")
    return replace(world, domain=changed, facts=world.facts | facts)


def unmarked(actions: Iterable[Action]) -> tuple[Action, ...]:
    """The actions of a plan of a changed world as those of the world itself."""
    return tuple(Action(a.operator.removesuffix(_MARK), a.args) for a in actions)


def _like(name: str, literal: Literal, world: World) -> Predicate:
    return Predicate(name, world.domain.predicates[literal.predicate].parameters)


def _held_back(operator: Operator, literal: Literal, for_a_time: bool) -> Operator:
    kept = [operator.precondition]
    for effect in _bringing(operator, literal):
        free: Formula = Literal(BARRED, effect.args, positive=False)
        kept.append(Or((free, REACHED)) if for_a_time else free)
    return operator if len(kept) == 1 else replace(operator, precondition=And(tuple(kept)))


def _reaching(operator: Operator, until: Literal) -> Iterator[Operator]:
    """The operator once more for each effect that may be the fact that comes first."""
    for number, effect in enumerate(_bringing(operator, until)):
        name = f"{operator.name}{_MARK}"
        if number:
            raise ValueError(name)
        wanted = And((operator.precondition, Literal(WANTED, effect.args)))
        done = And((operator.effect, REACHED))
        yield replace(operator, name=name, precondition=wanted, effect=done)


def _bringing(operator: Operator, literal: Literal) -> Iterator[Literal]:
    """The effects that may be a fact, with the operator's own parameters.

    Raises:
        ValueError: one comes about only on a condition or for all of a kind.
    """
    plain = [part for part in conjuncts(operator.effect) if isinstance(part, Literal)]
    names = {p.name for p in operator.parameters}
    for effect in effect_literals(operator.effect):
        if (effect.predicate, effect.positive) == (literal.predicate, literal.positive):
            if effect not in plain or any(
                a.startswith("?") and a not in names for a in effect.args
            ):
                raise ValueError(operator.name)
            yield effect
