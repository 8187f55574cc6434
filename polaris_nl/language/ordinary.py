"""Ordinary words of a language: what is one is not taken for a slip of another word.

The words are pyspellchecker's dictionary, which is read when the first unknown word comes up.
"""

from __future__ import annotations

from functools import cache
from typing import Any


def is_ordinary(word: str, language: str = "en") -> bool:
    """Whether a lower-case word is one that people use; False in a language without a dictionary."""
    dictionary = _dictionary(language)
    return dictionary is not None and word in dictionary


@cache
def _dictionary(language: str) -> Any:
    from spellchecker import SpellChecker

    try:
        return SpellChecker(language=language).word_frequency
    except ValueError:
        return None
