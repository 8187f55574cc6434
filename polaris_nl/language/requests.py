"""Where a request may begin, also with a verb that no goal begins with: "he is asleep mop the floor"."""

from __future__ import annotations

import re
from collections.abc import Collection, Sequence

SUBJECTS = frozenset(
    ("i", "we", "you", "they", "he", "she", "it", "that", "this", "there", "people", "everybody",
     "everyone", "somebody", "someone", "nobody", "my", "our")
)  # fmt: skip
"""Words that a sentence about something else can begin with, besides what has a name."""
BE_OR_DO = frozenset(
    (
        "is", "are", "am", "was", "were", "be", "been", "'s", "'m", "'re", "'ve", "'d", "'ll", "has", "have",
        "had", "can", "could", "will", "would", "do", "does", "did", "gets", "get", "needs", "need", "wants",
        "want", "looks", "keeps", "keep", "never",
    )
)  # fmt: skip
"""Verbs of what is told."""
SMALL = frozenset(
    (
        "the",
        "a",
        "an",
        "her",
        "his",
        "my",
        "our",
        "your",
        "their",
        "of",
        "to",
        "and",
        "this",
        "that",
    )
)
"""Words that no stretch of words ends with."""
_NO_VERBS = frozenset(
    (
        "to", "on", "in", "i", "we", "what", "into", "onto", "inside", "off", "over", "can", "could", "may",
        "might", "back", "be", "have", "do", "let", "free", "see",
    )
)  # fmt: skip
"""Words that goals can begin with and that are no verbs, or stand in anything that is told."""
_BEFORE_VERBS = SMALL | BE_OR_DO | {"not", "might", "should", "for", "very", "so", "still", "too"}
"""Words behind which a verb is no request: "likes to read", "is open", "a rest"."""
_PEOPLE = frozenset(("i", "we", "they", "he", "she"))
_BEFORE_OTHERS = _BEFORE_VERBS | SUBJECTS | {"got"}
_OBJECTS = frozenset(
    ("the", "a", "an", "some", "your", "his", "her", "him", "our", "their", "me", "us", "them")
)
_PARTICLES = frozenset(("up", "down", "on", "off", "out", "away"))
_NO_REQUEST = BE_OR_DO | SMALL | _OBJECTS | _PARTICLES | frozenset(
    (
        "about", "after", "all", "always", "and", "around", "as", "at", "back", "because", "before", "by",
        "during", "enough", "even", "for", "from", "here", "in", "into", "just", "like", "more", "near", "now",
        "of", "only", "or", "over", "quite", "rather", "really", "since", "such", "than", "that", "there",
        "through", "to", "under", "until", "what", "where", "who", "with", "without",
    )
)  # fmt: skip
"""Words before "the" or "him" that are no verb."""
_FORM = re.compile(r".*[aeiouy].*(ing|ed|ly)|.*[^s]s")
"""What no request begins with: "waiting", "dropped", "likes", but not "ring" or "press"."""


class Requests:
    """Tells where something may be asked for.

    Args:
        verbs: words that goals begin with.
    """

    def __init__(self, verbs: Collection[str]) -> None:
        self._verbs = frozenset(verbs) - _NO_VERBS

    def may_begin(self, words: Sequence[str], at: int) -> bool:
        """Whether a request may begin with the word at a position, which isn't the first."""
        before, word = words[at - 1 : at + 1]
        if word in self._verbs:
            # Nothing is asked of a thing that isn't named: "they leave things open".
            return before not in _BEFORE_VERBS | _PEOPLE and at + 1 < len(words)
        if word in _NO_REQUEST or before in _BEFORE_OTHERS or _FORM.fullmatch(word):
            return False
        behind = at + 1
        if behind < len(words) and words[behind] in _PARTICLES:
            behind += 1
        return behind < len(words) and words[behind] in _OBJECTS
