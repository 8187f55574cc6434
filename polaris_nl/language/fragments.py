"""Fragments: what is said without a predicate, such as topics, exceptions, contrasts and reasons."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Literal as OneOf

from polaris_nl.language.background import OWNED, Background
from polaris_nl.language.clauses import Clause, ClauseFinder
from polaris_nl.language.common import Common
from polaris_nl.language.mention import Mention
from polaris_nl.language.template import Slot, match
from polaris_nl.language.tokens import BREAK, COMMA, PhraseSet

AGAIN_COST = 1.0
BARE_COST = 2.2
"""What it costs to take a bare name after "otherwise" or "and" for "the same with that"."""
TOPIC_COST = 1.2
CALLED_COST = 0.5
"""What it costs to take a name for that of whoever is spoken to: "tom, go home"."""
TELLING_COST = 1.0
CONTRAST_COST = 0.6
REASON_COST = 0.6
REASON_WORD_COST = 0.12
"""What it costs to pass over a reason ("so that she can read"), and each of its words."""
_OPENERS = PhraseSet(
    tuple(words.split())
    for opener in ("could you", "can you", "would you", "will you", "please")
    for words in (opener, f"so {opener}", f"so {opener} please", f"{opener} please")
)
"""Words that begin a request behind what is only told: "my hands are full, could you ..."."""
_EXCUSING = frozenset(
    (
        "is",
        "are",
        "am",
        "'m",
        "'s",
        "'ll",
        "will",
        "was",
        "has",
        "have",
        "'ve",
        "had",
        "can",
        "could",
        "do",
        "does",
    )
)
_NO_EXCUSE = frozenset(
    (
        "if", "when", "once", "unless", "until", "mind", "changed", "mean", "meant", "said", "wrong", "instead",
        "wait", "stop", "want", "then", "otherwise",
    )
)  # fmt: skip
"""Words that what is only told doesn't have: with them it asks for something, or takes something back."""
_NO_REMARK = frozenset(("if", "when", "once", "unless", "until", "till", "otherwise", "then"))
"""Words that what is told of people doesn't have: what they say must not be lost."""
_TOLD_WORDS = 12
"""Words within which what is told of a person ends."""
_LEADING = frozenset(
    ("otherwise", "else", "and", "then", "finally", "lastly", "next", "afterwards", "last")
)
"""Words after which a bare name asks for the same with that."""
_ENDS = (
    BREAK,
    COMMA,
    "and",
    "then",
    "next",
    "last",
    "finally",
    "lastly",
    "after",
    "at",
    "followed",
)
"""Words that may follow a bare name."""
_LEADING_PAIRS = (
    ("after", "that"),
    ("after", "this"),
    ("after", "it"),
    ("of", "all"),
    ("the", "end"),
    ("followed", "by"),
)
_PRONOUNS = frozenset(
    {"it", "them", "they", "one", "ones", "these", "those", "that", "both", "him", "her", "there"}
)
_NEAR = 8
"""Words within which a pronoun takes a topic up."""
_ONWARD = frozenset(("then", "wait", "until", "till", "next", "finally", "afterwards"))
"""Words behind what is wanted, not behind what is only named: "plate on the table then wait till it's full"."""
_JOINING = ("so", "and", "but")
_ENABLING = frozenset(
    ("can", "could", "will", "would", "may", "might", "do", "does", "stay", "stays", "get", "gets")
)
"""Verbs of what a request makes possible: "so the clothes can air"."""
_ASKING = ("goal", "wish", "ellipsis")
_SEVERAL = frozenset({"them", "they", "these", "those", "both", "there"})
Mentions = Sequence[Sequence[Mention]]
Clauses = Sequence[Sequence[Clause]]


@dataclass(frozen=True, slots=True)
class Fragment:
    """Words that are no clause and yet say something, or are passed over.

    Attributes:
        end: where they end, exclusive.
        cost: the lower the better.
        role: `topic` is only named; `again` asks for the same with another thing; `except` leaves one
            out of what was asked for; "" is passed over.
        mention: the thing that it is about, where it has a role.
    """

    end: int
    cost: float
    role: OneOf["topic", "again", "except", ""] = ""
    mention: Mention | None = None


