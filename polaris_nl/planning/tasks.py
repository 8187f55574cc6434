"""Translated tasks that are used again: one translation for all states and goals of the same entities.

Translating takes longer than searching, and within a program only the state and the goals of a task
change. So a task is translated once, from the state at the start and without goals, and then aimed:
its initial values and goal values are replaced. That is right as long as all facts of the new state
that matter are values of the translated task, or were true all along: what can be reached from such
a state could be reached from the start, as the translator sees it, who lets nothing become false. Where
that doesn't hold, the task is translated for itself.

What a segment's task is translated from depends on the entities and on what never changes, and not on
what was planned before, so plans don't depend on it either.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence

from polaris_nl.model.domain import Domain
from polaris_nl.model.errors import PlanningError
from polaris_nl.model.formula import (
    And,
    Formula,
    Imply,
    Literal,
    Not,
    Or,
    Quantified,
    When,
    literals_in,
)
from polaris_nl.model.state import State
from polaris_nl.model.world import World
from polaris_nl.planning.aiming import Shared
from polaris_nl.planning.budget import never
from polaris_nl.planning.costs import Extra
from polaris_nl.planning.grounding import Cancelled
from polaris_nl.planning.memory import Memory
from polaris_nl.planning.pddl_text import domain_text, problem_text
from polaris_nl.planning.translate import (
    Sas,
    Task,
    translate,
    translate_without_goals,
)

MOST_TEXT = 30_000_000
"""Characters of translated tasks that are remembered."""
AGAIN_S = 60.0
"""When a translation that failed is tried again."""
MOST_DENIED = 6
"""Negative goals of a task of its own: the translator counts all combinations of what may hold instead."""


class Tasks:
    """The planner's tasks in one world.

    Args:
        world: the whole world; the state at its start is what shared translations start from.
        extra: what actions cost, where they don't all cost the same. A task that has to be translated
            for itself passes it over.
    """

    def __init__(self, world: World, extra: Extra | None = None) -> None:
        self._extra = extra or {}
        self._initial = world.initial
        self._domain = domain_text(world.domain)
        self._asked = _asked_for(world.domain)
        self._static = frozenset(
            p for p in world.domain.predicates if not world.domain.robot_can_change(p)
        )
        self._failed: dict[object, tuple[float, str]] = {}
        self._shared: Memory[object, Shared] = Memory(MOST_TEXT, lambda key, value: value.size)

    def of(
        self,
        world: World,
        state: State,
        goals: Sequence[Formula],
        cancelled: Callable[[], bool] = never,
    ) -> Task:
        """The task of making goals true from a state.

        Args:
            world: the entities that matter.
            state: the facts about them.
            goals: closed formulas.
            cancelled: asked now and then; True ends the work.

        Raises:
            PlanningError: the planner can't use the domain, or it takes too long to translate.
            Cancelled: `cancelled` said so.
        """
        literals = [g for g in goals if isinstance(g, Literal)]
        if len(literals) == len(goals):
            aimed = self._of_shared(world, state, cancelled).aim(state, literals)
            if aimed is not None:
                return aimed
        if sum(not g.positive for g in literals) > MOST_DENIED:
            raise PlanningError(
                "That is too much at once that is not to be so; split the step in several."
            )
        return translate(self._domain, problem_text(world, state, goals), cancelled)

    def _of_shared(self, world: World, state: State, cancelled: Callable[[], bool]) -> Shared:
        static = frozenset(
            f for f in state.facts if f.predicate in self._static and f.predicate in self._asked
        )
        key = (frozenset(world.entities), static)
        shared = self._shared.get(key)
        if shared is None:
            start = {
                f
                for f in self._initial.facts
                if f.predicate not in self._static and world.entities.keys() >= set(f.args)
            }
            facts = static | start
            text = problem_text(world, State(facts), ())
            sas = self._translated(key, text, cancelled)
            shared = Shared(sas, facts, self._asked, self._extra)
            self._shared.put(key, shared)
        return shared

    def _translated(self, key: object, problem: str, cancelled: Callable[[], bool]) -> Sas | None:
        """A translation; what took too long isn't tried again for a while, so that edits are answered."""
        again, reason = self._failed.get(key, (0.0, ""))
        if time.monotonic() < again:
            raise PlanningError(reason)
        try:
            return translate_without_goals(self._domain, problem, cancelled)
        except Cancelled:
            raise
        except PlanningError as error:
            self._failed = {key: (time.monotonic() + AGAIN_S, str(error))}
            raise


def _asked_for(domain: Domain) -> frozenset[str]:
    """The predicates of preconditions and of effects' conditions."""
    found: set[str] = set()
    for operator in domain.operators.values():
        found.update(x.predicate for x in literals_in(operator.precondition))
        waiting = [operator.effect]
        while waiting:
            formula = waiting.pop()
            if isinstance(formula, When):
                found.update(x.predicate for x in literals_in(formula.condition))
                waiting.append(formula.effect)
            elif isinstance(formula, And | Or):
                waiting.extend(formula.parts)
            elif isinstance(formula, Quantified):
                waiting.append(formula.body)
            elif isinstance(formula, Not | Imply):
                found.update(x.predicate for x in literals_in(formula))
    return frozenset(found)
