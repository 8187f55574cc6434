"""Which entities mentions mean: by type, owner, adjectives, place and what was said before."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace

from polaris_nl.language.clauses import Clause
from polaris_nl.language.mention import ASKED, EVERYTHING, WORDLESS, Candidate, Mention
from polaris_nl.model.formula import (
    And,
    Equal,
    Formula,
    Imply,
    Literal,
    Not,
    Quantified,
    Variable,
    bind,
    literals_in,
)
from polaris_nl.model.text import listed
from polaris_nl.model.wording import Wording
from polaris_nl.model.world import World

KIND_RANK = 3
"""The rank of a candidate of which only the type was named."""
_INDEFINITE = ("a ", "an ", "any ", "some ", "one of ")
_ONE_PLACE = ("at", "in")
_PLACE_PREDICATES = ("at", "in", "person-in", "located", "has")


class Unclear(Exception):
    """A mention that may mean several entities, or none that is known: the reading has a hole.

    Args:
        about: the question.
        options: what can be answered, as spoken.
        phrase: the words that are unclear, or the missing parameter.
        types: what an answer can be.
        number: how many are asked for, or 0 for any number.
    """

    def __init__(
        self,
        about: str,
        options: Sequence[str],
        phrase: str,
        types: Sequence[str] = (),
        number: int = 0,
    ) -> None:
        super().__init__(about)
        self.about = about
        self.options = tuple(options)
        self.phrase = phrase
        self.types = tuple(types)
        self.number = number


class Misfit(Exception):
    """A reading that can't be: the reason is a sentence for the user."""


@dataclass(frozen=True, slots=True)
class Scope:
    """What was talked about, for pronouns and "the same".

    Attributes:
        referents: entities, the latest last.
        group: the entities of the latest plural mention.
        choices: what the user has answered for phrases and missing parameters that were asked about.
        told: who was told of what, the latest last.
    """

    referents: tuple[str, ...] = ()
    group: tuple[str, ...] = ()
    choices: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    told: tuple[tuple[str, str], ...] = ()

    def after(self, entities: Sequence[str]) -> Scope:
        """The scope once entities were mentioned."""
        if not entities:
            return self
        kept = tuple(r for r in self.referents if r not in entities)
        group = tuple(entities) if len(entities) > 1 else self.group
        return replace(self, referents=(*kept, *entities)[-40:], group=group)


@dataclass(frozen=True, slots=True)
class Meant:
    """What a mention means: entities, every entity of a kind, or none of some.

    Attributes:
        negated: it is said of none of the entities.
    """

    entities: tuple[str, ...] = ()
    every: Quantified | None = None
    negated: bool = False


