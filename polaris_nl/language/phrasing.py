"""Goals and conditions as clauses: what is alike is said together, and adjectives go to their nouns.

"bring the cup and the plate to the countertop" is two goals, "bring the full tray to the table" two
as well; "nobody is in the office" is one condition a person.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from polaris_nl.language.grammar import Grammar
from polaris_nl.language.noun_phrases import (
    OBJECT,
    PERSON,
    PLACES,
    ROBOT,
    AllOf,
    Namer,
    NounPhrases,
    SomeOf,
    all_of,
    some_of,
)
from polaris_nl.language.predicate_phrases import AGENT, SAID
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
)
from polaris_nl.model.text import listed
from polaris_nl.model.world import World

_ALONE = ("robot-at", "holding")
"""Goals of which one rules the next out: two of them can't be said together."""
_PLURALS = {
    "is": "are",
    "has": "have",
    "doesn't": "don't",
    "does": "do",
}
_VERB = re.compile(rf"^(\{{[\w-]+\}}) ({'|'.join(_PLURALS)})\b")
_SLOT = re.compile(r"\{([\w-]+)(?::(\w+))?\}")
NOBODY = "nobody"


@dataclass(frozen=True, slots=True)
class Group:
    """Literals that are said in one clause.

    Attributes:
        literals: of one predicate and sign, all arguments but one the same.
        at: which argument differs.
        many: what differs stands for several things.
    """

    literals: tuple[Literal, ...]
    at: int = 0
    many: bool = False

    @property
    def first(self) -> Literal:
        """The literal that stands for the others."""
        return self.literals[0]

    @property
    def things(self) -> tuple[str, ...]:
        """What differs, in order."""
        return tuple(x.args[self.at] for x in self.literals) if self.first.args else ()


