"""Finds mentions: determiners, possessives, quantifiers, adjectives and lists around names."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

from polaris_nl.language.grammar import Grammar
from polaris_nl.language.lexicon import Lexicon
from polaris_nl.language.mention import Mention, Quantifier
from polaris_nl.language.tokens import COMMA

_AND, _OR = ("and",), ("or",)


class MentionFinder:
    """Finds the mentions of one world's entities."""

    def __init__(self, lexicon: Lexicon, grammar: Grammar) -> None:
        common = grammar.common
        self._lexicon = lexicon
        self._determiners = set(common.words("determiners"))
        self._quantifiers: dict[tuple[str, ...], Quantifier] = {}
        self._quantifiers.update(dict.fromkeys(common.words("all"), "all"))
        self._quantifiers.update(dict.fromkeys(common.words("both"), "both"))
        self._numbers = {k: int(str(v)) for k, v in common.mapping("numbers").items()}
        self._possessives = {k: str(v) or "any" for k, v in common.mapping("possessives").items()}
        self._pronouns = {tuple(k.split()): k for k in common.mapping("pronouns")}
        self._adjectives = _adjectives(grammar)
        self._which = sorted(
            (tuple(x.split()) for x in _flat(common.lists.get("which-is", ""))),
            key=len,
            reverse=True,
        )
        self._from = sorted(
            (tuple(x.split()) for x in _flat(common.lists.get("from", ""))), key=len, reverse=True
        )

    def at(self, tokens: Sequence[str], start: int) -> tuple[Mention, ...]:
        """All mentions that start at a position: lists, places and single ones."""
        return tuple(self._all(tokens, start))

    def _all(self, tokens: Sequence[str], start: int) -> Iterator[Mention]:
        for single in self._single(tokens, start):
            placed = list(self._placed(tokens, single))
            for mention in (*placed, single):
                yield from self._listed(tokens, mention)
                yield mention

    def _listed(self, tokens: Sequence[str], first: Mention) -> Iterator[Mention]:
        """`a, b and c`; `a or b`; each prefix that ends in a joined one."""
        parts, at, joined, alternative = [first], first.end, False, False
        while at < len(tokens) and len(parts) < 12:
            step = at + 1 if tokens[at] == COMMA else at
            word = tokens[step] if step < len(tokens) else ""
            if word in ("and", "or"):
                joined, alternative, step = True, alternative or word == "or", step + 1
                if step < len(tokens) and tokens[step] == "then":
                    return
            elif step == at:
                return
            following = next(iter(self._single(tokens, step)), None)
            if following is None or following.pronoun:
                return
            parts.append(following)
            at = following.end
            if joined:
                text = " ".join(tokens[first.start : at])
                yield Mention(first.start, at, text, parts=tuple(parts), alternative=alternative)

    def _placed(self, tokens: Sequence[str], mention: Mention) -> Iterator[Mention]:
        """`the cup on the counter`, `the cup that is in the sink`, `the cup from the table`."""
        at = mention.end
        which = _prefix(tokens, at, self._which)
        inner = at + which
        origin = _prefix(tokens, inner, self._from)
        if not origin and inner < len(tokens) and tokens[inner] in ("on", "in", "at", "inside"):
            origin = 1
        if origin:
            for place in self._single(tokens, inner + origin):
                if not place.pronoun or place.pronoun == "there":
                    text = " ".join(tokens[mention.start : place.end])
                    yield replace(mention, end=place.end, text=text, place=place)

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
                end=end,
                text=" ".join(tokens[start:end]),
                candidates=entry.candidates,
                plural=entry.plural,
                kind=entry.kind if several or mention.number else "",
            )
            yield from self._possessed(tokens, found)
            yield found
        one = tokens[at : at + 1] in (["one"], ["ones"], ("one",), ("ones",))
        if one and (mention.other or mention.states or at > start):
            yield replace(mention, end=at + 1, text=" ".join(tokens[start : at + 1]), pronoun="one")

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
        if word == "other":
            return at + 1, replace(mention, other=True)
        if word in self._adjectives:
            return at + 1, replace(mention, states=(*mention.states, *self._adjectives[word]))
        if (word,) in self._determiners:
            return at + 1, mention
        return at, mention

    def _pronoun(self, tokens: Sequence[str], start: int) -> Iterator[Mention]:
        for size in (3, 2, 1):
            words = tuple(tokens[start : start + size])
            if len(words) == size and words in self._pronouns:
                yield Mention(start, start + size, " ".join(words), pronoun=self._pronouns[words])
        if tokens[start : start + 1] in (["me"], ["i"], ["myself"], ("me",), ("i",), ("myself",)):
            yield Mention(start, start + 1, tokens[start], pronoun="me")


def _adjectives(grammar: Grammar) -> Mapping[str, tuple[tuple[str, bool], ...]]:
    found: dict[str, tuple[tuple[str, bool], ...]] = {}
    for phrases in grammar.predicates.values():
        for words, positive in ((phrases.adjectives, True), (phrases.not_adjectives, False)):
            for word in words:
                found[word] = (*found.get(word, ()), (phrases.predicate, positive))
    return found


def _flat(choice: str) -> list[str]:
    return [option.strip() for option in choice.strip("()").split("|") if option.strip()]


def _prefix(tokens: Sequence[str], at: int, phrases: Sequence[tuple[str, ...]]) -> int:
    """The length of the longest of some phrases that stands at a position, or 0."""
    return next((len(p) for p in phrases if tuple(tokens[at : at + len(p)]) == p), 0)
