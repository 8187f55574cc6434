"""What is made of an utterance that isn't understood as a whole: a request in it, an offer, a stop."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

from polaris_nl.automaton.automaton import Automaton
from polaris_nl.language.commands import COMMAND_SAYS, SAID_ALONE, Commands
from polaris_nl.language.dialogue import Dialogue, Pending
from polaris_nl.language.interpretation import Interpretation
from polaris_nl.language.parts import LEAST, behind_told, parts, without_told
from polaris_nl.language.patterns import strip
from polaris_nl.language.protocol import Language, Meant
from polaris_nl.language.segment import Segmenter
from polaris_nl.language.spelling import Spelling
from polaris_nl.language.tokens import MOST_WORDS, words

Reads = Callable[[str, Sequence[str], Automaton, Dialogue], Meant]
"""Reads an utterance, of which these tokens are what is to be understood."""
_LEADING = (("and",), ("then",), ("so",), ("but",))
"""Words that go on with what isn't offered."""


class Salvage:
    """The last resorts of the language side of one world.

    Args:
        language: its other parts.
        commands: a stop counts whatever follows it.
        segmenter: finds where a request may begin.
        spelling: what is known, and what mends the rest.
        reads: reads what was found.
    """

    def __init__(
        self,
        language: Language,
        commands: Commands,
        segmenter: Segmenter,
        spelling: Spelling,
        reads: Reads,
    ) -> None:
        self._language = language
        self._commands = commands
        self._segmenter = segmenter
        self._spelling = spelling
        self._reads = reads

    def behind_told(
        self, utterance: str, tokens: Sequence[str], program: Automaton, dialogue: Dialogue
    ) -> Meant | None:
        """What is asked for behind what is only told, in whatever words; None where nothing is."""
        mentions = self._language.mentions(tokens)
        found = behind_told(tokens, self._segmenter.clauses_in(tokens, mentions), mentions)
        if found is None:
            return None
        start, named = found
        scope = dialogue.scope
        for name in named:
            scope = scope.after((name,))
        heard = replace(dialogue, scope=scope)
        meant, after = self._reads(utterance, tokens[start:], program, heard)
        if meant.outcome == "refused" or meant.command in SAID_ALONE:
            return None
        return replace(meant, aside=(" ".join(tokens[:start]), *meant.aside)), after

    def without_told(self, tokens: Sequence[str]) -> tuple[tuple[str, ...], tuple[str, ...]]:
        """Tokens without what is only told between commas, and that."""
        clauses = self._segmenter.clauses_in(tokens, self._language.mentions(tokens))
        return without_told(tokens, clauses) or (tuple(tokens), ())

    def between_commas(
        self, utterance: str, tokens: Sequence[str], program: Automaton, dialogue: Dialogue
    ) -> Meant | None:
        """What is asked for without what is only told before or behind a comma; None where nothing is."""
        kept, aside = self.without_told(tokens)
        if not aside:
            return None
        meant, after = self._reads(utterance, kept, program, dialogue)
        if meant.outcome == "refused" or meant.command in SAID_ALONE:
            return None
        return replace(meant, aside=(*aside, *meant.aside)), after

    def halting(self, utterance: str, tokens: Sequence[str]) -> Interpretation | None:
        """A stop or pause with words that aren't understood; where it is heard, the quick words act on it."""
        found = self._commands.halting(tokens)
        if found is None:
            return None
        command, rest = found
        return Interpretation(
            utterance, "command", COMMAND_SAYS[command], command=command, aside=(rest,)
        )

    def offered(self, refused: Interpretation, program: Automaton, dialogue: Dialogue) -> Meant:
        """A refusal with the part of the utterance that can be understood, to be done after a yes.

        Args:
            refused: what an utterance was taken to mean.
            program: the program it is about.
            dialogue: what was said before it, and that it was refused.
        """
        tokens = self._spelling.mended(words(refused.utterance), program)
        if refused.refusal is None or not LEAST < len(tokens) <= MOST_WORDS:
            return refused, dialogue
        clauses = self._segmenter.clauses_in(tokens, self._language.mentions(tokens))
        fillers = self._language.grammar.common.fillers
        for part in parts(tokens, clauses, self._spelling.known):
            text = " ".join(strip(part, (*fillers, *_LEADING)))
            meant, _ = self._reads(text, part, program, dialogue)
            if meant.outcome == "applied" or meant.query is not None or meant.command == "undo":
                reason = refused.refusal.reason.removesuffix(self._language.examples()).rstrip()
                say = f'{reason} Did you mean only "{text}"?'
                pending = Pending(text, "", kind="part")
                return replace(
                    refused, say=say, refusal=replace(refused.refusal, reason=say)
                ), replace(dialogue, pending=pending)
        return refused, dialogue
