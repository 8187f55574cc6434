"""Which entities mentions mean: by type, owner, adjectives, place and what was said before."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

from polaris_nl.language.entity_types import is_a
from polaris_nl.language.mention import Candidate, Mention
from polaris_nl.language.pronouns import Pronouns
from polaris_nl.language.scope import Meant, Misfit, Scope, Unclear
from polaris_nl.model.formula import (
    And,
    Equal,
    Formula,
    Literal,
    Not,
    Quantified,
    Variable,
)
from polaris_nl.model.text import listed
from polaris_nl.model.world import World

KIND_RANK = 3
"""The rank of a candidate of which only the type was named."""
_INDEFINITE = ("a ", "an ", "any ", "some ", "one of ")
_POINTING = ("that ", "this ")
_PLACE_PREDICATES = ("at", "in", "person-in", "located", "has")


class Referents:
    """Finds what mentions mean in one world."""

    def __init__(self, world: World) -> None:
        self._world = world
        self._pronouns = Pronouns(world)
        placing = (world.domain.predicates.get(name) for name in _PLACE_PREDICATES)
        self._places = tuple(
            {t: None for found in placing if found for p in found.parameters for t in p.types}
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
            return self._pronouns.meant(mention, types, scope)
        names = self._fitting(mention, types, scope)
        if not names and mention.quantifier == "all" and not condition:
            names = self._elsewhere(mention, types, scope)
        if not names:
            raise Misfit(self._nothing_fits(mention, types, scope))
        if mention.quantifier == "none":
            return Meant(tuple(names), negated=True)
        if mention.quantifier == "rest" or (mention.other and mention.plural):
            rest = tuple(n for n in names if n not in scope.referents)
            return Meant(rest or tuple(names))
        if mention.quantifier == "all" and not condition:
            return self._every(mention, types, names, scope)
        if mention.quantifier in ("all", "both") or (mention.plural and not mention.number):
            # "Both the cup and the plate" says it of a list, so that each of them is one.
            if mention.quantifier == "both" and len(names) != 2 and (names[1:] or mention.plural):
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
        candidates = [c for c in mention.candidates if is_a(self._world, c.entity, types)]
        if mention.pronoun == "one":
            names = reversed(scope.referents)
            nouns = {self._world.entities[n].noun for n in names if is_a(self._world, n, types)} - {
                ""
            }
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
        if mention.text.startswith(_POINTING):
            # "That cup" is the one spoken of, even if another is called just so.
            spoken_of = [r for r in scope.referents if r in {c.entity for c in candidates}]
            if spoken_of:
                return spoken_of[-1:]
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
            if self._holds_nothing(place, candidates):
                raise Misfit(
                    f'Things can\'t be in or on {place.text}; name a place, or join the two with "and".'
                ) from None
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

    def _holds_nothing(self, place: Mention, things: Sequence[Candidate]) -> bool:
        """Whether what is said to be a place is a thing itself: "the fork in the spoon" is misheard."""
        types = {self._world.entities[c.entity].type for c in things}
        placed_in = [p for p in self._places if p not in types]
        named = [c.entity for c in place.candidates]
        return bool(named) and not any(is_a(self._world, name, placed_in) for name in named)

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
            and is_a(self._world, f.args[0], ("surface",))
        ]

    def _every(
        self, mention: Mention, types: Sequence[str], names: Sequence[str], scope: Scope
    ) -> Meant:
        if self._in_a_region(mention, scope):
            return Meant(tuple(names))
        kind = mention.kind or (types[0] if types else "object")
        if types and kind in self._world.domain.types:
            kind = types[0]  # "Close everything" is about what can be closed.
        if not mention.kind and any(c.rank < KIND_RANK for c in mention.candidates):
            # "Every bottle", where the only bottle is called just so: its name is as good as a kind.
            if len(names) != 1:
                return Meant(tuple(names))
            kind = names[0]
        variable = Variable("?x", (types[0] if types else "object",))
        parts: list[Formula] = []
        if kind != variable.types[0]:
            parts.append(Literal("kind", ("?x", kind)))
        parts.extend(Literal(p, ("?x",), positive) for p, positive in mention.states)
        if mention.place is not None:
            there = self.meant(mention.place, ("surface", "container"), scope).entities
            predicate = "in" if is_a(self._world, there[0], ("container",)) else "at"
            parts.append(Literal(predicate, ("?x", there[0])))
        left_out = self._excepted(mention, types, scope)
        parts.extend(Not(Equal("?x", name)) for name in left_out)
        body = parts[0] if len(parts) == 1 else And(tuple(parts))
        return Meant(tuple(names), Quantified("forall", (variable,), body))

    def _elsewhere(self, mention: Mention, types: Sequence[str], scope: Scope) -> list[str]:
        """What may be where a mention says by then, though nothing but what is left out is there now."""
        if mention.place is None or self._in_a_region(mention, scope):
            return []
        return self._fitting(replace(mention, place=None), types, scope)

    def _in_a_region(self, mention: Mention, scope: Scope) -> bool:
        """Whether a place is a room: what is on and in the things there has no predicate of its own."""
        if mention.place is None:
            return False
        place = self.meant(mention.place, ("surface", "container", "region"), scope).entities
        return is_a(self._world, place[0], ("region",))

    def _excepted(self, mention: Mention, types: Sequence[str], scope: Scope) -> tuple[str, ...]:
        """What is left out. "All the cups except the red one": "one" is a cup."""
        if mention.excepted is None:
            return ()
        of_kind = tuple(c.entity for c in mention.candidates)
        return self.meant(mention.excepted, types, scope.after(of_kind)).entities

    def _spoken(self, names: Iterable[str]) -> list[str]:
        return [self._world.entities[n].spoken for n in names]

    def _nothing_fits(self, mention: Mention, types: Sequence[str], scope: Scope) -> str:
        left_out = self._excepted(mention, types, scope)
        if left_out:
            return (
                f"Apart from {listed(self._spoken(left_out))} I know none; nothing is left to do."
            )
        there = [self._world.entities[e.name].spoken for e in self._world.of_type(*types)][:6]
        what = " or ".join(types)
        return f"I know no {what} called {mention.text}. I know {', '.join(there)}."


EVERY_ONE = ("them", "these", "those", "both", "both of them", "them both", "all of them")
"""Pronouns that answer a question with all that was offered."""


def _noun(mention: Mention) -> str:
    for word in ("the ", "a ", "an ", "some ", "my ", "her ", "his ", "one "):
        if mention.text.startswith(word):
            return mention.text[len(word) :]
    return mention.text
