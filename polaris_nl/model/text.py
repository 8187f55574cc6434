"""Small helpers for sentences."""

from __future__ import annotations

import re
from collections.abc import Sequence

NUMBERS = (
    "no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten", "eleven", "twelve"
)  # fmt: skip


def listed(texts: Sequence[str], word: str = "and") -> str:
    """Texts as a list in a sentence: "a", "a and b", "a, b and c"."""
    if len(texts) < 2:
        return "".join(texts)
    return f"{', '.join(texts[:-1])} {word} {texts[-1]}"


def sentence(text: str) -> str:
    """A clause as a sentence: first letter upper case, full stop at the end."""
    text = text.strip()
    if not text:
        return text
    end = "" if text[-1] in ".!?:" else "."
    return f"{text[0].upper()}{text[1:]}{end}"


def with_article(noun: str) -> str:
    """A noun with "a" or "an"."""
    return f"{'an' if noun[:1] in 'aeiou' else 'a'} {noun}"


def names_several(noun: str) -> bool:
    """Whether a noun is a plural already."""
    return noun == "people" or (noun.endswith("s") and not noun.endswith("ss"))


def plural_of(noun: str) -> str:
    """`dish` -> `dishes`, `box` -> `boxes`, `cup` -> `cups`."""
    if noun.endswith(("s", "x", "ch", "sh")):
        return noun + "es"
    return noun[:-1] + "ies" if noun.endswith("y") and noun[-2:-1] not in "aeiou" else noun + "s"


def in_words(count: int) -> str:
    """A count in words up to twelve, and in digits beyond."""
    return NUMBERS[count] if count < len(NUMBERS) else str(count)


def supposed(clause: str) -> str:
    """A clause to go after "if", of what isn't so: "the hall and the attic were connected"."""
    return re.sub(r"\b(is|are)\b", "were", clause, count=1)
