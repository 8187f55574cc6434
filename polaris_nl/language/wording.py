"""Words for entities, facts, goals and actions, from a domain's grammar (the `Wording` of the model layer)."""

from __future__ import annotations

from collections.abc import Sequence

from polaris_nl.language.grammar import Grammar
from polaris_nl.language.noun_phrases import MESSAGE, Namer, NounPhrases
from polaris_nl.language.phrasing import Phrasing, joined
from polaris_nl.model.domain import Action
from polaris_nl.model.formula import Formula, Literal
from polaris_nl.model.wording import PlainWording
from polaris_nl.model.world import World


class GrammarWording:
    """The wording of one world by its grammar; plain wording where the grammar says nothing.

    Attributes:
        nouns: what things are called.
        phrasing: clauses, with names for things that the caller may choose.
    """

    def __init__(self, world: World, grammar: Grammar) -> None:
        self.world = world
        self.grammar = grammar
        self.nouns = NounPhrases(world, grammar)
        self.phrasing = Phrasing(world, grammar, self.nouns)
        self._plain = PlainWording(world)

    def entity(self, name: str) -> str:
        """A noun phrase with the article that it takes."""
        return self.nouns.entity(name)

    def option(self, name: str, spoken: str) -> str:
        """An entity as one of several that are offered: "the table", "room 1", "Mr Brown"."""
        entity = self.world.entities.get(name)
        if entity is None or entity.type == MESSAGE:
            return spoken
        return self.nouns.proper(spoken) if self.nouns.is_named(name) else f"the {spoken}"

    def fact(self, literal: Formula) -> str:
        """A clause: "the tray is on the table"."""
        return self.phrasing.fact(literal, self.entity)

    def goal(self, goal: Formula) -> str:
        """An imperative: "bring the tray to the resident's table"."""
        return self.goals((goal,))

    def goals(self, goals: Sequence[Formula], namer: Namer | None = None) -> str:
        """Imperatives in one: "bring the cup and the plate to the sink and open the cupboard"."""
        return joined(self.phrasing.goals(goals, namer or self.entity))

    def event(self, literal: Literal) -> str:
        """A clause for after "once"."""
        return self.events((literal,))

    def events(self, when: Sequence[Literal], namer: Namer | None = None) -> str:
        """Clauses for after "once", in one: "the cup and the plate are on the drying rack"."""
        return joined(self.phrasing.events(when, namer or self.entity))

    def action(self, action: Action) -> str:
        """An imperative: "pick up the tray from the empty trays"."""
        operator = self.world.domain.operators.get(action.operator)
        template = self.grammar.operators.get(action.operator, "")
        if operator is None or not template:
            return self._plain.action(action)
        return self.phrasing.filled(template, operator.parameters, action.args, self.entity)
