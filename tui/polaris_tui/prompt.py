"""The input line: what was typed before comes back with the arrows, and nothing blinks."""

from __future__ import annotations

from typing import ClassVar

from textual import events
from textual.binding import Binding, BindingType
from textual.message import Message
from textual.widgets import Input

from polaris_nl.render.glyphs import plain

LONGEST = 2_000
"""Characters that a line can have; the language refuses longer ones anyway."""


class Prompt(Input):
    """Where sentences are typed."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("up", "recall(-1)", show=False),
        Binding("down", "recall(1)", show=False),
        Binding("pageup", "app.scroll(-1)", show=False),
        Binding("pagedown", "app.scroll(1)", show=False),
    ]

    class Said(Message):
        """A line was entered."""

        def __init__(self, line: str) -> None:
            super().__init__()
            self.line = line

    def __init__(self, placeholder: str, *, id: str) -> None:
        super().__init__(
            placeholder=placeholder,
            id=id,
            compact=True,
            max_length=LONGEST,
            select_on_focus=False,
        )
        self.cursor_blink = False
        self._earlier: list[str] = []
        self._at = 0
        self._draft = ""

    async def _on_key(self, event: events.Key) -> None:
        """Does at once what a key means; Textual lets characters typed after it overtake it."""
        bindings = self._bindings.key_to_bindings.get(event.key)
        if bindings:
            event.stop()
            event.prevent_default()
            await self.run_action(bindings[0].action)

    async def action_submit(self) -> None:
        """Sends the line; it is empty then, and can be recalled."""
        line = self.value.strip()
        if line and (not self._earlier or self._earlier[-1] != line):
            self._earlier.append(line)
        self._at = len(self._earlier)
        self._draft = ""
        self.value = ""
        if line:
            # Straight to the application: on the way up, a key pressed later could overtake it.
            self.app.post_message(self.Said(line))

    def action_recall(self, by: int) -> None:
        """Goes through the earlier lines; the one being typed comes last."""
        if self._at == len(self._earlier):
            self._draft = self.value
        self._at = max(0, min(self._at + by, len(self._earlier)))
        here = self._at < len(self._earlier)
        self.value = self._earlier[self._at] if here else self._draft
        self.cursor_position = len(self.value)

    def type_in(self, character: str) -> None:
        """Takes a character that was typed elsewhere."""
        self.cursor_position = len(self.value)
        self.insert_text_at_cursor(character)

    def insert_text_at_cursor(self, text: str) -> None:
        """Takes text without what could move the terminal's cursor."""
        super().insert_text_at_cursor(plain(text))

    def _on_paste(self, event: events.Paste) -> None:
        """Takes all pasted lines as one."""
        if event.text:
            self.insert_text_at_cursor(" ".join(event.text.split()))
        event.stop()
        event.prevent_default()
