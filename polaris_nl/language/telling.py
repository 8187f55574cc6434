"""Steps as sentences: who and what was spoken of, so that "she", "her table" and "it" are clear.

A pronoun is said only where hearers and the parser take it for the same thing: it stands for the one
that was spoken of last.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

from polaris_nl.language.noun_phrases import MESSAGE, PERSON, Namer
from polaris_nl.language.plain_clauses import imperative
from polaris_nl.language.template import Choice, Parts, Slot
from polaris_nl.language.verbs import third_person
from polaris_nl.language.wording import GrammarWording
from polaris_nl.model.domain import Action
from polaris_nl.model.formula import Formula, Literal, literals_in
from polaris_nl.model.text import listed, sentence

MOST_WORDS = 25
"""Words that a sentence is kept to where it can be split."""
NOTHING = "do nothing"
_SUBJECTS = {"female": "she", "male": "he"}
_OBJECTS = {"female": "her", "male": "him"}
_OWNERS = {"female": "her", "male": "his"}
_PASSIVE = re.compile(r"^\{[\w-]+\} is (\w+ed)$")
_THINGS = ("object", "container")


@dataclass(frozen=True, slots=True)
class _Memory:
    """What was spoken of.

    Attributes:
        person: who was spoken of last, or "" where it isn't clear.
        owner: whose thing was spoken of after that, or "".
        message: what was told last.
        since: sentences since the person was spoken of.
    """

    person: str = ""
    owner: str = ""
    message: str = ""
    since: int = 0


@dataclass(frozen=True, slots=True)
class Told:
    """A step to be told.

    Attributes:
        addressees: whom messages were told, for "once she acknowledges it".
    """

    goals: tuple[Formula, ...] = ()
    when: tuple[Literal, ...] = ()
    action: Action | None = None
    addressees: Mapping[str, str] = field(default_factory=dict)


class Teller:
    """Puts steps into sentences, one after the other."""

    def __init__(self, wording: GrammarWording) -> None:
        self._wording = wording
        self._world = wording.world
        self._memory = _Memory()
        self._things: set[str] = set()
        """What was spoken of in the sentence that "it" could mean."""
        self._owners: set[str] = set()
        """Whose things were spoken of in the sentence."""
        self._people: set[str] = set()
        """Whom the parser has heard of so far."""
        self._open = ""
        self._said: list[str] = []

    @property
    def text(self) -> str:
        """All that was told, in sentences."""
        return " ".join(map(sentence, (*self._said, *((self._open,) if self._open else ()))))

    def then(self, step: Told) -> None:
        """What comes right after the step before, in its sentence where that stays short."""
        if not self._open:
            self.sentence("", "then " if self._said else "", step)
            return
        memory, things = self._memory, set(self._things)
        done = self._done(step)
        longer = f"{self._open}, then {done}"
        if len(longer.split()) <= MOST_WORDS:
            self._open = longer
            return
        self._memory, self._things = memory, things
        self.sentence("", "then ", step)

    def sentence(self, lead: str, opening: str, step: Told, alone: bool = False) -> None:
        """A sentence of its own.

        Args:
            lead: names the place that it belongs to: "after alerted, ".
            opening: "then ", "otherwise ", "once ", "if ", "unless " or "wait until "; those that need
                a condition have the step's.
            step: what is done.
            alone: nothing may follow in the same sentence.
        """
        self._close()
        before = self._memory
        said = lead + opening
        if step.when:
            said += self._events(step)
            if not opening.endswith("wait until "):
                said += ", "
        if not opening.endswith("wait until "):
            said += self._done(step)
        self._open = said
        if alone:
            self._close()
        if lead:
            # An edit of a step by its name leaves what "she" and "it" mean to the parser as it was.
            self._memory = replace(before, person="", owner="", message="")

    def _close(self) -> None:
        if self._open:
            self._said.append(self._open)
        self._open, self._things, self._owners = "", set(), set()
        self._memory = replace(self._memory, since=self._memory.since + 1)

    def _done(self, step: Told) -> str:
        if step.action is not None:
            self._things.add("")
            return self._wording.action(step.action)
        if not step.goals:
            return NOTHING
        said = self._wording.goals(step.goals, self._namer(step.goals))
        self._heard(step.goals)
        return said

    def _events(self, step: Told) -> str:
        said: list[str] = []
        rest = list(step.when)
        while rest:
            event = self._answer(rest[0], step) or ""
            if event:
                rest.pop(0)
            else:
                answers = [x for x in rest if self._answering(x, step)]
                others = [x for x in rest if x not in answers]
                event = self._wording.events(others, self._namer(others, subject=True))
                self._heard(others)
                rest = answers
            said.append(event)
        return listed(said)

    # What people answer to a message

    def _answering(self, literal: Literal, step: Told) -> bool:
        return literal.positive and len(literal.args) == 1 and literal.args[0] in step.addressees

    def _answer(self, literal: Literal, step: Told) -> str:
        """`she acknowledges it`: what a message was answered, by the person it was told; "" where unknown."""
        if not self._answering(literal, step):
            return ""
        phrases = self._wording.grammar.predicates.get(literal.predicate)
        passive = _PASSIVE.match(phrases.texts.get("event", "")) if phrases else None
        if phrases is None or passive is None or not _of_persons(phrases.wordings["states"]):
            return ""
        message = literal.args[0]
        person = step.addressees[message]
        self._people.add(person)
        who = self._pronoun(person, _SUBJECTS) or self._wording.entity(person)
        what = "it" if message == self._memory.message else self._wording.entity(message)
        self._memory = _Memory(person, "", message)
        return f"{who} {third_person(imperative(passive[1]))} {what}"

    # Pronouns

    def _namer(self, said: Sequence[Formula], subject: bool = False) -> Namer:
        """Names for the things of a clause, in the order they are asked for, with clear pronouns."""
        literals = [x for formula in said for x in literals_in(formula)]
        persons = {a for x in literals for a in x.args if self._type(a) == PERSON}
        given = [x for x in literals if x.predicate == "has" and (x.positive or subject)]
        # Where the clause itself speaks of other people, a pronoun could stand for one of them.
        clear = persons <= {self._memory.person}

        def name(entity: str) -> str:
            kind = self._type(entity)
            if kind in _THINGS and entity not in self._places(literals):
                # "Give her it" is not said.
                if self._things == {entity} and not given:
                    return "it"
                self._things.add(entity)
            if kind == PERSON and clear and (subject or not self._gets_own(entity, given)):
                pronoun = self._pronoun(entity, _SUBJECTS if subject else _OBJECTS)
                return pronoun or self._wording.entity(entity)
            owner = self._owner(entity)
            if not owner or self._wording.nouns.is_named(entity):
                return self._wording.entity(entity)
            whose = self._pronoun(owner, _OWNERS) if clear else ""
            again = owner in self._owners and not persons and self._only_one(owner)
            if again or (persons == {owner} and given):
                whose = _OWNERS.get(self._world.entities[owner].gender, "")
            self._owners.add(owner)
            if whose:
                return f"{whose} {self._wording.nouns.owned(entity)}"
            return self._wording.entity(entity)

        return name

    def _places(self, literals: Sequence[Literal]) -> set[str]:
        """Containers that are only where something else is, which "it" doesn't mean."""
        at = self._wording.phrasing.thing_of
        return {a for x in literals for n, a in enumerate(x.args) if n != at(x)}

    def _gets_own(self, person: str, given: Sequence[Literal]) -> bool:
        """Whether a person gets what is hers: "give the resident her book", not "give her her book"."""
        return any(self._owner(arg) == person for literal in given for arg in literal.args)

    def _owner(self, entity: str) -> str:
        known = self._world.entities.get(entity)
        return known.owner if known and known.owner in self._world.entities else ""

    def _only_one(self, person: str) -> bool:
        """Whether no other person was spoken of, or known before, whom "her" could mean."""
        gender = self._world.entities[person].gender
        alike = {e.name for e in self._world.of_type(PERSON) if e.gender == gender}
        doubtful = {p for p in self._people if self._world.entities[p].gender in (gender, "")}
        return alike == {person} and doubtful <= {person}

    def _pronoun(self, person: str, forms: Mapping[str, str]) -> str:
        """A pronoun for a person, or "" where it could be missed or mean another."""
        memory = self._memory
        near = memory.since <= 1 and memory.person == person
        clear = near and memory.owner in ("", person)
        entity = self._world.entities.get(person)
        return forms.get(entity.gender, "") if entity and clear else ""

    def _heard(self, said: Sequence[Formula]) -> None:
        """Remembers what a clause spoke of."""
        literals = [x for formula in said for x in literals_in(formula)]
        persons = {a for x in literals for a in x.args if self._type(a) == PERSON}
        self._people |= persons
        if any(not isinstance(formula, Literal) for formula in said):
            self._things.add("")  # All things of a kind were spoken of: "it" could be any of them.
        for arg in (arg for literal in literals for arg in literal.args):
            if self._type(arg) == PERSON:
                person = arg if len(persons) == 1 else ""
                self._memory = replace(self._memory, person=person, owner="", since=0)
            elif self._type(arg) == MESSAGE:
                self._memory = replace(self._memory, message=arg)
            owner = self._owner(arg)
            if owner:
                since = 0 if owner == self._memory.person else self._memory.since
                self._memory = replace(self._memory, owner=owner, since=since)

    def _type(self, name: str) -> str:
        entity = self._world.entities.get(name)
        return entity.type if entity else ""


def _of_persons(templates: Sequence[Parts]) -> bool:
    """Whether a wording says who does it: `{p:person} acknowledges`."""
    return any(_has_person(template) for template in templates)


def _has_person(template: Parts) -> bool:
    for part in template.parts:
        if isinstance(part, Slot) and part.type == PERSON:
            return True
        if isinstance(part, Choice) and any(_has_person(option) for option in part.options):
            return True
    return False
