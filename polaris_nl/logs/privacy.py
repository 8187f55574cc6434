"""What people said, left out of a log: when it is written, or afterwards."""

from __future__ import annotations

import contextlib
import dataclasses
import json
import re
import unicodedata
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from polaris_nl.execution.events import Edited, Event, Heard, Interpreted, Said, Understood
from polaris_nl.logs.schema import names_of

LEFT_OUT = "[left out]"
"""Stands for a text that isn't kept."""
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
        never: words that are blackened wherever they stand, in any case of letters; between several in
            one, spaces, hyphens and underscores are the same: "ms green" is `ms-green`, too.
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

    def of_line(self, kind: str, text: str) -> str:
        """The text of an event of a kind, by the name of its class, as it is told to ROS tools."""
        spoken = any(kind == x.__name__ for x in (*_SPOKEN, Edited))
        kept: str = LEFT_OUT if text and spoken and not self.text else self.of_value(text)
        return kept

    def of_value(self, value: Any) -> Any:
        """A JSON value with the words blackened, in keys, too.

        Each gets a name in its place that PDDL and YAML can read, so that a world in which it is somebody's
        name can still be read, and a run replayed.
        """
        if not self.never:
            return value
        if isinstance(value, str):
            return self._pattern.sub(lambda found: f"left-out-{found.lastindex}", value)
        if isinstance(value, list):
            return [self.of_value(x) for x in value]
        if isinstance(value, dict):
            return {self.of_value(k): self.of_value(v) for k, v in value.items()}
        return value

    def of_text(self, name: str, text: str) -> str:
        """The text of a file with the words blackened; in JSON those that are written with escapes, too."""
        if not self.never:
            return text
        if name.endswith(".json"):
            with contextlib.suppress(ValueError, RecursionError):
                return json.dumps(self.of_value(json.loads(text)), indent=2, ensure_ascii=False)
        found: str = self.of_value(text)
        return found

    def of_attachments(self, texts: Mapping[str, str]) -> dict[str, str]:
        """Attachments with the words blackened."""
        return {self.of_value(name): self.of_text(name, text) for name, text in texts.items()}

    def in_bytes(self, data: bytes) -> bool:
        """Whether bytes hold one of the words, in any way in which a log may write it."""
        return bool(self.never) and self._bytes.search(data) is not None

    @cached_property
    def _pattern(self) -> re.Pattern[str]:
        words = (dict.fromkeys(map(_spaced, _normal_forms(word))) for word in self.never)
        return re.compile("|".join(f"({'|'.join(forms)})" for forms in words), re.IGNORECASE)

    @cached_property
    def _bytes(self) -> re.Pattern[bytes]:
        forms = dict.fromkeys(f for word in self.never for f in _written(word))
        return re.compile(b"|".join(forms), re.IGNORECASE)


def _normal_forms(word: str) -> Iterator[str]:
    """A word in both ways in which Unicode writes accents."""
    yield unicodedata.normalize("NFC", word)
    yield unicodedata.normalize("NFD", word)


def _spaced(word: str) -> str:
    """A pattern for a word or several, with whatever stands between them in speech and in names."""
    return r"[\s_-]+".join(map(re.escape, _parts(word))) or re.escape(word)


def _parts(word: str) -> list[str]:
    return [part for part in re.split(r"[\s_-]+", word) if part]


def _written(word: str) -> Iterator[bytes]:
    """Patterns for a word in bytes: as UTF-8, as JSON writes it, and as UTF-16; in any case of letters."""
    for form in _normal_forms(word):
        for cased in dict.fromkeys((form, form.lower(), form.upper(), form.title())):
            yield _spaced(cased).encode()
            for ascii_only in (True, False):
                yield _spaced(json.dumps(cased, ensure_ascii=ascii_only)[1:-1]).encode()
            wide = [re.escape(part.encode("utf-16-le")) for part in _parts(cased) or [cased]]
            yield rb"(?:[\s_-]\x00)+".join(wide)


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
