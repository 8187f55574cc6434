"""Domains and problems as PDDL text for the planner.

A domain that declares `object` as a type of its own (a thing to grasp) can't be handed to a planner
as it is: there, every entity is an `object`. The type is called `item` on the way to the planner;
    names of entities and operators stay as they are.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

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
    as_it_is = not domain.object_is_a_type and not domain.uncommanded
    if domain.source and as_it_is and not written:
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
        variables = _variables(domain, formula.variables)
        return f"({formula.quantifier} ({variables}) {formula_text(domain, formula.body)})"
    return str(formula)


def _texts(domain: Domain, formulas: Iterable[Formula]) -> str:
    return " ".join(formula_text(domain, f) for f in formulas)


def _type_line(domain: Domain, kind: str) -> str:
    parents = [planner_type(domain, p) for p in domain.parents[kind] if p != OBJECT]
    name = planner_type(domain, kind)
    if not parents:
        return f"{name} - {OBJECT}"
    return f"{name} - {parents[0] if len(parents) == 1 else '(either ' + ' '.join(parents) + ')'}"


def _variables(domain: Domain, variables: Sequence[Variable]) -> str:
    renamed = (Variable(v.name, tuple(planner_type(domain, t) for t in v.types)) for v in variables)
    return " ".join(map(str, renamed))


def _operator(domain: Domain, operator: Operator) -> str:
    return (
        f"(:action {operator.name} :parameters ({_variables(domain, operator.parameters)})"
        f" :precondition {formula_text(domain, operator.precondition)}"
        f" :effect {formula_text(domain, operator.effect)})"
    )
