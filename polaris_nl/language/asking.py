"""Finds the question inside what people say around it: "I wonder whether ...", "..., isn't it"."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Sequence

from polaris_nl.language.commands import Softeners
from polaris_nl.language.common import Common
from polaris_nl.language.patterns import Patterns
from polaris_nl.language.template import first_words

AUXILIARIES = ("is", "are", "was", "were", "am", "has", "have", "had")
DOING = ("does", "do", "did")
SET_WORDS = ("who", "what", "which", "how")

Found = tuple[tuple[str, ...], bool]
"""Tokens, and whether they follow "I wonder", "tell me" or the like."""


class Asking:
    """Finds the question inside what people say around it.

    Args:
        common: whose words they are.
        patterns: the wordings of the questions.
    """

    def __init__(self, common: Common, patterns: Patterns) -> None:
        self.patterns = patterns
        self._softeners = Softeners(common)
        self._asking = frozenset(common.listed("asking"))
        self._longest = max((len(p) for p in self._asking), default=0)
        self._tags = common.listed("tag")
        wordings = [w for intent in common.of_kind("query") for w in intent.wordings]
        starts = (first_words(wording) or frozenset() for wording in wordings)
        self._first = frozenset((*AUXILIARIES, *DOING, *SET_WORDS)).union(*starts)

    def within(self, tokens: Sequence[str]) -> Iterator[Found]:
        """The tokens as they are, then without more and more of what is around them."""
        waiting: deque[Found] = deque([(tuple(tokens), False)])
        seen: set[Found] = set()
        while waiting:
            start, indirect = waiting.popleft()
            for inner in self._softeners.within(start):
                if (inner, indirect) in seen:
                    continue
                seen.add((inner, indirect))
                if inner[0] in self._first or "what" in inner or indirect:
                    yield inner, indirect
                for size in range(1, min(self._longest, len(inner) - 1) + 1):
                    if inner[:size] in self._asking:
                        waiting.append((inner[size:], True))

    def untagged(self, tokens: tuple[str, ...]) -> Iterator[tuple[str, ...]]:
        """The tokens without "isn't it" at their end."""
        for tag in self._tags:
            if len(tokens) > len(tag) + 1 and tokens[-len(tag) :] == tag:
                yield tokens[: -len(tag)]
