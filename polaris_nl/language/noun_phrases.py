"""What things are called in what is said back: articles, proper names, and all things of a kind."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

from polaris_nl.language.grammar import Grammar
from polaris_nl.model.domain import KIND
from polaris_nl.model.formula import And, Equal, Formula, Imply, Literal, Not, Quantified, Variable
from polaris_nl.model.text import in_words, listed, names_several, plural_of, with_article
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
        left_out = [
            namer(part.part.right)
            for part in goal.conditions
            if isinstance(part, Not) and isinstance(part.part, Equal)
        ]
        noun, adjectives, place = self._described(goal.variable, goal.conditions, namer, moved)
        everything = noun == OBJECT and not adjectives
        described = " ".join([*adjectives, noun])
        head = "everything" if everything else f"{_quantifier(noun)} {described}"
        but = f" but {listed(left_out)}" if left_out else ""
        return f"{head}{place}{but}"

    def some(self, goal: SomeOf, namer: Namer, moved: bool = False) -> str:
        """Things of which there are to be so many: "a clean bowl from the shelf", "two cups"."""
        noun, adjectives, place = self._described(goal.variable, goal.conditions, namer, moved)
        noun = "thing" if noun == OBJECT else noun
        if goal.count == 1:
            return f"{with_article(' '.join([*adjectives, noun]))}{place}"
        noun = noun if names_several(noun) else plural_of(noun)
        return f"{' '.join([in_words(goal.count), *adjectives, noun])}{place}"

    def _described(
        self, variable: Variable, conditions: Sequence[Formula], namer: Namer, moved: bool
    ) -> tuple[str, list[str], str]:
        """A noun, the adjectives before it and the place after it."""
        noun, place, adjectives = variable.types[0] if variable.types else OBJECT, "", []
        for part in conditions:
            if not isinstance(part, Literal):
                continue
            if part.predicate == KIND:
                noun = part.args[1].replace("-", " ")
            elif len(part.args) == 2:
                link = "from" if moved else _LINKS.get(part.predicate, part.predicate)
                place = f" {link} {namer(part.args[1])}"
            else:
                adjectives.append(self.adjective(part) or str(part))
        return noun, adjectives, place

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


@dataclass(frozen=True, slots=True)
class SomeOf:
    """A goal for so many things of which some conditions hold, in the one form that can be said.

    Attributes:
        variable: stands for one of the things.
        count: how many there are to be, all different.
        conditions: which things; literals about the variable.
        said: what is to hold of each.
    """

    variable: Variable
    count: int
    conditions: tuple[Literal, ...]
    said: Literal


def some_of(goal: Formula) -> SomeOf | None:
    """A goal for some things in parts; None for one that has another form, and for other goals.

    What is to hold of each is what brings it somewhere, or else what is named last.
    """
    if not isinstance(goal, Quantified) or goal.quantifier != "exists":
        return None
    names = [v.name for v in goal.variables]
    of_each: dict[str, list[Literal]] = {name: [] for name in names}
    for part in _parts(goal.body):
        if isinstance(part, Not) and isinstance(part.part, Equal):
            if not {part.part.left, part.part.right} <= set(names):
                return None
            continue
        about = [n for n in names if isinstance(part, Literal) and n in part.args]
        if len(about) != 1 or not isinstance(part, Literal):
            return None
        of_each[about[0]].append(part)
    first, *others = (
        {x.bind({name: names[0]}): None for x in literals} for name, literals in of_each.items()
    )
    sayable = [x for x in first if x.predicate != KIND]
    if not sayable or any(set(other) != set(first) for other in others):
        return None
    moving = [x for x in sayable if x.positive and x.predicate in PLACES]
    said = (moving or sayable)[-1]
    rest = tuple(x for x in first if x != said)
    if any(len(x.args) > 2 for x in rest) or sum(_is_place(x) for x in rest) > 1:
        return None
    return SomeOf(goal.variables[0], len(names), rest, said)


def _is_place(literal: Literal) -> bool:
    return len(literal.args) == 2 and literal.predicate != KIND


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
