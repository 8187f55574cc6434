"""The input line: what was typed before comes back with the arrows, and nothing blinks.

While a menu is open the same line filters it, and where a text is asked for it takes that.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Literal as OneOf
from typing import Protocol

from textual import events
from textual.widgets import Input

from polaris_nl.render.glyphs import plain
from polaris_tui.completion import completions

LONGEST = 2_000
"""Characters that a line can have; the language refuses longer ones anyway."""

Purpose = OneOf["sentence", "menu", "ask"]


class Owner(Protocol):
    """Who is told at once of what is typed, so that keys keep their order."""

    def take_line(self, line: str) -> None:
        """Enter was pressed."""
        ...

    def filter_menu(self, text: str) -> None:
        """The filter of a menu has changed."""
        ...

    def move_menu(self, by: int) -> None:
        """Another option of a menu is wanted."""
        ...

    def key_anywhere(self, key: str) -> bool:
        """A key was pressed that the line has no use for; whether it meant anything."""
        ...

    def names(self) -> Iterable[str]:
        """What can be completed."""
        ...


class Prompt(Input):
    """Where sentences are typed."""

    def __init__(self, owner: Owner, placeholder: str, *, id: str) -> None:
        super().__init__(
            placeholder=placeholder,
            id=id,
            compact=True,
            max_length=LONGEST,
            select_on_focus=False,
        )
        self.cursor_blink = False
        self._owner = owner
        self._hint = placeholder
        self._purpose: Purpose = "sentence"
        self._kept = ""  # the sentence that was begun before a menu came
        self._earlier: list[str] = []
        self._at = 0
        self._draft = ""
        self._offered: list[str] = []

    def serve(self, purpose: Purpose, initial: str = "") -> None:
        """Takes sentences, a menu's filter, or a text that is asked for."""
        if self._purpose == "sentence":
            self._kept = self.value
        self._purpose = purpose
        self.placeholder = self._hint if purpose == "sentence" else ""
        self.value = self._kept if purpose == "sentence" else plain(initial)
        self.cursor_position = len(self.value)

    async def _on_key(self, event: events.Key) -> None:
        """Does at once what a key means; Textual lets characters typed after it overtake it."""
        focused, before = self.app.focused, self.value
        if focused is not None and focused is not self:  # Typed ahead, before the focus moved.
            await focused._on_key(event)
            return
        if event.key in ("up", "down"):
            self._vertical(-1 if event.key == "up" else 1)
        elif event.key in ("pageup", "pagedown") and self._purpose == "menu":
            self._owner.move_menu(-8 if event.key == "pageup" else 8)
        elif event.key == "tab" and (self._purpose != "sentence" or self._complete()):
            pass
        elif bindings := self._bindings.key_to_bindings.get(event.key):
            await self.run_action(bindings[0].action)
        else:
            if event.is_printable and event.character:
                self.insert_text_at_cursor(event.character)
            elif not self._owner.key_anywhere(event.key):
                return
        event.stop()
        event.prevent_default()
        if self._purpose == "menu" and self.value != before:
            self._owner.filter_menu(self.value)

    async def action_submit(self) -> None:
        """Sends the line; a sentence can be recalled then."""
        line = self.value.strip()
        if self._purpose == "sentence":
            if line and (not self._earlier or self._earlier[-1] != line):
                self._earlier.append(line)
            self._at = len(self._earlier)
            self._draft = ""
        self.value = ""
        if line or self._purpose != "sentence":
            self._owner.take_line(line)

    def _vertical(self, by: int) -> None:
        if self._purpose == "menu":
            self._owner.move_menu(by)
        elif self._purpose == "sentence":
            self._recall(by)

    def _recall(self, by: int) -> None:
        """Goes through the earlier lines; the one being typed comes last."""
        if self._at == len(self._earlier):
            self._draft = self.value
        self._at = max(0, min(self._at + by, len(self._earlier)))
        here = self._at < len(self._earlier)
        self.value = self._earlier[self._at] if here else self._draft
        self.cursor_position = len(self.value)

    def _complete(self) -> bool:
        """Completes a name at the end; pressed again, offers the next one that begins like that."""
        if self.cursor_position != len(self.value):
            return False
        if self._offered == [self.value]:
            self._offered = []
        if self.value in self._offered:
            at = (self._offered.index(self.value) + 1) % len(self._offered)
        else:
            self._offered, at = completions(self.value, self._owner.names()), 0
        if not self._offered:
            return False
        self.value = self._offered[at]
        self.cursor_position = len(self.value)
        return True

    def insert_text_at_cursor(self, text: str) -> None:
        """Takes text without what could move the terminal's cursor."""
        super().insert_text_at_cursor(plain(text))

    def _on_paste(self, event: events.Paste) -> None:
        """Takes all pasted lines as one."""
        if event.text:
            self.insert_text_at_cursor(" ".join(event.text.split()))
        event.stop()
        event.prevent_default()
