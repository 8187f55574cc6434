"""Reads an utterance as the answer to the question that is open."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from polaris_nl.automaton.automaton import Automaton
from polaris_nl.language.commands import Commands
from polaris_nl.language.corrections import Corrections
from polaris_nl.language.dialogue import Dialogue, Pending
from polaris_nl.language.interpretation import Interpretation
from polaris_nl.language.protocol import Language, Meant
from polaris_nl.language.references import References
from polaris_nl.language.rereading import with_phrase
from polaris_nl.language.scope import Unclear
from polaris_nl.language.tokens import words


@dataclass(frozen=True, slots=True)
class PendingReply:
    """What is said while a question is open.

    Attributes:
        utterance: what was said or typed.
        bare: its tokens without fillers.
        pending: the question.
        program: the program that it is about.
        dialogue: what was said before, without the question.
    """

    utterance: str
    bare: Sequence[str]
    pending: Pending
    program: Automaton
    dialogue: Dialogue


class Answering:
    """Reads answers for the language side of one world.

    Args:
        language: its other parts.
        commands: which take precedence over steps.
        corrections: "no, the plate" answers, too.
        references: finds the steps that an answer names.
    """

    def __init__(
        self,
        language: Language,
        commands: Commands,
        corrections: Corrections,
        references: References,
    ) -> None:
        self._language = language
        self._commands = commands
        self._corrections = corrections
        self._references = references
        common = language.grammar.common
        self._connectives = tuple(
            words
            for mark in ("if", "until", "unless", "else")
            for words in common.connectives[mark]
        )

    def answered(self, reply: PendingReply) -> Meant | None:
        """Reads a reply as the answer to the open question, or None where it is something else."""
        pending, dialogue = reply.pending, reply.dialogue
        if pending.kind == "part":
            return self._agreed(reply)
        if pending.kind == "then" and tuple(reply.bare) not in self._language.questions.neither:
            return self._done_then(reply)
        try:
            chosen = self._chosen(reply)
        except Unclear as unclear:
            narrowed = Unclear(
                unclear.about, unclear.options, pending.phrase, pending.types, pending.number
            )
            meant, after = self._language.asked(pending.utterance, narrowed, dialogue)
            return replace(meant, utterance=reply.utterance), after
        if chosen is None:
            return self._asked_again(reply)
        if not chosen:
            scope = replace(dialogue.scope, choices={})
            return _left_out(reply.utterance), replace(dialogue, scope=scope)
        choices = {**dialogue.scope.choices, pending.phrase: chosen}
        answered = replace(dialogue, scope=replace(dialogue.scope, choices=choices))
        meant, after = self._language.interpret(pending.utterance, reply.program, answered)
        if after.pending is None:  # Another question of the same utterance needs this answer again.
            scope = after.scope
            fresh = [
                c for c in chosen if c in self._language.world.entities and c not in scope.referents
            ]
            for name in fresh:
                scope = scope.after((name,))
            after = replace(after, scope=replace(scope, choices={}))
        return replace(meant, utterance=reply.utterance), after

    def _agreed(self, reply: PendingReply) -> Meant | None:
        """The part that was understood, after a yes; None where something else was said."""
        told = self._commands.meant(reply.bare)
        if (told is not None and told.commands == ("yes",)) or tuple(reply.bare) in _ONLY_THAT:
            meant, after = self._language.interpret(
                reply.pending.utterance, reply.program, reply.dialogue
            )
            return replace(meant, utterance=reply.utterance), after
        if told is not None and told.commands == ("no",):
            return _left_out(reply.utterance), reply.dialogue
        return None

    def _done_then(self, reply: PendingReply) -> Meant | None:
        """The condition that came alone with what is to be done then, or None for something else."""
        bare, pending = reply.bare, reply.pending
        begins = any(tuple(bare[: len(words)]) == words for words in self._connectives)
        if begins or self._commands.meant(bare) is not None:
            return None
        whole = f"{pending.utterance.strip(' .,!?')}, {reply.utterance}"
        meant, after = self._language.interpret(whole, reply.program, reply.dialogue)
        if meant.outcome not in ("applied", "question") or after.pending == pending:
            return None
        return replace(meant, utterance=reply.utterance), after

    def _asked_again(self, reply: PendingReply) -> Meant | None:
        """What was asked about is corrected: "Which bowl?" - "No, the plate"."""
        core = self._corrections.core(reply.bare)
        pending = reply.pending
        if not core.strength or pending.kind != "thing" or not self._language.mentions(core.words):
            return None
        if not any(m.end == len(core.words) for m in self._language.mentions(core.words)[0]):
            return None
        tokens = with_phrase(words(pending.utterance), words(pending.phrase), core.words)
        if tokens is None:
            return None
        meant, after = self._language.interpret(" ".join(tokens), reply.program, reply.dialogue)
        if meant.outcome not in ("applied", "question"):
            return None
        return replace(meant, utterance=reply.utterance), after

    def _chosen(self, reply: PendingReply) -> tuple[str, ...] | None:
        """What an answer chooses: () for none of it, None where it is no answer.

        Raises:
            Unclear: it may be the answer, but has several meanings.
        """
        bare, pending = reply.bare, reply.pending
        core = self._corrections.core(bare)
        for tokens in (bare, core.words) if core.words != list(bare) else (bare,):
            chosen = self._language.questions.choice(
                tokens, pending, self._language.mentions, reply.dialogue.scope
            )
            if chosen is None and pending.kind == "step":
                chosen = self._chosen_step(tokens, pending, reply.program)
            if chosen is not None:
                return chosen
        return None

    def _chosen_step(
        self, tokens: Sequence[str], pending: Pending, program: Automaton
    ) -> tuple[str, ...] | None:
        ids = {i for _, i in pending.options}
        for found in self._references.at(tokens, 0, program, (), self._language.mentions(tokens)):
            fitting = [i for i in found.ids if i in ids]
            if found.end == len(tokens) and len(fitting) == 1:
                return (fitting[0],)
        return None


def _left_out(utterance: str) -> Interpretation:
    return Interpretation(utterance, "answer", "All right, I left that out. Say it another way.")


_ONLY_THAT = (("only", "that"), ("just", "that"), ("that",), ("that", "only"), ("only", "this"))
