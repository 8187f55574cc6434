"""The terminal application: one screen, one input line, the same sentences as everywhere.

Keys become sentences, sentences go to the session in a thread of its own, and whatever comes back is a
message here. Each message makes a new scene, and the panes are drawn from that by pure functions.
"""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import ClassVar

from textual.app import App, ComposeResult
from textual.binding import Binding, BindingType
from textual.events import Resize
from textual.message import Message

from polaris_nl.answers import change_in_words
from polaris_nl.execution.state import HumanCommand
from polaris_nl.logs.paths import new_log_path
from polaris_nl.model.wording import PlainWording, Wording
from polaris_nl.render.glyphs import glyphs_for
from polaris_nl.session import Session
from polaris_nl.snapshot import Answer, Snapshot
from polaris_tui import styles
from polaris_tui.board import Board
from polaris_tui.conversation import Conversation
from polaris_tui.keys import KEYS
from polaris_tui.messages import Answered, Changed, Happened, RunOver, Told, Warmed
from polaris_tui.pane import Pane
from polaris_tui.phrases import Order, order_in, view_asked
from polaris_tui.progress import Activity, Progress, advanced
from polaris_tui.prompt import Prompt
from polaris_tui.running import Running
from polaris_tui.transcript import Entry, Exchange, Transcript, answer_entries, event_entry
from polaris_tui.views import Scene, View

PATIENCE_S = 0.15
"""How long a new plan may take before the screen says that it is being made: most come sooner."""
END_S = 5.0
"""How long leaving waits for a run to stop, and for what the session is doing."""

NO_FILE = "Nothing is saved without a program file; to keep this, start with: polaris-nl tui FILE"
NO_RUN = 'There is no run. F5, or "run it", starts one.'
RUN_GOES_ON = "The run goes on with the program that was read out; this counts from the next run."
STOPPED_FIRST = "You said stop before it began, so nothing runs."
ONE_RUN = "A run is going on. Stop it with F9 before you start another."


