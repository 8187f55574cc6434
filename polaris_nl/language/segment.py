"""Cuts an utterance into clauses and connectives: the cheapest way to account for every word.

A shortest-path search over positions (Viterbi), since recognised speech has no punctuation to cut
at. Words that nothing accounts for are skipped at a high price and reported.
"""

from __future__ import annotations

import heapq
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Literal as OneOf

from polaris_nl.language.clauses import Clause, ClauseFinder
from polaris_nl.language.grammar import Common
from polaris_nl.language.mention import Mention
from polaris_nl.language.tokens import BREAK, COMMA

Mark = OneOf["and", "then", "if", "until", "unless", "else", "not", "assure", "comma", "break"]
UNKNOWN_COST = 10.0
FILLER_COST = 0.02
MARK_COST = 0.1
WIDTH = 6
"""Partial readings kept at each position and mode."""


@dataclass(frozen=True, slots=True)
class Item:
    """A clause in its role, a connective, or a word that nothing accounts for."""

    role: OneOf["goal", "condition", "mark", "unknown"]
    text: str
    clause: Clause | None = None
    mark: Mark | None = None


@dataclass(frozen=True, slots=True)
class Cut:
    """One way to cut an utterance.

    Attributes:
        cost: the lower the better.
    """

    cost: float
    items: tuple[Item, ...]

    @property
    def unknown(self) -> tuple[str, ...]:
        """The words that nothing accounts for."""
        return tuple(item.text for item in self.items if item.role == "unknown")


_Mode = OneOf["plain", "condition", "after-condition", "either", "state", "negated"]
_MARK_MODES: dict[str, _Mode] = {
    "if": "condition",
    "until": "condition",
    "unless": "condition",
    "assure": "state",
    "not": "negated",
}


class Segmenter:
    """Cuts utterances about one world."""

    def __init__(self, common: Common, clauses: ClauseFinder) -> None:
        self._clauses = clauses
        self._marks: dict[tuple[str, ...], list[Mark]] = {}
        marks: tuple[Mark, ...] = ("and", "then", "if", "until", "unless", "else", "not")
        for mark in marks:
            for words in common.words("connectives", mark):
                self._marks.setdefault(words, []).append(mark)
        for words in common.words("assure"):
            self._marks.setdefault(words, []).append("assure")
        that = [(*w[:-1],) for w in common.words("assure") if w[-1:] == ("that",)]
        for words in that:
            self._marks.setdefault(words, []).append("assure")
        self._fillers = set(common.words("fillers"))
        self._longest = max(len(w) for w in (*self._marks, *self._fillers))

    def cut(self, tokens: Sequence[str], mentions: Sequence[Sequence[Mention]]) -> list[Cut]:
        """The best ways to cut tokens, cheapest first."""
        size = len(tokens)
        best: list[dict[_Mode, list[tuple[float, int, tuple[Item, ...]]]]] = [
            {} for _ in range(size + 1)
        ]
        best[0]["plain"] = [(0.0, 0, ())]
        counter = 0
        for at in range(size):
            if not best[at]:
                continue
            clauses = (
                list(self._clauses.at(tokens, at, mentions))
                if tokens[at] not in (BREAK, COMMA)
                else []
            )
            marks = list(self._marks_at(tokens, at))
            fillers = list(self._fillers_at(tokens, at))
            for mode, paths in best[at].items():
                steps = list(_steps(mode, at, tokens, clauses, marks, fillers))
                for cost, _, items in paths:
                    for end, extra, item, following in steps:
                        counter += 1
                        after = items if item is None else (*items, item)
                        _keep(best[end], following, (cost + extra, counter, after))
        final = [path for mode, paths in best[size].items() if mode in _FINAL for path in paths]
        return [Cut(cost, items) for cost, _, items in sorted(final, key=lambda p: p[:2])]

    def _marks_at(self, tokens: Sequence[str], at: int) -> Iterator[tuple[int, Mark]]:
        if tokens[at] == BREAK:
            yield at + 1, "break"
        elif tokens[at] == COMMA:
            yield at + 1, "comma"
        for end in range(min(len(tokens), at + self._longest), at, -1):
            for mark in self._marks.get(tuple(tokens[at:end]), ()):
                yield end, mark

    def _fillers_at(self, tokens: Sequence[str], at: int) -> Iterator[int]:
        for end in range(min(len(tokens), at + self._longest), at, -1):
            if tuple(tokens[at:end]) in self._fillers:
                yield end


_FINAL = ("plain", "after-condition", "either")
_Step = tuple[int, float, Item | None, _Mode]


def _steps(
    mode: _Mode,
    at: int,
    tokens: Sequence[str],
    clauses: Sequence[Clause],
    marks: Sequence[tuple[int, Mark]],
    fillers: Sequence[int],
) -> Iterator[_Step]:
    """What can follow at a position in a mode: end, cost, item, and the mode after it."""
    for clause in clauses:
        yield from _clause_steps(mode, clause, tokens)
    for end, mark in marks:
        following = _after_mark(mode, mark)
        if following is not None:
            item = Item("mark", " ".join(tokens[at:end]), mark=mark)
            yield end, MARK_COST, item, following
    for end in fillers:
        yield end, FILLER_COST * (end - at), None, mode
    if tokens[at] not in (BREAK, COMMA):
        yield at + 1, UNKNOWN_COST, Item("unknown", tokens[at]), mode
    else:
        yield at + 1, MARK_COST, None, mode


def _clause_steps(mode: _Mode, clause: Clause, tokens: Sequence[str]) -> Iterator[_Step]:
    text = " ".join(tokens[clause.start : clause.end])
    as_goal = Item("goal", text, clause)
    as_condition = Item("condition", text, clause)
    if clause.kind == "state":
        if mode in ("condition", "either"):
            yield clause.end, clause.cost, as_condition, "after-condition"
        if mode == "state":
            yield clause.end, clause.cost, as_goal, "plain"
    elif clause.kind == "wish":
        if mode in ("plain", "either", "after-condition", "state"):
            yield clause.end, clause.cost, as_goal, "plain"
    elif clause.kind == "goal":
        if mode in ("plain", "either", "after-condition", "negated"):
            yield clause.end, clause.cost, as_goal, "plain"
        elif mode == "state":
            yield clause.end, clause.cost + 0.2, as_goal, "plain"
    elif mode in ("plain", "either"):
        yield clause.end, clause.cost, as_goal, "plain"


def _after_mark(mode: _Mode, mark: Mark) -> _Mode | None:
    if mode in ("condition", "state", "negated"):
        return mode if mark == "comma" else None
    if mark in _MARK_MODES:
        return _MARK_MODES[mark]
    if mode == "after-condition" and mark in ("and", "comma"):
        return "either"
    return "plain"


def _keep(
    place: dict[_Mode, list[tuple[float, int, tuple[Item, ...]]]],
    mode: _Mode,
    path: tuple[float, int, tuple[Item, ...]],
) -> None:
    paths = place.setdefault(mode, [])
    if len(paths) < WIDTH:
        paths.append(path)
        paths.sort(key=lambda p: p[:2])
    elif path[0] < paths[-1][0]:
        paths[-1] = path
        paths.sort(key=lambda p: p[:2])


def cheapest(cuts: Sequence[Cut], count: int) -> list[Cut]:
    """Some of the cheapest cuts, each reading once."""
    seen: dict[tuple[tuple[str, str | None, Clause | None], ...], Cut] = {}
    for cut in cuts:
        key = tuple((i.role, i.mark, i.clause) for i in cut.items)
        seen.setdefault(key, cut)
    return heapq.nsmallest(count, seen.values(), key=lambda c: c.cost)
