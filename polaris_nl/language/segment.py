"""Cuts an utterance into clauses and connectives: the cheapest way to account for every word.

A shortest-path search over positions (Viterbi), since recognised speech has no punctuation to cut
at. Words that nothing accounts for are skipped at a high price and reported.
"""

from __future__ import annotations

import heapq
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Literal as OneOf
from typing import get_args

from polaris_nl.language.clauses import Clause, ClauseFinder, Fitting
from polaris_nl.language.common import Common
from polaris_nl.language.mention import Mention
from polaris_nl.language.template import Slot, match
from polaris_nl.language.tokens import BREAK, COMMA

Connective = OneOf[
    "and", "or", "then", "if", "until", "unless", "else", "not", "before", "done", "purpose", "given",
    "polite", "nothing",
]  # fmt: skip
Mark = Connective | OneOf["assure", "comma", "break"]
Role = OneOf["goal", "condition", "fact", "topic", "again", "except", "mark", "unknown"]

UNKNOWN_COST = 10.0
FILLER_COST = 0.02
MARK_COST = 0.1
ASIDE_COST = 0.2
AGAIN_COST = 1.0
BARE_COST = 2.2
"""What it costs to take a bare name after "otherwise" or "and" for "the same with that"."""
PRESENT_COST = 0.15
"""What it costs to take "once you go there" for something to do, rather than for a condition."""
SMALL_COST = 0.7
"""What it costs to let a state lean on the verb of the one before: "... and the cupboard closed"."""
WISH_COST = 0.15
"""What it costs to take "if ..., and the cup is not on the desk" for a wish, rather than for a condition."""
TOPIC_COST = 1.2
CALLED_COST = 0.5
"""What it costs to take a name for that of whoever is spoken to: "tom, go home"."""
TELLING_COST = 1.0
CONTRAST_COST = 0.6
FACT_COST = 0.8
"""What it costs to take a state for something told in passing rather than for a condition or a wish."""
REASON_COST = 0.6
REASON_WORD_COST = 0.12
"""What it costs to pass over a reason ("so that she can read"), and each of its words."""
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


_Mode = OneOf[
    "plain", "condition", "after-condition", "either", "state", "negated", "event", "telling"
]  # fmt: skip
_MARK_MODES: dict[str, _Mode] = {
    "if": "condition",
    "until": "condition",
    "unless": "condition",
    "assure": "state",
    "not": "negated",
    "before": "event",
    "done": "event",
    "polite": "event",
    "given": "telling",
}
_FINAL = ("plain", "after-condition", "either")
_OPEN: tuple[_Mode, ...] = ("plain", "either", "after-condition")
"""Modes in which a new clause may start."""
_LEADING = frozenset(("otherwise", "else", "and", "then", "finally", "lastly", "next"))
"""Words after which a bare name asks for the same with that."""
_PRONOUNS = frozenset(
    {"it", "them", "they", "one", "ones", "these", "those", "that", "both", "him", "her", "there"}
)
_Step = tuple[int, float, Item | None, _Mode]
_Path = tuple[float, int, tuple[Item, ...]]


