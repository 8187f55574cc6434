"""Questions that hold the plan against another one: "why do you ... before ...", "what if she never ..."."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from polaris_nl.language.interpretation import Query, QueryKind
from polaris_nl.language.mention import Mention
from polaris_nl.language.patterns import Match
from polaris_nl.model.formula import Literal
from polaris_nl.model.world import World

FOILS: Mapping[str, tuple[QueryKind, bool]] = {
    "why-first": ("why-first", True),
    "why-before": ("why-before", False),
    "why-not-before": ("why-before", True),
    "why-instead": ("why-instead", False),
    "why-not-instead": ("why-instead", True),
}
"""By intent: the kind of the question, and whether its first goals are the ones that the user has in mind."""
FOIL_KINDS = frozenset(kind for kind, _ in FOILS.values())
_NOBODY = ("nobody", "nothing")
_NEVER = (
    ("never",), ("does", "not", "ever"), ("do", "not", "ever"), ("does", "not"), ("do", "not"), ("will", "not"),
    ("is", "never"), ("is", "not"), ("are", "not"), ("has", "not"),
)  # fmt: skip

Words = tuple[str, ...]


def foil(
    match: Match, tokens: Words, goals_of: Callable[[Words], tuple[Literal, ...]], world: World
) -> Query | None:
    """The question that a wording of an intent in `FOILS` asks, or None where its goals are none.

    Args:
        match: the wording, with spans for goals and a mention for `x`.
        tokens: what was said.
        goals_of: the goals that some words ask for.
        world: whose entities are meant.
    """
    kind, foil_first = FOILS[match.intent]
    goals = goals_of(_words(match.slots["g"], tokens))
    if not goals:
        return None
    others: tuple[Literal, ...] = ()
    if "h" in match.slots:
        others = goals_of(_words(match.slots["h"], tokens))
    elif isinstance(mention := match.slots.get("x"), Mention):
        others = _same_with(goals, mention, world)
    if kind != "why-first" and (not others or set(others) == set(goals)):
        return None
    wanted, held_against = (goals, others) if foil_first else (others, goals)
    return Query(kind, goals=wanted, others=held_against)


def _same_with(goals: Sequence[Literal], mention: Mention, world: World) -> tuple[Literal, ...]:
    """The goals about another thing: "take the cup before the plate"."""
    best = min((c.rank for c in mention.candidates), default=0)
    for name in (c.entity for c in mention.candidates if c.rank == best):
        kind = world.entities[name].type
        changed = []
        for goal in goals:
            at = next((n for n, a in enumerate(goal.args) if _is(a, kind, world)), None)
            if at is not None:
                args = (*goal.args[:at], name, *goal.args[at + 1 :])
                changed.append(Literal(goal.predicate, args, goal.positive))
        if changed:
            return tuple(changed)
    return ()


def _is(name: str, kind: str, world: World) -> bool:
    return name in world.entities and world.entities[name].type == kind


def never(
    match: Match, tokens: Words, condition_of: Callable[[Words], tuple[Literal, ...]]
) -> Query | None:
    """The question of what is done if something never comes about, or None where it may come about.

    Args:
        match: the wording, with a span of words for `f`, if any.
        tokens: what was said.
        condition_of: the facts that some words state.
    """
    if "f" not in match.slots:
        return Query("what-if-never")
    part = _words(match.slots["f"], tokens)
    for stated in _without_never(part):
        facts = condition_of(stated)
        if facts:
            # "She never acknowledges" and "she doesn't acknowledge" leave the fact itself.
            return Query("what-if-never", when=tuple(fact.atom for fact in facts))
    return None


def _without_never(part: Words) -> list[Words]:
    """What the words state without the "never" in them; nothing where there is none."""
    found = []
    if part[0] in _NOBODY or part[:2] == ("no", "one"):
        rest = part[2:] if part[0] == "no" else part[1:]
        rest = rest[1:] if rest[:1] == ("ever",) else rest
        found += [("someone", *rest), ("she", *rest), ("he", *rest), ("it", *rest)]
    for words in _NEVER:
        for at in range(len(part) - len(words) + 1):
            if part[at : at + len(words)] == words:
                verb = words[:1] if words[0] in ("is", "are", "has") else ()
                found.append((*part[:at], *verb, *part[at + len(words) :]))
    return found


def _words(span: object, tokens: Words) -> Words:
    assert isinstance(span, tuple)
    return tokens[span[0] : span[1]]