class Phrasing:
    """Clauses about one world."""

    def __init__(self, world: World, grammar: Grammar, nouns: NounPhrases) -> None:
        self._world = world
        self._grammar = grammar
        self._nouns = nouns

    def goals(self, goals: Sequence[Formula], namer: Namer) -> list[str]:
        """Imperatives; those for all things of a kind come last."""
        adjectives = dict(self._adjectives(goals))

        def with_adjective(name: str) -> str:
            if name not in adjectives:
                return namer(name)
            word = self._nouns.adjective(adjectives[name])
            return re.sub(r"^the ", f"the {word} ", self._nouns.entity(name))

        groups = self._said_together(goals, adjectives)
        others = [g for g in goals if not isinstance(g, Literal)]
        said = [self._imperative(group, with_adjective) for group in groups]
        # "Everything but it" is not said.
        return [*said, *(self._goal(g, self._nouns.entity) for g in others)]

    def in_order(self, goals: Sequence[Formula]) -> tuple[Formula, ...]:
        """Goals in the order in which they are said, which decides what a step is called."""
        adjectives = dict(self._adjectives(goals))
        found: list[Formula] = []
        for group in self._said_together(goals, adjectives):
            found.extend(group.literals)
            found.extend(adjectives[t] for t in group.things if t in adjectives)
        found.extend(g for g in goals if not isinstance(g, Literal))
        return tuple(dict.fromkeys(found))

    def _said_together(
        self, goals: Sequence[Formula], adjectives: Mapping[str, Literal]
    ) -> list[Group]:
        literals = [g for g in goals if isinstance(g, Literal)]
        return self.groups([x for x in literals if x not in adjectives.values()], goal=True)

    def events(self, when: Sequence[Literal], namer: Namer) -> list[str]:
        """Clauses for after "once"."""
        return [self._clause(group, "event", namer) for group in self.groups(when)]

    def fact(self, formula: Formula, namer: Namer) -> str:
        """A clause: "the tray is on the table"."""
        match formula:
            case Literal():
                return self._clause(Group((formula,)), "fact", namer)
            case And(parts):
                return listed([self.fact(part, namer) for part in parts])
            case Or(parts):
                return listed([self.fact(part, namer) for part in parts], "or")
            case Not(part):
                return f"it is not so that {self.fact(part, namer)}"
            case Equal(left, right):
                return f"{namer(left)} is {namer(right)}"
            case Imply(condition, conclusion):
                return f"{self.fact(conclusion, namer)} if {self.fact(condition, namer)}"
            case Quantified():
                return self._all(formula, "fact", namer)
        return str(formula)

    def clause(self, literal: Literal, kind: str, namer: Namer) -> str:
        """One literal by a text of the grammar, "" where it has none of that kind."""
        text = self._text(literal, kind)
        return self.filled(text, self._parameters(literal), literal.args, namer) if text else ""

    def filled(
        self, text: str, parameters: Sequence[Variable], args: Sequence[str], namer: Namer
    ) -> str:
        """A text of the grammar with its slots filled."""
        told = dict(zip((p.name.lstrip("?") for p in parameters), args, strict=True))

        def filler(slot: re.Match[str]) -> str:
            if slot[1] not in told:
                return slot[0]
            if slot[2] == SAID:
                return self._nouns.told(told[slot[1]])
            return self._agent(told[slot[1]]) if slot[2] == AGENT else namer(told[slot[1]])

        said = _SLOT.sub(filler, text).strip()
        said = re.sub(r"\b(go|come|return) to home\b", r"\1 home", said)
        said = re.sub(r"\bin home\b", "at home", said)
        return re.sub(r"\b(up|down|off) it\b", r"it \1", said)

    def groups(self, literals: Sequence[Literal], goal: bool = False) -> list[Group]:
        """Literals that differ in what they are about, put together."""
        found: list[Group] = []
        for literal in literals:
            at = self.thing_of(literal)
            for number, group in enumerate(found):
                if self._fits(group, literal, at, goal):
                    found[number] = Group((*group.literals, literal), at)
                    break
            else:
                found.append(Group((literal,), at))
        return found

    def thing_of(self, literal: Literal) -> int:
        """Which argument a literal is about: the object that a person has, else the first."""
        types = [p.types for p in self._parameters(literal)]
        persons_first = bool(types) and PERSON in types[0]
        return next((n for n, t in enumerate(types) if OBJECT in t and persons_first), 0)

    def _fits(self, group: Group, literal: Literal, at: int, goal: bool) -> bool:
        first = group.first
        if (literal.predicate, literal.positive) != (first.predicate, first.positive):
            return False
        if not literal.args or (goal and literal.predicate in _ALONE):
            return False
        imperative = goal and bool(self._text(literal, "goal"))
        text = self._text(literal, "event") or self._text(literal, "fact")
        if at == 0 and not imperative and not _VERB.match(text):
            return False  # Its verb has no plural that is known.
        others = [n for n in range(len(literal.args)) if n != at]
        return all(literal.args[n] == first.args[n] for n in others)

    def _imperative(self, group: Group, namer: Namer) -> str:
        if self._text(group.first, "goal"):
            return self._clause(group, "goal", namer)
        return f"make sure that {self._clause(group, 'fact', namer)}"

    def _clause(self, group: Group, kind: str, namer: Namer) -> str:
        first, things = group.first, group.things
        text = self._text(first, kind) or self._text(first, "fact")
        if not text:
            return " ".join([first.predicate.replace("-", " "), *map(namer, first.args)])
        if (len(things) > 1 or group.many) and group.at == 0:
            text = _VERB.sub(lambda m: f"{m[1]} {_PLURALS[m[2]]}", text)
        parameters = self._parameters(first)
        nobody = self._nobody(group, kind)
        if nobody:
            text = self._text(first.negation, kind)

        def listing(name: str) -> str:
            if things and name == things[0]:
                return NOBODY if nobody else listed([namer(t) for t in things])
            return namer(name)

        return self.filled(text, parameters, first.args, listing)

    def _nobody(self, group: Group, kind: str) -> bool:
        """Whether something is said of no person at all."""
        if group.first.positive or kind == "goal" or len(group.literals) < 2:
            return False
        if PERSON not in {t for p in self._parameters(group.first)[:1] for t in p.types}:
            return False
        return {e.name for e in self._world.of_type(PERSON)} == set(group.things)

    def _goal(self, goal: Formula, namer: Namer) -> str:
        if isinstance(goal, And):
            return listed(self.goals(goal.parts, namer))
        quantified = all_of(goal) or some_of(goal)
        if quantified is None:
            return f"make sure that {self.fact(goal, namer)}"
        moved = quantified.said.positive and quantified.said.predicate in PLACES
        names = self._quantifier(quantified, namer, moved)
        return self._imperative(_group(quantified), names)

    def _all(self, formula: Quantified, kind: str, namer: Namer) -> str:
        quantified = all_of(formula) or some_of(formula)
        if quantified is not None:
            return self._clause(_group(quantified), kind, self._quantifier(quantified, namer))
        words = {"forall": "every", "exists": "some"}[formula.quantifier]
        names = {v.name: f"{words} {(v.types or ('thing',))[0]}" for v in formula.variables}
        return self.fact(formula.body, lambda name: names.get(name) or namer(name))

    def _quantifier(self, goal: AllOf | SomeOf, namer: Namer, moved: bool = False) -> Namer:
        if isinstance(goal, AllOf):
            said = self._nouns.every(goal, namer, moved)
        else:
            said = self._nouns.some(goal, namer, moved)
        return lambda name: said if name == goal.variable.name else namer(name)

    def _adjectives(self, goals: Sequence[Formula]) -> Iterator[tuple[str, Literal]]:
        """Goals that an adjective in another one says: "full" in "bring the full tray to the table".

        Only where the words mean the same again: an adjective that another thing deserves already
        would pick that thing.
        """
        literals = [g for g in goals if isinstance(g, Literal) and g.positive]
        moved = {x.args[self.thing_of(x)] for x in literals if x.predicate in PLACES}
        for literal in literals:
            if len(literal.args) != 1 or literal.args[0] not in moved:
                continue
            if not self._nouns.adjective(literal) or not self._world.domain.achievers(literal):
                continue
            taken = any(f.predicate == literal.predicate for f in self._world.initial.facts)
            owner = self._world.entities[literal.args[0]].owner
            plain = self._nouns.entity(literal.args[0]).startswith("the ")
            if not taken and not owner and plain:
                yield literal.args[0], literal

    def _text(self, literal: Literal, kind: str) -> str:
        phrases = self._grammar.predicates.get(literal.predicate)
        if phrases is None:
            return ""
        texts: Mapping[str, str] = phrases.texts
        key = kind if literal.positive else f"not-{kind}"
        return texts.get(key) or (texts.get("not-fact", "") if key == "not-event" else "")

    def _parameters(self, literal: Literal) -> Sequence[Variable]:
        predicate = self._world.domain.predicates.get(literal.predicate)
        return predicate.parameters if predicate else ()

    def _agent(self, name: str) -> str:
        """Who acts: nothing where it is the only robot, who says "I"; "have ann" otherwise."""
        entity = self._world.entities.get(name)
        robots = [e for e in self._world.entities.values() if e.type == ROBOT]
        alone = entity in robots and len(robots) == 1
        return "" if alone else f"have {self._nouns.entity(name)}"


def _group(goal: AllOf | SomeOf) -> Group:
    at = goal.said.args.index(goal.variable.name) if goal.variable.name in goal.said.args else 0
    return Group((goal.said,), at, isinstance(goal, SomeOf) and goal.count > 1)


def joined(clauses: Sequence[str]) -> str:
    """Clauses in one: with a comma where one of them has a list of its own."""
    if len(clauses) > 1 and any(" and " in clause for clause in clauses):
        return f"{', '.join(clauses[:-1])}, and {clauses[-1]}"
    return listed(clauses)
