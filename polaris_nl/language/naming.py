"""Names for checkpoints that the user didn't name: short, unique, from the grammar and the first goal."""

from __future__ import annotations

from collections.abc import Sequence

from polaris_nl.automaton.automaton import Automaton
from polaris_nl.language.grammar import Grammar
from polaris_nl.model.formula import Goal, Literal, literals_in
from polaris_nl.model.world import World

WAITED = "waited"


class Names:
    """Names checkpoints in one world."""

    def __init__(self, world: World, grammar: Grammar) -> None:
        self._world = world
        self._grammar = grammar

    def checkpoint(self, goals: Sequence[Goal], when: Sequence[Literal], program: Automaton) -> str:
        """A name that no checkpoint of the program has."""
        return program.fresh_name(self._wanted(goals, when))

    def _wanted(self, goals: Sequence[Goal], when: Sequence[Literal]) -> str:
        for condition in when:
            for predicate, name in self._grammar.names:
                if condition.predicate == predicate and condition.positive:
                    return name
        first = next(
            (x for goal in goals for x in literals_in(goal) if x.predicate != "kind"), None
        )
        if first is None:
            return self._waited(when)
        if goals and not isinstance(goals[0], Literal):
            first = list(literals_in(goals[0]))[-1]
        return self._named(first)

    def _waited(self, when: Sequence[Literal]) -> str:
        return self._named(when[0]) if when else WAITED

    def _named(self, literal: Literal) -> str:
        phrases = self._grammar.predicates.get(literal.predicate)
        texts = phrases.texts if phrases else {}
        name = texts.get("name" if literal.positive else "not-name") or literal.predicate.replace(
            "-", " "
        )
        predicate = self._world.domain.predicates[literal.predicate]
        for parameter, arg in zip(predicate.parameters, literal.args, strict=True):
            entity = self._world.entities.get(arg)
            spoken = entity.spoken if entity else "all"
            name = name.replace(f"{{{parameter.name.lstrip('?')}}}", spoken)
        return name if literal.positive or texts.get("not-name") else f"not {name}"
