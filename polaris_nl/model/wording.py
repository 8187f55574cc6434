"""How entities, facts and actions are put into words: the protocol, and wording without a grammar.

Planning and rendering say things without knowing the language: they are handed a `Wording`. The
language side makes one from a domain's grammar file; `PlainWording` serves domains that have none.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Protocol

from polaris_nl.model.domain import Action
from polaris_nl.model.formula import Formula, Literal
from polaris_nl.model.text import listed
from polaris_nl.model.world import World


class Wording(Protocol):
    """Words for the values of a world. All texts start in lower case and have no full stop."""

    def entity(self, name: str) -> str:
        """A noun phrase: "the blue cup", "the resident's table", "home"."""
        ...

    def fact(self, literal: Formula) -> str:
        """A clause: "the tray is on the table", "the cupboard is not open"."""
        ...

    def goal(self, goal: Formula) -> str:
        """An imperative: "put the tray on the table", "tell the resident that lunch is ready"."""
        ...

    def goals(self, goals: Sequence[Formula]) -> str:
        """Imperatives in one: "put the cup and the plate in the sink"."""
        ...

    def event(self, literal: Literal) -> str:
        """A clause for after "once": "lunch is acknowledged", "the cup is on the rack"."""
        ...

    def events(self, when: Sequence[Literal]) -> str:
        """Clauses for after "once", in one: "the cup and the plate are on the rack"."""
        ...

    def action(self, action: Action) -> str:
        """An imperative: "pick up the tray from the empty trays", "go to the hall"."""
        ...


class PlainWording:
    """Words made from names and from the domain's `; NL:` comments alone."""

    def __init__(self, world: World) -> None:
        self._world = world

    def entity(self, name: str) -> str:
        """The spoken name with "the"."""
        entity = self._world.entities.get(name)
        return f"the {entity.spoken}" if entity else name.replace("-", " ")

    def fact(self, literal: Formula) -> str:
        """The author's phrase, or predicate and arguments in their order."""
        if not isinstance(literal, Literal):
            return str(literal)
        predicate = self._world.domain.predicates.get(literal.predicate)
        text = self._fill(predicate.hint if predicate else "", literal.predicate, literal.args)
        return text if literal.positive else f"it is not so that {text}"

    def goal(self, goal: Formula) -> str:
        """The fact, to be made true."""
        return f"make sure that {self.fact(goal)}"

    def goals(self, goals: Sequence[Formula]) -> str:
        """One after the other."""
        return listed([self.goal(goal) for goal in goals])

    def event(self, literal: Literal) -> str:
        """The same as the fact."""
        return self.fact(literal)

    def events(self, when: Sequence[Literal]) -> str:
        """One after the other."""
        return listed([self.event(literal) for literal in when])

    def action(self, action: Action) -> str:
        """The author's phrase, or operator and arguments in their order."""
        operator = self._world.domain.operators.get(action.operator)
        return self._fill(operator.hint if operator else "", action.operator, action.args)

    def _fill(self, hint: str, name: str, args: Sequence[str]) -> str:
        words = [self.entity(a) for a in args]
        if not hint:
            return " ".join([name.replace("-", " ").replace("_", " "), *words])
        return re.sub(
            r"\[(\d+)\]", lambda m: words[int(m[1])] if int(m[1]) < len(words) else m[0], hint
        )
