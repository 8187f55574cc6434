"""Forms of verbs: "before going home", "once you have filled the tray" are "go", "fill" said otherwise.

The forms are made from the verbs that a grammar's wordings start with, so that wordings are written
once, in the imperative.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from typing import Literal as OneOf

Inflection = OneOf["base", "gerund", "participle"]
INFLECTED: tuple[Inflection, ...] = ("gerund", "participle")
_THIRD = {"have": "has", "be": "is", "do": "does"}
_VOWELS = "aeiou"
_DOUBLED = "bdgklmnprt"
"""Last letters that are doubled after one short vowel: putting, dropped."""


class Verbs:
    """The forms of some verbs.

    Args:
        bases: verbs in the imperative: `bring`, `put`.
        irregular: past participles that no rule makes, by verb: `{"bring": "brought"}`; several are
            written with spaces.

    Attributes:
        imperatives: the verbs as they stand in requests.
    """

    def __init__(self, bases: Iterable[str], irregular: Mapping[str, str]) -> None:
        self._bases: dict[tuple[str, Inflection], tuple[str, ...]] = {}
        self.imperatives = frozenset(bases)
        for base in sorted(self.imperatives):
            self._add(gerund(base), "gerund", base)
            for past in irregular.get(base, participle(base)).split():
                self._add(past, "participle", base)

    def _add(self, word: str, form: Inflection, base: str) -> None:
        self._bases[word, form] = (*self._bases.get((word, form), ()), base)

    def bases(self, word: str, form: Inflection) -> tuple[str, ...]:
        """The imperatives that a word is a form of; the word itself for `base`."""
        return (word,) if form == "base" else self._bases.get((word, form), ())

    @property
    def vocabulary(self) -> frozenset[str]:
        """All forms."""
        return frozenset(word for word, _ in self._bases)


def gerund(base: str) -> str:
    """`bring` -> `bringing`, `take` -> `taking`, `put` -> `putting`, `lie` -> `lying`."""
    if base.endswith("ie"):
        return base[:-2] + "ying"
    if base.endswith("e") and not base.endswith(("ee", "oe", "ye")) and len(base) > 2:
        return base[:-1] + "ing"
    return _doubled(base) + "ing"


def participle(base: str) -> str:
    """`open` -> `opened`, `place` -> `placed`, `drop` -> `dropped`, `carry` -> `carried`."""
    if base.endswith("e"):
        return base + "d"
    if base.endswith("y") and base[-2:-1] not in _VOWELS:
        return base[:-1] + "ied"
    return _doubled(base) + "ed"


def _doubled(base: str) -> str:
    short = len(base) >= 3 and base[-1] in _DOUBLED and base[-2] in _VOWELS
    one_syllable = sum(c in _VOWELS for c in base) == 1
    return base + base[-1] if short and one_syllable and base[-3] not in _VOWELS else base


def third_person(base: str) -> str:
    """`go` -> `goes`, `carry` -> `carries`, `put` -> `puts`, `have` -> `has`."""
    if base in _THIRD:
        return _THIRD[base]
    if base.endswith(("s", "x", "ch", "sh", "o", "z")):
        return base + "es"
    if base.endswith("y") and base[-2:-1] not in _VOWELS:
        return base[:-1] + "ies"
    return base + "s"


_ANY = re.compile(r"([!?]?)~(\w+)")


def with_forms(text: str, irregular: Mapping[str, str]) -> str:
    """A wording with `~verb` written out as a choice of the verb's forms.

    `!~verb` stands for their negations and `?~verb` for what should be done.

    `{p} ~acknowledge [it]` then takes "she acknowledges it", "once she has acknowledged", "for her
    to acknowledge"; `{p} !~acknowledge` takes "she does not acknowledge", "she hasn't acknowledged".

    Args:
        text: a wording.
        irregular: past forms that no rule makes, by verb, several with spaces.
    """

    def forms(found: re.Match[str]) -> str:
        base = found[2]
        past = irregular.get(base, participle(base)).split()
        pasts = "|".join(past)
        if found[1] == "?":
            modals = "should|must|shall|has to|have to|needs to|need to|ought to|is to|are to"
            return f"(({modals}) [now|also|both|all] {base})"
        if found[1] == "!":
            never = "do|does|did|will|would|can|could"
            return (
                f"(({never}) not {base}|(has|have|had|is|are|was) not [yet] ({pasts})"
                f"|(is|are|was) not {gerund(base)}|(refuses|fails|forgets|declines) to {base}"
                f"|never {third_person(base)})"
            )
        # "Is", for "she's acknowledged it" is taken apart like "she's here".
        auxiliaries = "has|have|had|'s|is|will have|has just|have just|has already"
        return (
            f"({base}|{third_person(base)}|{pasts}|{gerund(base)}|({auxiliaries}) ({pasts})"
            f"|(is|are|was|'s) {gerund(base)}|(to|will|does|did|can|happens to) {base})"
        )

    return _ANY.sub(forms, text)
