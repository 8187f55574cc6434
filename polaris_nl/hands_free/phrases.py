"""What a recogniser should expect in a conversation: the world's phrases, and the conversation's own."""

from __future__ import annotations

from polaris_nl.hands_free.choices import choice_phrases
from polaris_nl.language.tokens import phrase
from polaris_nl.language.understanding import Understanding

SLEEP = "go to sleep"
WAKE = "wake up"


def spoken_names(understanding: Understanding) -> tuple[str, ...]:
    """What the world's things are called, as it is spoken."""
    entities = understanding.world.entities.values()
    return tuple(" ".join(phrase(name)) for e in entities for name in (e.spoken, *e.synonyms))


def spoken_phrases(understanding: Understanding) -> tuple[str, ...]:
    """The phrases of a conversation, in a fixed order."""
    return (*understanding.phrases(), *choice_phrases(), SLEEP, WAKE)
