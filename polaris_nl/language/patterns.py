"""Wordings about the program or the plan, not about the world: edits, questions, corrections."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from polaris_nl.automaton.automaton import START, Automaton
from polaris_nl.language.grammar import Common
from polaris_nl.language.mention import Mention
from polaris_nl.language.template import Parts, Slot, match
from polaris_nl.language.tokens import BREAK, COMMA, phrase

Span = tuple[int, int]


@dataclass(frozen=True, slots=True)
class Match:
    """A pattern that takes all of an utterance.

    Attributes:
        intent: the key of its list in the grammar: `rename`, `where`, ...
        slots: mentions for x and y, checkpoint ids for k and l, spans of tokens for everything
            else.
    """

    intent: str
    slots: Mapping[str, object]


class Patterns:
    """The patterns of one section of the shared grammar (`edits`, `queries`)."""

    def __init__(self, common: Common, section: str) -> None:
        self._templates = [
            (intent, template)
            for intent in common.mapping(section)
            for template in common.templates(section, intent)
        ]

    def matches(
        self,
        tokens: Sequence[str],
        mentions: Sequence[Sequence[Mention]],
        program: Automaton,
        touched: Sequence[str],
    ) -> Iterator[Match]:
        """Every pattern that takes all of the tokens."""
        for intent, template in self._templates:
            yield from matches_of(intent, template, tokens, mentions, program, touched)


def matches_of(
    intent: str,
    template: Parts,
    tokens: Sequence[str],
    mentions: Sequence[Sequence[Mention]],
    program: Automaton,
    touched: Sequence[str],
) -> Iterator[Match]:
    """The ways in which one pattern takes all of the tokens."""

    def fillers(slot: Slot, at: int) -> Iterator[tuple[int, object]]:
        if slot.name in ("x", "y"):
            for mention in mentions[at] if at < len(mentions) else ():
                yield mention.end, mention
        elif slot.name in ("k", "l"):
            yield from checkpoints_at(tokens, at, program, touched)
        else:
            for end in range(at + 1, len(tokens) + 1):
                yield end, (at, end)

    for end, bound in match(template, tokens, 0, fillers):
        if end == len(tokens):
            yield Match(intent, dict(bound))


_PART = ("step", "part", "checkpoint", "one", "branch", "bit", "goal")
_ORDINALS = {
    "first": 0,
    "second": 1,
    "third": 2,
    "fourth": 3,
    "fifth": 4,
    "sixth": 5,
    "last": -1,
    "latest": -1,
}


def checkpoints_at(
    tokens: Sequence[str], at: int, program: Automaton, touched: Sequence[str]
) -> Iterator[tuple[int, str]]:
    """Checkpoints that are meant by name, by number or by recency: (end, id)."""
    start = at
    while (
        at < len(tokens)
        and tokens[at] in ("the", "this", "that", "checkpoint", "step")
        and at - start < 2
    ):
        at += 1
    made = [c for c in program.checkpoints if c != START]
    for checkpoint in made:
        name = phrase(program.checkpoints[checkpoint].name)
        if tuple(tokens[at : at + len(name)]) == name:
            end = at + len(name)
            yield end, checkpoint
            if tokens[end : end + 1] and tokens[end] in _PART:
                yield end + 1, checkpoint
    word = tokens[at] if at < len(tokens) else ""
    if word in _ORDINALS and made:
        number = _ORDINALS[word]
        latest = touched[-1] if touched and touched[-1] in made else made[-1]
        chosen = latest if number == -1 else (made[number] if number < len(made) else None)
        if chosen is not None:
            end = at + 1
            while end < len(tokens) and tokens[end] in _PART:
                end += 1
            if end > at + 1:
                yield end, chosen
    if start == at and word in ("it", "that") and touched and touched[-1] in made:
        yield at + 1, touched[-1]
    elif at == start + 1 and tokens[start] in ("that", "this") and touched and touched[-1] in made:
        yield at, touched[-1]


def strip(tokens: Sequence[str], fillers: Sequence[tuple[str, ...]]) -> list[str]:
    """Tokens without marks and fillers at either end."""
    found = list(tokens)
    changed = True
    while changed and found:
        changed = False
        if found[0] in (BREAK, COMMA):
            found, changed = found[1:], True
        if found and found[-1] in (BREAK, COMMA):
            found, changed = found[:-1], True
        for words in fillers:
            size = len(words)
            if len(found) > size and tuple(found[:size]) == words:
                found, changed = found[size:], True
            if len(found) > size and tuple(found[-size:]) == words:
                found, changed = found[:-size], True
    return found
