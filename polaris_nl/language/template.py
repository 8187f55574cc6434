"""Wordings: what can be said, as small patterns.

`(bring|fetch) {o} [over] to {s}` is words, a choice, an optional part and slots. `<list>` stands
for a list of the grammar. A slot `{p:person}` names the type it takes, another one takes the type
of the predicate's parameter.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Protocol, TypeVar

from polaris_nl.language.tokens import phrase
from polaris_nl.model.errors import GrammarError, did_you_mean

NAMED = "named"
"""The type of a slot that takes a name without "the" only, of whatever type its parameter has: "she's home",
but not "she isn't the kitchen"."""

_SYMBOL = re.compile(r"[()|\[\]]|\{[\w:-]*\}|<[\w-]*>|[{}<>]|[^\s()|\[\]{}<>]+")


@dataclass(frozen=True, slots=True)
class Word:
    """One word."""

    text: str


@dataclass(frozen=True, slots=True)
class Slot:
    """A place for a mention; `type` is "" where the predicate's parameter decides."""

    name: str
    type: str = ""

    def types(self, parameters: Mapping[str, tuple[str, ...]]) -> tuple[str, ...]:
        """The types of what can stand here, for the types of the predicate's parameters."""
        own = self.type and self.type != NAMED
        return (self.type,) if own else parameters.get(self.name, ())


@dataclass(frozen=True, slots=True)
class Choice:
    """One of several sequences; an empty one makes it optional."""

    options: tuple[Parts, ...]


Part = Word | Slot | Choice


@dataclass(frozen=True, slots=True)
class Source:
    """Where a wording is written, and how."""

    path: Path
    line: int
    text: str


@dataclass(frozen=True, slots=True)
class Parts:
    """Parts, one after the other.

    Attributes:
        source: where a whole wording is written; None for its inner parts, and for one that was
            made.
        states: how it is matched; made when it is first needed.
    """

    parts: tuple[Part, ...]
    source: Source | None = field(default=None, compare=False, repr=False)
    states: list[_State] = field(default_factory=list, compare=False, repr=False)


class Lists(Mapping[str, str]):
    """Wordings that others use as `<name>`, by name; each is parsed once, when it is first used."""

    def __init__(self, texts: Mapping[str, str] | None = None) -> None:
        self._texts = dict(texts or {})
        self._parts: dict[str, tuple[Part, ...]] = {}
        self._open: list[str] = []

    def __getitem__(self, name: str) -> str:
        return self._texts[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._texts)

    def __len__(self) -> int:
        return len(self._texts)

    def parts(self, name: str, where: str) -> tuple[Part, ...]:
        """What a list stands for.

        Args:
            name: the list.
            where: the wording that uses it.

        Raises:
            GrammarError: it is unknown, uses itself, or can't be read.
        """
        if name not in self._texts:
            raise GrammarError(
                f"There is no list <{name}> for {where!r}.{did_you_mean(name, self._texts)}"
            )
        if name in self._open:
            raise GrammarError(f"The list <{name}> contains itself; write its words out.")
        if name not in self._parts:
            self._open.append(name)
            try:
                self._parts[name] = _whole(self._texts[name], self)
            finally:
                self._open.pop()
        return self._parts[name]


NO_LISTS = Lists()


def parse_template(text: str, lists: Lists = NO_LISTS, source: Source | None = None) -> Parts:
    """Reads a wording.

    Raises:
        GrammarError: a bracket is open, or a list is unknown.
    """
    return Parts(_whole(text, lists), source)


def _whole(text: str, lists: Lists) -> tuple[Part, ...]:
    symbols = _SYMBOL.findall(text)
    parts, rest = _sequence(symbols, 0, text, lists)
    if rest == len(symbols):
        return parts
    if symbols[rest] == "|":
        raise GrammarError(f"The | in {text!r} stands in no brackets; write (this|that).")
    raise GrammarError(f"There is one closing bracket too many in {text!r}; take it out.")


def _sequence(
    symbols: Sequence[str], at: int, text: str, lists: Lists
) -> tuple[tuple[Part, ...], int]:
    parts: list[Part] = []
    while at < len(symbols) and symbols[at] not in (")", "]", "|"):
        symbol = symbols[at]
        at += 1
        if symbol in "([":
            choice, at = _choice(symbols, at, symbol, text, lists)
            parts.append(choice)
        elif symbol in "{}<>":
            raise GrammarError(
                f"The {symbol} in {text!r} is never closed or opened; write {{slot}} or <list>."
            )
        elif symbol.startswith("{"):
            name, _, kind = symbol[1:-1].partition(":")
            parts.append(Slot(name, kind))
        elif symbol.startswith("<"):
            parts.extend(lists.parts(symbol[1:-1], text))
        else:
            parts.extend(_words(symbol))
    return tuple(parts), at


