"""Questions to the user: how they are put, and what counts as their answer."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

from polaris_nl.language.common import Common
from polaris_nl.language.dialogue import Pending
from polaris_nl.language.mention import Mention
from polaris_nl.language.referents import EVERY_ONE
from polaris_nl.language.resolve import Resolver
from polaris_nl.language.scope import Misfit, Scope
from polaris_nl.language.tokens import BREAK, COMMA, phrase
from polaris_nl.language.wording import GrammarWording
from polaris_nl.model.text import listed

SHOWN = 6
_SMALL = ("the", "a", "an", "one", "number", "option", "please", "on", "in", "to")
_LEADS = ("in", "into", "inside", "on", "onto", "to", "at", "from", "about", "with")

Mentions = Callable[[Sequence[str]], Sequence[Sequence[Mention]]]


class Questions:
    """Puts questions and reads answers."""

    def __init__(self, common: Common, resolver: Resolver, wording: GrammarWording) -> None:
        self._ordinals = common.ordinals
        self.neither = set(common.neither)
        self._resolver = resolver
        self._wording = wording

    def asked(self, about: str, options: Sequence[tuple[str, str]]) -> str:
        """A question with its options: each as spoken, with its entity."""
        if not options:
            return about
        shown = [self._wording.option(e, o) for o, e in options[:SHOWN]]
        more = f" ({len(options) - SHOWN} more)" if len(options) > SHOWN else ""
        text = listed(shown, "or")
        return f"{about} {text[:1].upper()}{text[1:]}{more}?"

    def choice(
        self, tokens: Sequence[str], pending: Pending, mentions: Mentions, scope: Scope
    ) -> tuple[str, ...] | None:
        """The entities that an answer chooses; () for none of them; None where it is no answer.

        Raises:
            Unclear: it may be the answer, but has several meanings.
        """
        tokens = [t for t in tokens if t not in (COMMA, BREAK)]
        if tuple(tokens) in self.neither:
            return ()
        one = self._by_words(tokens, pending.options)
        if one is not None:
            return (one,)
        for mention in _whole(tokens, mentions):
            try:
                found = self._by_mention(mention, pending, scope)
            except Misfit:
                continue
            if found and (not pending.number or len(found) == pending.number):
                return found
        return None

    def _by_words(self, tokens: Sequence[str], options: Sequence[tuple[str, str]]) -> str | None:
        """The option that is meant by its number or by words of its name."""
        core = [t for t in tokens if t not in _SMALL]
        if not core and options and tuple(tokens) in _FIRST:
            return options[0][1]
        if len(core) == 1 and core[0] in self._ordinals:
            number = self._ordinals[core[0]]
            if options and number <= len(options):
                return options[number - 1 if number > 0 else -1][1]
        exact = [e for o, e in options if list(phrase(o)) == core]
        if exact:
            return exact[0]
        partial = [e for o, e in options if core and set(core) <= set(phrase(o))]
        return partial[0] if len(partial) == 1 else None

    def _by_mention(
        self, mention: Mention, pending: Pending, scope: Scope
    ) -> tuple[str, ...] | None:
        names = [e for _, e in pending.options]
        if not names:
            return self._resolver.meant(mention, pending.types, scope).entities
        if mention.pronoun in EVERY_ONE or mention.quantifier in ("all", "both"):
            both = mention.quantifier == "both" or "both" in mention.pronoun
            return tuple(names) if len(names) == 2 or not both else None
        found = self._resolver.among(mention, names, scope)
        return found if len(found) == 1 or mention.parts or mention.plural else None


_FIRST = (("one",), ("number", "one"), ("option", "one"), ("the", "number", "one"))


def _whole(tokens: Sequence[str], mentions: Mentions) -> Iterator[Mention]:
    """The mentions that are all of an answer, with or without "in" or "to" in front."""
    for skipped in (0, 1) if tokens and tokens[0] in _LEADS else (0,):
        rest = tokens[skipped:]
        found = mentions(rest)
        yield from (m for m in (found[0] if found else ()) if m.end == len(rest))