class PolarisApp(App[int]):
    """The application.

    Args:
        session: program, language and planner; it belongs to the caller.
        live: runs go in real time; otherwise as fast as the machine can.
        logs: the folder for the logs of runs; the usual one by default.
    """

    ENABLE_COMMAND_PALETTE = False
    CSS = styles.CSS
    HORIZONTAL_BREAKPOINTS = styles.BREAKPOINTS
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding(k.keys, k.action, k.does, show=False, priority=k.first) for k in KEYS if k.keys
    ]

    def __init__(self, session: Session, *, live: bool = True, logs: Path | None = None) -> None:
        super().__init__()
        self.theme = styles.THEME
        self.animation_level = "none"
        self._session = session
        self._live = live
        self._logs = logs
        self._glyphs = glyphs_for()
        self._wording: Wording = PlainWording(session.world)
        self._progress = Progress(session.world.initial, activity="loading")
        self._transcript = Transcript()
        self._view: View = "plan"
        self._current: Running | None = None
        self._awaited: tuple[int, Answer] | None = None
        self._stopped_at = 0  # The ticket of the last thing said before a stop.
        self._leaving = False
        self._unsubscribe: Callable[[], None] = lambda: None
        self._conversation = Conversation(session, self._tell)
        self._board = Board(self._glyphs)

    def compose(self) -> ComposeResult:
        """One screen."""
        yield self._board

    def on_mount(self) -> None:
        """Shows the first screen; language and planner are loaded behind it."""
        self._board.prompt.focus()
        if self._session.path is None:
            self._note(Entry(NO_FILE, tone="faint"))
        self._draw()
        self._unsubscribe = self._session.subscribe(lambda snapshot: self._tell(Changed()))
        self.call_after_refresh(self._conversation.start)

    def on_unmount(self) -> None:
        """Leaves no thread behind that still uses the session."""
        self._unsubscribe()
        if self._current is not None:
            self._current.command(HumanCommand("stop"))
            self._current.wait(END_S)
        self._conversation.end(END_S)

    # What the threads tell

    def _tell(self, message: Message) -> None:
        """Sends a message from any thread; a screen that is gone already needs none."""
        with contextlib.suppress(RuntimeError):
            self.post_message(message)

    def on_warmed(self, message: Warmed) -> None:
        """Says things in the words of the domain from now on."""
        self._progress = replace(self._progress, activity="")
        if message.failure:
            self._note(Entry(message.failure, "! ", "bad"))
        else:
            self._wording = self._session.wording
        self._draw()

    def on_changed(self) -> None:
        """Shows the newest program and plan."""
        if self._session.snapshot.planning == "planning":
            self.set_timer(PATIENCE_S, self._draw)
        else:
            self._tell_news()
            self._draw()

    def on_answered(self, message: Answered) -> None:
        """Shows an answer, and does what it leaves to the screen."""
        answer = message.answer
        command = answer.interpretation.command
        entries = answer_entries(answer)
        starts = answer.confirmed and not self._current and message.ticket > self._stopped_at
        if command in ("stop", "pause", "resume") and not self._current:
            entries = [Entry(NO_RUN)]
        elif answer.confirmed and not starts:
            entries = [Entry(ONE_RUN if self._current else STOPPED_FIRST, "! ")]
        elif self._current and answer.snapshot.automaton != self._current.snapshot.automaton:
            entries.append(Entry(RUN_GOES_ON))
        self._transcript = self._transcript.answer(message.ticket, entries)
        if starts:
            self._start(answer.snapshot)
        elif command == "help":
            self._view = "help"
        elif command == "quit":
            self._leave()
        if answer.snapshot.planning == "planning":
            self._awaited = (message.ticket, answer)
            self._tell_news()
        self._draw()

    def _tell_news(self) -> None:
        """Adds what a change did to the plan, where the answer came before the plan."""
        if self._awaited is None:
            return
        ticket, answer = self._awaited
        now = self._session.snapshot
        if now.planning == "planning" and now.revision == answer.snapshot.revision:
            return
        self._awaited = None
        if now.revision == answer.snapshot.revision:
            news = change_in_words("", answer.snapshot.plan, now.plan, False, now.failure).strip()
            self._transcript = self._transcript.answer(ticket, [Entry(news)] if news else [])

    def on_told(self, message: Told) -> None:
        """Shows something else that was asked for."""
        self._transcript = self._transcript.answer(message.ticket, message.entries)
        self._draw()

    def on_happened(self, message: Happened) -> None:
        """Shows an event of a run."""
        if self._current is None:
            return
        event = message.event
        self._progress = advanced(self._progress, event, self._current.plan)
        entry = event_entry(event, event.time - (self._progress.started or 0.0), self._glyphs)
        if entry is not None:
            self._note(entry)
        self._draw()

    def on_run_over(self, message: RunOver) -> None:
        """Goes back to editing."""
        self._current = None
        self._progress = replace(self._progress, activity="", at=None)
        self._note(*message.entries)
        if self._leaving:
            self.exit(0)
        self._draw()

    # What the user does

    def on_prompt_said(self, message: Prompt.Said) -> None:
        """Takes a line."""
        line = message.line
        view, order = view_asked(line), order_in(line)
        if order and (self._current or order == "stop"):
            if self._current:
                self._note(said=line)
            self._order(order)
        elif view is not None:
            self._view = view
            self._draw()
        else:
            self.action_say(line)

    def on_pane_typed(self, message: Pane.Typed) -> None:
        """Goes on typing in the input line."""
        self._board.prompt.focus()
        self._board.prompt.type_in(message.character)

    def on_pane_chosen(self, message: Pane.Chosen) -> None:
        """Says why something is in the program."""
        checkpoint, action = message.row.checkpoint, message.row.action
        if checkpoint is None or self._current:
            return
        asked = f"why action {action}?" if action else f"what about {self._name_of(checkpoint)}?"
        self._conversation.explain(checkpoint, action, self._note(said=asked))
        self._draw()

    def action_say(self, sentence: str) -> None:
        """Says a sentence, typed or meant by a key."""
        self._conversation.say(sentence, self._note(said=sentence), self._current)
        self._draw()

    def action_run(self) -> None:
        """Asks for a run; it is read out, and needs a yes."""
        if self._current:
            self._note(Entry(ONE_RUN, "! "))
            self._draw()
        else:
            self.action_say("run it")

    def action_stop(self) -> None:
        """Stops the run, before all that is queued."""
        self._order("stop")

    def action_pause(self) -> None:
        """Pauses the run, or resumes it."""
        self._order("resume" if self._progress.activity == "paused" else "pause")

    def action_view(self, view: View) -> None:
        """Shows something else in the largest pane; the same key goes back."""
        self._view = "plan" if view == self._view else view
        self._board.main.reset()
        self._draw()

    def action_home(self) -> None:
        """Goes back to the input line, the second time to the program."""
        if self._board.prompt.has_focus and self._view != "plan":
            self.action_view("plan")
        self._board.prompt.focus()

    def action_scroll(self, pages: int) -> None:
        """Scrolls the largest pane."""
        board = self._board
        (board.answers if self._view == "answers" else board.main).scroll_rows(pages)

    async def action_quit(self) -> None:
        """Leaves; a run is stopped first, and the second time nothing is waited for."""
        self._leave()

    def on_resize(self, event: Resize) -> None:
        """Shares the rows of the screen out anew."""
        self.call_after_refresh(self._draw)

    # Parts

    def _note(self, *entries: Entry, said: str = "") -> int:
        """Adds to what was said; returns its ticket."""
        self._transcript = self._transcript.add(Exchange(said, entries))
        return self._transcript.tickets

    def _name_of(self, checkpoint: str) -> str:
        found = self._session.snapshot.automaton.checkpoints.get(checkpoint)
        return found.name if found else checkpoint

    def _start(self, snapshot: Snapshot) -> None:
        if snapshot.plan is None:
            return
        log = new_log_path(self._session.world.name, self._logs) if self._logs else None
        self._current = Running(self._session, snapshot, snapshot.plan, self._tell, self._live, log)
        self._progress = Progress(self._session.world.initial, activity="running")
        self._view = "plan" if self._view == "help" else self._view
        self._current.start()

    def _leave(self) -> None:
        if self._current is None or self._leaving:
            self.exit(0)
            return
        self._leaving = True
        self._order("stop")

    def _order(self, order: Order) -> None:
        if self._current is not None:
            self._current.command(HumanCommand(order))
            activity: Activity = "stopping" if order == "stop" else self._progress.activity
            self._progress = replace(self._progress, activity=activity)
        elif order == "stop":
            self._stopped_at = self._transcript.tickets
            self.action_say("stop")  # The session forgets that it asked for a yes.
        else:
            self._note(Entry(NO_RUN))
        self._draw()

    def _scene(self) -> Scene:
        running, path = self._current, self._session.path
        return Scene(
            self._session.world,
            path.name if path else "(no file)",
            running.snapshot if running else self._session.snapshot,
            self._wording,
            self._progress,
            self._glyphs,
        )

    def _draw(self) -> None:
        """Shows how things are now."""
        self._board.show(self._scene(), self._view, self._transcript)
