"""Domains and problems as PDDL text for the planner.

A domain that declares `object` as a type of its own (a thing to grasp) can't be handed to a planner
as it is: there, every entity is an `object`. The type is called `item` on the way to the planner;
names of entities and operators stay as they are. Nor can the planner read `(either ...)` but in the
declaration of a predicate, so it is said there in other words.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator, Sequence

from polaris_nl.model.domain import OBJECT, Domain, Operator
from polaris_nl.model.formula import (
    And,
    Formula,
    Imply,
    Not,
    Or,
    Quantified,
    Variable,
    When,
)
from polaris_nl.model.state import State
from polaris_nl.model.world import World

ITEM = "item"


def planner_type(domain: Domain, kind: str) -> str:
    """What the planner calls a type."""
    return ITEM if kind == OBJECT and domain.object_is_a_type else kind


def domain_text(domain: Domain, written: bool = False) -> str:
    """The domain for the planner.

    Args:
        domain: the domain.
        written: write it from its parts even where its source would do, as it has been added to.
    """
    if domain.source and not written and not _needs_writing(domain):
        return domain.source
    types = " ".join(_type_line(domain, kind) for kind in domain.types)
    predicates = " ".join(
        f"({p.name} {_variables(domain, p.parameters)})" for p in domain.predicates.values()
    )
    operators = "\n".join(_operator(domain, op) for op in domain.operators.values())
    named = " ".join(f"{n} - {planner_type(domain, t)}" for n, t in domain.constants.items())
    constants = f"(:constants {named})\n" if named else ""
    return (
        f"(define (domain {domain.name}) (:requirements :adl)\n(:types {types})\n"
        f"{constants}(:predicates {predicates})\n{operators})"
    )


def _needs_writing(domain: Domain) -> bool:
    """Whether the planner can't have the source: it says more than the parts do, or the planner can't read it.

    Costs need values that worlds don't have; plans are as short as can be instead.
    """
    unions = any(
        len(variable.types) > 1
        for operator in domain.operators.values()
        for variable in (*operator.parameters, *_quantified(operator.precondition),
                         *_quantified(operator.effect))
    )  # fmt: skip
    costs = "(:functions" in domain.source.lower()
    return domain.object_is_a_type or bool(domain.uncommanded) or unions or costs


def _quantified(formula: Formula) -> Iterator[Variable]:
    """The variables of the quantifiers in a formula."""
    if isinstance(formula, And | Or):
        for part in formula.parts:
            yield from _quantified(part)
    elif isinstance(formula, Not):
        yield from _quantified(formula.part)
    elif isinstance(formula, Imply):
        yield from _quantified(formula.condition)
        yield from _quantified(formula.conclusion)
    elif isinstance(formula, When):
        yield from _quantified(formula.condition)
        yield from _quantified(formula.effect)
    elif isinstance(formula, Quantified):
        yield from formula.variables
        yield from _quantified(formula.body)


def problem_text(world: World, state: State, goals: Sequence[Formula]) -> str:
    """The problem of making goals true from a state, entities and facts sorted so that plans don't flicker."""
    domain = world.domain
    names = sorted(n for n in world.entities if n not in domain.constants)
    entities = " ".join(f"{n} - {planner_type(domain, world.entities[n].type)}" for n in names)
    facts = " ".join(map(str, sorted(state.facts)))
    wanted = " ".join(formula_text(domain, goal) for goal in goals)
    return (
        f"(define (problem {world.name}) (:domain {domain.name})\n(:objects {entities})\n"
        f"(:init {facts})\n(:goal (and {wanted})))"
    )


def formula_text(domain: Domain, formula: Formula) -> str:
    """A formula with the planner's names of types."""
    if isinstance(formula, And | Or):
        head = "and" if isinstance(formula, And) else "or"
        return f"({head} {_texts(domain, formula.parts)})"
    if isinstance(formula, Not):
        return f"(not {formula_text(domain, formula.part)})"
    if isinstance(formula, Imply):
        return f"(imply {_texts(domain, (formula.condition, formula.conclusion))})"
    if isinstance(formula, When):
        return f"(when {_texts(domain, (formula.condition, formula.effect))})"
    if isinstance(formula, Quantified):
        return _quantified_text(domain, formula)
    return str(formula)


def _quantified_text(domain: Domain, formula: Quantified) -> str:
    parts = [
        f"({x.quantifier} ({_variables(domain, x.variables)}) {formula_text(domain, x.body)})"
        for x in one_type_each(formula)
    ]
    if len(parts) == 1:
        return parts[0]
    return f"({'and' if formula.quantifier == 'forall' else 'or'} {' '.join(parts)})"


def one_type_each(formula: Quantified) -> list[Quantified]:
    """The same quantifier for each choice of types, where variables are of one of several.

    All of a `forall` are to hold, and one of an `exists`.
    """
    return [
        Quantified(
            formula.quantifier,
            tuple(
                Variable(v.name, (kind,) if kind else ())
                for v, kind in zip(formula.variables, kinds, strict=True)
            ),
            formula.body,
        )
        for kinds in itertools.product(*(v.types or ("",) for v in formula.variables))
    ]


def _texts(domain: Domain, formulas: Iterable[Formula]) -> str:
    return " ".join(formula_text(domain, f) for f in formulas)


def _type_line(domain: Domain, kind: str) -> str:
    parents = [planner_type(domain, p) for p in domain.parents[kind] if p != OBJECT]
    name = planner_type(domain, kind)
    if not parents:
        return f"{name} - {OBJECT}"
    return f"{name} - {parents[0] if len(parents) == 1 else '(either ' + ' '.join(parents) + ')'}"


def _variables(domain: Domain, variables: Sequence[Variable]) -> str:
    # Without a type of its own, a variable would be read with the next one's.
    renamed = (
        Variable(v.name, tuple(planner_type(domain, t) for t in v.types) or (OBJECT,))
        for v in variables
    )
    return " ".join(map(str, renamed))


def _operator(domain: Domain, operator: Operator) -> str:
    plain = [Variable(p.name, p.types if len(p.types) < 2 else ()) for p in operator.parameters]
    kinds = " ".join(_one_of(domain, p) for p in operator.parameters if len(p.types) > 1)
    precondition = formula_text(domain, operator.precondition)
    if kinds:
        precondition = f"(and {kinds} {precondition})"
    return (
        f"(:action {operator.name} :parameters ({_variables(domain, plain)})"
        f" :precondition {precondition} :effect {formula_text(domain, operator.effect)})"
    )


def _one_of(domain: Domain, parameter: Variable) -> str:
    """That a parameter is of one of its types, for a planner that knows no `(either ...)`."""
    same = " ".join(
        f"(exists (?one - {planner_type(domain, kind)}) (= ?one {parameter.name}))"
        for kind in parameter.types
    )
    return f"(or {same})"
