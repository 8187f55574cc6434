"""Utterances as normal words: lower case, contractions written out, numbers as words, no fillers of spelling.

The splitting is spaCy's (a blank English pipeline: rules, no statistical model).
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterable, Sequence
from functools import cache
from typing import Any

LONGEST = 2_000
"""Characters beyond which an utterance is refused: nobody says so much in one breath."""
MOST_WORDS = 300

_CONTRACTIONS = {
    "n't": "not", "nt": "not", "'d": "would", "'ll": "will", "'m": "am", "'re": "are", "'ve": "have",
    "ca": "can", "wo": "will", "sha": "shall", "cannot": "can",
}  # fmt: skip
_IN_FULL = {
    "gonna": "going to", "wanna": "want to", "gotta": "got to", "gimme": "give me", "lemme": "let me",
}  # fmt: skip
"""Written out before anything is split."""
_NUMBERS = [
    "zero",
    "one",
    "two",
    "three",
    "four",
    "five",
    "six",
    "seven",
    "eight",
    "nine",
    "ten",
    "eleven",
    "twelve",
    "thirteen",
    "fourteen",
    "fifteen",
    "sixteen",
    "seventeen",
    "eighteen",
    "nineteen",
    "twenty",
]
_SPELLINGS = {
    "colour": "color", "grey": "gray", "favourite": "favorite", "centre": "center", "okay": "ok",
    "til": "till", "'til": "till", "cos": "because",
}  # fmt: skip
_SUBJECTS = frozenset(
    (
        "it",
        "that",
        "this",
        "there",
        "here",
        "what",
        "where",
        "who",
        "how",
        "she",
        "he",
        "everything",
        "whatever",
    )
)
"""Words after which `'s` is a verb, not a possessive."""
BREAK, COMMA = ".", ","
_BREAKS = {
    ".": BREAK,
    "!": BREAK,
    "?": BREAK,
    ";": BREAK,
    ":": COMMA,
    ",": COMMA,
    "…": BREAK,
    "\n": BREAK,
}


@cache
def _tokenizer() -> Any:
    """Makes spaCy's tokenizer for English with what `words` leaves to it: contractions and possessives.

    The pipeline around it takes longer to make than all else here, as do its rules for capitals and web
    addresses.
    """
    from spacy.lang.en import EnglishDefaults
    from spacy.tokenizer import Tokenizer
    from spacy.util import compile_prefix_regex, compile_suffix_regex
    from spacy.vocab import Vocab

    exceptions = EnglishDefaults.tokenizer_exceptions
    return Tokenizer(
        Vocab(),
        rules={text: parts for text, parts in exceptions.items() if text == text.lower()},
        prefix_search=compile_prefix_regex(EnglishDefaults.prefixes or ()).search,
        suffix_search=compile_suffix_regex(EnglishDefaults.suffixes or ()).search,
    )


def plain(text: str) -> str:
    """A text without control characters, its quotes and dashes made simple."""
    text = unicodedata.normalize("NFKC", text)
    text = (
        text.replace("\u2019", "'")
        .replace("\u2018", "'")
        .replace("\u2014", ", ")
        .replace("\u2013", " ")
    )
    return "".join(c if c.isprintable() or c in "\n\t" else " " for c in text)


def words(text: str) -> list[str]:
    """The words of a text and its marks: `.` for the end of a sentence and `,` for a comma."""
    lowered = re.sub(r"[\"“”()\[\]{}<>*_/\\|~^`#@=+%&$-]", " ", plain(text).lower())
    lowered = re.sub(r"\s*\n\s*", " . ", lowered.strip())
    lowered = re.sub(rf"\b({'|'.join(_IN_FULL)})\b", lambda m: _IN_FULL[m[0]], lowered)
    # Marks stand alone, so that "1." and "home." are split the same way.
    lowered = re.sub(r"([.,!?;:…])", r" \1 ", lowered)
    found: list[str] = []
    for token in _tokenizer()(re.sub(r"\s+", " ", lowered).strip()):
        word = token.text
        if not word.isspace():
            found.append(_normal(word, found))
    return [word for word in found if word]


def _normal(word: str, before: list[str]) -> str:
    if word in _BREAKS:
        return _BREAKS[word]
    if word == "'s" and before and before[-1] in _SUBJECTS:
        return "is"
    if word == "'":
        return "'s" if before and before[-1].endswith("s") else ""
    if word.isascii() and word.isdigit() and int(word) < len(_NUMBERS):
        return _NUMBERS[int(word)]
    return _CONTRACTIONS.get(word) or _SPELLINGS.get(word) or word


@cache
def phrase(text: str) -> tuple[str, ...]:
    """The words of a name or a wording, without marks."""
    return tuple(w for w in words(text.replace("_", " ")) if w not in (BREAK, COMMA))


class PhraseSet:
    """Phrases, for finding the longest that stands at a position."""

    def __init__(self, phrases: Iterable[tuple[str, ...]]) -> None:
        self._by_first: dict[str, list[tuple[str, ...]]] = {}
        for words_of_it in sorted({p for p in phrases if p}, key=lambda p: (-len(p), p)):
            self._by_first.setdefault(words_of_it[0], []).append(words_of_it)

    def length_at(self, tokens: Sequence[str], at: int) -> int:
        """The number of words of the longest phrase that stands at a position, or 0."""
        if at >= len(tokens):
            return 0
        for found in self._by_first.get(tokens[at], ()):
            if tuple(tokens[at : at + len(found)]) == found:
                return len(found)
        return 0
