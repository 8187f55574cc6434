"""Wordings about the program or the plan, not about the world: edits, questions, corrections."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from polaris_nl.automaton.automaton import Automaton
from polaris_nl.language.intents import Intent
from polaris_nl.language.mention import Mention
from polaris_nl.language.references import Reference, References
from polaris_nl.language.template import Slot, first_words, match, slots_in
from polaris_nl.language.tokens import BREAK, COMMA

Span = tuple[int, int]


@dataclass(frozen=True, slots=True)
class Match:
    """A pattern that takes all of an utterance.

    Attributes:
        intent: its name: `rename`, `where`, ...
        slots: mentions for x and y, checkpoint ids for k and l, a number for q, spans of tokens for
            everything else.
        references: what stands for the checkpoints, by slot; where it fits several, the slot has the
            latest of them.
        tokens: what was matched; the spans are positions in it.
    """

    intent: str
    slots: Mapping[str, object]
    references: Mapping[str, Reference] = field(default_factory=dict)
    tokens: Sequence[str] = ()


class Patterns:
    """The patterns of some intents, in order.

    Args:
        intents: whose wordings they are.
        references: finds the checkpoints that are meant.
        numbers: number words.
    """

    def __init__(
        self, intents: Sequence[Intent], references: References, numbers: Mapping[str, int]
    ) -> None:
        self._references = references
        self._numbers = numbers
        templates = [(intent.name, template) for intent in intents for template in intent.wordings]
        # "What is there" means the world rather than what "there" is.
        self._templates = sorted(templates, key=lambda t: any(slots_in(t[1])))

    def matches(
        self,
        tokens: Sequence[str],
        mentions: Sequence[Sequence[Mention]],
        program: Automaton,
        touched: Sequence[str],
    ) -> Iterator[Match]:
        """Every pattern that takes all of the tokens."""
        known: dict[int, list[Reference]] = {}
        for intent, template in self._templates:

            def fillers(slot: Slot, at: int) -> Iterator[tuple[int, object]]:
                if slot.name in ("k", "l"):
                    if at not in known:
                        found = self._references.at(tokens, at, program, touched, mentions)
                        known[at] = sorted(found, key=lambda r: -r.end)
                    yield from ((reference.end, reference) for reference in known[at])
                elif slot.name == "q":
                    number = self._numbers.get(tokens[at]) if at < len(tokens) else None
                    yield from ((at + 1, number) for _ in range(number is not None))
                else:
                    yield from _others(slot, at, tokens, mentions)

            for end, bound in match(template, tokens, 0, fillers):
                if end == len(tokens):
                    references = {n: v for n, v in bound if isinstance(v, Reference)}
                    ids = {name: found.ids[0] for name, found in references.items()}
                    yield Match(intent, {**dict(bound), **ids}, references, tokens)

    def unnamed(
        self, tokens: Sequence[str], intents: Sequence[str]
    ) -> Iterator[tuple[str, tuple[str, ...]]]:
        """Patterns of some intents that would take all of the tokens if their words named checkpoints.

        Yields:
            The intent, and the words.
        """

        def fillers(slot: Slot, at: int) -> Iterator[tuple[int, object]]:
            for end in range(at + 1, len(tokens) + 1):
                yield end, (at, end)

        for intent, template in self._templates:
            if intent in intents and first_words(template) is not None:
                for end, bound in match(template, tokens, 0, fillers):
                    span = dict(bound).get("k")
                    if end == len(tokens) and isinstance(span, tuple):
                        yield intent, tuple(tokens[span[0] : span[1]])


def _others(
    slot: Slot, at: int, tokens: Sequence[str], mentions: Sequence[Sequence[Mention]]
) -> Iterator[tuple[int, object]]:
    """Mentions for x and y, any words for the other slots."""
    if slot.name in ("x", "y"):
        for mention in mentions[at] if at < len(mentions) else ():
            yield mention.end, mention
    else:
        for end in range(at + 1, len(tokens) + 1):
            yield end, (at, end)


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
            # "For anna, not for me" says whom it isn't for.
            denied = found[-size - 1 : -size] == ["not"]
            if len(found) > size and tuple(found[-size:]) == words and not denied:
                found, changed = found[:-size], True
    return found
