"""What was said last, with other words in it; and the edits from one program to another."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

from polaris_nl.automaton.automaton import START, Automaton
from polaris_nl.automaton.edits import (
    Edit,
    RenameCheckpoint,
    ReplaceProgram,
    SetConditional,
    SetGoals,
    apply_all,
)
from polaris_nl.language.changes import NOTHING_CHANGES, MeantThen
from polaris_nl.language.dialogue import Dialogue
from polaris_nl.language.interpretation import Interpretation
from polaris_nl.language.patterns import Match
from polaris_nl.language.protocol import Language
from polaris_nl.language.references import References
from polaris_nl.language.scope import Unclear
from polaris_nl.model.errors import EditError

_ARTICLES = ("a", "an", "the", "one", "some")


def edits_between(now: Automaton, wanted: Automaton) -> list[Edit]:
    """The edits that make one program of another; a new program where its shape is another one."""
    if now == wanted:
        return []
    edits: list[Edit] = []
    for checkpoint in wanted.checkpoints.values():
        old = now.checkpoints.get(checkpoint.id)
        if old is not None and old.goals != checkpoint.goals:
            edits.append(SetGoals(checkpoint.id, checkpoint.goals, checkpoint.action))
        if old is not None and old.name != checkpoint.name:
            edits.append(RenameCheckpoint(checkpoint.id, checkpoint.name))
    for transition in wanted.transitions.values():
        arrow = now.transitions.get(transition.id)
        if arrow is not None and arrow.when != transition.when:
            edits.append(SetConditional(transition.id, transition.when))
    try:
        same = apply_all(now, edits) == wanted
    except EditError:
        same = False
    return edits if same else [ReplaceProgram(wanted)]


def with_words(
    tokens: Sequence[str], number: str, numbers: Mapping[str, int]
) -> Iterator[list[str]]:
    """An utterance with another number: "bring two cups" -> "bring three cups", "bring a cup" too."""
    if not number:
        return
    number = "all the" if number == "all" else number
    counted = [at for at, token in enumerate(tokens) if token in numbers]
    for at in counted:
        yield [*tokens[:at], *number.split(), *tokens[at + 1 :]]
    for at, token in enumerate(tokens[:-1]):
        if token in _ARTICLES and not counted:
            noun = tokens[at + 1]
            plural = (
                noun
                if noun.endswith("s")
                else noun + ("es" if noun.endswith(("x", "ch", "sh")) else "s")
            )
            yield [*tokens[:at], *number.split(), plural, *tokens[at + 2 :]]
            if at + 2 < len(tokens):  # "The blue cup" -> "three cups".
                yield [*tokens[:at], *number.split(), tokens[at + 2] + "s", *tokens[at + 3 :]]


def with_phrase(tokens: Sequence[str], old: Sequence[str], new: Sequence[str]) -> list[str] | None:
    """Tokens with some words in the place of others, or None where those aren't there."""
    size = len(old)
    for at in range(len(tokens) - size + 1):
        if size and list(tokens[at : at + size]) == list(old):
            return [*tokens[:at], *new, *tokens[at + size :]]
    return None


class Rereading:
    """Reads the latest utterance again with something else in it, for the language side of one world."""

    def __init__(self, language: Language, references: References) -> None:
        self._language = language
        self._references = references
        self._numbers = language.grammar.common.numbers

    def said(
        self, utterance: str, tokens: Sequence[str], program: Automaton, dialogue: Dialogue
    ) -> MeantThen | None:
        """Several steps in the place of those that were said last."""
        latest = dialogue.latest
        if latest is None or latest.after != program or latest.intent:
            return None
        before = replace(latest.dialogue, scope=dialogue.scope)
        found, after = self._language.said(utterance, tokens, latest.before, before)
        if found.outcome != "applied":
            return (found, dialogue) if found.outcome == "refused" else (found, after)
        edits = edits_between(program, apply_all(latest.before, found.edits))
        return replace(found, edits=tuple(edits)), after

    def edited(
        self, utterance: str, words: Sequence[str], program: Automaton, dialogue: Dialogue
    ) -> MeantThen | None:
        """Another checkpoint in the place of the one that the latest edit named: "no, the first one"."""
        latest = dialogue.latest
        if latest is None or latest.after != program or not latest.spans:
            return None
        slot = next(iter(latest.spans))
        start, end = latest.spans[slot]
        before = latest.before
        mentions = self._language.mentions(words)
        whole = [
            r
            for r in self._references.at(words, 0, before, latest.dialogue.touched, mentions)
            if r.end == len(words)
        ]
        if whole and whole[0].ids != (START,):
            tokens = [*latest.tokens[:start], *words, *latest.tokens[end:]]
        elif latest.intent == "rename" and words and _all_new(words, self._language):
            new = self._language.edited(utterance, words, program, dialogue)
            if new is not None:
                return new
            tokens = [*latest.tokens[:end], *words]
        else:
            return None
        again = self._language.edited(utterance, tokens, before, latest.dialogue)
        if again is None or again[0].outcome != "applied":
            return again and (again[0], dialogue)
        found, after = again
        edits = edits_between(program, apply_all(before, found.edits))
        if not edits:
            return Interpretation(utterance, "answer", NOTHING_CHANGES), dialogue
        return replace(found, edits=tuple(edits)), after

    def counted(
        self, match: Match, program: Automaton, dialogue: Dialogue
    ) -> tuple[list[Edit], str] | None:
        """The latest utterance with another number in it: "no, three"."""
        latest = dialogue.latest
        if latest is None or latest.after != program:
            return None
        number = int(str(match.slots.get("q", 0)))
        word = next((w for w, n in self._numbers.items() if n == number and w.isalpha()), "")
        word = word or next((w for w in ("all", "both") if w in match.tokens), "")
        before = replace(
            latest.dialogue, scope=replace(latest.dialogue.scope, choices=dialogue.scope.choices)
        )
        for tokens in with_words(latest.tokens, word, self._numbers):
            found, _ = self._language.said("", tokens, latest.before, before)
            if found.question is not None:
                raise Unclear(
                    found.question.about, found.question.options, _noun(tokens, word), (), number
                )
            if found.outcome == "applied":
                edits = edits_between(program, apply_all(latest.before, found.edits))
                return (edits, found.say) if edits else ([], NOTHING_CHANGES)
        return None


def _noun(tokens: Sequence[str], word: str) -> str:
    at = list(tokens).index(word)
    return " ".join(tokens[at : at + 2])


def _all_new(words: Sequence[str], language: Language) -> bool:
    """Whether words mean nothing yet, so that they can be a name."""
    if any(mention.end == len(words) for mention in language.mentions(words)[0]):
        return False
    return len(words) <= 4 and all(cut.unknown for cut in language.cuts(words))
