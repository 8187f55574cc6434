"""What was probably said: self-repairs, fillers in odd places, words said twice, words that sound alike.

People correct themselves in mid-sentence ("the red, no, the blue cup"), and recognisers write what
they hear ("bring it two the kitchen"). Each way to mend an utterance is offered as a candidate; only
one that is understood counts, and, but for outspoken corrections, only where the words as they
stand are not.
"""

from __future__ import annotations

import itertools
from collections.abc import Collection, Iterator, Mapping, Sequence

from polaris_nl.language.common import Common
from polaris_nl.language.mention import Mention
from polaris_nl.language.tokens import BREAK, COMMA, PhraseSet
from polaris_nl.language.verbs import Verbs, gerund

BACK = 10
"""Words that a repair can take back at most."""
_NO = "no"
_HESITATING = frozenset(("uh", "um", "oh", "er", "erm", "ah", "hmm", "wait", "sorry"))
"""Words before a "no" that say nothing."""
_MORE = frozenset(("too", "also", "well", "then", "and"))
"""Words of what comes on top, and in the place of nothing."""
_WAITS = frozenset(("if", "when", "once", "unless", "until", "till", "says", "said", "say"))
"""Words before a "no" that somebody else may say: "if she says no tell the nurse"."""
_TOLD_BEHIND = ("before", "is", "'s", "are", "was", "were")
"""Words with which more may be told behind a request."""
_WANTING = ("wants", "needs", "would", "could", "asks", "fancies")
_TAKEN_UP = ("it", "them", "one", "him", "her")
LONG = 25
"""Words beyond which fewer candidates are tried: each costs as much as a reading."""
MOST = 14
"""Candidates that are offered at most."""


