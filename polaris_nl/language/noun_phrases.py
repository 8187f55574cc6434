"""What things are called in what is said back: articles, proper names, and all things of a kind."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass

from polaris_nl.language.grammar import Grammar
from polaris_nl.model.domain import KIND
from polaris_nl.model.formula import And, Equal, Formula, Imply, Literal, Not, Quantified, Variable
from polaris_nl.model.text import listed
from polaris_nl.model.world import Entity, World

Namer = Callable[[str], str]
"""The noun phrase for a term: an entity's name, or a variable."""
ROBOT = "robot"
"""The type of what the robot itself is, in domains where it is an entity."""
MESSAGE, PERSON, OBJECT = "message", "person", "object"
PLACES = ("at", "in", "has")
"""Predicates that bring a thing somewhere."""
_BARE = ("home",)
_TITLED = re.compile(r"(mr|mrs|ms|miss|dr)\b")
_MASS = ("ware", "cutlery", "crockery", "laundry")
"""Ends of kinds that have no plural: "all the cutlery"."""
_CLAUSE = re.compile(r" (is|are|has|have) ")
_SOMEBODY = re.compile(r"\b(her|his|my|your)\b")


class NounPhrases:
    """Noun phrases of one world."""

    def __init__(self, world: World, grammar: Grammar) -> None:
        self._world = world
        self._grammar = grammar

    def entity(self, name: str) -> str:
        """A noun phrase with the article that it takes."""
        entity = self._world.entities.get(name)
        if entity is None:
            return name.lstrip("?").replace("-", " ")
        if entity.type == MESSAGE:
            return _topic(entity)
        if self.is_named(name):
            return self.proper(entity.spoken)
        if entity.owner and entity.owner in self._world.entities:
            return f"{possessive(self.entity(entity.owner))} {self.owned(name)}"
        return f"the {entity.spoken}"

    def owned(self, name: str) -> str:
        """What stands behind a possessive: "table" in "the resident's table"."""
        return self._world.entities[name].spoken

    def proper(self, spoken: str) -> str:
        """A proper name as it is written: "Mr Brown"; "room 1" is no name of a person."""
        return spoken.title() if _TITLED.match(spoken) else spoken

    def is_named(self, name: str) -> bool:
        """Whether it is a proper name, which takes no article."""
        entity = self._world.entities.get(name)
        numbered = bool(re.search(r"[-_]\d+$", name))
        robot = entity is not None and entity.type == ROBOT and name != ROBOT
        titled = entity is not None and bool(_TITLED.match(entity.spoken))
        return name in _BARE or titled or numbered or robot

    def told(self, message: str) -> str:
        """A message as what is told: "that lunch is ready", or "of bingo" where it is no clause."""
        entity = self._world.entities.get(message)
        clause = _clause(entity) if entity else None
        return f"that {clause}" if clause else f"of {self.entity(message)}"

    def every(self, goal: AllOf, namer: Namer, moved: bool = False) -> str:
        """What a quantifier runs over: "every dirty dish on the dining table but the red cup".

        Args:
            goal: the quantified goal.
            namer: names for what stands in it.
            moved: the things are to be brought from where they are said to be.
        """
        types = goal.variable.types
        noun, place, adjectives, left_out = types[0] if types else OBJECT, "", [], []
        for part in goal.conditions:
            if isinstance(part, Not) and isinstance(part.part, Equal):
                left_out.append(namer(part.part.right))
            elif isinstance(part, Literal) and part.predicate == KIND:
                noun = part.args[1].replace("-", " ")
            elif isinstance(part, Literal) and len(part.args) == 2:
                link = "from" if moved else _LINKS.get(part.predicate, part.predicate)
                place = f" {link} {namer(part.args[1])}"
            elif isinstance(part, Literal):
                adjectives.append(self.adjective(part) or str(part))
        everything = noun == OBJECT and not adjectives
        described = " ".join([*adjectives, noun])
        head = "everything" if everything else f"{_quantifier(noun)} {described}"
        but = f" but {listed(left_out)}" if left_out else ""
        return f"{head}{place}{but}"

    def adjective(self, literal: Literal) -> str:
        """A word before a noun for a predicate, or ""."""
        phrases = self._grammar.predicates.get(literal.predicate)
        if phrases is None:
            return ""
        words = phrases.adjectives if literal.positive else phrases.not_adjectives
        return words[0] if words else ""


_LINKS = {"at": "on", "in": "in"}


def possessive(noun: str) -> str:
    """A noun phrase as the owner of what follows."""
    return f"{noun}'s"


@dataclass(frozen=True, slots=True)
class AllOf:
    """A goal for all things of which some conditions hold, in the one form that can be said.

    Attributes:
        said: what is to hold of each.
    """

    variable: Variable
    conditions: tuple[Formula, ...]
    said: Literal


def all_of(goal: Formula) -> AllOf | None:
    """A quantified goal in parts; None for one that has another form, and for other goals."""
    if not isinstance(goal, Quantified) or goal.quantifier != "forall" or len(goal.variables) != 1:
        return None
    body = goal.body if isinstance(goal.body, Imply) else Imply(And(()), goal.body)
    parts = tuple(_parts(body.condition))
    plain = all(
        isinstance(p, Literal) or (isinstance(p, Not) and isinstance(p.part, Equal)) for p in parts
    )
    if not plain or not isinstance(body.conclusion, Literal):
        return None
    return AllOf(goal.variables[0], parts, body.conclusion)


def _parts(condition: Formula) -> Iterator[Formula]:
    if isinstance(condition, And):
        for part in condition.parts:
            yield from _parts(part)
    else:
        yield condition


def _quantifier(noun: str) -> str:
    return "all the" if noun.endswith(_MASS) else "every"


def _clause(message: Entity) -> str | None:
    """The name of a message that is a clause: "lunch is ready"; one of nobody in particular first."""
    clauses = [n for n in (message.spoken, *message.synonyms) if _CLAUSE.search(n)]
    return min(clauses, key=lambda n: bool(_SOMEBODY.search(n)), default=None)


def _topic(message: Entity) -> str:
    """A message by what it is about: "lunch" where it says that lunch is ready."""
    clause = _clause(message) or ""
    about = (n for n in message.synonyms if clause.startswith(f"{n} "))
    return next(about, message.spoken)
