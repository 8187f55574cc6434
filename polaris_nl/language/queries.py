"""Questions by the user: they are answered and never change anything."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import cast

from polaris_nl.automaton.automaton import START, Automaton
from polaris_nl.automaton.edits import AddCheckpoint
from polaris_nl.language.asking import AUXILIARIES, DOING, SET_WORDS, Asking
from polaris_nl.language.conditions import condition_in, span_of
from polaris_nl.language.dialogue import Dialogue
from polaris_nl.language.facts_asked import FactsAsked
from polaris_nl.language.foils import FOIL_KINDS, FOILS, foil, never
from polaris_nl.language.interpretation import Interpretation, Query, QueryKind
from polaris_nl.language.mention import Mention
from polaris_nl.language.patterns import Match, Patterns
from polaris_nl.language.protocol import Language
from polaris_nl.language.scope import Misfit, Unclear
from polaris_nl.language.tokens import BREAK, COMMA
from polaris_nl.model.evaluate import holds
from polaris_nl.model.formula import Literal, literals_in
from polaris_nl.model.world import World

LONGEST = 60
"""Words beyond which an utterance is not taken for a question."""
_SMALL = ("the", "a", "an", "any", "all", "of", "some", "other", "more", "your", "my")
_ABOUT_GOALS = ("why-not", "why", "when", "will", "able")
_ABOUT_STEPS = ("after-step", "before-step", "checkpoint")
_SUGGESTING = ("why", "do", "not", "you")
_COMPARING = frozenset(("first", "before", "instead", "rather"))
"""Words with which "why don't you" asks about the plan, rather than suggests something."""
_BARE = ("where-robot", "first", "last", "length", "world", "people", "problems")


def answer_to(
    language: Language,
    utterance: str,
    asking: Asking,
    tokens: Sequence[str],
    program: Automaton,
    dialogue: Dialogue,
) -> tuple[Interpretation, Dialogue] | None:
    """The answer that a question asks for, or None where the utterance is no question.

    Raises:
        Unclear: it is about something that has several meanings.
    """
    plain = [t for t in tokens if t not in (BREAK, COMMA)]
    if not plain or len(plain) > LONGEST:
        return None
    suggests = tuple(plain[: len(_SUGGESTING)]) == _SUGGESTING and not _COMPARING & set(plain)
    if suggests and len(program.checkpoints) == 1:
        return None  # Where nothing is planned there is nothing to ask the reason of.
    reader = _Reader(language, program, dialogue)
    unclear: Unclear | None = None
    for inner, indirect in asking.within(plain):
        try:
            query = reader.query(inner, indirect, asking.patterns)
        except Unclear as found:
            unclear = unclear or found
            continue
        if query is not None:
            return _answer(utterance, query, language, program, dialogue)
    for statement in asking.untagged(tuple(plain)):
        query = reader.facts.statement(statement)
        if query is not None:
            return _answer(utterance, query, language, program, dialogue)
    if unclear is not None:
        raise unclear
    if plain[0] == "why":
        query = Query("why", checkpoint=_latest(dialogue, program))
        return _answer(utterance, query, language, program, dialogue)
    return None


def contrast_asked(
    language: Language,
    utterance: str,
    asking: Asking,
    tokens: Sequence[str],
    program: Automaton,
    dialogue: Dialogue,
) -> tuple[Interpretation, Dialogue] | None:
    """The answer to "why don't you ... first" and the like, which must not be taken for a request."""
    if "why" not in tokens:
        return None
    try:
        answer = answer_to(language, utterance, asking, tokens, program, dialogue)
    except Unclear:
        return None
    query = answer[0].query if answer is not None else None
    contrasts = query is not None and query.kind in FOIL_KINDS
    return answer if contrasts else None


def _answer(
    utterance: str, query: Query, language: Language, program: Automaton, dialogue: Dialogue
) -> tuple[Interpretation, Dialogue]:
    asked = query.checkpoint
    if query.kind == "plan":
        asked = next(
            (t.target for t in program.transitions.values() if t.when and set(query.when) <= set(t.when)), None
        )  # fmt: skip
    about = [*query.entities, query.entity]
    if query.literal is not None:
        about.extend(reversed(query.literal.args))
    state = language.world.initial
    true = [x for x in query.literals if holds(x, state, language.world)]
    if len(true) == 1:
        about.extend(reversed(true[0].args))
    known = tuple(dict.fromkeys(e for e in about if e in language.world.entities))
    after = replace(dialogue, scope=dialogue.scope.after(known), asked=asked)
    return Interpretation(utterance, "answer", query=query), after


_WHO = tuple((word,) for word in ("i", "you", "we", "they", "these", "those", "both"))
"""Who stands behind "have" in a question."""


class _Reader:
    """Reads one question about a program."""

    def __init__(self, language: Language, program: Automaton, dialogue: Dialogue) -> None:
        self._language = language
        self._program = program
        self._dialogue = dialogue
        self._scope = dialogue.scope
        self.facts = FactsAsked(language, dialogue.scope)

    def query(self, tokens: tuple[str, ...], indirect: bool, patterns: Patterns) -> Query | None:
        """What some tokens ask, or None.

        Raises:
            Unclear: it is about something that has several meanings.
        """
        if indirect and tokens[0] in ("if", "whether"):
            return self.facts.whether(tokens[1:])
        mentions = self._language.mentions(tokens)
        unclear: Unclear | None = None
        for match in patterns.matches(tokens, mentions, self._program, self._dialogue.touched):
            try:
                query = self._matched(match, tokens)
            except Unclear as found:
                unclear = unclear or found
                continue
            except Misfit:
                continue
            if query is not None:
                return query
        if unclear is not None:
            raise unclear
        if tokens[0] in SET_WORDS:
            return self.facts.which(tokens)
        if tokens[0] == "have" and tokens[1:2] not in _WHO and "been" not in tokens:
            return None  # "Have the fridge opened" asks for it.
        if tokens[0] in AUXILIARIES or tokens[0] in DOING:
            return self.facts.inverted(tokens)
        return None

    # Wordings

    def _matched(self, match: Match, tokens: tuple[str, ...]) -> Query | None:
        slots, intent = match.slots, cast(QueryKind, match.intent)
        if intent == "people":
            people = tuple(e.name for e in self._language.world.of_type("person"))
            return Query("list", entities=people, noun="people")
        if intent in _BARE:
            return Query(intent)
        if intent in _ABOUT_STEPS:
            return self._about_step(intent, str(slots["k"]))
        if intent == "next":
            return Query("next", checkpoint=self._dialogue.asked)
        if intent == "plan":
            return self._case(slots, tokens)
        if intent in FOILS:
            return foil(match, tokens, self._goals, self._language.world)
        if intent == "what-if-never":
            return never(match, tokens, self._condition)
        if intent == "is-it":
            span = span_of(slots["f"])
            statement = tokens[span[0] : span[1]]
            thing = slots.get("x")
            if isinstance(thing, Mention):
                statement = (*tokens[thing.start : thing.end], "is", *statement)
            return self.facts.whether(statement)
        if intent in _ABOUT_GOALS:
            return self._about_goals(intent, slots, tokens)
        mention = slots["x"]
        assert isinstance(mention, Mention)
        return self._about_entity(intent, mention, tokens)

    def _condition(self, part: tuple[str, ...]) -> tuple[Literal, ...]:
        return condition_in(self._language, part, (0, len(part)), self._scope)

    def _case(self, slots: dict[str, object] | object, tokens: tuple[str, ...]) -> Query | None:
        assert isinstance(slots, dict)
        span = span_of(slots.get("c") or slots.get("f"))
        part = tokens[span[0] : span[1]]
        literals = condition_in(self._language, part, (0, len(part)), self._scope, "c" in slots)
        return Query("plan", when=literals) if literals else None

    def _about_step(self, intent: QueryKind, checkpoint: str) -> Query:
        """A checkpoint may be called like a thing: "what is home" asks for both."""
        name = self._program.checkpoints[checkpoint].name
        entities = self._language.world.entities.values()
        thing = next((e.name for e in entities if e.spoken == name), "")
        return Query(intent, checkpoint=checkpoint, entity=thing if intent == "checkpoint" else "")

    def _about_goals(
        self, intent: QueryKind, slots: dict[str, object] | object, tokens: tuple[str, ...]
    ) -> Query | None:
        assert isinstance(slots, dict)
        if "g" not in slots:
            return Query(intent, checkpoint=_latest(self._dialogue, self._program))
        if (
            intent == "will" and tokens[0] == "are"
        ):  # "Are you holding the cup?" asks how it is now.
            state = self.facts.inverted(tokens)
            if state is not None:
                return state
        span = span_of(slots["g"])
        goals = self._goals(tokens[span[0] : span[1]])
        return Query(intent, goals=goals) if goals else None

    def _about_entity(
        self, intent: QueryKind, mention: Mention, tokens: tuple[str, ...]
    ) -> Query | None:
        world = self._language.world
        noun = _noun(mention)
        if intent == "list":
            if mention.place is not None or mention.owner:
                return None
            fitting = {c.entity for c in mention.candidates}
            names = tuple(n for n in world.entities if n in fitting)
            counted = tokens[:2] == ("how", "many")
            return Query("list", entities=names, noun=noun, counted=counted) if names else None
        if intent == "meaning":
            if mention.pronoun or mention.place is not None:
                return None
            kind = _kind(noun, world)
            if kind:
                return Query("list", entities=kind, noun=noun)
        names = self._meant(mention)
        if not names:
            return None
        if intent == "contents":
            if any(not _holds_things(world.entities[n].type) for n in names):
                return None
            return Query("contents", entity=names[0], entities=names)
        here = None
        if intent == "meaning":
            by_name = {c.name: c.id for c in self._program.checkpoints.values() if c.id != START}
            here = by_name.get(noun)
        return Query(intent, checkpoint=here, entity=names[0], entities=names, noun=noun)

    def _meant(self, mention: Mention) -> tuple[str, ...]:
        """What is meant; where it may be several things, all of them are answered for."""
        try:
            return self._language.resolver.meant(mention, (), self._scope, condition=True).entities
        except Unclear:
            best = min((c.rank for c in mention.candidates), default=None)
            if best is None:
                raise
            return tuple(c.entity for c in mention.candidates if c.rank == best)

    def _goals(self, part: tuple[str, ...]) -> tuple[Literal, ...]:
        """The goals that some words ask for: "go home", "going home"."""
        found = self._goals_of(part)
        if found:
            return found
        for base in self._language.verbs.bases(part[0], "gerund"):
            found = self._goals_of((base, *part[1:]))
            if found:
                return found
        return ()

    def _goals_of(self, part: tuple[str, ...]) -> tuple[Literal, ...]:
        meant, _ = self._language.said("", part, Automaton(), Dialogue(scope=self._scope))
        if meant.outcome != "applied":
            return ()
        goals = [g for e in meant.edits if isinstance(e, AddCheckpoint) for g in e.checkpoint.goals]
        return tuple(dict.fromkeys(x for goal in goals for x in literals_in(goal)))


def _holds_things(kind: str) -> bool:
    return kind in ("surface", "container", "region", "person")


def _kind(noun: str, world: World) -> tuple[str, ...]:
    """The members of a kind that a word names, singular or plural, where no entity is called so."""
    if any(noun == e.spoken for e in world.entities.values()):
        return ()
    for word in (noun, noun.removesuffix("s"), noun.removesuffix("es")):
        members = world.kinds.get(word.replace(" ", "-"), frozenset())
        if len(members) > 1:
            return tuple(n for n in world.entities if n in members)
    return ()


def _noun(mention: Mention) -> str:
    """The words of a mention without "the", "all the" and the like."""
    words = mention.text.split()
    while len(words) > 1 and words[0] in _SMALL:
        words = words[1:]
    return " ".join(words)


def _latest(dialogue: Dialogue, program: Automaton) -> str | None:
    for checkpoint in (dialogue.asked, dialogue.here):
        if checkpoint in program.checkpoints:
            return checkpoint
    return None
