"""Questions by the user: they are answered and never change anything."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

from polaris_nl.automaton.automaton import Automaton
from polaris_nl.language.dialogue import Dialogue
from polaris_nl.language.interpretation import Interpretation, Query
from polaris_nl.language.mention import Mention
from polaris_nl.language.patterns import Match
from polaris_nl.language.resolve import Misfit, Scope, Unclear
from polaris_nl.model.formula import Literal

if TYPE_CHECKING:
    from polaris_nl.language.understanding import Understanding

_QUESTION_WORDS = ("is", "are", "does", "do", "has", "was")


def answer_to(
    language: Understanding,
    utterance: str,
    matches: Iterable[Match],
    tokens: Sequence[str],
    program: Automaton,
    dialogue: Dialogue,
) -> Interpretation | None:
    """The answer that a question asks for, or None where the utterance is no question.

    Raises:
        Unclear: it is about something that has several meanings.
    """
    for match in matches:
        query = _query(language, match, tokens, dialogue)
        if query is not None:
            return Interpretation(utterance, "answer", query=query)
    literal = _yes_or_no(language, tokens, dialogue)
    if literal is not None:
        return Interpretation(utterance, "answer", query=Query("is-it", literal=literal))
    if tokens and tokens[0] in ("why",):
        return Interpretation(
            utterance, "answer", query=Query("why", checkpoint=_latest(dialogue, program))
        )
    return None


def _query(
    language: Understanding, match: Match, tokens: Sequence[str], dialogue: Dialogue
) -> Query | None:
    slots = match.slots
    if match.intent in ("world", "problems"):
        return Query(match.intent)  # type: ignore[arg-type]
    if match.intent == "where":
        mention = slots["x"]
        assert isinstance(mention, Mention)
        try:
            entities = language.resolver.meant(mention, (), dialogue.scope).entities
        except Misfit:
            return None
        return Query("where", entity=entities[0])
    if match.intent == "checkpoint":
        return Query("checkpoint", checkpoint=str(slots["k"]))
    if match.intent == "is-it":
        literals = _condition(language, tokens, slots["f"], dialogue.scope)
        return Query("is-it", literal=literals[0]) if literals else None
    if match.intent == "plan":
        literals = _condition(language, tokens, slots["c"], dialogue.scope, introduced=True)
        return Query("plan", when=literals) if literals else None
    if match.intent == "why":
        return None if "g" in slots and not _is_goal(language, tokens, slots["g"]) else Query("why")
    return None


def _condition(
    language: Understanding,
    tokens: Sequence[str],
    span: object,
    scope: Scope,
    introduced: bool = False,
) -> tuple[Literal, ...]:
    """The literals of a condition in a span of tokens, or none."""
    assert isinstance(span, tuple)
    part = list(tokens[span[0] : span[1]])
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


def _is_goal(language: Understanding, tokens: Sequence[str], span: object) -> bool:
    assert isinstance(span, tuple)
    cuts = language.cuts(list(tokens[span[0] : span[1]]))
    return bool(cuts) and not cuts[0].unknown


def _yes_or_no(
    language: Understanding, tokens: Sequence[str], dialogue: Dialogue
) -> Literal | None:
    """`is the cupboard open` is the state "the cupboard is open" with its verb in front."""
    if len(tokens) < 3 or tokens[0] not in _QUESTION_WORDS:
        return None
    rest = list(tokens[1:])
    verb = {"does": [], "do": []}.get(tokens[0], [tokens[0]])
    for at in range(1, len(rest) + 1):
        statement = [*rest[:at], *verb, *rest[at:]]
        literals = _condition(language, statement, (0, len(statement)), dialogue.scope)
        if literals:
            return literals[0]
    return None


def _latest(dialogue: Dialogue, program: Automaton) -> str | None:
    return dialogue.here if dialogue.here in program.checkpoints else None
