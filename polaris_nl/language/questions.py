"""Questions to the user: how they are put, and what counts as their answer."""

from __future__ import annotations

from collections.abc import Sequence

from polaris_nl.language.grammar import Common
from polaris_nl.language.mention import Mention
from polaris_nl.language.tokens import phrase
from polaris_nl.model.text import listed

SHOWN = 6


class Questions:
    """Puts questions and reads answers."""

    def __init__(self, common: Common) -> None:
        self._ordinals = {k: int(str(v)) for k, v in common.mapping("ordinals").items()}
        self._neither = set(common.words("neither"))

    def asked(self, about: str, options: Sequence[str]) -> str:
        """A question with its options."""
        if not options:
            return about
        shown = list(options[:SHOWN])
        more = f" ({len(options) - SHOWN} more)" if len(options) > SHOWN else ""
        return f"{about} {listed([f'the {o}' for o in shown], 'or').capitalize()}{more}?"

    def choice(
        self,
        tokens: Sequence[str],
        options: Sequence[tuple[str, str]],
        mentions: Sequence[Sequence[Mention]],
    ) -> str | None:
        """The entity that an answer chooses; "" for none of them; None where it is no answer."""
        if tuple(tokens) in self._neither:
            return ""
        core = [
            t
            for t in tokens
            if t not in ("the", "a", "an", "one", "number", "option", "please", "on", "in", "to")
        ]
        if not core and tokens and tokens[-1] == "one" and options:
            return options[0][1]
        if len(core) == 1 and core[0] in self._ordinals:
            number = self._ordinals[core[0]]
            if number == -1 or 1 <= number <= len(options):
                return options[number - 1 if number > 0 else -1][1]
        exact = [e for o, e in options if list(phrase(o)) == core]
        if exact:
            return exact[0]
        partial = [e for o, e in options if core and set(core) <= set(phrase(o))]
        if len(partial) == 1:
            return partial[0]
        names = {e for _, e in options}
        for mention in mentions[0] if mentions else ():
            if mention.end == len(tokens) and mention.candidates:
                meant = [c.entity for c in mention.candidates if c.entity in names]
                if len(meant) == 1:
                    return meant[0]
                if not options:
                    return mention.candidates[0].entity
        return None
