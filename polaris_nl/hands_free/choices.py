"""Numbered choices, for when something was not understood twice."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

NUMBERS = ("one", "two", "three")
_ORDINALS = ("first", "second", "third")
_LEADS = (
    "",
    "number ",
    "choice ",
    "option ",
    "the ",
    "i mean ",
    "i meant ",
    "i mean the ",
    "i meant the ",
)
_NONE = (
    "none", "none of them", "none of these", "no", "neither", "nope", "never mind", "cancel", "forget it",
)  # fmt: skip
_YES = ("yes", "yeah", "yep", "yes please", "yes i did", "right", "that's right", "that's it")


@dataclass(frozen=True, slots=True)
class Choices:
    """What may have been meant, by number.

    Attributes:
        sentences: in the order they are read out, at most three.
    """

    sentences: tuple[str, ...]

    @property
    def say(self) -> str:
        """The question."""
        if len(self.sentences) == 1:
            return f"Did you mean: {self.sentences[0]}? Say yes or no."
        told = "; ".join(f"{n}: {s}" for n, s in zip(NUMBERS, self.sentences, strict=False))
        return f"I didn't get that. Did you mean {told}? Say the number, or none."

    def chosen(self, text: str) -> str | None:
        """The sentence that an answer means, "" for none of them, or None where it is no answer."""
        if text in _NONE:
            return ""
        if len(self.sentences) == 1 and text in _YES:
            return self.sentences[0]
        for number, sentence in enumerate(self.sentences):
            if text in _answers(number):
                return sentence
        return sentence if (sentence := text) in self.sentences else None


def _answers(number: int) -> set[str]:
    word, ordinal = NUMBERS[number], _ORDINALS[number]
    plain = {lead + word for lead in _LEADS}
    return plain | {f"{lead}{ordinal}{tail}" for lead in _LEADS for tail in ("", " one")}


def choice_phrases() -> tuple[str, ...]:
    """What may be answered, for the recogniser."""
    found = {answer for number in range(len(NUMBERS)) for answer in _answers(number)}
    return (*sorted(found), *sorted(_NONE))


def choices_among(near: Sequence[str], examples: Sequence[str]) -> Choices | None:
    """Choices of what may have been said, filled up with what can be said; None without any."""
    found = tuple(dict.fromkeys((*near, *examples)))[: len(NUMBERS)]
    return Choices(found) if found else None
