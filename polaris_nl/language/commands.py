"""Commands: "undo", "okay robot, please run it now", "no, undo that"; and what goes around them."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import cast

from polaris_nl.language.common import Common
from polaris_nl.language.interpretation import Command
from polaris_nl.language.tokens import BREAK, COMMA

MOST_AT_ONCE = 16
"""Words up to which an utterance is looked at for several commands."""
REPLIES: frozenset[Command] = frozenset(("yes", "no"))
SAID_ALONE: frozenset[Command] = REPLIES | {"run", "resume", "new", "load", "save", "quit"}
"""Commands that nobody gives a reason for: "let's get going or we'll miss it" is said to others."""
COMMAND_SAYS: Mapping[Command, str] = {
    "stop": "Stopping.",
    "pause": "Pausing.",
    "resume": "Going on.",
    "yes": "There is nothing to say yes to.",
    "no": "There is nothing to say no to.",
    "quit": "Goodbye.",
}
"""What is said to a command where nothing else is."""
_JOINS = ("and", "then")
_ALONE = (("what",), ("sorry",), ("right",))
"""Commands only where nothing else is said: "then what" asks for something else."""
_HALTING = frozenset(("stop", "pause", "halt", "freeze", "abort", "whoa"))
_HALTING_WITHIN = 4
"""Words within which they stand: "oh heavens, stop, ...", not in what is told of a bus stop."""
_NO_HALT = frozenset(
    ("the", "a", "to", "not", "never", "will", "would", "can", "should", "did", "does", "do", "bus")
)
"""Words behind which they are told of, or denied."""
_GOES_ON = frozenset(
    ("when", "if", "once", "until", "till", "before", "after", "unless", "at", "in", "by", "on", "near", "from",
     "to", "with", "off", "over")
)  # fmt: skip
"""Words behind which it is said when, or where, or what to stop with."""


@dataclass(frozen=True, slots=True)
class Told:
    """What an utterance commands.

    Attributes:
        commands: one, or several different ones that can't all be done at once.
        agrees: it begins with a yes: "yes, run it".
    """

    commands: tuple[Command, ...]
    agrees: bool = False


class Softeners:
    """What people say around a command or a question, where it changes nothing: "could you ... please"."""

    def __init__(self, common: Common) -> None:
        self._opening = frozenset(common.listed("opening"))
        self._closing = frozenset(common.listed("closing"))
        self._longest = max((len(p) for p in (*self._opening, *self._closing)), default=0)

    def within(self, tokens: Sequence[str]) -> Iterator[tuple[str, ...]]:
        """The tokens as they are, then without more and more of what is around them."""
        waiting = deque([tuple(tokens)])
        seen = set(waiting)
        while waiting:
            found = waiting.popleft()
            yield found
            for size in range(1, min(self._longest, len(found) - 1) + 1):
                shorter = [found[size:]] if found[:size] in self._opening else []
                if found[-size:] in self._closing:
                    shorter.append(found[:-size])
                for rest in shorter:
                    if rest not in seen:
                        seen.add(rest)
                        waiting.append(rest)


class Commands:
    """Finds the commands of a grammar in utterances."""

    def __init__(self, common: Common) -> None:
        self._softeners = Softeners(common)
        found: dict[tuple[str, ...], Command] = {}
        for intent in common.of_kind("command"):
            for words in intent.phrases:
                found.setdefault(words, cast(Command, intent.name))
        self._known: Mapping[tuple[str, ...], Command] = found
        self._first = frozenset(words[0] for words in found)

    def meant(self, tokens: Sequence[str]) -> Told | None:
        """What the tokens command, or None where there is more in them than commands."""
        plain = tuple(t for t in tokens if t not in (BREAK, COMMA))
        one = self._one(plain)
        if one is not None:
            return Told((one,))
        if len(plain) > MOST_AT_ONCE:
            return None
        several = self._several(plain)
        return _together(several) if several else None

    def halting(self, tokens: Sequence[str]) -> tuple[Command, str] | None:
        """A stop or a pause that an utterance begins with, and the rest: "stop, you're dripping".

        For what isn't understood as a whole; "stop when the tray is full" isn't taken for one.
        """
        plain = tuple(t for t in tokens if t not in (BREAK, COMMA))
        for at in range(min(_HALTING_WITHIN, len(plain) - 1)):
            if plain[at] not in _HALTING or (at and plain[at - 1] in _NO_HALT):
                continue
            for end in range(len(plain) - 1, at, -1):
                command = self._one(plain[at:end])
                if command in ("stop", "pause") and plain[end] not in _GOES_ON:
                    return command, " ".join((*plain[:at], *plain[end:]))
        return None

    def _one(self, tokens: tuple[str, ...]) -> Command | None:
        found = (
            self._known.get(inner)
            for inner in self._softeners.within(tokens)
            if inner == tokens or inner not in _ALONE
        )
        return next((command for command in found if command is not None), None)

    def _several(self, tokens: tuple[str, ...]) -> tuple[Command, ...]:
        """The commands that all of the tokens consist of, the longest first at each place."""
        failed: set[int] = set()

        def after(at: int) -> tuple[Command, ...] | None:
            if at == len(tokens):
                return ()
            for end in range(len(tokens), at, -1) if at not in failed else ():
                command = self._one(tokens[at:end])
                rest = after(end) if command is not None else None
                if command is not None and rest is not None:
                    return (command, *rest)
            failed.add(at)
            if tokens[at] in _JOINS and 0 < at < len(tokens) - 1:
                return after(at + 1)
            return None

        return after(0) or ()


def _together(commands: tuple[Command, ...]) -> Told:
    """Several commands as one where they come to the same; a stop comes before all others."""
    if "stop" in commands:
        return Told(("stop",))
    asked = tuple(dict.fromkeys(c for c in commands if c not in REPLIES))
    agrees = commands[0] == "yes"
    return Told(asked, agrees) if asked else Told((commands[0],), agrees)
