"""What the working threads tell the screen."""

from __future__ import annotations

from typing import TYPE_CHECKING
from typing import Literal as OneOf

from textual.message import Message

from polaris_nl.execution.events import Event
from polaris_nl.model.wording import Wording
from polaris_nl.planning.result import BranchingPlan
from polaris_nl.snapshot import Answer, Snapshot
from polaris_tui.phrases import Order
from polaris_tui.transcript import Entry

if TYPE_CHECKING:
    from polaris_nl.hands_free.conversation import Reply
    from polaris_tui.replay import Replay

VoiceState = OneOf["", "opening", "listening", "waiting", "asleep", "speaking", "deaf", "off"]


class Warmed(Message):
    """Language and planner are loaded; `failure` says why not, or is empty."""

    def __init__(self, failure: str = "") -> None:
        super().__init__()
        self.failure = failure


class HungUp(Message):
    """The terminal is gone."""


class Changed(Message):
    """The session has a new snapshot."""


class Answered(Message):
    """A sentence was carried out."""

    def __init__(self, ticket: int, answer: Answer) -> None:
        super().__init__()
        self.ticket = ticket
        self.answer = answer


class Edited(Message):
    """The program was changed by keys; the plan's news may still be on their way."""

    def __init__(
        self, ticket: int, before: BranchingPlan | None, after: Snapshot, failure: str, focus: str
    ) -> None:
        super().__init__()
        self.ticket = ticket
        self.before = before
        self.after = after
        self.failure = failure
        self.focus = focus


class Explained(Message):
    """Why an action of a revision's plan is there."""

    def __init__(self, revision: int, number: int, text: str) -> None:
        super().__init__()
        self.place = (revision, number)
        self.text = text


class Opened(Message):
    """A log was opened."""

    def __init__(self, replay: Replay, wording: Wording) -> None:
        super().__init__()
        self.replay = replay
        self.wording = wording


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


class Listened(Message):
    """The voice side has a new state, or a sentence to say about it; both may be "".

    `opening`, the states of `speech.modes`, `deaf` where it can't listen, `off` where it has ended.
    """

    def __init__(self, state: VoiceState, text: str = "") -> None:
        super().__init__()
        self.state = state
        self.text = text


class Ordered(Message):
    """A quick word was heard, "stop" or "pause"; a run has been told already."""

    def __init__(self, order: Order) -> None:
        super().__init__()
        self.order = order


class Spoken(Message):
    """Something was said and carried out."""

    def __init__(self, reply: Reply) -> None:
        super().__init__()
        self.reply = reply
