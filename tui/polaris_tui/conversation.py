"""Carries sentences out, one after the other, in a thread of its own: typing never waits.

Everything that may take longer than a frame happens here. Results go to the screen as messages,
which is safe from any thread and never waits for the screen.
"""

from __future__ import annotations

import queue
import threading
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from textual.message import Message

from polaris_nl.model.errors import PolarisError
from polaris_nl.session import Session
from polaris_tui.messages import Answered, Told, Warmed
from polaris_tui.transcript import Entry

if TYPE_CHECKING:
    from polaris_tui.running import Running

ANSWER_WAIT_S = 1.0
"""How long an answer waits for the plan; the plan's news come later then."""

Tell = Callable[[Message], object]


@dataclass(frozen=True, slots=True)
class _Job:
    """Work for the thread, and the ticket that a failure is told to."""

    work: Callable[[], None]
    ticket: int


class Conversation:
    """The thread that talks to the session.

    Args:
        session: program, language and planner.
        tell: is given messages; called in the thread.
    """

    def __init__(self, session: Session, tell: Tell) -> None:
        self._session = session
        self._tell = tell
        self._ended = False
        self._jobs: queue.SimpleQueue[_Job | None] = queue.SimpleQueue()
        self._thread = threading.Thread(target=self._work, name="conversation", daemon=True)

    def start(self) -> None:
        """Starts the thread; it first loads language and planner."""
        self._jobs.put(_Job(self._warm_up, 0))
        self._thread.start()

    def end(self, seconds: float) -> None:
        """Ends the thread after what it is doing, and waits so long for that."""
        self._ended = True
        self._jobs.put(None)
        if self._thread.is_alive():
            self._thread.join(seconds)

    def say(self, sentence: str, ticket: int, running: Running | None = None) -> None:
        """Carries a sentence out; during a run it may be a command for that."""
        self._jobs.put(_Job(lambda: self._say(sentence, ticket, running), ticket))

    def explain(self, checkpoint: str, action: int | None, ticket: int) -> None:
        """Says why an action is there, or what a checkpoint takes."""
        self._jobs.put(_Job(lambda: self._explain(checkpoint, action, ticket), ticket))

    def _work(self) -> None:
        while (job := self._jobs.get()) is not None and not self._ended:
            try:
                job.work()
            except PolarisError as error:
                self._tell(Told(job.ticket, Entry(str(error), "! ", "bad")))
            except Exception as error:
                # A fault must not take the screen with it: the program is saved, and can be mended.
                text = f"That went wrong ({type(error).__name__}: {error}). Say it another way."
                self._tell(Told(job.ticket, Entry(text, "! ", "bad")))

    def _warm_up(self) -> None:
        failure = ""
        try:
            self._session.warm_up()
        except PolarisError as error:
            failure = str(error)
        self._tell(Warmed(failure))

    def _say(self, sentence: str, ticket: int, running: Running | None) -> None:
        if running is not None and running.active:
            from polaris_nl.commands.run import command_in

            automaton = running.snapshot.automaton
            command = command_in(sentence, self._session.understanding, automaton)
            if command is not None:
                running.command(command)
                return
        self._tell(Answered(ticket, self._session.say(sentence, ANSWER_WAIT_S)))

    def _explain(self, checkpoint: str, action: int | None, ticket: int) -> None:
        from polaris_nl.commands.why import Asker

        snapshot = self._session.wait(ANSWER_WAIT_S)
        if snapshot.plan is None or snapshot.planning != "planned":
            self._tell(Told(ticket, Entry(snapshot.failure or "I'm still working out the plan.")))
            return
        asker = Asker(self._session, snapshot.automaton, snapshot.plan)
        found = asker.checkpoint(checkpoint) if action is None else asker.action(action)
        repairs = [Entry(text, "  Way out: ") for text in found.get("repairs", ())]
        self._tell(Told(ticket, Entry(found["text"]), *repairs))
