"""What the working threads tell the screen."""

from __future__ import annotations

from textual.message import Message

from polaris_nl.execution.events import Event
from polaris_nl.snapshot import Answer
from polaris_tui.transcript import Entry


class Warmed(Message):
    """Language and planner are loaded; `failure` says why not, or is empty."""

    def __init__(self, failure: str = "") -> None:
        super().__init__()
        self.failure = failure


class Changed(Message):
    """The session has a new snapshot."""


class Answered(Message):
    """A sentence was carried out."""

    def __init__(self, ticket: int, answer: Answer) -> None:
        super().__init__()
        self.ticket = ticket
        self.answer = answer


class Told(Message):
    """Something else is to be shown below a sentence."""

    def __init__(self, ticket: int, *entries: Entry) -> None:
        super().__init__()
        self.ticket = ticket
        self.entries = entries


class Happened(Message):
    """A run reports an event."""

    def __init__(self, event: Event) -> None:
        super().__init__()
        self.event = event


class RunOver(Message):
    """A run has ended; the entries say what there is to say about it."""

    def __init__(self, *entries: Entry) -> None:
        super().__init__()
        self.entries = entries