class Repairs:
    """Ways to mend utterances.

    Args:
        common: fillers, markers of corrections, words that sound alike.
        verbs: the forms of the domain's verbs.
        types: the type of each entity.
        telling: adjectives that tell things from others, and can't be left out.
    """

    def __init__(
        self,
        common: Common,
        verbs: Verbs,
        types: Mapping[str, str],
        telling: Collection[str] = (),
    ) -> None:
        self._common = common
        self._verbs = verbs
        self._types = types
        self._alike = {
            word: tuple(w for w in group if w != word)
            for group in common.homophones
            for word in group
        }
        self._starts = {p[-1] for mark in common.connectives.values() for p in mark if p}
        self._dropped = PhraseSet((*common.fillers, *common.hesitations))
        self._remarks = PhraseSet(common.remarks)
        self._needing = PhraseSet(common.needing)
        self._markers = PhraseSet(common.markers)
        self._all_markers = PhraseSet((*common.markers, *common.hesitations))
        self._descriptors = {p[0] for p in common.descriptors}.difference(telling)

    def corrections(
        self, tokens: Sequence[str], mentions: Sequence[Sequence[Mention]]
    ) -> Iterator[list[str]]:
        """What remains where somebody says that they meant something else: "the desk, sorry, the table"."""
        corrected = itertools.chain(
            self._corrected(tokens, mentions, self._markers),
            self._begun_again(tokens, mentions),
            self._named_again(tokens, mentions),
        )
        yield from _different(tokens, (w for c in corrected for w in (c, _without_commas(c))))

    def without_fillers(self, tokens: Sequence[str]) -> list[str]:
        """Tokens without fillers inside of what is said: "put it please on the counter"."""
        return self._bare(tokens)

    def candidates(
        self, tokens: Sequence[str], mentions: Sequence[Sequence[Mention]]
    ) -> Iterator[list[str]]:
        """Other words that may have been meant, the likeliest first, each once."""
        yield from _different(tokens, self._all(list(tokens), mentions))

    def _all(self, tokens: list[str], mentions: Sequence[Sequence[Mention]]) -> Iterator[list[str]]:
        bare = self._bare(tokens)
        yield bare
        yield from self._active(bare, mentions if len(bare) == len(tokens) else ())
        yield from self._with_subject(tokens, mentions)
        yield from self._by_doing(tokens, mentions)
        yield from self._for_each(tokens, mentions)
        yield from self._corrected(tokens, mentions, self._all_markers)
        yield _once(tokens)
        yield self._undescribed(tokens, mentions)
        for at in range(1, len(bare)):
            if bare[at] == "'s":  # A wrong apostrophe: "the CD's" are several.
                yield [*bare[: at - 1], bare[at - 1] + "s", *bare[at + 1 :]]
        yield from self._nouns(tokens, mentions)
        counting = {tokens[m.start] for there in mentions for m in there if m.number and m.plural}
        for words in (bare, tokens):
            for at, word in enumerate(words):
                if at and (word in _TOLD_BEHIND or self._remarks.length_at(words, at)):
                    break  # In other words more could be passed over there.
                for other in () if word in counting else self._alike.get(word, ()):
                    yield [*words[:at], other, *words[at + 1 :]]

    def _nouns(
        self, tokens: list[str], mentions: Sequence[Sequence[Mention]]
    ) -> Iterator[list[str]]:
        """`the red or the blue cup` with its noun in both places."""
        for at, word in enumerate(tokens[:-1]):
            if word in ("or", "and") and mentions[at + 1]:
                noun = tokens[mentions[at + 1][-1].end - 1]
                yield [*tokens[:at], noun, *tokens[at:]]

    def _for_each(
        self, tokens: list[str], mentions: Sequence[Sequence[Mention]]
    ) -> Iterator[list[str]]:
        """`for each cup, bring it here`, `everything there, bring it here`: "bring each cup here"."""
        start = int(tokens[:1] == ["for"])
        if len(tokens) < 3 or not mentions:
            return
        for mention in mentions[start]:
            taken_up = next(
                (i for i in range(mention.end, len(tokens)) if tokens[i] in _TAKEN_UP), None
            )
            if mention.quantifier and taken_up is not None:
                rest = _bare_start(tokens[mention.end : taken_up])
                yield [*rest, *tokens[start : mention.end], *tokens[taken_up + 1 :]]

    def _undescribed(self, tokens: list[str], mentions: Sequence[Sequence[Mention]]) -> list[str]:
        """Tokens without adjectives in front of names that mean one thing only: "the old brown tray"."""
        kept: list[str] = []
        for at, word in enumerate(tokens):
            behind = at + 1
            while behind < len(tokens) and tokens[behind] in self._descriptors:
                behind += 1
            named = mentions[behind] if behind < len(tokens) else ()
            unique = any(len({c.entity for c in m.candidates}) == 1 for m in named)
            if word != COMMA and not (word in self._descriptors and unique):
                kept.append(word)
        return kept

    def _bare(self, tokens: Sequence[str]) -> list[str]:
        """Tokens without fillers and commas, wherever they stand: "put it, um, in the cupboard"."""
        found: list[str] = []
        at = 0
        while at < len(tokens):
            size = self._dropped.length_at(tokens, at)
            if not size and tokens[at] != COMMA:
                found.append(tokens[at])
            at += size or 1
        return found

    def _active(
        self, tokens: Sequence[str], mentions: Sequence[Sequence[Mention]]
    ) -> Iterator[list[str]]:
        """`the fridge needs opening`, `the tray must be taken to the table`: as an imperative."""
        for at in range(len(tokens)):
            size = self._needing.length_at(tokens, at)
            if not size or not at or at + size >= len(tokens):
                continue
            verb = tokens[at + size]
            form = "gerund" if verb.endswith("ing") else "participle"
            start = next(
                (i + 1 for i in range(at - 1, -1, -1) if tokens[i] == BREAK or tokens[i] in self._starts), 0
            )  # fmt: skip
            # "Everything that is there should be moved": the longest name before it.
            named = (i for i, there in enumerate(mentions) if any(m.end == at for m in there))
            start = min(next(named, start), start)
            for base in self._verbs.bases(verb, "gerund" if form == "gerund" else "participle"):
                yield [*tokens[:start], base, *tokens[start:at], *tokens[at + size + 1 :]]

    def _with_subject(
        self, tokens: list[str], mentions: Sequence[Sequence[Mention]]
    ) -> Iterator[list[str]]:
        """`mr brown is back and wants the paper`: who wants it is said once more."""
        for person in mentions[0] if mentions else ():
            if not self._kinds(person) <= {"person"} or not person.candidates:
                continue
            for at in range(person.end + 1, len(tokens) - 1):
                if tokens[at] in ("and", "but") and tokens[at + 1] in _WANTING:
                    yield [*tokens[: at + 1], *tokens[: person.end], *tokens[at + 1 :]]

    def _by_doing(
        self, tokens: list[str], mentions: Sequence[Sequence[Mention]]
    ) -> Iterator[list[str]]:
        """`clear the table by moving all that is on it to the sink`: how it is to be done, alone."""
        for at in range(2, len(tokens) - 2):
            if tokens[at] != "by" or BREAK in tokens or _WAITS & {*tokens[:at]}:
                continue
            named = [m for there in mentions[:at] for m in there if m.end == at and m.candidates]
            for base in self._verbs.bases(tokens[at + 1], "gerund") if named else ():
                rest = tokens[at + 2 :]
                if "it" in rest:
                    first = rest.index("it")
                    rest[first : first + 1] = tokens[named[0].start : at]
                yield [base, *rest]

    # Corrections

    def _corrected(
        self,
        tokens: Sequence[str],
        mentions: Sequence[Sequence[Mention]],
        markers: PhraseSet,
    ) -> Iterator[list[str]]:
        at = 1
        while at < len(tokens):
            size = markers.length_at(tokens, at)
            if tokens[at] == "like" and tokens[at - 1] in ("would", "'d", "should"):
                size = 0  # "I would like" is no hesitation.
            if size:
                before, rest = _bare_end(list(tokens[:at])), list(tokens[at + size :])
                rest = _bare_start(rest)
                if before and rest:
                    yield from self._said_again(before, rest)
                    yield from self._replaced(before, rest, len(tokens) - len(rest), mentions)
                    yield [*before[: self._clause_start(before)], *rest]
            at += size or 1

    def _begun_again(
        self, tokens: Sequence[str], mentions: Sequence[Sequence[Mention]]
    ) -> Iterator[list[str]]:
        """The same verb after a "no" says the clause again: "open the fridge no open the drawer"."""
        for at in range(1, len(tokens) - 1):
            before, rest = _bare_end(list(tokens[:at])), _bare_start(list(tokens[at + 1 :]))
            if tokens[at] != _NO or not rest or _MORE & set(rest) or BREAK in tokens:
                continue
            # A condition may stand before the verb: "if she's there open the fridge no open the drawer".
            verb = rest[0] in self._verbs.bases(gerund(rest[0]), "gerund")
            starts = (
                i for i in range(len(before)) if verb or not i or before[i - 1] in self._starts
            )
            start = max((i for i in starts if before[i] == rest[0]), default=None)
            if start is not None and not _WAITS & set(before[start:]):
                behind = len(tokens) - len(rest) + 1
                if any(
                    m.end == len(tokens) for there in mentions[behind : behind + 1] for m in there
                ):
                    # Nothing but somebody else is named: "tell Ann that ..., no, tell Bob".
                    yield from self._replaced(before, rest[1:], behind, mentions, start)
                yield [*before[:start], *rest]

    def _named_again(
        self, tokens: Sequence[str], mentions: Sequence[Sequence[Mention]]
    ) -> Iterator[list[str]]:
        """A thing right behind a "no" that stands right behind one of its type: "the cup no the plate"."""
        # "To the kitchen no to the office" says the preposition again, too.
        for at in range(1, len(tokens) - 1):
            if tokens[at] != _NO or _MORE & set(tokens[at:]):
                continue
            end = at
            while end > 1 and tokens[end - 1] in _HESITATING:
                end -= 1
            for lead, start in itertools.product((0, 1), range(max(end - BACK, 1), end)):
                if at + 1 + lead >= len(tokens) or _WAITS & set(tokens[:start]):
                    continue
                same = tokens[start - lead] == tokens[at + 1]
                old = [m for m in mentions[start] if m.end == end and same]
                new = [m for m in mentions[at + 1 + lead] if m.candidates]
                if any(self._kinds(o) & self._kinds(n) for o in old for n in new):
                    yield [*tokens[: start - lead], *tokens[at + 1 :]]

    def _said_again(self, before: list[str], rest: list[str]) -> Iterator[list[str]]:
        """A repair starts with the word at which what it repairs started: "the red no the blue cup"."""
        for at in range(len(before) - 1, max(len(before) - BACK, 0) - 1, -1):
            if before[at] == rest[0]:
                yield [*before[:at], *rest]
                return

    def _replaced(
        self,
        before: list[str],
        rest: list[str],
        restart: int,
        mentions: Sequence[Sequence[Mention]],
        first: int = 0,
    ) -> Iterator[list[str]]:
        """A thing takes the place of the latest of its type: "the cup to the desk, no, the plate"."""
        for new in mentions[restart] if restart < len(mentions) else ():
            size = new.end - new.start
            for at in range(len(before) - 1, first - 1, -1):
                for old in mentions[at] if at < len(mentions) else ():
                    if old.end <= len(before) and self._kinds(old) & self._kinds(new):
                        yield [*before[:at], *rest[:size], *before[old.end :], *rest[size:]]
                        return

    def _kinds(self, mention: Mention) -> set[str]:
        return {self._types[c.entity] for c in mention.candidates}

    def _clause_start(self, before: Sequence[str]) -> int:
        for at in range(len(before) - 1, -1, -1):
            if before[at] in self._starts or before[at] == BREAK:
                return at + 1
        return 0


def _different(tokens: Sequence[str], found: Iterator[list[str]]) -> Iterator[list[str]]:
    seen = {tuple(tokens)}
    for candidate in found:
        if candidate and tuple(candidate) not in seen:
            seen.add(tuple(candidate))
            yield candidate
        if len(seen) > (MOST if len(tokens) <= LONG else MOST // 3):
            return


def _once(tokens: Sequence[str]) -> list[str]:
    """Tokens without what was said twice in a row: "bring the bring the cup"."""
    found: list[str] = []
    for token in tokens:
        found.append(token)
        for size in (3, 2, 1):
            if len(found) >= 2 * size and found[-size:] == found[-2 * size : -size]:
                del found[-size:]
                break
    return found


def _without_commas(tokens: list[str]) -> list[str]:
    return [t for t in tokens if t != COMMA]


def _bare_start(tokens: list[str]) -> list[str]:
    while tokens and tokens[0] in (COMMA, BREAK):
        tokens = tokens[1:]
    return tokens


def _bare_end(tokens: list[str]) -> list[str]:
    while tokens and tokens[-1] in (COMMA, BREAK):
        tokens = tokens[:-1]
    return tokens