class Segmenter:
    """Cuts utterances about one world."""

    def __init__(self, common: Common, clauses: ClauseFinder) -> None:
        self._clauses = clauses
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
        self._again = common.again
        self._excepting = common.excepting
        self._contrast = frozenset(common.contrast)
        self._reasons = frozenset(common.reasons)
        self._telling = frozenset(word for p in common.telling for word in p)
        phrases = (*self._marks, *self._fillers, *self._contrast, *self._reasons)
        self._longest = max(map(len, phrases))

    def cut(self, tokens: Sequence[str], mentions: Sequence[Sequence[Mention]]) -> list[Cut]:
        """The best ways to cut tokens, cheapest first."""
        size = len(tokens)
        best: list[dict[_Mode, list[_Path]]] = [{} for _ in range(size + 1)]
        best[0]["plain"] = [(0.0, 0, ())]
        counter = 0
        known: Fitting = {}
        clauses = [
            [] if token in (BREAK, COMMA) else list(self._clauses.at(tokens, at, mentions, known))
            for at, token in enumerate(tokens)
        ]
        for at in range(size):
            if not best[at]:
                continue
            anywhere = [*self._marks_at(tokens, at)]
            fillers = [*self._fillers_at(tokens, at)]
            opening = [
                *self._again_at(tokens, at, mentions),
                *self._topics_at(tokens, at, mentions, clauses),
                *self._passed_over(tokens, at, mentions, clauses),
            ]
            for mode, paths in best[at].items():
                steps = list(_steps(mode, at, tokens, clauses[at], anywhere, fillers))
                if mode in _OPEN:
                    steps += opening
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

    def _again_at(
        self, tokens: Sequence[str], at: int, mentions: Sequence[Sequence[Mention]]
    ) -> Iterator[_Step]:
        """`the same for the plate`, `the plate too`, `except the red one`, `otherwise the juice`."""

        def fillers(slot: Slot, at: int) -> Iterator[tuple[int, object]]:
            for mention in mentions[at] if at < len(mentions) else ():
                yield mention.end, mention

        for template in self._again:
            for end, bound in match(template, tokens, at, fillers):
                mention = bound[0][1] if bound else None
                if isinstance(mention, Mention):
                    text = " ".join(tokens[at:end])
                    yield end, AGAIN_COST, Item("again", text, mention=mention), "plain"
        for words in self._phrases_at(tokens, at):
            start = at + len(words)
            if words in self._excepting and start < len(tokens):
                for mention in mentions[start]:
                    text = " ".join(tokens[at : mention.end])
                    item = Item("except", text, mention=mention)
                    yield mention.end, AGAIN_COST, item, "plain"
        if at and tokens[at - 1] in _LEADING:
            for mention in mentions[at]:
                ends = mention.end == len(tokens) or tokens[mention.end] in (BREAK, COMMA, "and")
                if ends and mention.candidates:
                    item = Item("again", mention.text, mention=mention)
                    yield mention.end, BARE_COST, item, "plain"

    def _topics_at(
        self,
        tokens: Sequence[str],
        at: int,
        mentions: Sequence[Sequence[Mention]],
        clauses: Sequence[Sequence[Clause]],
    ) -> Iterator[_Step]:
        """`michael, go home`; `the cup and the plate, put them there`, where a pronoun takes it up."""
        if at and tokens[at - 1] not in (BREAK, COMMA):
            return
        for mention in mentions[at]:
            called = mention.end < len(tokens) and any(
                c.kind == "goal" for c in clauses[mention.end]
            )
            if called and mention.candidates and self._clauses.fits(mention, ("person",)):
                yield (
                    mention.end,
                    CALLED_COST,
                    Item("topic", mention.text, mention=mention),
                    "plain",
                )
            if mention.candidates or mention.parts:
                rest = tokens[mention.end : mention.end + 8]
                if mention.end < len(tokens) and _PRONOUNS & set(rest):
                    item = Item("topic", mention.text, mention=mention)
                    yield mention.end, TOPIC_COST, item, "plain"

    def _passed_over(
        self,
        tokens: Sequence[str],
        at: int,
        mentions: Sequence[Sequence[Mention]],
        clauses: Sequence[Sequence[Clause]],
    ) -> Iterator[_Step]:
        """What is said but not asked for: contrasts ("not the red one") and reasons ("so that ...")."""
        for words in self._phrases_at(tokens, at):
            start = at + len(words)
            if words in self._contrast and start < len(tokens):
                ends = {m.end for m in mentions[start]}
                ends |= {c.end for c in clauses[start] if c.kind in ("goal", "ellipsis")}
                for end in ends:
                    yield end, CONTRAST_COST, None, "plain"
            if words in self._reasons and not _purpose(words, at, clauses):
                for end in range(start, len(tokens) + 1):
                    if end > start and tokens[end - 1] == BREAK:
                        break
                    yield end, REASON_COST + REASON_WORD_COST * (end - start), None, "plain"
            if words == ("for",) and start < len(tokens):
                for mention in mentions[start]:
                    if self._clauses.fits(mention, ("person",)) and not mention.place:
                        yield (
                            mention.end,
                            CONTRAST_COST,
                            Item("topic", mention.text, mention=mention),
                            "plain",
                        )
        yield from self._told_of_people(tokens, at, mentions, clauses)

    def _told_of_people(
        self,
        tokens: Sequence[str],
        at: int,
        mentions: Sequence[Sequence[Mention]],
        clauses: Sequence[Sequence[Clause]],
    ) -> Iterator[_Step]:
        """`Tom says he is cold`, `somebody left the fridge open`: asks for nothing, but names things."""
        if at and tokens[at - 1] not in (BREAK, COMMA, "and", "but"):
            return
        for person in mentions[at]:
            verb = person.end
            if verb >= len(tokens) or tokens[verb] not in self._telling:
                continue
            if not self._clauses.fits(person, ("person", "message")):
                continue
            for end in range(verb + 1, min(verb + 12, len(tokens)) + 1):
                if tokens[end - 1] in (BREAK, COMMA):
                    break
                goes_on = end < len(tokens) and (
                    tokens[end] in (BREAK, COMMA, "so", "and", "but") or clauses[end]
                )
                if goes_on:
                    named = [person, *_named(mentions, verb + 1, end)]
                    topic = Mention(at, end, " ".join(tokens[at:end]), parts=tuple(named))
                    cost = TELLING_COST + REASON_WORD_COST * (end - verb)
                    yield end, cost, Item("topic", topic.text, mention=topic), "plain"


