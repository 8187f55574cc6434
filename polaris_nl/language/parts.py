"""What of an utterance that isn't understood as a whole may be the request: the rest may only be told.

People wrap a request into what the robot can't know: "the phone is ringing, so take her the pills". To
refuse all of it is worse than to ask whether a part was meant; to do a part unasked is worse still.
"""

from __future__ import annotations

from collections.abc import Container, Iterator, Sequence
from itertools import chain

from polaris_nl.language.clauses import Clause
from polaris_nl.language.mention import Mention
from polaris_nl.language.requests import BE_OR_DO, SUBJECTS
from polaris_nl.language.tokens import BREAK, COMMA

MOST = 5
"""Parts that are tried: each costs as much as an utterance."""
LEAST = 2
"""Words of a part."""
_CHANGING = frozenset((
    "if", "when", "once", "while", "unless", "until", "till", "except", "only", "instead", "before",
    "otherwise"
))  # fmt: skip
"""Words without which the others would ask for something else."""
_CHANGING_BEHIND = _CHANGING | {"not", "never", "no"}
"""The same behind them: "open the fridge, no, ..."."""
_NOT_BEFORE = SUBJECTS | BE_OR_DO | frozenset((
    "to", "not", "never", "and", "or", "the", "a", "should", "must", "might", "may", "let", "being", "prior"
))  # fmt: skip
"""Words behind which a verb asks for nothing."""
_CORRECTING = frozenset((
    "no", "sorry", "actually", "rather", "forget", "meant", "mean", "wrong", "scratch", "mind", "undo"
))  # fmt: skip
"""Words of what is taken back."""
_STEPS = frozenset(("step", "part", "bit", "steps", "last", "first"))
"""Words about the program: the step that is meant is named in what is told."""
_TOLD = frozenset((
    "smells", "rang", "sent", "says", "said", "left", "wants", "goes", "went", "feels", "comes",
    "came"
))  # fmt: skip
"""More verbs of what is told."""
_TAKEN_UP = frozenset(("it", "them", "one", "there", "that", "those", "these", "him", "her", "his"))
"""Pronouns for what was spoken of."""
_ASKING_YOU = frozenset(("could", "can", "would", "will"))
_REPORTING = frozenset(
    ("asked", "said", "says", "asks", "whether", "wonder", "wonders", "what", "how", "where")
)
"""Words behind which somebody else's request is told."""
_THINGS = _TAKEN_UP - {"him", "her", "his"}
"""Pronouns for what may have been named by words that aren't known."""
_ASKING = frozenset(("where", "what", "which", "who", "how", "why", "undo"))
"""Words that a question begins with wherever it stands, and that commands about the program do."""
_LEADING = frozenset(("if", "when", "once", "unless", "could", "can", "would", "please"))
"""Words that may stand before what is asked for, and belong to it."""
_OPENING = frozenset(
    ("because", "since", "as", "cause", "and", "so", "sorry", "oh", "well", "okay", "right")
)
"""Words that what is told may begin with."""
_REASON = ("because", "cause")
_NAMING = frozenset(("the", "her", "his", "their", "your", "mine", "who", "which"))
_DUTY = frozenset((
    "should", "must", "shall", "let", "please", "you", "want", "wants", "rather", "like", "prefer",
    "stay", "stays", "belongs", "goes"
))  # fmt: skip
"""Words of what is asked for after all."""


def behind_told(
    tokens: Sequence[str],
    clauses: Sequence[Sequence[Clause]],
    mentions: Sequence[Sequence[Mention]],
) -> tuple[int, tuple[str, ...]] | None:
    """Where a request begins behind what is only told, and the things named there; None if nothing is.

    `the phone is ringing so you take her the pills`, `the napkin has a stain, bin it`: words that aren't
    known may stand in what is told, but no request, no condition, and no "not" right before the request.

    Args:
        tokens: the utterance.
        clauses: those that start at each position.
        mentions: the same.
    """
    if not tokens or tokens[0] in BE_OR_DO | _ASKING:
        return None  # "Is it open then close it" asks first.
    for at in range(LEAST + 1, len(tokens) - 1):
        if _CORRECTING.intersection(tokens[:at]) or _STEPS.intersection(tokens[at:]):
            return None
        if _CHANGING.intersection(tokens[:at]) or any(map(_wished, chain(*clauses[:at]))):
            return None
        if not BE_OR_DO.union(_TOLD).intersection(tokens[:at]):
            continue
        start = at + (tokens[at] == "so")
        asked = _polite(tokens, at)
        begins = _requests(clauses[at]) and tokens[at - 1] not in _NOT_BEFORE | _REPORTING
        if start == at and not begins and not (asked and _requests(clauses[asked])):
            continue
        named = _named(mentions, at)
        if named is None and _TAKEN_UP.intersection(tokens[start:]):
            return None  # What "it" is isn't known.
        return start, named or ()
    return None


