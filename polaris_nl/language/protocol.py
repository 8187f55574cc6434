"""What the ways to understand an utterance need of the whole: words, names, cuts, and one another.

`understanding.Understanding` is the one that there is. The parts are given it by this protocol, so that
imports go one way.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from polaris_nl.automaton.automaton import Automaton
from polaris_nl.language.dialogue import Dialogue
from polaris_nl.language.grammar import Grammar
from polaris_nl.language.interpretation import Interpretation
from polaris_nl.language.mention import Mention
from polaris_nl.language.naming import Names
from polaris_nl.language.questions import Questions
from polaris_nl.language.resolve import Resolver
from polaris_nl.language.scope import Unclear
from polaris_nl.language.segment import Cut
from polaris_nl.language.verbs import Verbs
from polaris_nl.language.wording import GrammarWording
from polaris_nl.model.world import World

Meant = tuple[Interpretation, Dialogue]
"""The meaning of an utterance, and the dialogue after it."""


class Language(Protocol):
    """The language side of one world."""

    world: World
    grammar: Grammar
    wording: GrammarWording
    resolver: Resolver
    names: Names
    questions: Questions
    verbs: Verbs

    def interpret(
        self, utterance: str, program: Automaton, dialogue: Dialogue | None = None
    ) -> Meant:
        """The meaning of an utterance."""
        ...

    def edited(
        self, utterance: str, tokens: Sequence[str], program: Automaton, dialogue: Dialogue
    ) -> Meant | None:
        """Tokens as an edit of what is there; None where they are none."""
        ...

    def said(
        self, utterance: str, tokens: Sequence[str], program: Automaton, dialogue: Dialogue
    ) -> Meant:
        """Tokens as steps of the program."""
        ...

    def asked(self, utterance: str, unclear: Unclear, dialogue: Dialogue) -> Meant:
        """The question that an unclear mention needs."""
        ...

    def refused(self, utterance: str, reason: str, unknown: Sequence[str] = ()) -> Interpretation:
        """A refusal with its reason."""
        ...

    def asks_for(self, tokens: Sequence[str]) -> bool:
        """Whether tokens as a whole are one imperative."""
        ...

    def cuts(self, tokens: Sequence[str]) -> list[Cut]:
        """The best ways to cut tokens into clauses."""
        ...

    def mentions(self, tokens: Sequence[str]) -> list[tuple[Mention, ...]]:
        """The mentions that start at each position."""
        ...

    def examples(self) -> str:
        """What can be said, by examples."""
        ...
