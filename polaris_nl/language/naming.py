"""Names for checkpoints that the user didn't name: short, unique, from the grammar and the first goal."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from polaris_nl.automaton.automaton import Automaton
from polaris_nl.automaton.edits import RenameCheckpoint
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

    def renamed(
        self, program: Automaton, checkpoint: str, goals: Sequence[Goal], when: Sequence[Literal]
    ) -> Iterator[RenameCheckpoint]:
        """The new name of a checkpoint whose goals change; none where the user named it."""
        old = program.checkpoints[checkpoint]
        incoming = program.incoming(checkpoint)
        automatic = self._wanted(old.goals, incoming.when if incoming else ())
        wanted = self._wanted(goals, when)
        numbered = old.name.removeprefix(automatic).strip()
        made = old.name.startswith(automatic) and (not numbered or numbered.isdigit())
        if made and wanted != automatic:
            yield RenameCheckpoint(checkpoint, program.fresh_name(wanted))

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
