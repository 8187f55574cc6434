"""Which entity a correction means, and which one it is to take the place of."""

from __future__ import annotations

from collections.abc import Sequence

from polaris_nl.automaton.automaton import Automaton
from polaris_nl.automaton.edits import Edit
from polaris_nl.language.dialogue import Dialogue
from polaris_nl.language.exchange import exchanged, kinds_in, used_in
from polaris_nl.language.mention import Mention
from polaris_nl.language.protocol import Language
from polaris_nl.language.scope import Misfit, Unclear
from polaris_nl.model.formula import Literal

_PERSONS = ("he", "she", "him", "her")


class Choosing:
    """Finds what is meant instead of what, for the language side of one world."""

    def __init__(self, language: Language) -> None:
        self._language = language

    def entities(
        self,
        mention: Mention,
        old: object,
        where: Sequence[str],
        program: Automaton,
        dialogue: Dialogue,
    ) -> tuple[tuple[str, ...], object]:
        """What is meant instead, and the quantifier where it is everything of a kind.

        Raises:
            Misfit: nothing fits.
            Unclear: it has to be asked.
        """
        resolver, world = self._language.resolver, self._language.world
        used = [
            u for u in used_in(program, where or list(program.checkpoints)) if u in world.entities
        ]
        if not mention.other:
            if mention.pronoun and mention.pronoun not in ("one", "me", *_PERSONS):
                raise Misfit("")
            types = ("person",) if mention.pronoun in _PERSONS else ()
            found = resolver.meant(mention, types, dialogue.scope)
            return found.entities, found.every
        if isinstance(old, Mention) and old.candidates:
            used = [u for u in used if u in {c.entity for c in old.candidates}]
        fitting = [c.entity for c in mention.candidates if c.entity not in used]
        if not mention.candidates:
            fitting = next((s for u in used if (s := self._siblings(u))), [])
        if not fitting:
            raise Misfit("There is no other one.")
        return (self._chosen(fitting, mention.text, dialogue),), None

    def _chosen(self, fitting: Sequence[str], text: str, dialogue: Dialogue) -> str:
        chosen = dialogue.scope.choices.get(text, ())
        if len(chosen) == 1 and chosen[0] in fitting:
            return chosen[0]
        fitting = list(dict.fromkeys(fitting))
        if len(fitting) == 1:
            return fitting[0]
        options = [self._language.world.entities[e].spoken for e in fitting]
        raise Unclear("Which one do you mean?", options, text)

    def _siblings(self, entity: str) -> list[str]:
        """Others that are called the same: the cups beside a cup."""
        entities = self._language.world.entities
        this = entities[entity]
        noun = this.noun or this.spoken
        return [
            e.name
            for e in entities.values()
            if e.type == this.type and e.name != entity and noun in (e.noun, e.spoken, *e.synonyms)
        ]

    def another(
        self, old: object, touched: Sequence[str], program: Automaton, dialogue: Dialogue
    ) -> tuple[list[Edit], str] | None:
        """The other one ("not that one"), where there is only one, else a question."""
        world = self._language.world
        used = [u for u in used_in(program, touched) if u in world.entities]
        if isinstance(old, Mention):
            used = [u for u in used if u in {c.entity for c in old.candidates}]
        called = [u for u in used if self._siblings(u)]
        for entity in called or used[:1]:
            kind = world.entities[entity].type
            others = self._siblings(entity) or [
                e.name for e in world.of_type(kind) if e.name != entity
            ]
            if others:
                new = self._chosen(others, f"not {entity}", dialogue)
                names = self._language.names
                edits = list(exchanged(program, touched, entity, (new,), None, world, names))
                wording = self._language.wording
                return edits, f"I've put {wording.entity(new)} in place of {wording.entity(entity)}"
        return None

    def replaceable(
        self, new: str, old: object, where: Sequence[str], program: Automaton, convert: bool
    ) -> str | None:
        """The entity that a correction is about: the one named, or the latest of the same kind."""
        world = self._language.world
        used = [u for u in used_in(program, where) if u in world.entities]
        if isinstance(old, Mention):
            named = {c.entity: c.rank for c in old.candidates}
            chosen = sorted((u for u in used if u in named), key=lambda u: named[u])
            if old.pronoun == "one":
                chosen = [u for u in used if world.entities[u].type == world.entities[new].type]
            return chosen[0] if chosen else None
        kind, noun = world.entities[new].type, world.entities[new].noun
        same = [u for u in used if world.entities[u].type == kind and u != new]
        nouns = [u for u in same if noun and (world.entities[u].noun == noun or u == noun)]
        if same or not convert:
            return next(iter(nouns or same), None)
        if kind == "object":
            return next(iter(kinds_in(program, where)), None)
        places = ("surface", "container", "person")
        goals = [g for c in where for g in program.checkpoints[c].goals if isinstance(g, Literal)]
        moved = {a for g in goals if g.predicate in ("at", "in", "has") for a in g.args}
        fitting = [u for u in used if u in moved and world.entities[u].type in places]
        return fitting[0] if fitting and kind in places else None