def _purpose(words: Sequence[str], at: int, clauses: Sequence[Sequence[Clause]]) -> bool:
    """Whether what follows "to" in a reason is something that can be asked for."""
    if "to" not in words:
        return False
    verb = at + words.index("to") + 1
    return verb < len(clauses) and any(c.kind == "goal" for c in clauses[verb])


def _named(mentions: Sequence[Sequence[Mention]], at: int, end: int) -> Iterator[Mention]:
    """The longest mentions in a stretch of words, one after the other."""
    while at < end:
        found = max(
            (m for m in mentions[at] if m.end <= end and m.candidates),
            key=lambda m: m.end,
            default=None,
        )
        if found is not None:
            yield found
        at = found.end if found is not None else at + 1


def _steps(
    mode: _Mode,
    at: int,
    tokens: Sequence[str],
    clauses: Sequence[Clause],
    marks: Sequence[tuple[int, Mark]],
    fillers: Sequence[tuple[int, float]],
) -> Iterator[_Step]:
    """What can follow at a position in a mode: end, cost, item, and the mode after it."""
    for clause in clauses:
        yield from _clause_steps(mode, clause, tokens)
    goes_on = False
    for end, mark in marks:
        following = _after_mark(mode, mark)
        goes_on = goes_on or following == mode
        if following is not None:
            item = Item("mark", " ".join(tokens[at:end]), mark=mark)
            yield end, MARK_COST, item, following
    for end, cost in fillers:
        yield end, cost, None, mode
    if tokens[at] not in (BREAK, COMMA):
        yield at + 1, UNKNOWN_COST, Item("unknown", tokens[at]), mode
    elif not goes_on:
        yield at + 1, MARK_COST, None, mode


def _clause_steps(mode: _Mode, clause: Clause, tokens: Sequence[str]) -> Iterator[_Step]:
    text = " ".join(tokens[clause.start : clause.end])
    as_goal = Item("goal", text, clause)
    as_condition = Item("condition", text, clause)
    if clause.form != "base":
        if mode == "event":
            yield clause.end, clause.cost, as_goal, "plain"
    elif mode == "telling":
        if clause.kind in ("told", "state"):
            yield clause.end, clause.cost, Item("fact", text, clause), "plain"
    elif clause.kind == "told":
        if mode == "plain":
            yield clause.end, clause.cost, Item("fact", text, clause), "plain"
    elif clause.kind == "state":
        if mode in ("condition", "either"):
            yield clause.end, clause.cost, as_condition, "after-condition"
        if mode == "state":
            yield clause.end, clause.cost, as_goal, "plain"
        if mode == "plain" and clause.tellable:
            yield clause.end, clause.cost + FACT_COST, Item("fact", text, clause), "plain"
    elif clause.kind == "small":
        if mode == "state":
            yield clause.end, clause.cost, as_goal, "plain"
        if mode == "plain" and clause.start and tokens[clause.start - 1] in ("and", "but", COMMA):
            yield clause.end, clause.cost + SMALL_COST, as_goal, "plain"
    elif clause.kind == "wish":
        if mode in (*_OPEN, "state"):
            extra = WISH_COST if mode in ("either", "after-condition") else 0.0
            yield clause.end, clause.cost + extra, as_goal, "plain"
    elif clause.kind == "goal":
        if mode in (*_OPEN, "negated"):
            yield clause.end, clause.cost, as_goal, "plain"
        elif mode == "event":
            yield clause.end, clause.cost + PRESENT_COST, as_goal, "plain"
        elif mode == "state":
            yield clause.end, clause.cost + 0.2, as_goal, "plain"
    elif mode in _OPEN:
        yield clause.end, clause.cost, as_goal, "plain"


def _after_mark(mode: _Mode, mark: Mark) -> _Mode | None:
    if mode == "negated" and mark == "assure":
        return "state"
    if mode in ("condition", "state", "negated", "event", "telling"):
        return mode if mark == "comma" else None
    if mark in _MARK_MODES:
        return _MARK_MODES[mark]
    if mode == "after-condition" and mark in ("and", "comma"):
        return "either"
    return "plain"


def _keep(place: dict[_Mode, list[_Path]], mode: _Mode, path: _Path) -> None:
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
