"""Reasons for refusing, and help: what was not understood, what is near it, what can be said instead."""

from __future__ import annotations

import itertools
from collections.abc import Collection, Sequence

from rapidfuzz import process

from polaris_nl.language.clauses import ClauseFinder
from polaris_nl.language.mention import Mention
from polaris_nl.language.segment import Cut
from polaris_nl.language.tokens import BREAK, COMMA
from polaris_nl.language.wording import GrammarWording
from polaris_nl.model.formula import Literal
from polaris_nl.model.text import listed, sentence, with_article
from polaris_nl.model.world import World

_SMALL = frozenset(
    {
        "the", "a", "an", "to", "of", "on", "in", "at", "and", "or",
        "it", "is", "are", "be", "my", "her", "his", "its", "me", "you",
        "i", "she", "he", "they", "them", "that", "this", "there", "with", "for",
        "from", "do", "not", "then", "now", "please", "just", "some",
    }
)  # fmt: skip
_TELLING = ("at", "alerted-to", "open", "robot-at", "in", "has")
"""Predicates that make the best examples, where a domain has them."""
NEAR = 80
"""How alike a word and a name must be, in percent, to ask whether the name was meant."""


class Refusals:
    """Puts refusals into words for one world."""

    def __init__(
        self, world: World, known: Collection[str], clauses: ClauseFinder, wording: GrammarWording
    ) -> None:
        self._world = world
        self._wording = wording
        self._known = known
        self._clauses = clauses
        self._spoken = [e.spoken for e in world.entities.values()]

    def unknown(self, tokens: Sequence[str], skipped: Sequence[str]) -> tuple[str, ...]:
        """The words to name: those that mean nothing here; else those that nothing accounted for."""
        strange = [w for w in tokens if w not in self._known and w not in (BREAK, COMMA)]
        content = [w for w in skipped if w not in _SMALL and w not in (BREAK, COMMA)]
        return tuple(dict.fromkeys(strange or content))

    def misfit(self, tokens: Sequence[str], mentions: Sequence[Sequence[Mention]]) -> str:
        """Why a thing that was named can't be in its place, or "": "the kitchen is a region, ..."."""
        found = (
            f for at in range(len(tokens)) for f in self._clauses.misfits(tokens, at, mentions)
        )
        best = max(found, key=lambda f: f[0], default=None)
        if best is None or not best[1].candidates or not best[2]:
            return ""
        entity = self._world.entities[best[1].candidates[0].entity]
        needed = listed([with_article(kind) for kind in best[2]], "or")
        return sentence(
            f"{self._wording.entity(entity.name)} is {with_article(entity.type)}, but {needed} is needed "
            f"there; name another one. {self.examples()}"
        )

    def reason(self, tokens: Sequence[str], unknown: Sequence[str], cuts: Sequence[Cut]) -> str:
        """A sentence or two: what wasn't understood, what is near, what can be asked."""
        strange = [w for w in unknown if w not in self._known]
        if strange:
            near = self._near(strange)
            hint = (
                f" Did you mean {listed([f'the {n}' for n in near], 'or')}?"
                if near
                else f" {self.examples()}"
            )
            words = listed([f'"{w}"' for w in strange[:4]])
            return f"I don't understand {words}.{hint}"
        if unknown:
            words = " ".join(unknown[:6])
            return f'I can\'t make a goal of "{words}" here. {self.examples()}'
        return f"I don't see what should be achieved. {self.examples()}"

    def told(self) -> str:
        """What to say where an utterance only tells how things are."""
        return f"That tells me how things are, but not what to achieve. {self.examples()}"

    def help(self) -> str:
        """What can be said."""
        return (
            f"{self.examples()} Add conditions with once, if, unless or otherwise; "
            "ask what I will do; say undo, read it back, or run it."
        )

    def examples(self) -> str:
        """Two or three things that can be asked of this robot, about things in this world."""
        found = []
        domain = self._world.domain
        for name in dict.fromkeys((*_TELLING, *domain.predicates)):
            predicate = domain.predicates.get(name)
            if predicate is None or predicate.internal or not domain.achievers(Literal(name)):
                continue
            args: list[str] = []
            for parameter in predicate.parameters:
                others = (e.name for e in self._world.of_type(*parameter.types))
                args.extend(itertools.islice((e for e in others if e not in args), 1))
            if len(args) == len(predicate.parameters):
                found.append(f'"{self._wording.goal(Literal(name, tuple(args)))}"')
        return f"You can say, for example, {listed(found[:3], 'or')}." if found else "Say a goal."

    def _near(self, words: Sequence[str]) -> list[str]:
        near: list[str] = []
        for word in words:
            found = process.extractOne(word, self._spoken, score_cutoff=NEAR)
            if found is not None and found[0] not in near:
                near.append(found[0])
        return near
