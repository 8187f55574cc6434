"""Mentions: noun phrases and pronouns as typed slots, before it is known which entity is meant."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal as OneOf

Quantifier = OneOf["", "all", "both", "some", "rest", "none"]


EVERYTHING = "everything"
"""The type of a slot that takes no words and stands for all that is in the place named beside it."""

SPEAKER = "speaker"
"""The type of a slot that takes no words and stands for the one who speaks: "bring it here"."""

ASKED = "asked"
"""The type of a slot that takes no words and is asked for: "bring the cup" lacks where to."""

SPOKEN_OF = "spoken-of"
"""The type of a slot that takes no words and stands for what was spoken of last: "put it inside"."""

WORDLESS = (EVERYTHING, SPEAKER, ASKED, SPOKEN_OF)
"""The types of slots that take no words."""


@dataclass(frozen=True, slots=True)
class Candidate:
    """An entity that a phrase may mean.

    Attributes:
        rank: 0 for its own name, 1 for a synonym or noun with adjectives, 2 for its bare noun, 3 for its type.
    """

    entity: str
    rank: int


@dataclass(frozen=True, slots=True)
class Mention:
    """Words that stand for one entity, or for several.

    Attributes:
        start, end: the tokens, the end exclusive.
        text: the words.
        candidates: what may be meant, all types; empty for a pronoun.
        pronoun: the pronoun, or "".
        quantifier: `all` for every one of a kind, `both` for each of several, `some` for a number of
            them, `rest` for those of which nothing was said yet, `none` for none of them.
        number: how many, where said, or 0.
        plural: the noun stands in the plural.
        kind: the kind or noun that a quantifier runs over, or "".
        owner: whose it is: an entity's name, `female`, `male`, `user` or `any` for a possessive, or "".
        other: "the other one".
        states: what adjectives say of it: (predicate, positive).
        parts: the mentions of a list ("the cup and the plate").
        alternative: the list is joined by "or".
        place: where it is said to be: "the cup on the counter", "from the sink".
        beside: it is described by what is near it.
        excepted: what is left out: "all the cups but the red one".
    """

    start: int
    end: int
    text: str
    candidates: tuple[Candidate, ...] = ()
    pronoun: str = ""
    quantifier: Quantifier = ""
    number: int = 0
    plural: bool = False
    kind: str = ""
    owner: str = ""
    other: bool = False
    states: tuple[tuple[str, bool], ...] = ()
    parts: tuple[Mention, ...] = ()
    alternative: bool = False
    place: Mention | None = None
    beside: bool = False
    excepted: Mention | None = None
