"""What was talked about, what a mention may mean, and why a reading can't be."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

from polaris_nl.model.formula import Quantified


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
