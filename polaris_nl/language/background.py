"""What is told around a request and asks for nothing: "it's too warm here so ...", "for the starter ..."."""

from __future__ import annotations

import itertools
from collections.abc import Collection, Iterator, Sequence

from polaris_nl.language.clauses import Clause
from polaris_nl.language.common import Common
from polaris_nl.language.mention import Mention
from polaris_nl.language.requests import BE_OR_DO, SMALL, SUBJECTS, Requests
from polaris_nl.language.tokens import BREAK, COMMA, PhraseSet

Span = tuple[int, int]
Clauses = Sequence[Sequence[Clause]]
_CONDITIONS = frozenset(
    ("if", "when", "once", "unless", "until", "till", "after", "before", "otherwise")
)
_ENDING = _CONDITIONS - {"after", "before"} | {"and"}
"""Words that what is told behind a request doesn't have: more may be asked for behind them. "He likes it
after his nap" says no order."""
_CORRECTING = frozenset(
    ("mean", "meant", "said", "wrong", "instead", "stop", "then", "not", "mind", "changed")
)
_PAIRS = frozenset(itertools.product(("i", "we"), ("want", "need", "would", "meant")))
"""Words with which something is asked for: "it's the plate I want there"."""
_MODALS = frozenset(("will", "not"))
_BEING = frozenset(("is", "are", "was", "were", "'s"))
"""Verbs that tell something also of what isn't known: "tv night is over so ..."."""
_SO = "so"
_FOR = "for"
OWNED = ("the", "our", "my", "his", "her", "their", "a", "an")
_BEHIND = (BREAK, COMMA, "and", "then", "but", "please", "so", "if", "when", "once", "unless")
"""Words that may follow whom something is for."""
_MOST_FOR = 5
_MOST_NOUN = 2
_MOST_TOLD = 16
_MOST_SUBJECT = 6
"""Words of a subject that isn't known: "the last thing i want tonight is ..."."""
_MOST_OCCASION = 7
_LEAST_LATE = 3
"""Words that a sentence behind a request has at least."""
_MOST_LATE = 12