def without_told(
    tokens: Sequence[str], clauses: Sequence[Sequence[Clause]]
) -> tuple[tuple[str, ...], tuple[str, ...]] | None:
    """What is asked for between commas, and what is only told there; None where nothing is told.

    `scrap the reminder, the staff do that themselves`: what is told has a subject and its verb, asks for
    nothing, and forbids nothing. Only what is typed has commas; "because" does for one.

    Args:
        tokens: the utterance.
        clauses: those that start at each position.
    """
    marks = (BREAK, COMMA)
    ends = [at for at, token in enumerate(tokens) if token in marks or (at and token in _REASON)]
    starts = [0, *(at + (tokens[at] in marks) for at in ends)]
    spans = list(zip(starts, [*ends, len(tokens)], strict=True))
    spans = [(start, end) for start, end in spans if start < end]
    told = [
        span for span in spans if _only_tells(tokens[span[0] : span[1]], clauses[span[0] : span[1]])
    ]
    if not told or len(told) == len(spans):
        return None
    kept: list[str] = []
    for start, end in spans:
        if (start, end) not in told:
            kept += [COMMA] * bool(kept) + list(tokens[start:end])
    aside = " ".join(token for start, end in told for token in tokens[start:end])
    return tuple(kept), (aside,)


def _only_tells(words: Sequence[str], clauses: Sequence[Sequence[Clause]]) -> bool:
    """Whether a part between commas only tells something."""
    if words[0] in _OPENING:
        words, clauses = words[1:], clauses[1:]
    if len(words) < LEAST:
        return False
    if not (words[0] in SUBJECTS or words[0] in _NAMING or words[1] in BE_OR_DO):
        return False
    if not BE_OR_DO.union(_TOLD).intersection(words[1:]) and not _verbal(words[1]):
        return False
    if _CHANGING.union(_CORRECTING, _STEPS, _DUTY).intersection(words):
        return False
    return not any(map(_wished, chain(*clauses)))


def _verbal(word: str) -> bool:
    """Whether a word behind a pronoun looks like a verb: "he likes", "she dropped"."""
    return len(word) > 3 and word.endswith(("s", "ed"))


def _polite(tokens: Sequence[str], at: int) -> int:
    """Where what is asked for begins behind "could you" or "please" at a position, or 0."""
    if tokens[at - 1] in _REPORTING:
        return 0  # "He asked could you ..." may be told.
    if tokens[at] == "please" and at + 1 < len(tokens):
        return at + 1
    asks = tokens[at] in _ASKING_YOU and tuple(tokens[at + 1 : at + 2]) == ("you",)
    return at + 2 if asks and at + 2 < len(tokens) else 0


def _wished(clause: Clause) -> bool:
    """Whether a clause asks for something, in whatever form."""
    return clause.kind in ("goal", "wish") and bool(clause.bindings)


def _requests(clauses: Sequence[Clause]) -> bool:
    return any(c.kind == "goal" and c.form == "base" and c.bindings for c in clauses)


def _named(mentions: Sequence[Sequence[Mention]], end: int) -> tuple[str, ...] | None:
    """The things that are named before a position, or None where there is none, or it isn't clear which."""
    found: list[str] = []
    at = 0
    while at < end:
        longest = max((m for m in mentions[at] if m.end <= end), key=lambda m: m.end, default=None)
        if longest is None:
            at += 1
            continue
        entities = {c.entity for c in longest.candidates if c.rank <= 1}
        if len(entities) == 1:
            found += entities
        at = longest.end
    return tuple(found) or None


def parts(
    tokens: Sequence[str], clauses: Sequence[Sequence[Clause]], known: Container[str]
) -> Iterator[tuple[str, ...]]:
    """Parts of an utterance that may be what was asked for, the longest first.

    Args:
        tokens: the utterance.
        clauses: those that start at each position.
        known: the words of grammar and world; others are in no part.
    """
    size = len(tokens)
    starts = [at for at in range(size) if not at or _may_begin(tokens, at, clauses[at])]
    ends = [at for at in range(LEAST, size + 1) if at == size or _may_end(tokens, at)]
    spans = [
        (start, end)
        for start in starts
        for end in ends
        if LEAST <= end - start < size
        and not _changes(tokens, start, end)
        and not _asks(clauses, start, end)
        and not (start and _THINGS.intersection(tokens[start:end]))
    ]
    found = 0
    for start, end in sorted(spans, key=lambda s: (s[0] - s[1], s)):
        part = tuple(t for t in tokens[start:end] if t not in (BREAK, COMMA))
        if found < MOST and len(part) >= LEAST and all(t in known for t in part):
            found += 1
            yield part


def _may_begin(tokens: Sequence[str], at: int, clauses: Sequence[Clause]) -> bool:
    if tokens[at - 1] in ("to", "not", "never"):
        return False
    asked = any(c.kind == "goal" and c.form == "base" for c in clauses)
    asked = asked or any(c.kind == "wish" for c in clauses)
    return asked or tokens[at] in _ASKING or tokens[at] in _LEADING


def _may_end(tokens: Sequence[str], at: int) -> bool:
    """Whether a sentence of its own may begin at a position: "... i will do it", "... her son is here"."""
    if tokens[at] in (BREAK, COMMA):
        return True
    near = {*tokens[at + 1 : at + 4]} & BE_OR_DO
    return tokens[at] in SUBJECTS or bool(near) or tokens[at] in ("because", "since", "so", "as")


def _changes(tokens: Sequence[str], start: int, end: int) -> bool:
    """Whether a part would ask for something else than the whole: it leaves a condition out, or a "not"."""
    return bool(
        _CHANGING.intersection(tokens[:start]) or _CHANGING_BEHIND.intersection(tokens[end:])
    )


def _asks(clauses: Sequence[Sequence[Clause]], start: int, end: int) -> bool:
    """Whether more is asked for outside of a part, so that it would be lost."""
    before = (c for there in clauses[:start] for c in there if c.end <= start)
    behind = (c for there in clauses[end:] for c in there)
    return any(c.kind == "goal" and c.form == "base" and c.bindings for c in (*before, *behind))
