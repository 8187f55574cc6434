"""Questions about what is so: "is the cupboard open", "who is in the office", "what does she have"."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from polaris_nl.language.asking import AUXILIARIES, DOING
from polaris_nl.language.clauses import Clause
from polaris_nl.language.conditions import stated
from polaris_nl.language.interpretation import Query, QueryKind
from polaris_nl.language.mention import Candidate, Mention
from polaris_nl.language.protocol import Language
from polaris_nl.language.scope import Misfit, Scope, Unclear
from polaris_nl.language.segment import Cut
from polaris_nl.model.formula import Literal

_VAGUE = {
    "anyone": "someone", "anybody": "someone", "someone": "someone", "somebody": "someone", "people": "people",
    "nobody": "someone", "anything": "something", "something": "something", "nothing": "something",
    "any": "", "some": "", "a": "", "an": "", "no": "",
}  # fmt: skip
"""Words that make "is ... there?" ask whether there is one, with what stands for what is asked."""
_SUBJECT = 4
"""Words within which what a question is about begins: "the door of the fridge"."""
_HAVING = (("have",), ("have", "got"), ("got",), ("hold",), ("holding",), ("carry",), ("carrying",))
_BEING_THERE = (
    ("are", "there"),
    ("is", "there"),
    ("there", "are"),
    ("do", "you", "see"),
    ("do", "we", "have"),
)


class FactsAsked:
    """Reads what is asked about the world, in one dialogue."""

    def __init__(self, language: Language, scope: Scope) -> None:
        self._language = language
        self._scope = scope
        self._known_cuts: dict[tuple[str, ...], list[Cut]] = {}

    def _cuts(self, statement: tuple[str, ...]) -> list[Cut]:
        if statement not in self._known_cuts:
            self._known_cuts[statement] = self._language.cuts(["if", *statement])
        return self._known_cuts[statement]

    def whether(self, statement: tuple[str, ...]) -> Query | None:
        """`the cupboard is open`, `someone is there`."""
        if not statement:
            return None
        if statement[0] == "there" and statement[1:2] in (("is",), ("are",), ("'s",)):
            found = self.inverted((statement[1], "there", *statement[2:]))
            if found is not None:
                return found
        if statement[0] in _VAGUE:
            found = self._any(statement)
            if found is not None:
                return found
        inside = self._inside(statement)
        if inside is not None:
            return inside
        if statement[-1] in ("anything", "something"):
            literals = self._each((*statement[:-1], "something"), len(statement) - 1)
            if literals:
                return Query("any", literals=literals, noun="something")
        return self.statement(statement)

    def statement(self, statement: tuple[str, ...]) -> Query | None:
        """What is asked by a statement: whether it is so."""
        literals = stated(self._language, self._cuts(statement), self._scope)
        return is_it(literals) if literals else None

    def _inside(self, statement: tuple[str, ...], kind: QueryKind = "inside") -> Query | None:
        """`the cups are in the kitchen`: on or in something there, which no predicate says."""
        world = self._language.world
        for clause in self._clauses(statement):
            bindings = [m for _, m in clause.bindings]
            if clause.predicate not in ("at", "in") or len(bindings) != 2 or not clause.positive:
                return None
            thing, place = bindings
            types = {world.entities[c.entity].type for c in place.candidates}
            if types != {"region"}:
                return None
            region = self._language.resolver.meant(place, ("region",), self._scope).entities[0]
            if kind == "inside":
                names = self._language.resolver.meant(
                    thing, ("object",), self._scope, condition=True
                ).entities
            else:
                best = {c.entity for c in thing.candidates}
                names = tuple(n for n in world.entities if n in best)
            return Query(kind, entity=region, entities=names)
        return None

    def inverted(self, tokens: tuple[str, ...]) -> Query | None:
        """`is the cupboard open` is the state "the cupboard is open" with its verb in front."""
        verb = () if tokens[0] in DOING else ({"am": "are"}.get(tokens[0], tokens[0]),)
        rest = tokens[1:]
        if rest[:1] == ("not",):
            rest = rest[1:]
        there = rest[:1] == ("there",)
        rest = rest[1:] if there else rest
        if not rest:
            return None
        mentions = self._language.mentions(rest)
        # "The door of the fridge" and "the fridge door" end behind, or within, what is named in them.
        named = {m.end for there in mentions[:_SUBJECT] for m in there}
        first = {m.end for m in mentions[0]}
        ends = [
            *sorted(first | {1, 2}, key=lambda end: (end < 3, -end)),
            *sorted((named | {end + 1 for end in named}) - first - {1, 2}),
        ]
        unclear: Unclear | None = None
        for at in ends:
            if at > len(rest) or (at == len(rest) and verb):
                continue
            statement = (*rest[:at], *verb, *rest[at:])
            try:
                query = self._any(statement) if there else self.whether(statement)
            except Unclear as found:
                unclear = unclear or found
                continue
            if query is not None:
                return query
            if not verb:
                break
        if unclear is not None:
            raise unclear
        return None

    def _any(self, statement: tuple[str, ...]) -> Query | None:
        """`someone is in the office`: whether there is one."""
        subject = _VAGUE.get(statement[0], statement[0])
        if subject:
            statement = (subject, *statement[1:])
        inside = self._inside(statement, "any-inside")
        if inside is not None:
            return inside
        literals = self._each(statement, 0)
        if not literals and statement[0] == "someone" and statement[-1] in ("there", "here"):
            people = self._language.world.of_type("person")
            regions = {e.name for e in self._language.world.of_type("region")}
            literals = tuple(
                Literal("person-in", (p.name, region))
                for p in people
                for region in sorted(regions)
                if "person-in" in self._language.world.domain.predicates
            )
        return Query("any", literals=literals, noun=statement[0]) if literals else None

    def which(self, tokens: tuple[str, ...]) -> Query | None:
        """`who is in the office`, `which dishes are dirty`, `what does she have`."""
        word, rest = tokens[0], tokens[1:]
        counted = tokens[:2] == ("how", "many")
        if not rest or (word == "how" and not counted):
            return None
        if word == "what" and rest[0] in (*DOING, *AUXILIARIES):
            found = self._what_has(rest)
            if found is not None:
                return found
        if rest[:2] in (("'s", "got"), ("is", "got")):
            rest = ("has", *rest[1:])
        statement = rest
        if word == "who":
            statement = ("someone", *rest)
        elif counted:
            statement = rest[2:] if rest[1:2] == ("of",) else rest[1:]
        elif word == "what" and rest[0] in (*AUXILIARIES, "'s"):
            statement = ("something", *rest)
        elif rest[0] == "of":
            statement = rest[1:]
        for words in _BEING_THERE:
            at = next(
                (i for i in range(len(statement)) if statement[i : i + len(words)] == words), -1
            )
            if at > 0:
                statement = (*statement[:at], "are", *statement[at + len(words) :])
        if len(statement) < 2:
            return None
        inside = self._inside(statement, "any-inside")
        if inside is not None:
            return replace(inside, counted=counted)
        literals = self._each(statement, 0)
        if not literals and statement[0] == "something":
            literals = self._each(("containers", "are", *statement[2:]), 0)
        noun = statement[0] if statement[0] in ("someone", "something") else ""
        return Query("which", literals=literals, counted=counted, noun=noun) if literals else None

    def _what_has(self, rest: tuple[str, ...]) -> Query | None:
        """`what does mr brown have`, `what are you holding`."""
        subject = rest[1:]
        for ending in _HAVING:
            if len(subject) > len(ending) and subject[-len(ending) :] == ending:
                who = subject[: -len(ending)]
                verb = ("are", "holding") if who in (("you",), ("the", "robot")) else ("has",)
                statement = (*who, *verb, "something")
                literals = self._each(statement, len(statement) - 1)
                if literals:
                    return Query("which", literals=literals, noun="something")
        return None

    def _each(self, statement: tuple[str, ...], at: int) -> tuple[Literal, ...]:
        """A fact for each thing that the mention at a position may mean."""
        unclear: Unclear | None = None
        for clause in self._clauses(statement):
            name, mention = next(
                ((n, m) for n, m in clause.bindings if m.start == at + 1), ("", None)
            )
            if mention is None:
                continue
            try:
                literals = tuple(self._for_each(clause, name, mention))
            except Unclear as found:
                unclear = unclear or found
                continue
            except Misfit:
                continue
            if literals:
                return literals
        if unclear is not None:
            raise unclear
        return ()

    def _clauses(self, statement: tuple[str, ...]) -> Iterator[Clause]:
        for cut in self._cuts(statement):
            found = [i.clause for i in cut.items if i.role == "condition" and i.clause is not None]
            if not cut.unknown and len(found) == 1 and not any(i.role == "goal" for i in cut.items):
                yield found[0]

    def _for_each(self, clause: Clause, name: str, mention: Mention) -> Iterator[Literal]:
        language = self._language
        predicate = language.world.domain.predicates[clause.predicate]
        types = next((p.types for p in predicate.parameters if p.name == f"?{name}"), None)
        if types is None:
            return
        every = replace(mention, quantifier="all", number=0, owner="")
        if mention.pronoun or mention.parts:
            return
        for entity in language.resolver.meant(every, types, self._scope, condition=True).entities:
            one = replace(
                mention, candidates=(Candidate(entity, 0),), quantifier="", plural=False, number=0, kind="",
                states=(), place=None, excepted=None, text=entity,
            )  # fmt: skip
            bindings = tuple((n, one if n == name else m) for n, m in clause.bindings)
            found, _ = language.resolver.literals(
                replace(clause, bindings=bindings), self._scope, condition=True
            )
            yield from (x for x in found if isinstance(x, Literal))


def is_it(literals: tuple[Literal, ...]) -> Query:
    """The question whether some facts hold."""
    return Query("is-it", literal=literals[0], literals=literals if len(literals) > 1 else ())
