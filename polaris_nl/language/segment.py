"""Cuts an utterance into clauses and connectives: the cheapest way to account for every word.

A shortest-path search over positions (Viterbi), since recognised speech has no punctuation to cut
at. Words that nothing accounts for are skipped at a high price and reported.
"""

from __future__ import annotations

import heapq
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import get_args

from polaris_nl.language.clauses import Clause, ClauseFinder, Fitting
from polaris_nl.language.common import Common
from polaris_nl.language.fragments import Fragments
from polaris_nl.language.mention import Mention
from polaris_nl.language.modes import FINAL, OPEN, Connective, Mark, Mode, Role, after_mark, roles
from polaris_nl.language.tokens import BREAK, COMMA

UNKNOWN_COST = 10.0
FILLER_COST = 0.02
MARK_COST = 0.1
PLAIN_COST = 0.05
"""Less than other connectives, for those that say a whole thing: "if he's not, put it there" is another way on
before it's a condition, "after you've told her, go home" an order of acts."""
ASIDE_COST = 0.2
WIDTH = 6
"""Partial readings kept at each position and mode."""


@dataclass(frozen=True, slots=True)
class Item:
    """A clause in its role, a connective, or a word that nothing accounts for.

    Attributes:
        role: `fact` is told in passing and asks for nothing; `topic` is only named, to be spoken of
            ("the cup, put it there"); `again` asks for the same with another thing; `except` leaves
            one out of what was asked for.
        mention: the thing of a `topic`, `again` or `except`.
    """

    role: Role
    text: str
    clause: Clause | None = None
    mark: Mark | None = None
    mention: Mention | None = None


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


_Step = tuple[int, float, Item | None, Mode]
"""Where a step ends, what it costs, what it adds, and the mode after it."""
_Path = tuple[float, int, tuple[Item, ...]]


class Segmenter:
    """Cuts utterances about one world."""

    def __init__(self, common: Common, clauses: ClauseFinder) -> None:
        self._clauses = clauses
        self._fragments = Fragments(common, clauses)
        self._marks: dict[tuple[str, ...], list[Mark]] = {}
        for mark in get_args(Connective):
            for words in common.connectives.get(mark, ()):
                self._marks.setdefault(words, []).append(mark)
        for words in common.assure:
            self._marks.setdefault(words, []).append("assure")
        self._fillers = {
            **dict.fromkeys(common.asides, ASIDE_COST),
            **dict.fromkeys(common.fillers, FILLER_COST),
        }
        self._longest = max(map(len, (*self._marks, *self._fillers)), default=0)
        self._latest: tuple[tuple[str, ...], list[list[Clause]]] | None = None

    def cut(self, tokens: Sequence[str], mentions: Sequence[Sequence[Mention]]) -> list[Cut]:
        """The best ways to cut tokens, cheapest first."""
        size = len(tokens)
        best: list[dict[Mode, list[_Path]]] = [{} for _ in range(size + 1)]
        best[0]["plain"] = [(0.0, 0, ())]
        counter = 0
        clauses = self.clauses_in(tokens, mentions)
        for at in range(size):
            if not best[at]:
                continue
            marks = [*self._marks_at(tokens, at)]
            fillers = [*self._fillers_at(tokens, at)]
            fragments = [*self._fragments_at(tokens, at, mentions, clauses)]
            for mode, paths in best[at].items():
                steps = [*_steps(mode, at, tokens, clauses[at], marks, fillers)]
                if mode in OPEN:
                    steps += fragments
                for cost, _, items in paths:
                    for end, extra, item, following in steps:
                        counter += 1
                        after = items if item is None else (*items, item)
                        _keep(best[end], following, (cost + extra, counter, after))
        final = [path for mode, paths in best[size].items() if mode in FINAL for path in paths]
        return [Cut(cost, items) for cost, _, items in sorted(final, key=lambda p: p[:2])]

    def before_remark(
        self, tokens: Sequence[str], mentions: Sequence[Sequence[Mention]]
    ) -> tuple[str, ...]:
        """Tokens without what is only told behind them: "... it's cold in there"."""
        background = self._fragments.background
        starts = [*background.remarks(tokens, mentions)]
        if not starts:
            return tuple(tokens)
        clauses = self.clauses_in(tokens, mentions)
        told = (at for at in starts if any(background.told_behind(tokens, at, mentions, clauses)))
        return tuple(tokens[: next(told, len(tokens))])

    def clauses_in(
        self, tokens: Sequence[str], mentions: Sequence[Sequence[Mention]]
    ) -> list[list[Clause]]:
        """The clauses that start at each position; those of the latest tokens are remembered."""
        key, latest = tuple(tokens), self._latest
        if latest is not None and latest[0] == key:
            return latest[1]
        known: Fitting = {}
        found = [
            [] if token in (BREAK, COMMA) else list(self._clauses.at(tokens, at, mentions, known))
            for at, token in enumerate(tokens)
        ]
        # As a pair, since others may understand something at the same time.
        self._latest = key, found
        return found

    def _marks_at(self, tokens: Sequence[str], at: int) -> Iterator[tuple[int, Mark]]:
        if tokens[at] == BREAK:
            yield at + 1, "break"
        elif tokens[at] == COMMA:
            yield at + 1, "comma"
        for words in self._phrases_at(tokens, at):
            for mark in self._marks.get(words, ()):
                yield at + len(words), mark

    def _fillers_at(self, tokens: Sequence[str], at: int) -> Iterator[tuple[int, float]]:
        for words in self._phrases_at(tokens, at):
            cost = self._fillers.get(words)
            if cost is not None:
                yield at + len(words), cost * len(words)

    def _phrases_at(self, tokens: Sequence[str], at: int) -> Iterator[tuple[str, ...]]:
        for end in range(min(len(tokens), at + self._longest), at, -1):
            yield tuple(tokens[at:end])

    def _fragments_at(
        self,
        tokens: Sequence[str],
        at: int,
        mentions: Sequence[Sequence[Mention]],
        clauses: Sequence[Sequence[Clause]],
    ) -> Iterator[_Step]:
        for found in self._fragments.at(tokens, at, mentions, clauses):
            text = " ".join(tokens[at : found.end])
            item = Item(found.role, text, mention=found.mention) if found.role else None
            yield found.end, found.cost, item, "plain"


