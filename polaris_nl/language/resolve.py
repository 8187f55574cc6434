"""From clauses to goals and conditions: what each parameter of a predicate is, said or implied."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace

from polaris_nl.language.clauses import Clause
from polaris_nl.language.entity_types import is_a
from polaris_nl.language.mention import ASKED, EVERYTHING, WORDLESS, Mention
from polaris_nl.language.pronouns import Pronouns
from polaris_nl.language.referents import Referents
from polaris_nl.language.scope import Meant, Misfit, Scope, Unclear
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

_ONE_PLACE = ("at", "in")


class Resolver:
    """Resolves mentions in one world."""

    def __init__(self, world: World, wording: Wording) -> None:
        self._world = world
        self._wording = wording
        self._referents = Referents(world)
        self._pronouns = Pronouns(world)
        self.meant = self._referents.meant
        self.among = self._referents.among

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
            if parameter.types == ("message",):
                scope = scope.after(self._named_in(bound))
            scope = scope.after(meant.entities)
            chosen.append(meant)
            if bound.text == "nothing" and clause.kind == "goal" and not condition:
                raise Misfit("Then there is nothing to do; say what the robot should achieve.")
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

    def _named_in(self, message: Mention) -> tuple[str, ...]:
        """The things that a message names: "tell her that her pills are due and bring them to her"."""
        said = f" {message.text} "
        return tuple(
            thing.name
            for thing in self._world.of_type("object")
            if any(f" {name} " in said for name in (thing.spoken, *thing.synonyms))
        )

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
                a
                for g in goals
                for x in literals_in(g)
                for a in x.args
                if is_a(self._world, a, (kind,))
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
            if isinstance(goal, Quantified):
                found.append(_all_but(goal, left_out))
            elif not any(x.args[:1] == (name,) for x in literals_in(goal) for name in left_out):
                found.append(goal)
        return tuple(found), scope.after(left_out)

    def _combined(self, clause: Clause, chosen: Sequence[Meant]) -> tuple[Formula, ...]:
        every = [m for m in chosen if m.every is not None]
        if len(every) > 1:
            raise Misfit(
                '"Every" and "all" can stand once in a goal; name the other thing or place.'
            )
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
        told = self._pronouns.message_told(parameter.types, scope)
        if told is not None:
            return Meant((told,))
        for name in reversed(scope.referents):
            if is_a(self._world, name, parameter.types):
                return Meant((name,))
        return self._answered(parameter, scope)

    def _tells(self, literal: Literal) -> bool:
        """Whether a person is told a message."""
        kinds = [self._world.entities[a].type for a in literal.args if a in self._world.entities]
        return literal.positive and kinds == ["person", "message"]

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


def _all_but(goal: Quantified, names: Sequence[str]) -> Quantified:
    """A goal for all of a kind, but for some."""
    body = goal.body if isinstance(goal.body, Imply) else Imply(And(()), goal.body)
    condition = body.condition
    parts = condition.parts if isinstance(condition, And) else (condition,)
    parts = (*parts, *(Not(Equal("?x", name)) for name in names))
    condition = parts[0] if len(parts) == 1 else And(parts)
    return replace(goal, body=replace(body, condition=condition))
