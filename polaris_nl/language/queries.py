"""Questions by the user: they are answered and never change anything."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, cast

from polaris_nl.automaton.automaton import START, Automaton
from polaris_nl.automaton.edits import AddCheckpoint
from polaris_nl.language.clauses import Clause
from polaris_nl.language.commands import Softeners
from polaris_nl.language.common import Common
from polaris_nl.language.dialogue import Dialogue
from polaris_nl.language.foils import FOIL_KINDS, FOILS, foil, never
from polaris_nl.language.interpretation import Interpretation, Query, QueryKind
from polaris_nl.language.mention import Candidate, Mention
from polaris_nl.language.patterns import Match, Patterns
from polaris_nl.language.resolve import Misfit, Scope, Unclear
from polaris_nl.language.segment import Cut
from polaris_nl.language.template import first_words
from polaris_nl.language.tokens import BREAK, COMMA
from polaris_nl.model.evaluate import holds
from polaris_nl.model.formula import Literal, literals_in
from polaris_nl.model.world import World

if TYPE_CHECKING:
    from polaris_nl.language.understanding import Understanding

LONGEST = 60
"""Words beyond which an utterance is not taken for a question."""
_AUXILIARIES = ("is", "are", "was", "were", "am", "has", "have", "had")
_DOING = ("does", "do", "did")
_SET_WORDS = ("who", "what", "which", "how")
_VAGUE = {
    "anyone": "someone", "anybody": "someone", "someone": "someone", "somebody": "someone", "people": "people",
    "nobody": "someone", "anything": "something", "something": "something", "nothing": "something",
    "any": "", "some": "", "a": "", "an": "", "no": "",
}  # fmt: skip
"""Words that make "is ... there?" ask whether there is one, with what stands for what is asked."""
_HAVING = (("have",), ("have", "got"), ("got",), ("hold",), ("holding",), ("carry",), ("carrying",))
_BEING_THERE = (
    ("are", "there"),
    ("is", "there"),
    ("there", "are"),
    ("do", "you", "see"),
    ("do", "we", "have"),
)
_SMALL = ("the", "a", "an", "any", "all", "of", "some", "other", "more", "your", "my")
_ABOUT_GOALS = ("why-not", "why", "when", "will", "able")
_ABOUT_STEPS = ("after-step", "before-step", "checkpoint")
_BARE = ("where-robot", "first", "last", "length", "world", "people", "problems")

Found = tuple[tuple[str, ...], bool]
"""Tokens, and whether they follow "I wonder", "tell me" or the like."""


class Asking:
    """Finds the question inside what people say around it.

    Args:
        common: whose words they are.
        patterns: the wordings of the questions.
    """

    def __init__(self, common: Common, patterns: Patterns) -> None:
        self.patterns = patterns
        self._softeners = Softeners(common)
        self._asking = frozenset(common.listed("asking"))
        self._longest = max((len(p) for p in self._asking), default=0)
        self._tags = common.listed("tag")
        wordings = [w for intent in common.of_kind("query") for w in intent.wordings]
        starts = (first_words(wording) or frozenset() for wording in wordings)
        self._first = frozenset((*_AUXILIARIES, *_DOING, *_SET_WORDS)).union(*starts)

    def within(self, tokens: Sequence[str]) -> Iterator[Found]:
        """The tokens as they are, then without more and more of what is around them."""
        waiting: deque[Found] = deque([(tuple(tokens), False)])
        seen: set[Found] = set()
        while waiting:
            start, indirect = waiting.popleft()
            for inner in self._softeners.within(start):
                if (inner, indirect) in seen:
                    continue
                seen.add((inner, indirect))
                if inner[0] in self._first or "what" in inner or indirect:
                    yield inner, indirect
                for size in range(1, min(self._longest, len(inner) - 1) + 1):
                    if inner[:size] in self._asking:
                        waiting.append((inner[size:], True))

    def untagged(self, tokens: tuple[str, ...]) -> Iterator[tuple[str, ...]]:
        """The tokens without "isn't it" at their end."""
        for tag in self._tags:
            if len(tokens) > len(tag) + 1 and tokens[-len(tag) :] == tag:
                yield tokens[: -len(tag)]


def answer_to(
    language: Understanding,
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
        query = reader.statement(statement)
        if query is not None:
            return _answer(utterance, query, language, program, dialogue)
    if unclear is not None:
        raise unclear
    if plain[0] == "why":
        query = Query("why", checkpoint=_latest(dialogue, program))
        return _answer(utterance, query, language, program, dialogue)
    return None


def contrast_asked(
    language: Understanding,
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
    utterance: str, query: Query, language: Understanding, program: Automaton, dialogue: Dialogue
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


class _Reader:
    """Reads one question about a program."""

    def __init__(self, language: Understanding, program: Automaton, dialogue: Dialogue) -> None:
        self._language = language
        self._program = program
        self._dialogue = dialogue
        self._scope = dialogue.scope
        self._known_cuts: dict[tuple[str, ...], list[Cut]] = {}

    def _cuts(self, statement: tuple[str, ...]) -> list[Cut]:
        if statement not in self._known_cuts:
            self._known_cuts[statement] = self._language.cuts(["if", *statement])
        return self._known_cuts[statement]

    def query(self, tokens: tuple[str, ...], indirect: bool, patterns: Patterns) -> Query | None:
        """What some tokens ask, or None.

        Raises:
            Unclear: it is about something that has several meanings.
        """
        if indirect and tokens[0] in ("if", "whether"):
            return self._whether(tokens[1:])
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
        if tokens[0] in _SET_WORDS:
            return self._which(tokens)
        if tokens[0] in _AUXILIARIES or tokens[0] in _DOING:
            return self._inverted(tokens)
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
            span = _span(slots["f"])
            statement = tokens[span[0] : span[1]]
            thing = slots.get("x")
            if isinstance(thing, Mention):
                statement = (*tokens[thing.start : thing.end], "is", *statement)
            return self._whether(statement)
        if intent in _ABOUT_GOALS:
            return self._about_goals(intent, slots, tokens)
        mention = slots["x"]
        assert isinstance(mention, Mention)
        return self._about_entity(intent, mention, tokens)

    def _condition(self, part: tuple[str, ...]) -> tuple[Literal, ...]:
        return _condition(self._language, part, (0, len(part)), self._scope)

    def _case(self, slots: dict[str, object] | object, tokens: tuple[str, ...]) -> Query | None:
        assert isinstance(slots, dict)
        span = _span(slots.get("c") or slots.get("f"))
        part = tokens[span[0] : span[1]]
        literals = _condition(self._language, part, (0, len(part)), self._scope, "c" in slots)
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
            state = self._inverted(tokens)
            if state is not None:
                return state
        span = _span(slots["g"])
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

    # Facts

    def _whether(self, statement: tuple[str, ...]) -> Query | None:
        """`the cupboard is open`, `someone is there`."""
        if not statement:
            return None
        if statement[0] == "there" and statement[1:2] in (("is",), ("are",), ("'s",)):
            found = self._inverted((statement[1], "there", *statement[2:]))
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
        literals = _literals(self._language, self._cuts(statement), self._scope)
        return _is_it(literals) if literals else None

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

    def _inverted(self, tokens: tuple[str, ...]) -> Query | None:
        """`is the cupboard open` is the state "the cupboard is open" with its verb in front."""
        verb = () if tokens[0] in _DOING else ({"am": "are"}.get(tokens[0], tokens[0]),)
        rest = tokens[1:]
        if rest[:1] == ("not",):
            rest = rest[1:]
        there = rest[:1] == ("there",)
        rest = rest[1:] if there else rest
        if not rest:
            return None
        mentions = self._language.mentions(rest)
        ends = sorted({m.end for m in mentions[0]} | {1, 2}, key=lambda end: (end < 3, -end))
        unclear: Unclear | None = None
        for at in ends:
            if at > len(rest) or (at == len(rest) and verb):
                continue
            statement = (*rest[:at], *verb, *rest[at:])
            try:
                query = self._any(statement) if there else self._whether(statement)
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

    def _which(self, tokens: tuple[str, ...]) -> Query | None:
        """`who is in the office`, `which dishes are dirty`, `what does she have`."""
        word, rest = tokens[0], tokens[1:]
        counted = tokens[:2] == ("how", "many")
        if not rest or (word == "how" and not counted):
            return None
        if word == "what" and rest[0] in (*_DOING, *_AUXILIARIES):
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
        elif word == "what" and rest[0] in (*_AUXILIARIES, "'s"):
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


def _condition(
    language: Understanding,
    tokens: Sequence[str],
    span: object,
    scope: Scope,
    introduced: bool = False,
) -> tuple[Literal, ...]:
    """The literals of a condition in a span of tokens, or none."""
    start, end = _span(span)
    part = list(tokens[start:end])
    for cut in language.cuts(part if introduced else ["if", *part]):
        conditions = [i for i in cut.items if i.role == "condition" and i.clause]
        if cut.unknown or not conditions or any(i.role == "goal" for i in cut.items):
            continue
        found: list[Literal] = []
        try:
            for item in conditions:
                assert item.clause is not None
                literals, scope = language.resolver.literals(item.clause, scope, condition=True)
                found.extend(x for x in literals if isinstance(x, Literal))
        except (Unclear, Misfit):
            continue
        return tuple(found)
    return ()


def _literals(language: Understanding, cuts: Sequence[Cut], scope: Scope) -> tuple[Literal, ...]:
    """The literals of a statement that was cut up, or none.

    Raises:
        Unclear: it is about something that has several meanings.
    """
    unclear: Unclear | None = None
    for cut in cuts:
        conditions = [i.clause for i in cut.items if i.role == "condition" and i.clause]
        if cut.unknown or not conditions or any(i.role == "goal" for i in cut.items):
            continue
        found: list[Literal] = []
        after = scope
        try:
            for clause in conditions:
                literals, after = language.resolver.literals(clause, after, condition=True)
                found.extend(x for x in literals if isinstance(x, Literal))
        except Unclear as question:
            unclear = unclear or question
            continue
        except Misfit:
            continue
        if found:
            return tuple(dict.fromkeys(found))
    if unclear is not None:
        raise unclear
    return ()


def _is_it(literals: tuple[Literal, ...]) -> Query:
    return Query("is-it", literal=literals[0], literals=literals if len(literals) > 1 else ())


def _span(value: object) -> tuple[int, int]:
    assert isinstance(value, tuple)
    return value[0], value[1]


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