@cache
def _words(symbol: str) -> tuple[Word, ...]:
    return tuple(Word(word) for word in phrase(symbol))


def _choice(
    symbols: Sequence[str], at: int, opening: str, text: str, lists: Lists
) -> tuple[Choice, int]:
    closing = ")" if opening == "(" else "]"
    options = []
    while True:
        parts, at = _sequence(symbols, at, text, lists)
        options.append(Parts(parts))
        if at >= len(symbols):
            raise GrammarError(f"A {opening} is never closed in {text!r}; add the {closing}.")
        at += 1
        if symbols[at - 1] == closing:
            break
        if symbols[at - 1] != "|":
            raise GrammarError(
                f"A {opening} is closed by {symbols[at - 1]} in {text!r}; write {closing}."
            )
    if closing == "]":
        options.append(Parts(()))
    return Choice(tuple(options)), at


Filler = TypeVar("Filler")
Bound = tuple[tuple[str, object], ...]


class Fillers(Protocol):
    """What can stand in a slot at a position: (end, value)."""

    def __call__(self, slot: Slot, at: int) -> Iterable[tuple[int, object]]:
        """The values that start at a position, with where they end."""
        ...


@dataclass(slots=True)
class _State:
    """A place in a wording: what can come next, and where that leads.

    Attributes:
        words: by word, the place after it.
        slots: the slots that can come next, each with the place after it.
        final: the wording may end here.
    """

    words: dict[str, _State] = field(default_factory=dict)
    slots: tuple[tuple[Slot, _State], ...] = ()
    final: bool = False


def prepare(template: Parts) -> None:
    """Turns a wording into states, which the first match does otherwise."""
    if not template.states:
        template.states.append(_states(template.parts, _State(final=True)))


def match(
    template: Parts, tokens: Sequence[str], at: int, fillers: Fillers
) -> Iterator[tuple[int, Bound]]:
    """Every way in which a wording matches tokens from a position: its end, and what fills its slots.

    A wording is turned into states once, in which a word leads to one place at most: long lists of
    alternatives cost a look-up, not a try each.
    """
    prepare(template)
    seen = set()
    waiting: list[tuple[_State, int, Bound]] = [(template.states[0], at, ())]
    size = len(tokens)
    while waiting:
        state, here, bound = waiting.pop()
        if state.final:
            key = (here, tuple((name, id(value)) for name, value in bound))
            if key not in seen:
                seen.add(key)
                yield here, bound
        for slot, following in state.slots:
            for end, value in fillers(slot, here):
                waiting.append((following, end, (*bound, (slot.name, value))))
        if here < size:
            after = state.words.get(tokens[here])
            if after is not None:
                waiting.append((after, here + 1, bound))


def _states(parts: Sequence[Part], following: _State) -> _State:
    """The place in front of some parts, behind which comes `following`."""
    for part in reversed(parts):
        if isinstance(part, Word):
            following = _State({part.text: following})
        elif isinstance(part, Slot):
            following = _State(slots=((part, following),))
        else:
            options = [_states(option.parts, following) for option in part.options]
            following = _merged(options, {})
    return following


def _merged(states: Sequence[_State], known: dict[frozenset[int], _State]) -> _State:
    """One place for several that a wording can be in at once."""
    distinct = list({id(s): s for s in states}.values())
    if len(distinct) == 1:
        return distinct[0]
    key = frozenset(map(id, distinct))
    if key in known:
        return known[key]
    merged = known[key] = _State(final=any(s.final for s in distinct))
    merged.slots = tuple(slot for s in distinct for slot in s.slots)
    ways: dict[str, list[_State]] = {}
    for state in distinct:
        for word, after in state.words.items():
            ways.setdefault(word, []).append(after)
    merged.words = {word: _merged(afters, known) for word, afters in ways.items()}
    return merged


def words_behind(template: Parts) -> frozenset[str] | None:
    """The words that can come first, or right behind a slot that comes first; None where anything can."""
    prepare(template)
    state = template.states[0]
    if state.final or any(after.slots or after.final for _, after in state.slots):
        return None
    return frozenset(state.words).union(*(after.words for _, after in state.slots))


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


def slots_in(template: Parts) -> Iterator[Slot]:
    """Every slot of a wording."""
    for part in template.parts:
        if isinstance(part, Slot):
            yield part
        elif isinstance(part, Choice):
            for option in part.options:
                yield from slots_in(option)
