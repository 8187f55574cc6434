"""Wordings: what can be said, as small patterns.

`(bring|fetch) {o} [over] to {s}` is words, a choice, an optional part and slots. `<list>` stands
for a list of the grammar. A slot `{p:person}` names the type it takes, another one takes the type
of the predicate's parameter.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol, TypeVar

from polaris_nl.language.tokens import phrase
from polaris_nl.model.errors import GrammarError

_SYMBOL = re.compile(r"[()|\[\]]|\{[^}]*\}|<[^>]*>|[^\s()|\[\]{}<>]+")


@dataclass(frozen=True, slots=True)
class Word:
    """One word."""

    text: str


@dataclass(frozen=True, slots=True)
class Slot:
    """A place for a mention; `type` is "" where the predicate's parameter decides."""

    name: str
    type: str = ""


@dataclass(frozen=True, slots=True)
class Choice:
    """One of several sequences; an empty one makes it optional."""

    options: tuple[Parts, ...]


Part = Word | Slot | Choice


@dataclass(frozen=True, slots=True)
class Parts:
    """Parts, one after the other."""

    parts: tuple[Part, ...]


def parse_template(text: str, lists: Mapping[str, str]) -> Parts:
    """Reads a wording.

    Raises:
        GrammarError: a bracket is open, or a list is unknown.
    """
    symbols = _SYMBOL.findall(text)
    parts, rest = _sequence(symbols, 0, text, lists)
    if rest != len(symbols):
        raise GrammarError(f"There is one closing bracket too many in {text!r}.")
    return Parts(parts)


def _sequence(
    symbols: Sequence[str], at: int, text: str, lists: Mapping[str, str]
) -> tuple[tuple[Part, ...], int]:
    parts: list[Part] = []
    while at < len(symbols) and symbols[at] not in (")", "]", "|"):
        symbol = symbols[at]
        at += 1
        if symbol in "([":
            choice, at = _choice(symbols, at, symbol, text, lists)
            parts.append(choice)
        elif symbol.startswith("{"):
            name, _, kind = symbol[1:-1].partition(":")
            parts.append(Slot(name, kind))
        elif symbol.startswith("<"):
            if symbol[1:-1] not in lists:
                raise GrammarError(f"There is no list {symbol} for {text!r}.")
            parts.extend(parse_template(lists[symbol[1:-1]], lists).parts)
        else:
            parts.extend(Word(word) for word in phrase(symbol))
    return tuple(parts), at


def _choice(
    symbols: Sequence[str], at: int, opening: str, text: str, lists: Mapping[str, str]
) -> tuple[Choice, int]:
    closing = ")" if opening == "(" else "]"
    options = []
    while True:
        parts, at = _sequence(symbols, at, text, lists)
        options.append(Parts(parts))
        if at >= len(symbols):
            raise GrammarError(f"A bracket is never closed in {text!r}.")
        at += 1
        if symbols[at - 1] == closing:
            break
        if symbols[at - 1] != "|":
            raise GrammarError(f"A bracket is closed by the wrong one in {text!r}.")
    if closing == "]":
        options.append(Parts(()))
    return Choice(tuple(options)), at


Filler = TypeVar("Filler")
Bound = tuple[tuple[str, object], ...]


class Fillers(Protocol):
    """What can stand in a slot at a position: (end, value)."""

    def __call__(self, slot: Slot, at: int) -> Iterator[tuple[int, object]]:
        """The values that start at a position, with where they end."""
        ...


def match(
    template: Parts, tokens: Sequence[str], at: int, fillers: Fillers
) -> Iterator[tuple[int, Bound]]:
    """Every way in which a wording matches tokens from a position: its end, and what fills its slots."""
    yield from _match(template.parts, 0, tokens, at, fillers, ())


def _match(
    parts: tuple[Part, ...],
    index: int,
    tokens: Sequence[str],
    at: int,
    fillers: Fillers,
    bound: Bound,
) -> Iterator[tuple[int, Bound]]:
    if index == len(parts):
        yield at, bound
        return
    part = parts[index]
    if isinstance(part, Word):
        if at < len(tokens) and tokens[at] == part.text:
            yield from _match(parts, index + 1, tokens, at + 1, fillers, bound)
    elif isinstance(part, Slot):
        for end, value in fillers(part, at):
            yield from _match(parts, index + 1, tokens, end, fillers, (*bound, (part.name, value)))
    else:
        seen = set()
        for option in part.options:
            for end, inner in _match(option.parts, 0, tokens, at, fillers, bound):
                if (end, inner) not in seen:
                    seen.add((end, inner))
                    yield from _match(parts, index + 1, tokens, end, fillers, inner)


def first_words(template: Parts) -> frozenset[str] | None:
    """The words that a match can start with; None where a slot can stand first."""
    words: set[str] = set()
    return frozenset(words) if _first(template.parts, words) else None


def _first(parts: tuple[Part, ...], words: set[str]) -> bool:
    """Collects first words; False where a slot, or nothing at all, can come first."""
    for part in parts:
        if isinstance(part, Word):
            words.add(part.text)
            return True
        if isinstance(part, Slot):
            return False
        empty = False
        for option in part.options:
            if not option.parts:
                empty = True
            elif not _first(option.parts, words):
                return False
        if not empty:
            return True
    return False


def vocabulary(template: Parts) -> Iterator[str]:
    """Every word of a wording."""
    for part in template.parts:
        if isinstance(part, Word):
            yield part.text
        elif isinstance(part, Choice):
            for option in part.options:
                yield from vocabulary(option)