class Resolver:
    """Resolves mentions in one world."""

    def __init__(self, world: World, wording: Wording) -> None:
        self._world = world
        self._wording = wording

    def literals(
        self, clause: Clause, scope: Scope, condition: bool
    ) -> tuple[tuple[Formula, ...], Scope]:
        """The goals, or the literals of a condition, that a clause asks for.

        Returns:
            They, and the scope after the clause.

        Raises:
            Unclear: a question has to be asked.
            Misfit: nothing that is known fits.
        """
        predicate = self._world.domain.predicates[clause.predicate]
        bindings = dict(clause.bindings)
        extra = [
            (n, m)
            for n, m in clause.bindings
            if f"?{n}" not in {p.name for p in predicate.parameters}
        ]
        for _, mention in extra:
            # Who puts the cup there doesn't matter, so nobody is asked.
            with suppress(Unclear, Misfit):
                scope = scope.after(self.meant(mention, (), scope, condition).entities)
        chosen: list[Meant] = []
        for parameter in predicate.parameters:
            bound = bindings.get(parameter.name.lstrip("?"))
            if bound is None:
                chosen.append(self._implied(clause, parameter, scope))
                continue
            if bound.text == EVERYTHING and not bound.candidates:
                chosen.append(self._all_there(clause, parameter, scope))
                continue
            if bound.text == ASKED and not bound.candidates:
                chosen.append(self._answered(parameter, scope))
                continue
            meant = self.meant(bound, parameter.types, scope, condition)
            scope = scope.after(meant.entities)
            chosen.append(meant)
        goals = self._combined(clause, chosen)
        told = tuple(x.args for x in goals if isinstance(x, Literal) and self._tells(x))
        if told and not condition:
            scope = replace(scope, told=(*scope.told, *((a[0], a[1]) for a in told)))
        for name, mention in bindings.items():
            if mention.text in WORDLESS and not mention.candidates:
                continue
            parameter_types = next(
                (p.types for p in predicate.parameters if p.name == f"?{name}"), ()
            )
            goals += self._said_of(mention, parameter_types, scope, condition)
        return tuple(dict.fromkeys(goals)), scope

    def _all_there(self, clause: Clause, parameter: Variable, scope: Scope) -> Meant:
        """Everything of which a clause holds: "clear the table" is about all that is on it."""
        predicate = self._world.domain.predicates[clause.predicate]
        bindings = dict(clause.bindings)
        args = []
        for other in predicate.parameters:
            named = bindings.get(other.name.lstrip("?"))
            if other.name == parameter.name or named is None:
                args.append("?x")
            else:
                args.append(self.meant(named, other.types, scope).entities[0])
        variable = Variable("?x", parameter.types)
        there = Literal(clause.predicate, tuple(args))
        return Meant((), Quantified("forall", (variable,), there))

    def said(self, goals: Sequence[Formula]) -> str:
        """Goals in words, to choose from."""
        return listed([self._wording.goal(goal) for goal in goals])

    def instead(
        self, goals: Sequence[Formula], mention: Mention, scope: Scope
    ) -> tuple[tuple[Formula, ...], Scope]:
        """Goals with another entity in the place of one of its type: "the same for the plate".

        Returns:
            The goals, none where nothing in them can be replaced, and the scope after them.

        Raises:
            Unclear: a question has to be asked.
        """
        try:
            meant = self.meant(mention, (), scope).entities
        except Misfit:
            return (), scope
        found: list[Formula] = []
        for name in meant:
            kind = self._world.entities[name].type
            used = dict.fromkeys(
                a for g in goals for x in literals_in(g) for a in x.args if self._is(a, (kind,))
            )
            old = next((u for u in used if u not in meant), None)
            if old is not None:
                found.extend(g for goal in goals if (g := bind(goal, {old: name})) != goal)
        return tuple(dict.fromkeys(found)), scope.after(meant)

    def without(
        self, goals: Sequence[Formula], mention: Mention, scope: Scope
    ) -> tuple[tuple[Formula, ...], Scope]:
        """Goals without what they ask of some entities, and the scope after them.

        Raises:
            Unclear: a question has to be asked.
            Misfit: nothing that is known fits.
        """
        used = {a for g in goals for x in literals_in(g) for a in x.args if not a.startswith("?")}
        kinds = {x.args[1] for g in goals for x in literals_in(g) if x.predicate == "kind"}
        about = tuple(
            e.name for e in self._world.entities.values()
            if e.name in used or kinds & {e.noun, *e.kinds} or e.name in kinds
        )  # fmt: skip
        left_out = self.meant(mention, (), scope.after(about)).entities
        found: list[Formula] = []
        for goal in goals:
            if isinstance(goal, Quantified) and isinstance(goal.body, Imply):
                parts = (goal.body.condition, *(Not(Equal("?x", name)) for name in left_out))
                found.append(replace(goal, body=replace(goal.body, condition=And(parts))))
            elif not any(x.args[:1] == (name,) for x in literals_in(goal) for name in left_out):
                found.append(goal)
        return tuple(found), scope.after(left_out)

    def _combined(self, clause: Clause, chosen: Sequence[Meant]) -> tuple[Formula, ...]:
        every = [m for m in chosen if m.every is not None]
        rows: list[tuple[str, ...]] = [()]
        for meant in chosen:
            terms = ("?x",) if meant.every is not None else meant.entities
            rows = [(*row, term) for row in rows for term in terms]
        positive = clause.positive and not any(m.negated for m in chosen)
        literals = tuple(Literal(clause.predicate, row, positive) for row in rows)
        things = {x.args[:1] for x in literals}
        if positive and clause.predicate in _ONE_PLACE and len(things) < len(literals):
            raise Misfit(
                "One thing can't be in two places at once; say for each where it should go."
            )
        if not every:
            return literals
        quantified = every[0].every
        assert quantified is not None
        whole = quantified.body == And(())
        return tuple(
            replace(quantified, body=literal if whole else Imply(quantified.body, literal))
            for literal in literals
        )

    def _said_of(
        self, mention: Mention, types: Sequence[str], scope: Scope, condition: bool
    ) -> tuple[Formula, ...]:
        """Goals in adjectives: "a full tray" is to be full, where the robot can see to it."""
        found: list[Formula] = []
        for part in mention.parts or (mention,):
            for predicate, positive in (
                part.states if not part.quantifier or part.quantifier != "all" else ()
            ):
                if condition or not self._world.domain.achievers(Literal(predicate, (), positive)):
                    continue
                for entity in self.meant(part, types, scope, condition).entities:
                    literal = Literal(predicate, (entity,), positive)
                    # What holds already describes, and needs no goal, unless it is to stay so.
                    if positive or not self._world.initial.holds(literal):
                        found.append(literal)
        return tuple(found)

    def _implied(self, clause: Clause, parameter: Variable, scope: Scope) -> Meant:
        """What isn't said: what was answered, the latest that fits, or the only one there is."""
        answered = scope.choices.get(parameter.name)
        if answered:
            return Meant(answered)
        told = self._told(parameter, scope)
        if told is not None:
            return Meant((told,))
        for name in reversed(scope.referents):
            if self._is(name, parameter.types):
                return Meant((name,))
        return self._answered(parameter, scope)

    def _tells(self, literal: Literal) -> bool:
        """Whether a person is told a message."""
        kinds = [self._world.entities[a].type for a in literal.args if a in self._world.entities]
        return literal.positive and kinds == ["person", "message"]

    def _told(self, parameter: Variable, scope: Scope) -> str | None:
        """The message that the person spoken of last was told: "once she acknowledges" is about hers."""
        if "message" not in parameter.types:
            return None
        people = [r for r in reversed(scope.referents) if self._is(r, ("person",))]
        return dict(scope.told).get(people[0]) if people else None

    def _answered(self, parameter: Variable, scope: Scope) -> Meant:
        """What was answered for a parameter, the only thing that fits, or a question."""
        answered = scope.choices.get(parameter.name)
        if answered:
            return Meant(answered)
        fitting = [e.name for e in self._world.of_type(*parameter.types)]
        if len(fitting) == 1:
            return Meant((fitting[0],))
        what = " or ".join(parameter.types)
        options = [self._world.entities[n].spoken for n in fitting][:6]
        question = {"surface": "Where to?", "container": "Into what?", "message": "About what?"}
        raise Unclear(
            question.get(what, f"Which {what}?"), options, parameter.name, parameter.types
        )

    def meant(
        self, mention: Mention, types: Sequence[str], scope: Scope, condition: bool = False
    ) -> Meant:
        """The entities that a mention means.

        Raises:
            Unclear: several fit equally well.
            Misfit: none fits.
        """
        if mention.parts:
            if mention.alternative:
                options = [self.meant(p, types, scope, condition).entities for p in mention.parts]
                return self._one([n for o in options for n in o], mention, scope)
            entities = [
                n for p in mention.parts for n in self.meant(p, types, scope, condition).entities
            ]
            return Meant(tuple(dict.fromkeys(entities)), negated=mention.quantifier == "none")
        if mention.pronoun and mention.pronoun != "one":
            return self._pronoun(mention, types, scope)
        names = self._fitting(mention, types, scope)
        if not names:
            raise Misfit(self._nothing_fits(mention, types))
        if mention.quantifier == "none":
            return Meant(tuple(names), negated=True)
        if mention.quantifier == "rest" or (mention.other and mention.plural):
            rest = tuple(n for n in names if n not in scope.referents)
            return Meant(rest or tuple(names))
        if mention.quantifier == "all" and not condition:
            return self._every(mention, types, names, scope)
        if mention.quantifier in ("all", "both") or (mention.plural and not mention.number):
            if mention.quantifier == "both" and len(names) > 2:
                return self._several(names, mention, scope, 2)
            return Meant(tuple(names))
        if mention.number == len(names):
            return Meant(tuple(names))
        if mention.number > 1:
            return self._several(names, mention, scope, mention.number)
        return self._one(names, mention, scope)

    def among(self, mention: Mention, names: Sequence[str], scope: Scope) -> tuple[str, ...]:
        """Those of some entities that an answer means, none where it means something else."""
        if mention.parts:
            each = [self.among(part, names, scope) for part in mention.parts]
            found = tuple(dict.fromkeys(e[0] for e in each if len(e) == 1))
            return found if len(found) == len(mention.parts) and not mention.alternative else ()
        if mention.pronoun not in ("", "one"):
            return ()
        candidates = [c for c in mention.candidates if c.entity in names]
        if mention.pronoun == "one":
            candidates = [Candidate(n, 1) for n in names]
        if not candidates:
            return ()
        narrowed = replace(mention, pronoun="", candidates=tuple(candidates))
        return tuple(self._fitting(narrowed, (), scope))

    def _several(self, names: Sequence[str], mention: Mention, scope: Scope, number: int) -> Meant:
        """A number of entities: what was answered, or a question."""
        chosen = scope.choices.get(mention.text, ())
        if len(chosen) == number and set(chosen) <= set(names):
            return Meant(chosen)
        if len(names) < number:
            raise Misfit(f"I know only {len(names)} of {mention.text}.")
        count = {2: "two", 3: "three", 4: "four", 5: "five"}.get(number, str(number))
        raise Unclear(
            f"Which {count} do you mean by {mention.text}?",
            self._spoken(names),
            mention.text,
            number=number,
        )

    def _one(self, names: Sequence[str], mention: Mention, scope: Scope) -> Meant:
        names = list(dict.fromkeys(names))
        chosen = scope.choices.get(mention.text, ())
        if chosen and set(chosen) <= set(names):
            return Meant(chosen)
        if len(names) == 1:
            return Meant((names[0],))
        recent = [r for r in reversed(scope.referents) if r in names]
        told_apart = mention.other or mention.alternative or mention.text.startswith(_INDEFINITE)
        if recent and not told_apart:
            return Meant((recent[0],))
        # The user's choice wins, then what was mentioned before; else it is asked.
        options = self._spoken(names)
        which = "one" if mention.alternative else _noun(mention)
        raise Unclear(f"Which {which} do you mean?", options, mention.text)

    def _fitting(self, mention: Mention, types: Sequence[str], scope: Scope) -> list[str]:
        candidates = [c for c in mention.candidates if self._is(c.entity, types)]
        if mention.pronoun == "one":
            names = reversed(scope.referents)
            nouns = {self._world.entities[n].noun for n in names if self._is(n, types)} - {""}
            candidates = [
                Candidate(e.name, 1) for e in self._world.of_type(*types) if e.noun in nouns
            ]
        if not candidates and "surface" in types:
            candidates = self._surfaces_in(mention)
        if mention.owner:
            candidates = self._owned(mention.owner, candidates, scope)
        if mention.place is not None:
            candidates = self._placed(candidates, mention.place, scope)
        if mention.other:
            last = next(
                (r for r in reversed(scope.referents) if r in {c.entity for c in candidates}), None
            )
            candidates = [c for c in candidates if c.entity != last]
        candidates = self._described(candidates, mention)
        left_out = self._excepted(mention, types, scope)
        candidates = [c for c in candidates if c.entity not in left_out]
        if not candidates:
            return []
        if mention.quantifier or mention.plural or mention.number:
            return [c.entity for c in candidates]
        if mention.text.startswith(_INDEFINITE):
            return [c.entity for c in candidates if c.rank < KIND_RANK] or [
                c.entity for c in candidates
            ]
        best = min(c.rank for c in candidates)
        return [c.entity for c in candidates if c.rank == best]

    def _owned(self, owner: str, candidates: Sequence[Candidate], scope: Scope) -> list[Candidate]:
        owners = self._owners(owner, scope)
        owned = [c for c in candidates if self._world.entities[c.entity].owner in owners]
        if owned:
            return owned
        # "Her table" may be any table to somebody whom the world gives no table.
        return [c for c in candidates if not self._world.entities[c.entity].owner]

    def _owners(self, owner: str, scope: Scope) -> tuple[str, ...]:
        people = list(self._world.of_type("person")) if "person" in self._world.domain.types else []
        if owner == "user":
            return tuple(p.name for p in people if p.user)
        if owner not in ("female", "male", "any"):
            return (owner,)
        fitting = [p.name for p in people if owner == "any" or p.gender in (owner, "")]
        recent = [r for r in reversed(scope.referents) if r in fitting]
        if recent:
            return (recent[0],)
        return tuple(p.name for p in people if owner == "any" or p.gender == owner)

    def _placed(
        self, candidates: Sequence[Candidate], place: Mention, scope: Scope
    ) -> list[Candidate]:
        try:
            there = set(
                self.meant(place, ("surface", "container", "region", "person"), scope).entities
            )
        except (Unclear, Misfit):
            return list(candidates)
        state = self._world.initial
        held = [
            c
            for c in candidates
            if any(
                f.predicate in _PLACE_PREDICATES and c.entity in f.args and there & set(f.args)
                for f in state.facts
            )
            or self._world.place_of(c.entity, state) in there
        ]
        return held or list(candidates)

    def _described(self, candidates: Sequence[Candidate], mention: Mention) -> list[Candidate]:
        """Adjectives that describe: among several, those of which they are true now."""
        if not mention.states or len(candidates) < 2:
            return list(candidates)
        state = self._world.initial
        true = [
            c
            for c in candidates
            if all(state.holds(Literal(p, (c.entity,), positive)) for p, positive in mention.states)
        ]
        return true or list(candidates)

    def _surfaces_in(self, mention: Mention) -> list[Candidate]:
        regions = {
            c.entity for c in mention.candidates if self._world.entities[c.entity].type == "region"
        }
        best = min((c.rank for c in mention.candidates if c.entity in regions), default=0)
        regions = {c.entity for c in mention.candidates if c.entity in regions and c.rank == best}
        return [
            Candidate(f.args[0], 1)
            for f in sorted(self._world.facts)
            if f.predicate == "located"
            and f.args[1] in regions
            and self._is(f.args[0], ("surface",))
        ]

    def _pronoun(self, mention: Mention, types: Sequence[str], scope: Scope) -> Meant:
        if mention.pronoun == "me":
            user = self._world.user
            if user is not None:
                return Meant((user.name,))
            people = [p.name for p in self._world.of_type("person")]
            return self._asked_who(people, mention, scope)
        if (
            mention.pronoun in _PLURAL
            and scope.group
            and all(self._is(n, types) for n in scope.group)
        ):
            return Meant(scope.group)
        gender = {"she": "female", "her": "female", "he": "male", "him": "male"}.get(
            mention.pronoun, ""
        )
        chosen = scope.choices.get(mention.text, ())
        if chosen and all(self._is(n, types) for n in chosen):
            return Meant(chosen)
        told = (
            self._told(Variable("?m", tuple(types)), scope)
            if tuple(types) == ("message",)
            else None
        )
        if told is not None:
            return Meant((told,))
        fitting = [
            r
            for r in reversed(scope.referents)
            if self._is(r, types) and (not gender or self._world.entities[r].gender in (gender, ""))
        ]
        if fitting:
            sure = [r for r in fitting if gender and self._world.entities[r].gender == gender]
            return Meant(((sure or fitting)[0],))
        known = [e.name for e in self._world.of_type(*types) if not gender or e.gender == gender]
        if gender and len(known) == 1:
            return Meant((known[0],))
        options = self._spoken(known) if len(known) <= 6 else []
        who = "Who" if "person" in types else "What"
        raise Unclear(f'{who} do you mean by "{mention.text}"?', options, mention.text, types)

    def _asked_who(self, people: Sequence[str], mention: Mention, scope: Scope) -> Meant:
        """The person that "me" was said to be, or a question."""
        chosen = scope.choices.get(mention.text, ())
        if len(people) == 1 or chosen:
            return Meant(chosen or tuple(people))
        options = self._spoken(people)
        raise Unclear(f'Who do you mean by "{mention.text}"?', options, mention.text, ("person",))

    def _every(
        self, mention: Mention, types: Sequence[str], names: Sequence[str], scope: Scope
    ) -> Meant:
        if self._in_a_region(mention, scope):
            return Meant(tuple(names))
        kind = mention.kind or (types[0] if types else "object")
        variable = Variable("?x", (types[0] if types else "object",))
        parts: list[Formula] = []
        if kind != variable.types[0]:
            parts.append(Literal("kind", ("?x", kind)))
        parts.extend(Literal(p, ("?x",), positive) for p, positive in mention.states)
        if mention.place is not None:
            there = self.meant(mention.place, ("surface", "container"), Scope()).entities
            predicate = "in" if self._is(there[0], ("container",)) else "at"
            parts.append(Literal(predicate, ("?x", there[0])))
        left_out = self._excepted(mention, types, scope)
        parts.extend(Not(Equal("?x", name)) for name in left_out)
        body = parts[0] if len(parts) == 1 else And(tuple(parts))
        return Meant(tuple(names), Quantified("forall", (variable,), body))

    def _in_a_region(self, mention: Mention, scope: Scope) -> bool:
        """Whether a place is a room: what is on and in the things there has no predicate of its own."""
        if mention.place is None:
            return False
        place = self.meant(mention.place, ("surface", "container", "region"), scope).entities
        return self._is(place[0], ("region",))

    def _excepted(self, mention: Mention, types: Sequence[str], scope: Scope) -> tuple[str, ...]:
        """What is left out. "All the cups except the red one": "one" is a cup."""
        if mention.excepted is None:
            return ()
        of_kind = tuple(c.entity for c in mention.candidates)
        return self.meant(mention.excepted, types, scope.after(of_kind)).entities

    def _is(self, entity: str, types: Sequence[str]) -> bool:
        known = self._world.entities.get(entity)
        if known is None:
            return False
        return not types or any(self._world.domain.is_a(known.type, t) for t in types)

    def _spoken(self, names: Iterable[str]) -> list[str]:
        return [self._world.entities[n].spoken for n in names]

    def _nothing_fits(self, mention: Mention, types: Sequence[str]) -> str:
        there = [self._world.entities[e.name].spoken for e in self._world.of_type(*types)][:6]
        what = " or ".join(types)
        return f"I know no {what} called {mention.text}. I know {', '.join(there)}."


EVERY_ONE = ("them", "these", "those", "both", "both of them", "them both", "all of them")
"""Pronouns that answer a question with all that was offered."""
_PLURAL = (
    "them",
    "they",
    "these",
    "those",
    "both",
    "both of them",
    "they both",
    "them both",
    "all of them",
    "everything",
)


def _noun(mention: Mention) -> str:
    for word in ("the ", "a ", "an ", "some ", "my ", "her ", "his ", "one "):
        if mention.text.startswith(word):
            return mention.text[len(word) :]
    return mention.text
