"""Who can be commanded, in domains whose operators are anybody's: `?a - agent`, a person or a robot.

A planner given such a domain makes people walk and carry. So the first parameter of an operator,
where it may be a person or a robot, is narrowed to those who can be commanded: the type `robot`, or
what a `; COMMANDED: robot drone` comment names. What people may do in the same way, they bring about
by themselves (their predicates are exogenous).
"""

from __future__ import annotations

from dataclasses import replace

from polaris_nl.model.domain import OBJECT, Domain, Operator, effect_literals
from polaris_nl.model.formula import Variable

ROBOT, PERSON = "robot", "person"


def narrowed(domain: Domain, commanded: tuple[str, ...] = ()) -> Domain:
    """The domain with operators that only those carry out who can be commanded.

    Args:
        domain: as it was read.
        commanded: the types whose entities can be commanded; none for `robot`, where the domain has
            robots and people of one kind.
    """
    if not commanded and {ROBOT, PERSON} <= set(domain.parents):
        commanded = (ROBOT,)
    operators: dict[str, Operator] = {}
    changed: set[str] = set()
    others: dict[str, None] = {}
    for name, operator in domain.operators.items():
        acting = _acting(domain, operator, commanded)
        operators[name] = operator
        if acting:
            first, *rest = operator.parameters
            others.update(dict.fromkeys(_others(domain, first, commanded)))
            parameters = (Variable(first.name, acting), *rest)
            operators[name] = replace(operator, parameters=parameters)
            changed |= {e.predicate for e in effect_literals(operator.effect)}
    if not others:
        return domain
    return replace(
        domain,
        operators=operators,
        exogenous=domain.exogenous | changed,
        commanded=commanded,
        uncommanded=tuple(others),
    )


def _acting(domain: Domain, operator: Operator, commanded: tuple[str, ...]) -> tuple[str, ...]:
    """The types that the first parameter is narrowed to; none where it stays as it is."""
    first = operator.parameters[0] if operator.parameters else None
    if first is None or not first.types:
        return ()
    if OBJECT in first.types and not domain.object_is_a_type:
        return ()
    acting = tuple(c for c in commanded if domain.fits(c, first))
    others = _others(domain, first, commanded)
    people = [kind for kind in others if domain.is_a(kind, PERSON)]
    # Where things fit as well as people, the parameter is no agent.
    return acting if people and people == others else ()


def _others(domain: Domain, first: Variable, commanded: tuple[str, ...]) -> list[str]:
    """The types that fit a parameter and can't be commanded."""
    return [
        kind
        for kind in domain.types
        if domain.fits(kind, first)
        and not any(domain.is_a(kind, c) or domain.is_a(c, kind) for c in commanded)
    ]
