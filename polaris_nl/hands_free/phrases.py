"""What a recogniser should expect in a conversation: the world's phrases, and the conversation's own."""

from __future__ import annotations

from polaris_nl.hands_free.choices import choice_phrases
from polaris_nl.hands_free.listening import MODE_PHRASES
from polaris_nl.language.understanding import Understanding


def spoken_phrases(understanding: Understanding) -> tuple[str, ...]:
    """The phrases of a conversation, in a fixed order."""
    return (*understanding.phrases(), *choice_phrases(), *MODE_PHRASES)
