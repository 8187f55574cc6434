"""What people said, left out of a log: when it is written, or afterwards."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from polaris_nl.execution.events import Edited, Event, Heard, Interpreted, Said, Understood
from polaris_nl.logs.schema import names_of

LEFT_OUT = "[left out]"
_SPOKEN: tuple[type[Event], ...] = (Heard, Interpreted, Understood, Said)
"""Events that are about words: all their texts go."""
_KEPT = frozenset({"outcome", "decision", "command", "source"})
"""Fields of those that are this program's own words."""


@dataclass(frozen=True)
class Privacy:
    """What isn't kept.

    Attributes:
        audio: whether sound is kept.
        text: whether what people said or typed is kept, and what was answered. What the program's
            goals are stays in any case: without them a log explains nothing.
        never: words that are blackened wherever they stand, in any case of letters.
    """

    audio: bool = True
    text: bool = True
    never: tuple[str, ...] = ()

    @property
    def words(self) -> str:
        """What is left out, in words."""
        kinds = [name for name, kept in (("audio", self.audio), ("text", self.text)) if not kept]
        count = len(self.never)
        return ", ".join(
            [*kinds, *([f"{count} words" if count > 1 else "a word"] if count else [])]
        )

    @property
    def sound(self) -> bool:
        """Whether sound is kept; not where there are words to be left out, as nobody can search it."""
        return self.audio and not self.never

    def of_event(self, event: Event) -> Event:
        """An event without what isn't kept."""
        if self.text and not self.never:
            return event
        changes: dict[str, Any] = {}
        for name in names_of(type(event)):
            value = getattr(event, name)
            if not self.text and _is_spoken(event, name):
                value = _emptied(value)
            changes[name] = self.of_value(value)
        return dataclasses.replace(event, **changes)

    def of_value(self, value: Any) -> Any:
        """A JSON value with the words blackened, in keys, too."""
        if not self.never:
            return value
        if isinstance(value, str):
            return self._pattern.sub(LEFT_OUT, value)
        if isinstance(value, list):
            return [self.of_value(x) for x in value]
        if isinstance(value, dict):
            return {self.of_value(k): self.of_value(v) for k, v in value.items()}
        return value

    def of_attachments(self, texts: Mapping[str, str]) -> dict[str, str]:
        """Attachments with the words blackened."""
        return {name: self.of_value(text) for name, text in texts.items()}

    def in_bytes(self, data: bytes) -> bool:
        """Whether bytes hold one of the words."""
        return bool(self.never) and any(
            re.search(re.escape(word.encode()), data, re.IGNORECASE) for word in self.never
        )

    @property
    def _pattern(self) -> re.Pattern[str]:
        return re.compile("|".join(map(re.escape, self.never)), re.IGNORECASE)


KEEP_ALL = Privacy()


def privacy_of(names: Sequence[str]) -> Privacy:
    """What a user wants left out: `audio`, `text`, and other words as they are."""
    words = tuple(name for name in names if name not in ("audio", "text") and name)
    return Privacy("audio" not in names, "text" not in names, words) if names else KEEP_ALL


def _is_spoken(event: Event, name: str) -> bool:
    if isinstance(event, Edited):
        return name in ("label", "text")
    return isinstance(event, _SPOKEN) and name not in _KEPT


def _emptied(value: Any) -> Any:
    """The same shape, without texts."""
    if isinstance(value, str):
        return LEFT_OUT if value else ""
    if isinstance(value, list):
        return [_emptied(x) for x in value]
    if isinstance(value, dict):
        return {k: v if k in _KEPT else _emptied(v) for k, v in value.items()}
    return value
