"""What is said to the screen: carried out as if it was typed, and shown. Loaded with the speech side only."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager

from textual.message import Message

from polaris_nl.execution.events import Heard as HeardEvent
from polaris_nl.execution.state import HumanCommand
from polaris_nl.hands_free.conversation import Conversation, Reply
from polaris_nl.hands_free.running import command_in
from polaris_nl.session import Session
from polaris_nl.speech.hearing import Utterance
from polaris_nl.speech.modes import State
from polaris_tui.messages import Listened, Ordered, Spoken
from polaris_tui.phrases import Order
from polaris_tui.running import Current

ANSWERS = {
    "stop": "Stopping.",
    "pause": "Pausing.",
    "resume": "Going on.",
    "happened": "I was told.",
}


class Heard(Conversation):
    """The conversation of somebody who can see and type, too: the runs are the screen's.

    Args:
        session: what is changed and asked.
        turn: is held while a sentence is carried out.
        tell: is given messages.
        current: the run that goes on, or None.
    """

    def __init__(
        self,
        session: Session,
        turn: AbstractContextManager[object],
        tell: Callable[[Message], object],
        current: Current,
    ) -> None:
        super().__init__(session)
        self._turn = turn
        self._told = tell
        self._current = current

    def quick(self, command: str) -> str:
        """Stops or pauses at once, whatever else goes on; the screen is told afterwards."""
        run = self._current()
        order: Order = "stop" if command == "stop" else "pause"
        if run is not None:
            run.command(HumanCommand(order, source="voice"))
        self._told(Ordered(order))
        return ""

    def take(
        self,
        said: Utterance,
        heard: HeardEvent,
        called: bool,
        near: Callable[[], Sequence[str]],
    ) -> Reply:
        """Does what an utterance asks for, when what was typed before it is done."""
        run = self._current()
        with self._turn:
            if said.accepted and run is not None:
                understanding = self.session.understanding
                command = command_in(said.text, understanding, run.snapshot.automaton)
                if command is not None:
                    self.note(heard)
                    run.command(HumanCommand(command.kind, command.literals, "voice"))
                    return Reply(said, ANSWERS[command.kind])
            return super().take(said, heard, called, near)


class Shown:
    """The screen as the hands-free loop's face."""

    def __init__(self, tell: Callable[[Message], object]) -> None:
        self._tell = tell

    def shows(self, state: State) -> None:
        """Whether it listens now."""
        self._tell(Listened(state))

    def tells(self, text: str) -> None:
        """A sentence about the microphone or the mode."""
        if text:
            self._tell(Listened("", text))

    def replies(self, reply: Reply) -> None:
        """What was heard, and what came of it."""
        self._tell(Spoken(reply))