class Fragments:
    """Finds the fragments of utterances about one world."""

    def __init__(self, common: Common, clauses: ClauseFinder) -> None:
        self._clauses = clauses
        self._again = common.again
        self._excepting = common.excepting
        self._contrast = frozenset(common.contrast)
        self._reasons = frozenset(common.reasons)
        self._telling = frozenset(word for p in common.telling for word in p)
        phrases = (*self._excepting, *self._contrast, *self._reasons)
        self._longest = max(map(len, phrases), default=0)
        self.background = Background(common, clauses.beginnings)

    def at(
        self, tokens: Sequence[str], at: int, mentions: Mentions, clauses: Clauses
    ) -> Iterator[Fragment]:
        """The fragments that start at a position.

        Args:
            tokens: the utterance.
            at: the position.
            mentions: those that start at each position.
            clauses: those that start at each position.
        """
        yield from self._same_again(tokens, at, mentions)
        yield from self._left_out(tokens, at, mentions)
        yield from self._same_with(tokens, at, mentions, clauses)
        yield from self._topics(tokens, at, mentions, clauses)
        yield from self._contrasts(tokens, at, mentions, clauses)
        yield from self._given_reasons(tokens, at, mentions, clauses)
        yield from self._beneficiaries(tokens, at, mentions)
        yield from self._told_of_people(tokens, at, mentions, clauses)
        yield from self._excuses(tokens, at, mentions, clauses)
        for start, end in self.background.at(tokens, at, mentions, clauses):
            named = tuple(_named(mentions, start, end))
            told = Mention(start, end, " ".join(tokens[start:end]), parts=named)
            yield Fragment(end, TELLING_COST + REASON_WORD_COST * (end - start), "topic", told)

    def _phrases(self, tokens: Sequence[str], at: int) -> Iterator[tuple[str, ...]]:
        for end in range(min(len(tokens), at + self._longest), at, -1):
            yield tuple(tokens[at:end])

    def _same_again(self, tokens: Sequence[str], at: int, mentions: Mentions) -> Iterator[Fragment]:
        """`the same for the plate`, `the plate too`."""

        def fillers(slot: Slot, at: int) -> Iterator[tuple[int, object]]:
            for mention in mentions[at] if at < len(mentions) else ():
                yield mention.end, mention

        for template in self._again:
            for end, bound in match(template, tokens, at, fillers):
                mention = bound[0][1] if bound else None
                if isinstance(mention, Mention):
                    yield Fragment(end, AGAIN_COST, "again", mention)

    def _left_out(self, tokens: Sequence[str], at: int, mentions: Mentions) -> Iterator[Fragment]:
        """`except the red one`."""
        for words in self._phrases(tokens, at):
            start = at + len(words)
            if words in self._excepting and start < len(tokens):
                for mention in mentions[start]:
                    yield Fragment(mention.end, AGAIN_COST, "except", mention)

    def _same_with(
        self, tokens: Sequence[str], at: int, mentions: Mentions, clauses: Clauses
    ) -> Iterator[Fragment]:
        """`otherwise the juice`."""
        before = tuple(tokens[max(0, at - 3) : at])
        if not (before[-1:] and before[-1] in _LEADING) and before[-2:] not in _LEADING_PAIRS:
            return
        # "To the nurse and then to the resident".
        to = tokens[at] in ("to", "for") and at + 1 < len(tokens)
        for mention in mentions[at + to]:
            end = mention.end
            ends = end == len(tokens) or tokens[end] in _ENDS
            ends = ends or any(self.background.told_behind(tokens, end, mentions, clauses))
            if ends and mention.candidates and (not to or self._clauses.fits(mention, ("person",))):
                yield Fragment(end, BARE_COST, "again", mention)

    def _topics(
        self, tokens: Sequence[str], at: int, mentions: Mentions, clauses: Clauses
    ) -> Iterator[Fragment]:
        """`michael, go home`; `the cup and the plate, put them there`, where a pronoun takes it up."""
        if at and tokens[at - 1] not in (BREAK, COMMA):
            return
        for mention in mentions[at]:
            called = mention.end < len(tokens) and any(
                c.kind == "goal" for c in clauses[mention.end]
            )
            if called and mention.candidates and self._clauses.fits(mention, ("person",)):
                yield Fragment(mention.end, CALLED_COST, "topic", mention)
            if mention.candidates or mention.parts:
                rest = _pronouns(tokens, mention.end, mentions)
                if mention.quantifier == "all" and not _SEVERAL & rest:
                    continue  # "Everything on the desk, put it there" is about more than one thing.
                goes_on = tokens[mention.end : mention.end + 2]
                # "Plate on the table please and once it's clean ..." asks for something already.
                onward = _ONWARD | {"and"} if mention.place else _ONWARD
                polite = "please" in goes_on[:1]
                if rest and not onward.intersection(goes_on[polite : polite + 1]):
                    yield Fragment(mention.end, TOPIC_COST, "topic", mention)

    def _contrasts(
        self, tokens: Sequence[str], at: int, mentions: Mentions, clauses: Clauses
    ) -> Iterator[Fragment]:
        """`not the red one`."""
        for words in self._phrases(tokens, at):
            start = at + len(words)
            if words in self._contrast and start < len(tokens):
                ends = {m.end for m in mentions[start]}
                # "The tray not full" says something of the tray; "... shut, not open" only says it again.
                said = any(c.end == at for there in clauses[:at] for c in there)
                against = [c for c in clauses[start] if c.kind in ("goal", "ellipsis")]
                ends |= {c.end for c in against if said or c.kind == "goal" or c.bindings}
                yield from (Fragment(end, CONTRAST_COST) for end in ends)

    def _given_reasons(
        self, tokens: Sequence[str], at: int, mentions: Mentions, clauses: Clauses
    ) -> Iterator[Fragment]:
        """`so that she can read`."""
        for words in self._phrases(tokens, at):
            if words not in self._reasons or _purpose(words, at, clauses):
                continue
            yield from self._passed_over(tokens, at, at + len(words), clauses)
        start = at + 1
        if tokens[at] == "so" and start < len(tokens):
            # "So the clothes can air": what "so she can" is for those that have a name.
            ends = {m.end for m in mentions[start] if not m.pronoun}
            if tokens[start] in OWNED:
                ends |= {start + 2, start + 3}
            if not any(c.kind in _ASKING for c in clauses[start]):
                for end in ends:
                    if {*tokens[end : end + 1]} & _ENABLING:
                        yield from self._passed_over(tokens, at, end + 1, clauses)

    def _passed_over(
        self, tokens: Sequence[str], at: int, start: int, clauses: Clauses
    ) -> Iterator[Fragment]:
        """A reason that goes on behind its first words, until more is asked for."""
        may = bool(_ENABLING.intersection(tokens[at : start + 1]))
        for end in range(start, len(tokens) + 1):
            if end > start and tokens[end - 1] == BREAK:
                return
            yield Fragment(end, REASON_COST + REASON_WORD_COST * (end - start))
            if self._asks_more(tokens, end, clauses, may):
                return

    def _asks_more(self, tokens: Sequence[str], at: int, clauses: Clauses, may: bool) -> bool:
        """Whether more is asked for at a position in a reason: "... so that she can see it, then go home".

        Args:
            tokens: the utterance.
            at: the position.
            clauses: those that start at each position.
            may: whether the reason is what somebody can do then, of which "and" may bring more.
        """
        start = at + (tokens[at : at + 1] in (["and"], ("and",)))
        following = tokens[start : start + 1]
        if not following:
            return False
        if tuple(tokens[start : start + 2]) in _LEADING_PAIRS:
            return self.background.asks(tokens, start + 2, clauses)
        if _ONWARD.intersection(following):
            return self.background.asks(tokens, start + 1, clauses)
        if _NO_REMARK.intersection(following) and start + 1 < len(tokens):
            return any(c.kind == "state" for c in clauses[start + 1])
        asked = any(c.kind == "goal" and c.form == "base" for c in clauses[start])
        return start > at and not may and asked

    def _beneficiaries(
        self, tokens: Sequence[str], at: int, mentions: Mentions
    ) -> Iterator[Fragment]:
        """`for the resident`, who can be meant by "her" afterwards."""
        if tokens[at] != "for" or at + 1 >= len(tokens):
            return
        for mention in mentions[at + 1]:
            if self._clauses.fits(mention, ("person",)) and not mention.place:
                yield Fragment(mention.end, CONTRAST_COST, "topic", mention)

    def _told_of_people(
        self, tokens: Sequence[str], at: int, mentions: Mentions, clauses: Clauses
    ) -> Iterator[Fragment]:
        """`Tom says he is cold`, `somebody left the fridge open`: asks for nothing, but names things."""
        if at and tokens[at - 1] not in (BREAK, COMMA, "and", "but"):
            return
        for person in mentions[at]:
            verb = person.end
            if verb >= len(tokens) or tokens[verb] not in self._telling:
                continue
            # "That has gone ..." may be about anything.
            told_of = ("person",) if person.pronoun else ("person", "message")
            if not self._clauses.fits(person, told_of):
                continue
            for end in range(verb + 1, min(verb + _TOLD_WORDS, len(tokens)) + 1):
                if tokens[end - 1] in (BREAK, COMMA) or tokens[end - 1] in _NO_REMARK:
                    break
                goes_on = end < len(tokens) and (
                    tokens[end] in (BREAK, COMMA, "so", "and", "but") or clauses[end]
                )
                if goes_on:
                    named = (person, *_named(mentions, verb + 1, end))
                    topic = Mention(at, end, " ".join(tokens[at:end]), parts=named)
                    cost = TELLING_COST + REASON_WORD_COST * (end - verb)
                    yield Fragment(end, cost, "topic", topic)
                asked = self.background.asks(tokens, end, clauses)
                if tokens[end - 1] == "so" or (tokens[end - 1] in _JOINING and asked):
                    break  # What is asked for isn't told any more, and must not be lost.

    def _excuses(
        self, tokens: Sequence[str], at: int, mentions: Mentions, clauses: Clauses
    ) -> Iterator[Fragment]:
        """`my hands are full, could you ...`, `... I've got my hands full`: why it is asked for."""
        first = self.background.begins(tokens, at) or tokens[at - 1] in (BREAK, COMMA)
        own = tokens[at] in ("my", "our", "i", "we")
        people = [m for m in mentions[at] if m.candidates and self._clauses.fits(m, ("person",))]
        if not own and not (first and people):
            return
        verbs = [i for i in range(at + 1, min(at + 4, len(tokens))) if tokens[i] in _EXCUSING]
        for end in range(verbs[0] + 2, min(at + _TOLD_WORDS, len(tokens)) + 1) if verbs else ():
            if tokens[end - 1] in _NO_EXCUSE:
                return
            ends = end == len(tokens) or tokens[end] == BREAK
            opening = end + (tokens[end : end + 1] == [COMMA] or tokens[end : end + 1] == ["um"])
            opener = _OPENERS.length_at(tokens, opening)
            asked = opening + opener
            requested = (
                opener and asked < len(tokens) and any(c.kind == "goal" for c in clauses[asked])
            )
            if (first and requested) or (at and own and ends):
                named = tuple(_named(mentions, at, end))
                told = Mention(at, end, " ".join(tokens[at:end]), parts=named)
                yield Fragment(end, TELLING_COST + REASON_WORD_COST * (end - at), "topic", told)


def _pronouns(tokens: Sequence[str], at: int, mentions: Mentions) -> frozenset[str]:
    """The pronouns soon behind a position: "put it there", but not "her" in "her table"."""
    near = range(at, min(at + _NEAR, len(tokens)))
    owning = {i for i in near if any(m.candidates and m.end > i + 1 for m in mentions[i])}
    return _PRONOUNS & {tokens[i] for i in near if i not in owning}


def _purpose(words: Sequence[str], at: int, clauses: Clauses) -> bool:
    """Whether what follows "to" in a reason is something that can be asked for."""
    if "to" not in words:
        return False
    verb = at + words.index("to") + 1
    return verb < len(clauses) and any(c.kind == "goal" for c in clauses[verb])


def _named(mentions: Mentions, at: int, end: int) -> Iterator[Mention]:
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
