"""Numbered choices, for when something was not understood twice."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

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
YES, NO = "yes", "no"
_NONE = (
    "none", "none of them", "none of these", NO, "neither", "nope", "never mind", "cancel", "forget it",
)  # fmt: skip


@dataclass(frozen=True, slots=True)
class Choices:
    """What may have been meant, by number.

    Attributes:
        sentences: in the order they are read out, at most three.
        lead: what is said before the question.
    """

    sentences: tuple[str, ...]
    lead: str = ""

    @property
    def say(self) -> str:
        """The question."""
        if len(self.sentences) == 1:
            return f"Did you mean: {self.sentences[0]}? Say yes or no."
        *told, last = (f"{n}: {s}" for n, s in zip(NUMBERS, self.sentences, strict=False))
        lead = f"{self.lead} " if self.lead else ""
        return f"{lead}Did you mean {'; '.join(told)}; or {last}? Say the number, or none."

    @property
    def ask_again(self) -> str:
        """The question, where a mere "yes" doesn't tell which was meant."""
        return replace(self, lead="Which one?").say

    def chosen(self, text: str) -> str | None:
        """The sentence that an answer means, "" for none of them, or None where it is no answer.

        Args:
            text: what was said; any agreement is to be given as `YES`, any other as `NO`.
        """
        if text in _NONE:
            return ""
        if len(self.sentences) == 1 and text == YES:
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
    return Choices(found, "I didn't get that.") if found else None
