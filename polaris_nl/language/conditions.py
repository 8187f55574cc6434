"""The facts that some words state: "she dismisses it", "if the fridge is open"."""

from __future__ import annotations

from collections.abc import Sequence

from polaris_nl.language.protocol import Language
from polaris_nl.language.scope import Misfit, Scope, Unclear
from polaris_nl.language.segment import Cut
from polaris_nl.model.formula import Literal


def condition_in(
    language: Language,
    tokens: Sequence[str],
    span: object,
    scope: Scope,
    introduced: bool = False,
) -> tuple[Literal, ...]:
    """The literals of a condition in a span of tokens, or none."""
    start, end = span_of(span)
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


def stated(language: Language, cuts: Sequence[Cut], scope: Scope) -> tuple[Literal, ...]:
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


def span_of(value: object) -> tuple[int, int]:
    """What a slot for words of any kind holds: where they start and end."""
    assert isinstance(value, tuple)
    return value[0], value[1]
