"""Finds mentions: determiners, possessives, quantifiers, adjectives and lists around names."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import cast

from polaris_nl.language.grammar import Grammar
from polaris_nl.language.lexicon import Lexicon
from polaris_nl.language.mention import Mention, Quantifier
from polaris_nl.language.tokens import BREAK, COMMA, PhraseSet

_SPEAKERS = ("me", "i", "us", "myself", "we")
THINGS = ("object", "thing", "item", "everything", "whatever", "anything", "something", "nothing")
"""Nouns that an adjective can follow: "everything clean"."""
DESCRIPTIONS = 3
"""Descriptions that can follow each other: "the ball on the floor by the bed in the corner"."""
_JOINERS = PhraseSet(
    (
        ("as", "well", "as"),
        ("along", "with"),
        ("together", "with"),
        ("and", "also"),
        ("plus",),
    )
)
_TAKEN_UP = ("it", "that", "them")
"""Pronouns for what "everything on it" is on."""
_WITHIN = ("on", "in", "at", "inside")
_OVER = ("over", "out", "down", "up", "through")
"""Words before those that say where a thing is: "the table over in the canteen"."""
_AGAIN = PhraseSet(
    (("to",), ("on",), ("in",), ("into",), ("onto",), ("at",), ("from",), ("either", "to"))
)
"""Prepositions that are said again after "or": "on the desk or on the table"."""


class MentionFinder:
    """Finds the mentions of one world's entities."""

    def __init__(self, lexicon: Lexicon, grammar: Grammar) -> None:
        common = grammar.common
        self._lexicon = lexicon
        self._determiners = set(common.determiners)
        self._quantifiers: dict[tuple[str, ...], Quantifier] = {}
        self._quantifiers.update(dict.fromkeys(common.all, "all"))
        self._quantifiers.update(dict.fromkeys(common.both, "both"))
        self._quantifiers.update(dict.fromkeys(common.rest, "rest"))
        self._quantifiers.update(dict.fromkeys(common.none, "none"))
        self._pro_quantifiers = {k: cast(Quantifier, v) for k, v in common.quantified.items()}
        self._excepting = PhraseSet(common.excepting)
        self._beside = PhraseSet(common.beside)
        self._whereabouts = PhraseSet(common.whereabouts)
        self._numbers = common.numbers
        self._possessives = {k: v or "any" for k, v in common.possessives.items()}
        self._pronouns = {tuple(k.split()): k for k in common.pronouns}
        self.adjectives = _adjectives(grammar)
        """What adjectives say of a thing: (predicate, positive)."""
        self._which = PhraseSet(common.listed("which-is"))
        self._from = PhraseSet(common.listed("from"))

    def at(self, tokens: Sequence[str], start: int) -> tuple[Mention, ...]:
        """All mentions that start at a position: lists, places and single ones."""
        return tuple(self._all(tokens, start))

    def _all(self, tokens: Sequence[str], start: int) -> Iterator[Mention]:
        if start < len(tokens) and tokens[start] == "neither":
            for listed in self._all(tokens, start + 1):
                if listed.parts and "nor" in tokens[start : listed.end]:
                    yield replace(listed, start=start, quantifier="none", alternative=False)
        if start < len(tokens) and tokens[start] == "both":
            for listed in self._all(tokens, start + 1):
                if listed.parts and not (listed.alternative or listed.parts[0].plural):
                    yield replace(listed, start=start)
        for single in self._single(tokens, start):
            if tokens[start] == "no" and (tokens[start + 1],) in self._determiners:
                continue  # "On the counter, no, the table" corrects; it isn't none of anything.
            placed = list(self._placed(tokens, single))
            for mention in (*placed, single):
                yield from self._excepted(tokens, mention)
                yield from self._listed(tokens, mention)
                yield mention

    def _excepted(self, tokens: Sequence[str], mention: Mention) -> Iterator[Mention]:
        """`all the cups except the red one`; in "... except the red one from the desk" all are there."""
        if not (mention.plural or mention.quantifier in ("all", "rest")):
            return
        size = self._excepting.length_at(tokens, mention.end)
        for left_out in self.at(tokens, mention.end + size) if size else ():
            longer = _longer(tokens, mention, left_out.end)
            place = left_out.parts[-1].place if left_out.parts else left_out.place
            if place is None or not self._taken_from(tokens, left_out.start, place):
                yield replace(longer, excepted=left_out)
            elif mention.place is None:
                yield replace(longer, excepted=_without_place(left_out), place=place)

    def _taken_from(self, tokens: Sequence[str], start: int, place: Mention) -> bool:
        """Whether a thing's place is where it is taken from: "the cup from the desk"."""
        starts = range(start, place.start)
        return any(at + self._from.length_at(tokens, at) == place.start for at in starts)

    def _listed(self, tokens: Sequence[str], first: Mention) -> Iterator[Mention]:
        """`a, b and c`; `a or b`; each prefix that ends in a joined one."""
        stands_before = (first.quantifier or first.pronoun) == "both" and not first.plural
        if first.text == "one" or stands_before:
            return  # "In room one and the cup ..."; "both the cup and the plate".
        parts, at, joined, alternative = [first], first.end, False, False
        while at < len(tokens) and len(parts) < 12:
            step = at + 1 if tokens[at] == COMMA else at
            word = tokens[step] if step < len(tokens) else ""
            joiner = _JOINERS.length_at(tokens, step)
            if joiner:
                step, word = step + joiner - 1, "and"
            if word in ("and", "or", "nor"):
                joined, alternative, step = True, alternative or word == "or", step + 1
                if step < len(tokens) and tokens[step] == "then":
                    return
                step += _AGAIN.length_at(tokens, step) if alternative else 0
            elif step == at and not (
                (word,) in self._determiners
                # "Fork spoon and plate" are a list, too.
                or (self._is_named(tokens, first.start) and self._is_named(tokens, step))
            ):
                return
            following = next(iter(self._single(tokens, step)), None)
            if following is None or following.pronoun:
                return
            parts.append(following)
            at = following.end
            if joined:
                text = " ".join(tokens[first.start : at])
                found = Mention(first.start, at, text, parts=tuple(parts), alternative=alternative)
                yield found
                yield from self._all_there(tokens, found)

    def _is_named(self, tokens: Sequence[str], at: int) -> bool:
        """Whether a thing's name begins at a position, without an article."""
        return any(
            not entry.plural and any(c.rank <= 1 for c in entry.candidates)
            for _, entry in self._lexicon.at(tokens, at)
        )

    def _all_there(self, tokens: Sequence[str], several: Mention) -> Iterator[Mention]:
        """`the cup and the plate on the table`: the place is that of each."""
        if any(part.place for part in several.parts):
            return
        for found in self._described(tokens, several):
            if found.place is not None:
                parts = tuple(replace(part, place=found.place) for part in several.parts)
                yield replace(found, place=None, parts=parts)

    def _placed(self, tokens: Sequence[str], mention: Mention) -> Iterator[Mention]:
        """`the cup on the counter by the sink`: what is said of a thing to tell it from others."""
        if mention.pronoun and mention.pronoun != "one":
            return
        described = [mention]
        for _ in range(DESCRIPTIONS):
            described = [more for one in described for more in self._described(tokens, one)]
            yield from described

    def _described(self, tokens: Sequence[str], mention: Mention) -> Iterator[Mention]:
        """One more description: an owner, a place, what is near, or "on the floor", which says nothing."""
        at = mention.end
        if tokens[at : at + 1] in (["of"], ("of",)):
            yield from self._of(tokens, mention)
        inner = at + self._which.length_at(tokens, at)
        if tokens[at - 1] == "whatever" and tokens[at : at + 1] in (["is"], ("is",)):
            inner = at + 1
        if tokens[inner : inner + 1] and tokens[inner] in _OVER and tokens[inner + 1 : inner + 2]:
            inner += tokens[inner + 1] in _WITHIN
        origin = self._from.length_at(tokens, inner)
        if not origin and inner < len(tokens) and tokens[inner] in _WITHIN:
            origin = 1
        for place in self._single(tokens, inner + origin) if origin else ():
            taken_up = place.pronoun == "there" or (
                mention.quantifier and place.pronoun in _TAKEN_UP
            )
            if mention.place is None and (not place.pronoun or taken_up):
                yield replace(_longer(tokens, mention, place.end), place=place)
            elif mention.place is not None and self._is_region(place):
                # "On the table in the kitchen": where its place is, is known.
                yield replace(_longer(tokens, mention, place.end), beside=True)
        word = tokens[inner] if inner < len(tokens) else ""
        every = bool(mention.quantifier) and tokens[at - 1] in THINGS
        if word in self.adjectives and (inner > at or every):
            # "The dishes that are dirty", "everything clean".
            yield replace(
                _longer(tokens, mention, inner + 1),
                states=(*mention.states, *self.adjectives[word]),
            )
        # Which things are near others isn't known, so that only describes.
        size = self._beside.length_at(tokens, inner)
        if tokens[inner : inner + 1] in (["with"], ("with",)) and self._is_one(mention):
            size = 0  # "Go to the kitchen with the cup", "give her the tray with the cup" ask for both.
        for other in self._single(tokens, inner + size) if size else ():
            if not other.pronoun:
                yield replace(_longer(tokens, mention, other.end), beside=True)
        size = self._whereabouts.length_at(tokens, inner)
        if size and not (mention.quantifier and tokens[inner + size - 1] in _TAKEN_UP):
            yield replace(_longer(tokens, mention, inner + size), beside=True)

    def _is_one(self, mention: Mention) -> bool:
        """Whether it needn't be told from others, and nothing can stand on it."""
        named = {c.entity for c in mention.candidates}
        return len(named) == 1 and not mention.place and not named & self._lexicon.places

    def _is_region(self, place: Mention) -> bool:
        named = {c.entity for c in place.candidates}
        return bool(named) and named <= self._lexicon.regions

    def _of(self, tokens: Sequence[str], mention: Mention) -> Iterator[Mention]:
        """`the table of the resident`."""
        for owner in self._single(tokens, mention.end + 1):
            if owner.candidates and not mention.owner:
                yield replace(_longer(tokens, mention, owner.end), owner=owner.candidates[0].entity)

    def _single(self, tokens: Sequence[str], start: int) -> Iterator[Mention]:
        yield from self._pronoun(tokens, start)
        at, mention = start, Mention(start, start, "")
        for _ in range(8):
            yield from self._noun(tokens, start, at, mention)
            step, mention = self._modifier(tokens, at, mention)
            if step == at:
                return
            at = step

    def _noun(
        self, tokens: Sequence[str], start: int, at: int, mention: Mention
    ) -> Iterator[Mention]:
        for end, entry in self._lexicon.at(tokens, at):
            several = mention.quantifier or entry.plural
            found = replace(
                mention,
                quantifier=mention.quantifier or self._pro_quantifiers.get(tokens[at], ""),
                end=end,
                text=" ".join(tokens[start:end]),
                candidates=entry.candidates,
                plural=entry.plural,
                kind=entry.kind if several or mention.number else "",
            )
            yield from self._possessed(tokens, found)
            yield found
            if not entry.plural and self._wrong_apostrophe(tokens, end):
                yield replace(_longer(tokens, found, end + 1), plural=True, kind=entry.kind)
        one = tokens[at : at + 1] in (["one"], ["ones"], ("one",), ("ones",))
        if one and (mention.other or mention.states or at > start or tokens[at] == "one"):
            yield replace(mention, end=at + 1, text=" ".join(tokens[start : at + 1]), pronoun="one")

    def _wrong_apostrophe(self, tokens: Sequence[str], at: int) -> bool:
        """Whether `'s` stands where nothing is owned: "the CD's from the table" are several."""
        if tokens[at : at + 1] not in (["'s"], ("'s",)):
            return False
        following = tokens[at + 1] if at + 1 < len(tokens) else BREAK
        return following in (BREAK, COMMA, "and") or any(
            p.length_at([following], 0) for p in (self._from, _AGAIN)
        )

    def _possessed(self, tokens: Sequence[str], owner: Mention) -> Iterator[Mention]:
        """`the resident's table`."""
        if tokens[owner.end : owner.end + 1] not in (["'s"], ("'s",)) or not owner.candidates:
            return
        at = owner.end + 1
        base = Mention(owner.start, at, "", owner=owner.candidates[0].entity)
        for _ in range(4):
            for end, entry in self._lexicon.at(tokens, at):
                text = " ".join(tokens[owner.start : end])
                yield replace(
                    base, end=end, text=text, candidates=entry.candidates, plural=entry.plural
                )
            step, base = self._modifier(tokens, at, base)
            if step == at:
                return
            at = step

    def _modifier(self, tokens: Sequence[str], at: int, mention: Mention) -> tuple[int, Mention]:
        """Takes one determiner, quantifier, possessive, number or adjective."""
        for size in (4, 3, 2, 1):
            words = tuple(tokens[at : at + size])
            if len(words) == size and words in self._quantifiers:
                return at + size, replace(mention, quantifier=self._quantifiers[words])
        word = tokens[at] if at < len(tokens) else ""
        if word in self._numbers:
            return at + 1, replace(mention, number=self._numbers[word], quantifier="some")
        if word in self._possessives:
            return at + 1, replace(mention, owner=self._possessives[word])
        if word in ("other", "others"):
            return at + 1, replace(mention, other=True)
        if word in self.adjectives:
            return at + 1, replace(mention, states=(*mention.states, *self.adjectives[word]))
        if (word,) in self._determiners and not mention.owner:
            return at + 1, mention
        if word == "of" and mention.number:
            return at + 1, mention
        return at, mention

    def _pronoun(self, tokens: Sequence[str], start: int) -> Iterator[Mention]:
        for size in (3, 2, 1):
            words = tuple(tokens[start : start + size])
            if len(words) == size and words in self._pronouns:
                yield Mention(start, start + size, " ".join(words), pronoun=self._pronouns[words])
        if start < len(tokens) and tokens[start] in _SPEAKERS:
            yield Mention(start, start + 1, tokens[start], pronoun="me")


def _adjectives(grammar: Grammar) -> Mapping[str, tuple[tuple[str, bool], ...]]:
    found: dict[str, tuple[tuple[str, bool], ...]] = {}
    for phrases in grammar.predicates.values():
        for words, positive in ((phrases.adjectives, True), (phrases.not_adjectives, False)):
            for word in words:
                found[word] = (*found.get(word, ()), (phrases.predicate, positive))
    return found


def _longer(tokens: Sequence[str], mention: Mention, end: int) -> Mention:
    return replace(mention, end=end, text=" ".join(tokens[mention.start : end]))


def _without_place(mention: Mention) -> Mention:
    return replace(mention, place=None, parts=tuple(map(_without_place, mention.parts)))
