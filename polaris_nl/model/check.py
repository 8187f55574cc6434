"""Type checks: does a fact, a goal or an action fit its domain and world?"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from polaris_nl.model.domain import KIND, Action, Domain
from polaris_nl.model.errors import did_you_mean
from polaris_nl.model.formula import (
    And,
    Equal,
    Formula,
    Imply,
    Literal,
    Not,
    Or,
    Quantified,
    Variable,
    When,
)
from polaris_nl.model.text import listed, with_article

Types = Mapping[str, str]
"""Entity name to type name."""


def formula_faults(formula: Formula, domain: Domain, types: Types) -> Iterator[str]:
    """Why a formula doesn't fit, a sentence each; nothing where it fits.

    Args:
        formula: a goal, a conditional or a fact.
        domain: whose predicates it may use.
        types: the entities it may name (and, below a quantifier, variables).
    """
    if isinstance(formula, Literal):
        yield from literal_faults(formula, domain, types)
    elif isinstance(formula, And | Or):
        for part in formula.parts:
            yield from formula_faults(part, domain, types)
    elif isinstance(formula, Not):
        yield from formula_faults(formula.part, domain, types)
    elif isinstance(formula, Imply):
        yield from formula_faults(formula.condition, domain, types)
        yield from formula_faults(formula.conclusion, domain, types)
    elif isinstance(formula, Quantified):
        yield from _quantified_faults(formula, domain, types)
    elif isinstance(formula, Equal):
        for term in (formula.left, formula.right):
            if term not in types:
                yield f"There is nothing called {term}.{did_you_mean(term, types)}"
    elif isinstance(formula, When):
        yield "(when ...) belongs to an operator's effect, not to a goal."


def literal_faults(literal: Literal, domain: Domain, types: Types) -> Iterator[str]:
    """Why a literal doesn't fit, a sentence each; nothing where it fits."""
    if literal.predicate == KIND and len(literal.args) == 2:
        yield from _unknown(literal.args[0], types)
        return
    predicate = domain.predicates.get(literal.predicate)
    if predicate is None:
        hint = did_you_mean(literal.predicate, domain.predicates)
        yield f"The domain {domain.name} has no predicate {literal.predicate}.{hint}"
        return
    yield from _argument_faults(
        str(literal.atom), literal.args, predicate.parameters, domain, types
    )


def action_faults(action: Action, domain: Domain, types: Types) -> Iterator[str]:
    """Why an action doesn't fit, a sentence each; nothing where it fits."""
    operator = domain.operators.get(action.operator)
    if operator is None:
        hint = did_you_mean(action.operator, domain.operators)
        yield f"The domain {domain.name} has no operator {action.operator}.{hint}"
        return
    yield from _argument_faults(str(action), action.args, operator.parameters, domain, types)


def _quantified_faults(formula: Quantified, domain: Domain, types: Types) -> Iterator[str]:
    known = {**types}
    for variable in formula.variables:
        for kind in variable.types:
            if kind != "object" and kind not in domain.parents:
                yield f"The domain {domain.name} has no type {kind}.{did_you_mean(kind, domain.types)}"
        known[variable.name] = variable.types[0] if variable.types else "object"
    yield from formula_faults(formula.body, domain, known)


def _argument_faults(
    text: str, args: tuple[str, ...], parameters: tuple[Variable, ...], domain: Domain, types: Types
) -> Iterator[str]:
    if len(args) != len(parameters):
        wanted = " ".join(map(str, parameters)) or "nothing"
        yield f"{text} has {len(args)} arguments, but takes {len(parameters)}: {wanted}."
        return
    for arg, parameter in zip(args, parameters, strict=True):
        unknown = list(_unknown(arg, types))
        yield from unknown
        if not unknown and not domain.fits(types[arg], parameter):
            wanted = listed([with_article(t) for t in parameter.types], "or")
            yield f"In {text}, {arg} is {with_article(types[arg])}, but {wanted} is needed."


def _unknown(name: str, types: Types) -> Iterator[str]:
    if name not in types:
        yield f"There is nothing called {name}.{did_you_mean(name, types)}"
