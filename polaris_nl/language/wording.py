"""Words for entities, facts, goals and actions, from a domain's grammar (the `Wording` of the model layer)."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

from polaris_nl.language.grammar import Grammar
from polaris_nl.model.domain import Action
from polaris_nl.model.formula import And, Formula, Imply, Literal, Quantified, Variable
from polaris_nl.model.text import listed
from polaris_nl.model.wording import PlainWording
from polaris_nl.model.world import World

_BARE = ("home",)


class GrammarWording:
    """The wording of one world by its grammar; plain wording where the grammar says nothing."""

    def __init__(self, world: World, grammar: Grammar) -> None:
        self._world = world
        self._grammar = grammar
        self._plain = PlainWording(world)

    def entity(self, name: str) -> str:
        """A noun phrase with the article that it takes."""
        entity = self._world.entities.get(name)
        if entity is None:
            return name.lstrip("?").replace("-", " ")
        if name in _BARE or self._is_named(name):
            return entity.spoken
        if entity.type == "message":
            return entity.spoken
        if entity.owner and entity.owner in self._world.entities:
            owner = self.entity(entity.owner)
            return f"{owner}'s {entity.spoken}"
        return f"the {entity.spoken}"

    def option(self, name: str, spoken: str) -> str:
        """An entity as one of several that are offered: "the table", "room 1", "mr brown"."""
        entity = self._world.entities.get(name)
        bare = entity is None or name in _BARE or entity.type == "message" or self._is_named(name)
        return spoken if bare else f"the {spoken}"

    def fact(self, literal: Formula) -> str:
        """A clause: "the tray is on the table"."""
        if isinstance(literal, Literal):
            return self._filled(literal, "fact") or self._plain.fact(literal)
        every = _every(literal)
        if every is None:
            return (
                listed([self.fact(p) for p in literal.parts])
                if isinstance(literal, And)
                else str(literal)
            )
        condition, conclusion, variable = every
        return (
            self.fact(conclusion)
            .replace("the x", self._all(condition, variable))
            .replace(" is ", " are ")
        )

    def goal(self, goal: Formula) -> str:
        """An imperative: "bring the tray to the resident's table"."""
        if isinstance(goal, Literal):
            return self._filled(goal, "goal") or f"make sure that {self.fact(goal)}"
        every = _every(goal)
        if every is None:
            return (
                listed([self.goal(p) for p in goal.parts]) if isinstance(goal, And) else str(goal)
            )
        condition, conclusion, variable = every
        return self.goal(conclusion).replace("the x", self._all(condition, variable))

    def event(self, literal: Literal) -> str:
        """A clause for after "once"."""
        return self._filled(literal, "event") or self.fact(literal)

    def action(self, action: Action) -> str:
        """An imperative: "pick up the tray from the empty trays"."""
        operator = self._world.domain.operators.get(action.operator)
        template = self._grammar.operators.get(action.operator, "")
        if operator is None or not template:
            return self._plain.action(action)
        return self._fill(template, operator.parameters, action.args)

    def _filled(self, literal: Literal, kind: str) -> str:
        phrases = self._grammar.predicates.get(literal.predicate)
        predicate = self._world.domain.predicates.get(literal.predicate)
        if phrases is None or predicate is None:
            return ""
        key = kind if literal.positive else f"not-{kind}"
        template = phrases.texts.get(key, "")
        if not template and key == "not-event":
            template = phrases.texts.get("not-fact", "")
        if not template:
            return ""
        return self._fill(template, predicate.parameters, literal.args)

    def _fill(self, template: str, parameters: Sequence[Variable], args: Sequence[str]) -> str:
        names: Mapping[str, str] = {
            p.name.lstrip("?"): ("the x" if a.startswith("?") else self.entity(a))
            for p, a in zip(parameters, args, strict=True)
        }
        told = dict(zip((p.name.lstrip("?") for p in parameters), args, strict=True))

        def filler(slot: re.Match[str]) -> str:
            if slot[2] == "said":
                return self._said(told.get(slot[1], ""))
            return names.get(slot[1], slot[0])

        text = re.sub(r"\{(\w+)(?::(\w+))?\}", filler, template)
        return re.sub(r"\b(go|come|return) to home\b", r"\1 home", text)

    def _said(self, message: str) -> str:
        """A message as what is told: "that lunch is ready", or "of bingo" where it is no clause."""
        entity = self._world.entities.get(message)
        names = (entity.spoken, *entity.synonyms) if entity else ()
        clause = next((n for n in names if re.search(r" (is|are|has|have) ", n)), None)
        return f"that {clause}" if clause else f"of {self.entity(message)}"

    def _all(self, condition: Formula, variable: str) -> str:
        """What a quantifier runs over: "every dirty dish on the dining table"."""
        noun, before, after = variable, "", ""
        for part in condition.parts if isinstance(condition, And) else (condition,):
            if not isinstance(part, Literal):
                continue
            if part.predicate == "kind":
                noun = part.args[1].replace("-", " ")
            elif len(part.args) == 2:
                link = {"at": "on", "in": "in"}.get(part.predicate, part.predicate)
                after = f" {link} {self.entity(part.args[1])}"
            else:
                before = f"{self._adjective(part)} {before}".strip() + " "
        return f"every {before}{noun}{after}"

    def _adjective(self, literal: Literal) -> str:
        phrases = self._grammar.predicates.get(literal.predicate)
        if phrases is None:
            return ""
        words = phrases.adjectives if literal.positive else phrases.not_adjectives
        return words[0] if words else literal.predicate

    def _is_named(self, name: str) -> bool:
        """Proper names take no article."""
        numbered = bool(re.search(r"-\d+$", name))
        titled = bool(re.match(r"(mr|mrs|ms|miss|dr)\b", name))
        return titled or numbered


def _every(goal: Formula) -> tuple[Formula, Formula, str] | None:
    """Condition, conclusion and type of a `forall` with an `imply`."""
    if (
        isinstance(goal, Quantified)
        and goal.quantifier == "forall"
        and isinstance(goal.body, Imply)
    ):
        types = goal.variables[0].types
        return goal.body.condition, goal.body.conclusion, types[0] if types else "thing"
    return None