def _steps(
    mode: Mode,
    at: int,
    tokens: Sequence[str],
    clauses: Sequence[Clause],
    marks: Sequence[tuple[int, Mark]],
    fillers: Sequence[tuple[int, float]],
) -> Iterator[_Step]:
    """What can follow at a position in a mode."""
    for clause in clauses:
        text = " ".join(tokens[clause.start : clause.end])
        before = tokens[clause.start - 1] if clause.start else ""
        for role, extra, following in roles(mode, clause, before):
            yield clause.end, clause.cost + extra, Item(role, text, clause), following
    goes_on = False
    for end, mark in marks:
        after = after_mark(mode, mark)
        goes_on = goes_on or after == mode
        if after is not None:
            cost = PLAIN_COST if mark in ("else", "done") else MARK_COST
            yield end, cost, Item("mark", " ".join(tokens[at:end]), mark=mark), after
    for end, cost in fillers:
        yield end, cost, None, mode
    if tokens[at] not in (BREAK, COMMA):
        yield at + 1, UNKNOWN_COST, Item("unknown", tokens[at]), mode
    elif not goes_on:
        yield at + 1, MARK_COST, None, mode


def _keep(place: dict[Mode, list[_Path]], mode: Mode, path: _Path) -> None:
    paths = place.setdefault(mode, [])
    if len(paths) < WIDTH:
        paths.append(path)
        paths.sort(key=lambda p: p[:2])
    elif path[0] < paths[-1][0]:
        paths[-1] = path
        paths.sort(key=lambda p: p[:2])


def cheapest(cuts: Sequence[Cut], count: int) -> list[Cut]:
    """Some of the cheapest cuts, each reading once."""
    seen: dict[tuple[tuple[Role, str | None, Clause | None], ...], Cut] = {}
    for cut in cuts:
        key = tuple((i.role, i.mark, i.clause) for i in cut.items)
        seen.setdefault(key, cut)
    return heapq.nsmallest(count, seen.values(), key=lambda c: c.cost)
