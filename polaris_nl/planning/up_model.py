"""Worlds and goals as unified-planning problems, for validating plans and for comparing planners.

Importing unified-planning takes about two seconds: nothing on the way from an edit to its plan
does.
"""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Iterable, Sequence
from typing import Any

from polaris_nl.model.domain import OBJECT, Action
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
from polaris_nl.model.state import State
from polaris_nl.model.world import World
from polaris_nl.planning.pddl_text import one_type_each, planner_type


def up_problem(world: World, state: State, goals: Sequence[Formula]) -> Any:
    """The `unified_planning.model.Problem` of making goals true from a state."""
    return _Builder(world).problem(state, goals)


def is_valid(
    world: World, state: State, goals: Sequence[Formula], actions: Iterable[Action]
) -> bool:
    """Whether actions lead from a state to goals, by unified-planning's `SequentialPlanValidator`."""
    from unified_planning.engines import SequentialPlanValidator, ValidationResultStatus

    problem = up_problem(world, state, goals)
    with SequentialPlanValidator() as validator:
        result = validator.validate(problem, up_plan(problem, actions))
    return bool(result.status == ValidationResultStatus.VALID)


def up_plan(problem: Any, actions: Iterable[Action]) -> Any:
    """Actions as a `SequentialPlan` of a unified-planning problem."""
    from unified_planning.plans import ActionInstance, SequentialPlan

    expressions = problem.environment.expression_manager
    instances = []
    for action in actions:
        objects = [expressions.ObjectExp(problem.object(arg)) for arg in action.args]
        instances.append(ActionInstance(problem.action(_do(action.operator)), tuple(objects)))
    return SequentialPlan(instances, problem.environment)


class _Builder:
    def __init__(self, world: World) -> None:
        import unified_planning.model as model
        from unified_planning.shortcuts import get_environment

        self._world = world
        self._model = model
        # The global one: parts of unified-planning's validator use no other.
        self._environment = get_environment()
        self._em = self._environment.expression_manager
        self._objects: dict[str, Any] = {}
        self._fluents: dict[str, Any] = {}

    def problem(self, state: State, goals: Sequence[Formula]) -> Any:
        world, model = self._world, self._model
        problem = model.Problem(world.name, self._environment, initial_defaults={})
        boolean = self._environment.type_manager.BoolType()
        for predicate in world.domain.predicates.values():
            parameters = OrderedDict((p.name, self._type(p)) for p in predicate.parameters)
            fluent = model.Fluent(_is(predicate.name), boolean, parameters, self._environment)
            self._fluents[predicate.name] = problem.add_fluent(fluent, default_initial_value=False)
        for entity in world.entities.values():
            kind = self._named(planner_type(world.domain, entity.type))
            self._objects[entity.name] = problem.add_object(
                model.Object(entity.name, kind, self._environment)
            )
        for fact in sorted(state.facts):
            problem.set_initial_value(self._expression(fact, {}), True)
        for operator in world.domain.operators.values():
            parameters = OrderedDict((p.name, self._type(p)) for p in operator.parameters)
            action = model.InstantaneousAction(_do(operator.name), parameters, self._environment)
            names = {p.name: action.parameter(p.name) for p in operator.parameters}
            bound = {k: self._em.ParameterExp(v) for k, v in names.items()}
            action.add_precondition(self._expression(operator.precondition, bound))
            for parameter in operator.parameters:
                if len(parameter.types) > 1:
                    action.add_precondition(self._one_of(parameter, bound[parameter.name]))
            self._effects(action, operator.effect, bound, None, ())
            problem.add_action(action)
        for goal in goals:
            problem.add_goal(self._expression(goal, {}))
        return problem

    def _effects(
        self,
        action: Any,
        effect: Formula,
        bound: dict[str, Any],
        condition: Any,
        forall: tuple[Any, ...],
    ) -> None:
        if isinstance(effect, And):
            for part in effect.parts:
                self._effects(action, part, bound, condition, forall)
        elif isinstance(effect, When):
            self._effects(
                action, effect.effect, bound, self._expression(effect.condition, bound), forall
            )
        elif isinstance(effect, Quantified):
            for one in one_type_each(effect):
                variables = [self._variable(v) for v in one.variables]
                inner = {**bound, **{v.name: self._em.VariableExp(v) for v in variables}}
                self._effects(action, one.body, inner, condition, (*forall, *variables))
        elif isinstance(effect, Literal):
            fluent = self._expression(effect.atom, bound)
            holds = True if condition is None else condition
            action.add_effect(fluent, effect.positive, holds, forall=forall)

    def _expression(self, formula: Formula, bound: dict[str, Any]) -> Any:
        em = self._em
        if isinstance(formula, Literal):
            args = tuple(self._term(a, bound) for a in formula.args)
            atom = em.FluentExp(self._fluents[formula.predicate], args)
            return atom if formula.positive else em.Not(atom)
        if isinstance(formula, And):
            return em.And([self._expression(p, bound) for p in formula.parts])
        if isinstance(formula, Or):
            return em.Or([self._expression(p, bound) for p in formula.parts])
        if isinstance(formula, Not):
            return em.Not(self._expression(formula.part, bound))
        if isinstance(formula, Imply):
            condition = self._expression(formula.condition, bound)
            return em.Implies(condition, self._expression(formula.conclusion, bound))
        if isinstance(formula, Quantified):
            parts = [self._quantified(one, bound) for one in one_type_each(formula)]
            return em.And(parts) if formula.quantifier == "forall" else em.Or(parts)
        assert isinstance(formula, Equal)
        return em.Equals(self._term(formula.left, bound), self._term(formula.right, bound))

    def _quantified(self, formula: Quantified, bound: dict[str, Any]) -> Any:
        variables = [self._variable(v) for v in formula.variables]
        inner = {**bound, **{v.name: self._em.VariableExp(v) for v in variables}}
        make = self._em.Forall if formula.quantifier == "forall" else self._em.Exists
        return make(self._expression(formula.body, inner), *variables)

    def _one_of(self, parameter: Variable, term: Any) -> Any:
        """That a term is one of the entities that fit a parameter."""
        fitting = [e.name for e in self._world.of_type(*parameter.types)]
        return self._em.Or([self._em.Equals(term, self._term(name, {})) for name in fitting])

    def _term(self, name: str, bound: dict[str, Any]) -> Any:
        return bound[name] if name in bound else self._em.ObjectExp(self._objects[name])

    def _variable(self, variable: Variable) -> Any:
        return self._model.Variable(variable.name, self._type(variable), self._environment)

    def _type(self, variable: Variable) -> Any:
        """A variable's type; unified-planning has no `(either ...)`, so that is anything there."""
        kind = variable.types[0] if len(variable.types) == 1 else None
        return self._named(OBJECT if kind is None else planner_type(self._world.domain, kind))

    def _named(self, name: str) -> Any:
        """A user type below its parent."""
        declared = self._world.domain.parents.get(name, ())
        parent = declared[0] if declared and declared[0] not in (OBJECT, name) else OBJECT
        above = self._named(parent) if name != OBJECT else None
        return self._environment.type_manager.UserType(f"a {name}", above)


# In PDDL an entity may bear the name of a predicate, such as food-station, and in unified-planning
# it may not. No PDDL name has a space in it, so these never clash.
def _is(predicate: str) -> str:
    return f"is {predicate}"


def _do(operator: str) -> str:
    return f"do {operator}"
