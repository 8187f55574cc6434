"""Carries sentences out, one after the other, in a thread of its own: typing never waits.

Everything that may take longer than a frame happens here. Results go to the screen as messages,
which is safe from any thread and never waits for the screen.
"""

from __future__ import annotations

import queue
import threading
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from textual.message import Message

from polaris_nl.automaton.edits import ReplaceProgram
from polaris_nl.automaton.program import read_program
from polaris_nl.model.errors import PolarisError
from polaris_nl.model.wording import Wording
from polaris_nl.planning.reasons import Reasons, Step
from polaris_nl.render.explanation import purpose_in_words
from polaris_nl.render.program import numbered
from polaris_nl.session import Session
from polaris_tui.keeping import saved_as
from polaris_tui.menus import Change
from polaris_tui.messages import Answered, Edited, Explained, Opened, Told, Warmed
from polaris_tui.running import Run
from polaris_tui.transcript import Entry

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
        self.turn = (
            threading.Lock()
        )  # Held while something is carried out; speech waits for it, too.
        self._put_in = self._done = 0  # Each is counted in one thread alone.
        self._reasons: Reasons | None = None
        self._jobs: queue.SimpleQueue[_Job | None] = queue.SimpleQueue()
        self._thread = threading.Thread(target=self._work, name="conversation", daemon=True)

    def start(self) -> None:
        """Starts the thread; it first loads language and planner."""
        self._put(_Job(self._warm_up, 0))
        self._thread.start()

    @property
    def busy(self) -> bool:
        """Whether there is work that isn't done."""
        return self._put_in > self._done

    def _put(self, job: _Job) -> None:
        self._put_in += 1
        self._jobs.put(job)

    def end(self, seconds: float) -> None:
        """Ends the thread after what it is doing, and waits so long for that."""
        self._ended = True
        self._jobs.put(None)
        if self._thread.is_alive():
            self._thread.join(seconds)

    def say(self, sentence: str, ticket: int, running: Run | None = None) -> None:
        """Carries a sentence out; during a run it may be a command for that."""
        self._put(_Job(lambda: self._say(sentence, ticket, running), ticket))

    def explain(self, checkpoint: str, action: int | None, ticket: int) -> None:
        """Says why an action is there, or what a checkpoint takes."""
        self._put(_Job(lambda: self._explain(checkpoint, action, ticket), ticket))

    def edit(self, change: Change, ticket: int) -> None:
        """Changes the program as one step."""
        self._put(_Job(lambda: self._edit(change, ticket), ticket))

    def travel(self, steps: int, ticket: int) -> None:
        """Goes so many steps back in the program's history, or forward with a negative number."""
        self._put(_Job(lambda: self._travel(steps, ticket), ticket))

    def purpose(self, number: int) -> None:
        """Says why an action of the present plan is there, for the plan step by step."""
        self._put(_Job(lambda: self._purpose(number), 0))

    def open_log(self, path: Path, ticket: int) -> None:
        """Opens a log."""
        self._put(_Job(lambda: self._open_log(path, ticket), ticket))

    def load(self, path: Path, label: str, ticket: int) -> None:
        """Takes another program from a file, as a step that can be undone."""
        self._put(_Job(lambda: self._load(path, label, ticket), ticket))

    def save_as(self, path: Path, ticket: int) -> None:
        """Saves the program to another file from now on."""
        self._put(_Job(lambda: self._save_as(path, ticket), ticket))

    def _work(self) -> None:
        while (job := self._jobs.get()) is not None and not self._ended:
            try:
                with self.turn:
                    job.work()
            except PolarisError as error:
                self._tell(Told(job.ticket, Entry(str(error), "! ", "bad")))
            except Exception as error:
                # A fault must not take the screen with it: the program is saved, and can be mended.
                text = f"That went wrong ({type(error).__name__}: {error}). Say it another way."
                self._tell(Told(job.ticket, Entry(text, "! ", "bad")))
            self._done += 1

    def _warm_up(self) -> None:
        failure = ""
        try:
            self._session.warm_up()
        except PolarisError as error:
            failure = str(error)
        self._tell(Warmed(failure))

    def _say(self, sentence: str, ticket: int, running: Run | None) -> None:
        if running is not None and running.active:
            from polaris_nl.commands.run import command_in

            automaton = running.snapshot.automaton
            command = command_in(sentence, self._session.understanding, automaton)
            if command is not None:
                running.command(command)
                return
        self._tell(Answered(ticket, self._session.say(sentence, ANSWER_WAIT_S)))

    def _edit(self, change: Change, ticket: int) -> None:
        before = self._session.snapshot.plan
        failure = self._session.edit(change.edits, change.label)
        after = self._session.wait(ANSWER_WAIT_S)
        self._tell(Edited(ticket, before, after, failure, change.focus))

    def _travel(self, steps: int, ticket: int) -> None:
        before = self._session.snapshot.plan
        go = self._session.undo if steps > 0 else self._session.redo
        for _ in range(abs(steps)):
            if go() is None:
                break
        self._tell(Edited(ticket, before, self._session.wait(ANSWER_WAIT_S), "", ""))

    def _purpose(self, number: int) -> None:
        snapshot = self._session.snapshot
        if snapshot.plan is None or snapshot.planning != "planned":
            return
        found = numbered(snapshot.plan, number)
        if found is None:
            return
        if self._reasons is None or self._reasons.plan is not snapshot.plan:
            self._reasons = Reasons(snapshot.plan, snapshot.automaton, self._session.world)
        text = purpose_in_words(self._reasons, Step(*found), self._session.wording)
        self._tell(Explained(snapshot.revision, number, text))

    def _open_log(self, path: Path, ticket: int) -> None:
        from polaris_tui.replay import open_replay

        replay = open_replay(path, self._session.world)
        own = replay.world.source == self._session.world.source
        wording: Wording = self._session.wording
        if not own:
            from polaris_nl.language.understanding import Understanding

            wording = Understanding(replay.world).wording
        count = (
            f"{len(replay.events)} events, {len(replay.shown(''))} of them with something to read."
        )
        self._tell(Told(ticket, Entry(count)))
        self._tell(Opened(replay, wording))

    def _load(self, path: Path, label: str, ticket: int) -> None:
        loaded = read_program(path).automaton
        if loaded == self._session.snapshot.automaton:
            self._tell(Told(ticket, Entry("Nothing was changed.")))
            return
        self._edit(Change(label, (ReplaceProgram(loaded),)), ticket)

    def _save_as(self, path: Path, ticket: int) -> None:
        self._tell(Told(ticket, Entry(saved_as(self._session, path))))

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
