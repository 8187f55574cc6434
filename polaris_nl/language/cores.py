"""What is left of an utterance without the words around a correction: "no, I meant", "instead", "sorry"."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass

from polaris_nl.language.common import Common
from polaris_nl.language.expansions import expansions
from polaris_nl.language.patterns import strip
from polaris_nl.language.tokens import BREAK, COMMA

DO_NOT = ("do", "not")
"""What a core that takes something back begins with, however that was said."""
AROUND: Mapping[str, int] = {
    "correct-lead": 2,
    "correct-aside": 1,
    "correct-tail": 1,
    "correct-noise": 0,
}
"""The intents of words around a correction, and how strongly each says that it is one."""
NEEDLESS = "correct-needless"
"""The intent of words in front of what needn't be done any more."""
_BETTER = (("would", "be", "better"), ("is", "better"), ("'s", "better"))
"""Behind a thing, what says that it should be elsewhere: "the plate would be better on the table"."""
_BETTER_SO = ("if", "that", "to", "when", "than", "for")
"""Words behind it that wish for something, and move nothing."""
_WAITED = ("until", "till", "for", "here", "there")
"""Words behind "wait" that make it something to do."""


@dataclass(frozen=True, slots=True)
class Core:
    """An utterance without the words around a correction.

    Attributes:
        tokens: what is left, without marks at its ends.
        strength: 2 behind "no" or "I meant", 1 behind "sorry" or "actually", else 0.
        needless: it only takes something back: "you needn't go home".
    """

    tokens: tuple[str, ...]
    strength: int = 0
    needless: bool = False

    @property
    def words(self) -> list[str]:
        """The tokens without marks."""
        return [t for t in self.tokens if t not in (COMMA, BREAK)]


class Cores:
    """Finds cores.

    Args:
        common: words that every domain shares.
        verbs: verbs that goals begin with.
    """

    def __init__(self, common: Common, verbs: Collection[str]) -> None:
        around = {
            intent.name: sorted(
                {
                    tuple(str(w) for w in said)
                    for wording in intent.wordings
                    for said in expansions(wording)
                },
                key=len,
                reverse=True,
            )
            for intent in common.of_kind("correction")
            if intent.name in (*AROUND, NEEDLESS)
        }
        self._needless = around.pop(NEEDLESS, [])
        self._around = around
        # "Go" is a filler in "go and open it", and the verb in "no, go to the kitchen"; "would you mind"
        # decides how its verb stands, and "instead" what is replaced.
        needed = {("instead",), *common.connectives["polite"]}
        self._fillers = [
            f for f in common.fillers if f not in needed and (len(f) > 1 or f[0] not in verbs)
        ]

    def core(self, tokens: Sequence[str]) -> Core:
        """An utterance without "no, I meant" in front of it, "instead" behind it, and the like."""
        found, strength, needless = trimmed(tokens), 0, False
        better = _better_elsewhere(found)
        if better is not None:
            found, strength = better, 1
        changed = True
        while changed:
            changed = False
            rest = _without(found, self._needless, False)
            if rest is not None:  # Before "no" is taken for an answer: "no need to go home".
                found, needless = [*DO_NOT, *rest], True
            for name, phrases in self._around.items():
                kept = _without(found, phrases, name == "correct-tail")
                if kept is not None:
                    found, strength, changed = trimmed(kept), max(strength, AROUND[name]), True
            if strength or not changed:
                kept = strip(found, self._fillers)
                changed = changed or kept != found
                found = kept
        behind = len(tokens) - len(found) - 1
        if found[:1] == ["not"] and behind >= 0 and tuple(tokens[behind : behind + 2]) == DO_NOT:
            found = ["do", *found]  # Of "please do", which is a filler.
        return Core(tuple(found), strength, needless)


def _better_elsewhere(tokens: Sequence[str]) -> list[str] | None:
    """What a thing "would be better" as what it should be; None where nothing is said to be better so."""
    for at in range(1, len(tokens)):
        for words in _BETTER:
            end = at + len(words)
            if tuple(tokens[at:end]) != words or end >= len(tokens):
                continue
            end += tokens[end] == "off"
            if end == len(tokens) or tokens[end] in (*_BETTER_SO, COMMA, BREAK):
                return None
            return [*tokens[:at], "should", "be", *tokens[end:]]
    return None


def trimmed(tokens: Sequence[str]) -> list[str]:
    """Tokens without marks at their ends."""
    found = list(tokens)
    while found and found[0] in (COMMA, BREAK):
        found.pop(0)
    while found and found[-1] in (COMMA, BREAK):
        found.pop()
    return found


def _without(
    tokens: Sequence[str], phrases: Sequence[tuple[str, ...]], behind: bool
) -> list[str] | None:
    """Tokens without the longest of some phrases at an end, or None; never nothing at all."""
    for phrase in phrases:
        size = len(phrase)
        end = tuple(tokens[-size:]) if behind else tuple(tokens[:size])
        if size and end == phrase:
            if len(tokens) <= size or (not behind and tokens[size] in _WAITED):
                return None
            return list(tokens[:-size] if behind else tokens[size:])
    return None
