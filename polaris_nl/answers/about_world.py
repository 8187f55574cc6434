"""Answers to questions about the world: where things are, what is where, who and what there is.

They come from the world's facts at the start.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from polaris_nl.language.interpretation import Query
from polaris_nl.model.evaluate import holds
from polaris_nl.model.formula import Literal
from polaris_nl.model.text import in_words, listed, names_several, plural_of, sentence
from polaris_nl.model.wording import Wording
from polaris_nl.model.world import Entity, World

MOST_NAMED = 8
"""Things that are named one by one; of more, the first are named."""
_PLACES = ("at", "in", "holding", "has", "person-in", "located", "robot-at")
_KINDS = {
    "region": ("room", "rooms"), "surface": ("surface", "surfaces"), "container": ("container", "containers"),
    "object": ("thing to carry", "things to carry"), "person": ("person", "people"),
    "message": ("message", "messages"),
}  # fmt: skip


@dataclass(frozen=True)
class AboutWorld:
    """Answers from a world's facts at the start."""

    world: World
    wording: Wording

    def answer(self, query: Query) -> str:
        """The answer, or "" where the question is about something else."""
        names = query.entities or ((query.entity,) if query.entity else ())
        match query.kind:
            case "where" if names:
                return " ".join(map(self._where, names[:MOST_NAMED]))
            case "where-robot":
                return self._where_robot()
            case "is-it" if query.literal is not None:
                return self._is_it(query.literals or (query.literal,))
            case "which" | "any" if query.literals:
                return self._which(query)
            case "contents" if names:
                return " ".join(map(self._contents, names))
            case "inside" if names:
                return self._inside(names, query.entity)
            case "any-inside":
                return self._any_inside(names, query)
            case "list":
                return self._list(names, query)
            case "checkpoint" if names and query.checkpoint:
                return self._meaning(names[0])
            case "meaning" if names:
                return " ".join(map(self._meaning, names[:4]))
            case "owner" if names:
                return " ".join(map(self._owner, names[:4]))
            case "world":
                return self._world()
        return ""

    # Places

    def _where(self, name: str) -> str:
        entity = self.world.entities[name]
        if entity.type == "region":
            return self._where_room(name)
        if entity.type == "message":
            return sentence(f"{self.wording.entity(name)} is something to tell, so it is nowhere")
        fact = self._place(name)
        if fact is None:
            return sentence(f"I don't know where {self.wording.entity(name)} {_is(entity)}")
        said = self._fact(fact)
        region = self.world.place_of(name, self.world.initial)
        if region is None or region in fact.args:
            return sentence(said)
        return sentence(f"{said}, in {self.wording.entity(region)}")

    def _place(self, name: str) -> Literal | None:
        facts = [
            f
            for f in self.world.facts
            if f.predicate in _PLACES and name in f.args and _tells_place(f, name)
        ]
        return min(facts, key=lambda f: (_PLACES.index(f.predicate), f), default=None)

    def _where_room(self, name: str) -> str:
        doors = [
            f.args[1] for f in self.world.facts if f.predicate == "connected" and f.args[0] == name
        ]
        said = self.wording.entity(name)
        if not doors:
            return sentence(f"I don't know the way to {said}")
        order = [n for n in self.world.entities if n in doors]
        return sentence(f"{said} is next to {self._named(order)}")

    def _where_robot(self) -> str:
        fact = next((f for f in self.world.facts if f.predicate == "robot-at"), None)
        return sentence(f"I'm {self._at(fact.args[0])}") if fact else "I don't know where I am."

    def _at(self, region: str) -> str:
        said = self.wording.entity(region)
        return f"at {said}" if said == "home" else f"in {said}"

    def _contents(self, name: str) -> str:
        """What is on a surface, in a container, in a room or in someone's hands."""
        entity, said = self.world.entities[name], self.wording.entity(name)
        facts = self.world.facts
        if entity.type == "person":
            held = self._in_order(
                f.args[1] for f in facts if f.predicate == "has" and f.args[0] == name
            )
            return sentence(f"{said} has {self._named(held) or 'nothing that I know of'}")
        if entity.type == "region":
            return self._room(name)
        link = "in" if entity.type == "container" else "on"
        inside = self._in_order(
            f.args[0] for f in facts if f.predicate in ("in", "at") and f.args[1:] == (name,)
        )
        if not inside:
            return sentence(f"nothing is {link} {said}, as far as I know")
        return sentence(f"{self._named(inside)} {_are(self.world, inside)} {link} {said}")

    def _room(self, name: str) -> str:
        there = [
            n
            for n, e in self.world.entities.items()
            if e.type != "region" and self.world.place_of(n, self.world.initial) == name
        ]
        said = self._at(name)
        furniture = [n for n in there if self.world.entities[n].type in ("surface", "container")]
        others = [n for n in there if n not in furniture]
        robot = ["I"] if Literal("robot-at", (name,)) in self.world.facts else []
        if not there:
            return sentence(
                f"nothing is {said} but me" if robot else f"nothing is {said}, as far as I know"
            )
        first = (
            sentence(f"{self._named(furniture)} {_are(self.world, furniture)} {said}")
            if furniture
            else ""
        )
        if not others:
            return first
        so = (
            f"{self._named(others)} {_are(self.world, others)} {'there too' if furniture else said}"
        )
        return f"{first} {sentence(so)}".strip()

    # Facts

    def _is_it(self, literals: Sequence[Literal]) -> str:
        initial = self.world.initial
        true = [x for x in literals if holds(x, initial, self.world)]
        false = [x.negation for x in literals if x not in true]
        if not true and len(literals) == 1:
            return self._no(literals[0])
        if not false or not true:
            return sentence(f"{'yes' if true else 'no'}, {listed(self._together(true or false))}")
        return sentence(f"not all of them: {', '.join(self._together([*true, *false]))}")

    def _no(self, literal: Literal) -> str:
        """A no, with how it is instead, where that is known."""
        elsewhere = (
            literal.positive and literal.predicate in _PLACES and literal.predicate != "located"
        )
        thing = ""
        if elsewhere and literal.predicate in ("at", "in", "has", "person-in"):
            thing = literal.args[1] if literal.predicate == "has" else literal.args[0]
        if thing and self._place(thing) is not None:
            there = self._where(thing)
            return f"No, {_lower(there)}"
        if elsewhere and literal.predicate == "robot-at":
            return f"No, {self._where_robot()}"
        return sentence(f"no, {self._fact(literal.negation)}")

    def _which(self, query: Query) -> str:
        true = [x for x in query.literals if holds(x, self.world.initial, self.world)]
        facts = self._together(true)
        yes = "yes, " if query.kind == "any" else ""
        if query.counted:
            number = in_words(len(true))
            return sentence(f"{number}: {listed(facts)}") if true else self._none(query)
        return sentence(f"{yes}{listed(facts)}") if true else self._none(query)

    def _none(self, query: Query) -> str:
        """That there is nothing of what was asked for: "nothing is on the desk"."""
        literal = query.literals[0]
        varied = [n for n in literal.args if any(n not in x.args for x in query.literals)]
        thing = varied[0] if varied else literal.args[0]
        entity = self.world.entities[thing]
        pronoun = "nobody" if entity.type == "person" else "nothing"
        if query.noun not in ("someone", "something", "people"):
            pronoun = "none of them" if len(query.literals) > 1 else self.wording.entity(thing)
        if pronoun not in ("nobody", "nothing", "none of them"):
            return self._no(literal)
        said = self._fact(literal).replace(self.wording.entity(thing), pronoun, 1)
        no = "no, " if query.kind == "any" else ""
        return sentence(f"{no}{said}, as far as I know")

    def _together(self, literals: Sequence[Literal]) -> list[str]:
        """Facts in words, with what is said of several things said once: "the cup and the plate are dirty"."""
        groups: dict[tuple[str, str], list[str]] = {}
        for literal in literals:
            said = self._fact(literal)
            before, after, thing = self._split(literal, said)
            groups.setdefault((before, after), []).append(thing)
        found = []
        for (before, after), things in groups.items():
            rest = _plural(after) if len(things) > 1 and not before else after
            found.append(f"{before}{listed(list(dict.fromkeys(things)))}{rest}")
        return found

    def _split(self, literal: Literal, said: str) -> tuple[str, str, str]:
        """A fact's words before and after the thing that it is about."""
        for name in reversed(literal.args) if literal.predicate == "has" else literal.args:
            thing = self.wording.entity(name)
            if literal.predicate == "has" and name == literal.args[0]:
                continue
            at = said.find(thing)
            if at >= 0:
                return said[:at], said[at + len(thing) :], thing
        return "", "", said

    # Entities

    def _list(self, names: Sequence[str], query: Query) -> str:
        if len(names) == 1:
            return sentence(f"{'one' if query.counted else 'yes'}, {self.wording.entity(names[0])}")
        noun = query.noun or "things"
        noun = noun if names_several(noun) else plural_of(noun)
        return sentence(f"there are {in_words(len(names))} {noun}: {self._named(names)}")

    def _meaning(self, name: str) -> str:
        entity, said = self.world.entities[name], self.wording.entity(name)
        if entity.type == "message":
            others = [s for s in entity.synonyms if " " in s]
            also = f': "{others[0]}"' if others else ""
            return sentence(f"{said} is a message that I can tell{also}")
        kind = _KINDS.get(entity.type, (entity.type, ""))[0]
        called = f", also called {listed(list(entity.synonyms), 'or')}" if entity.synonyms else ""
        article = "an" if kind[:1] in "aeiou" else "a"
        first = sentence(f"{said} {_is(entity)} {article} {kind}{called}")
        if entity.type == "object" and self._place(name) is None:
            return first
        it = {"female": "she", "male": "he"}.get(entity.gender) or (
            said if entity.type == "person" else "it"
        )
        it = "they" if _is(entity) == "are" else it
        return f"{first} {sentence(_after(self._where(name), said, it))}"

    def _inside(self, names: Sequence[str], region: str) -> str:
        """Whether things are in a room, on or in something there."""
        away = [n for n in names if self.world.place_of(n, self.world.initial) != region]
        shown = away or names
        said = " ".join(map(self._where, shown[:MOST_NAMED]))
        if len(names) > 1 and away and len(away) < len(names):
            return f"Not all of them. {said}"
        lead = "no" if away else "yes"
        return (
            f"{sentence(lead)[:-1]}. {said}"
            if len(shown) > 1
            else f"{lead.capitalize()}, {_lower(said)}"
        )

    def _any_inside(self, names: Sequence[str], query: Query) -> str:
        """Which of some things are in a room."""
        there = [n for n in names if self.world.place_of(n, self.world.initial) == query.entity]
        where = self._at(query.entity)
        if not there:
            return sentence(f"none, as far as I know: nothing of that is {where}")
        number = f"{in_words(len(there))}: " if query.counted else ""
        return sentence(f"{number}{self._named(there)} {_are(self.world, there)} {where}")

    def _owner(self, name: str) -> str:
        entity = self.world.entities[name]
        if entity.owner in self.world.entities:
            owner = self.wording.entity(entity.owner)
            return sentence(f"the {entity.spoken} belongs to {owner}")
        return sentence(f"as far as I know, {self.wording.entity(name)} is nobody's in particular")

    def _world(self) -> str:
        parts = []
        for kind, (one, several) in _KINDS.items():
            if kind not in self.world.domain.parents:
                continue
            names = [e.name for e in self.world.of_type(kind)]
            if names:
                noun = one if len(names) == 1 else several
                parts.append(
                    f"{in_words(len(names))} {noun}, such as {self._named(names[:3])}"
                    if len(names) > 3
                    else f"{in_words(len(names))} {noun}: {self._named(names)}"
                )
        return sentence(f"I know {'; '.join(parts)}")

    # Words

    def _fact(self, literal: Literal) -> str:
        """A fact as the robot says it: it speaks of itself as "I"."""
        said = self.wording.fact(literal)
        if literal.predicate == "robot-at" and literal.positive:
            return f"I'm {self._at(literal.args[0])}"
        for theirs, mine in (
            ("the robot's hand", "my hand"),
            ("the robot is", "I'm"),
            ("the robot", "I"),
        ):
            said = said.replace(theirs, mine)
        first = self.wording.entity(literal.args[0]) if literal.args else ""
        if first and _is(self.world.entities[literal.args[0]]) == "are":
            said = said.replace(f"{first} is ", f"{first} are ")
        return said

    def _named(self, names: Sequence[str]) -> str:
        more = len(names) - MOST_NAMED
        if more <= 1:
            return listed([self.wording.entity(n) for n in names])
        said = [self.wording.entity(n) for n in names[:MOST_NAMED]]
        return listed([*said, f"{in_words(more)} more"])

    def _in_order(self, names: Iterable[str]) -> list[str]:
        wanted = set(names)
        return [n for n in self.world.entities if n in wanted]


def _tells_place(fact: Literal, entity: str) -> bool:
    if fact.predicate == "has":
        return fact.args[-1] == entity
    return fact.predicate != "robot-at" and fact.args[0] == entity


def _lower(text: str) -> str:
    """A sentence to go after a comma: names and "I" keep their capital."""
    kept = text.startswith(("I ", "I'"))
    return text if kept else text[:1].lower() + text[1:]


def _after(text: str, thing: str, pronoun: str) -> str:
    """A sentence about a thing with a pronoun for it at its beginning."""
    return pronoun + text[len(thing) :] if text.lower().startswith(thing.lower()) else text


def _is(entity: Entity) -> str:
    return "are" if entity.spoken.endswith(("glasses", "trays", "pills")) else "is"


def _are(world: World, names: Sequence[str]) -> str:
    return "are" if len(names) > 1 else _is(world.entities[names[0]])


def _plural(rest: str) -> str:
    for one, several in (
        (" is ", " are "),
        (" has ", " have "),
        (" was ", " were "),
        (" doesn't ", " don't "),
    ):
        if rest.startswith(one):
            return several + rest[len(one) :]
    return rest