class Background:
    """Finds what is told around requests.

    Args:
        common: words that every domain shares.
        verbs: verbs that goals begin with.
    """

    def __init__(self, common: Common, verbs: Collection[str]) -> None:
        self._requests = Requests(verbs)
        leads = (*common.fillers, *common.assure, *common.connectives.get("polite", ()))
        self._leads = PhraseSet(leads)
        self._fillers = PhraseSet((*common.fillers, *common.hesitations))
        self._remarks = PhraseSet(common.remarks)

    def at(
        self,
        tokens: Sequence[str],
        at: int,
        mentions: Sequence[Sequence[Mention]],
        clauses: Clauses,
    ) -> Iterator[Span]:
        """The stretches of words that are told around a request from a position on, and only told."""
        if self.begins(tokens, at):
            yield from self._told_before(tokens, at, mentions, clauses)
            yield from self._occasion(tokens, at, mentions, clauses)
        elif at:
            yield from self.told_behind(tokens, at, mentions, clauses)
            yield from self._for_others(tokens, at, mentions)
            yield from self._deadline(tokens, at, clauses)

    def remarks(
        self, tokens: Sequence[str], mentions: Sequence[Sequence[Mention]]
    ) -> Iterator[int]:
        """Where what may be told behind a request can begin."""
        return (at for at in range(1, len(tokens)) if self._opening(tokens, at, mentions))

    def told_behind(
        self,
        tokens: Sequence[str],
        at: int,
        mentions: Sequence[Sequence[Mention]],
        clauses: Clauses,
    ) -> Iterator[Span]:
        """`... she'll be wanting her tea`, at the end, where it is nothing that could be waited for."""
        opening = self._opening(tokens, at, mentions)
        size = len(tokens)
        rest = tokens[at + opening :]
        if not opening or not rest or not _LEAST_LATE <= size - at <= _MOST_LATE:
            return
        if _ENDING & set(rest) or _corrects(rest) or BREAK in rest or COMMA in rest:
            return
        if tokens[at] == "it" and any(p in _PAIRS for p in itertools.pairwise(rest)):
            return
        if any(self._requests.may_begin(tokens, i) for i in range(at + opening, size)):
            return
        start = at + opening
        if tokens[start - 1] in _MODALS:
            # "She'll find it there": what somebody else does is nothing to do.
            done = (c.end for c in clauses[start] if c.kind == "goal")
            start = max(done, default=start)
        first = start if start > at + opening else at + 1
        inside = ((i, c) for i, there in enumerate(clauses) if i >= first for c in there)
        meant = any(
            c.form == "base" and (c.kind in ("goal", "small") or _leans(c, tokens[i]))
            for i, c in inside
        )
        if not meant and not any(c.end > at + 2 for c in clauses[at]):
            yield at, size

    def _opening(
        self, tokens: Sequence[str], at: int, mentions: Sequence[Sequence[Mention]]
    ) -> int:
        """How many words begin a remark at a position: "she can't", "the party's", "or the food"."""
        if size := self._remarks.length_at(tokens, at):
            return size
        ends = [m.end for m in mentions[at] if m.candidates and not m.quantifier]
        if tokens[at] in OWNED:
            nouns = itertools.takewhile(
                lambda i: tokens[i] not in SUBJECTS, range(at + 1, len(tokens))
            )
            ends += [i + 1 for i in itertools.islice(nouns, _MOST_NOUN)]
        return next((e - at + 1 for e in ends if {*tokens[e : e + 1]} & _BEING), 0)

    def begins(self, tokens: Sequence[str], at: int) -> bool:
        """Whether only fillers stand before a position."""
        here = 0
        while here < at:
            step = 1 if tokens[here] in (BREAK, COMMA) else self._fillers.length_at(tokens, here)
            if not step:
                return False
            here += step
        return here == at

    def asks(self, tokens: Sequence[str], at: int, clauses: Clauses) -> bool:
        """Whether something is asked for at a position, politely or not."""
        while at < len(tokens):
            if tokens[at] == "if" or any(c.kind in ("goal", "wish") for c in clauses[at]):
                return True
            step = 1 if tokens[at] == COMMA else self._leads.length_at(tokens, at)
            if not step:
                return False
            at += step
            if at < len(tokens) and any(c.kind in ("state", "small") for c in clauses[at]):
                return True
        return False

    def _told_before(
        self,
        tokens: Sequence[str],
        at: int,
        mentions: Sequence[Sequence[Mention]],
        clauses: Clauses,
    ) -> Iterator[Span]:
        """`the wine's been out all day so ...`: a sentence with a verb, and "so" before what is wanted."""
        subjects = [m.end for m in mentions[at] if not m.pronoun]
        if tokens[at] in SUBJECTS:
            subjects.append(at + 1)
        if any(c.kind == "goal" for c in clauses[at]):
            return
        far = _MOST_SUBJECT if tokens[at] in OWNED else 3
        if not subjects and not _BEING & {*tokens[at + 1 : at + 1 + far]}:
            return
        said_of = (m.end for m in mentions[at] if not (m.pronoun or m.quantifier))
        is_subject = any({*tokens[e : e + 1]} & _BEING for e in said_of)
        for end in range(at + 3, min(at + _MOST_TOLD, len(tokens) - 1) + 1):
            if tokens[end - 1] in _CONDITIONS or tokens[end - 1] in _CORRECTING - {"not"}:
                return
            is_subject = is_subject and tokens[end - 1] not in ("and", COMMA, BREAK)
            if tokens[end] == _SO and self.asks(tokens, end + 1, clauses):
                yield at, end + 1
                return  # What is asked for behind it isn't told any more.
            asked = self._requests.may_begin(tokens, end) and any(map(_takes_up, clauses[end]))
            if asked and is_subject:
                yield at, end
                return

    def _deadline(self, tokens: Sequence[str], at: int, clauses: Clauses) -> Iterator[Span]:
        """`... before the soup gets cold`, at the end, where it is nothing that could be known."""
        start, size = at + 1, len(tokens)
        if (
            tokens[at] != "before"
            or not _LEAST_LATE <= size - at <= _MOST_LATE
            or "not" in tokens[:at]  # Then it waits for that.
        ):
            return
        subject = tokens[start] in OWNED or tokens[start] in SUBJECTS
        if not subject or _ENDING & {*tokens[start:]} or BREAK in tokens[start:]:
            return
        if not any(clauses[start:]):
            yield at, size

    def _for_others(
        self, tokens: Sequence[str], at: int, mentions: Sequence[Sequence[Mention]]
    ) -> Iterator[Span]:
        """`... for the summer buffet`: what or whom something is for, where that is nothing known."""
        if tokens[at] != _FOR:
            return
        if at + 1 < len(tokens) and tokens[at + 1].endswith("ing"):
            if at + 2 == len(tokens) or tokens[at + 2] in _BEHIND:
                yield at, at + 2  # "For folding".
            return
        if not {*tokens[at + 1 : at + 2]} & {*OWNED}:
            return
        for end in range(at + 3, min(at + _MOST_FOR, len(tokens)) + 1):
            last = tokens[end - 1]
            begins = self._requests.may_begin(tokens, end - 1) and tokens[end - 2] not in OWNED
            if last in _CONDITIONS or any(m.candidates for m in mentions[end - 1]) or begins:
                return
            if last not in SMALL and (end == len(tokens) or tokens[end] in _BEHIND):
                yield at, end

    def _occasion(
        self,
        tokens: Sequence[str],
        at: int,
        mentions: Sequence[Sequence[Mention]],
        clauses: Clauses,
    ) -> Iterator[Span]:
        """`for the starter we need ...`: what something is wanted for, where that is nothing known."""
        if tokens[at] != _FOR:
            return
        for end in range(at + 2, min(at + _MOST_OCCASION, len(tokens) - 1) + 1):
            last = tokens[end - 1]
            if last in _CONDITIONS or last in (BREAK, COMMA):
                return
            named = any(m.end == end for there in mentions[at + 1 : end] for m in there)
            if last not in SMALL and not named and self.asks(tokens, end, clauses):
                yield at, end


def _corrects(words: Sequence[str]) -> bool:
    """Whether words may take something back: "not her", but not "she is not a reader"."""
    denied = {i for i, word in enumerate(words) if word == "not" and i and words[i - 1] in BE_OR_DO}
    return any(w in _CORRECTING for i, w in enumerate(words) if i not in denied)


def _takes_up(clause: Clause) -> bool:
    """Whether a request is about what was just spoken of: "the magazine's in the way, move it"."""
    asked = clause.kind == "goal" and clause.form == "base"
    return asked and any(m.pronoun in ("it", "them") for _, m in clause.bindings)


def _leans(clause: Clause, first: str) -> bool:
    """Whether a clause asks for something with the verb before it; "in the office" tells where somebody is."""
    named = [m for _, m in clause.bindings if not m.pronoun]
    return clause.kind == "ellipsis" and bool(named) and (first == "to" or len(named) > 1)
