"""A world in which one fact can't come about: what a plan is without it."""

from __future__ import annotations

from dataclasses import replace

from polaris_nl.model.domain import Domain, Operator, Predicate, conjuncts, effect_literals
from polaris_nl.model.formula import And, Literal
from polaris_nl.model.world import World

BARRED = "barred-here"
"""The predicate of the facts that can't come about; no domain has one of this name."""


def barred(world: World, literal: Literal) -> World | None:
    """The world without every action that makes a fact true, or false where the literal is negative.

    Planning there finds out whether something can be done without the fact, exactly: the two worlds
    have the same actions otherwise.

    Returns:
        The world, or None where an operator brings the fact about only on a condition or for all of
        a kind, so that the action can't be told from its other effects, or where the domain derives facts.
    """
    domain = world.domain
    if ":derived" in domain.source:
        return None
    operators: dict[str, Operator] = {}
    for name, operator in domain.operators.items():
        without = _without(operator, literal)
        if without is None:
            return None
        operators[name] = without
    parameters = domain.predicates[literal.predicate].parameters
    predicates = {**domain.predicates, BARRED: Predicate(BARRED, parameters)}
    changed: Domain = replace(domain, operators=operators, predicates=predicates, source="")
    return replace(world, domain=changed, facts=world.facts | {Literal(BARRED, literal.args)})


def _without(operator: Operator, literal: Literal) -> Operator | None:
    plain = [part for part in conjuncts(operator.effect) if isinstance(part, Literal)]
    names = {p.name for p in operator.parameters}
    kept = [operator.precondition]
    for effect in effect_literals(operator.effect):
        if (effect.predicate, effect.positive) != (literal.predicate, literal.positive):
            continue
        if effect not in plain or any(a.startswith("?") and a not in names for a in effect.args):
            return None
        kept.append(Literal(BARRED, effect.args, positive=False))
    return operator if len(kept) == 1 else replace(operator, precondition=And(tuple(kept)))
