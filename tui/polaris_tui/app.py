"""The terminal application: one screen, one input line, the same sentences as everywhere.

Keys become actions or sentences, sentences go to the session in a thread of its own, and whatever comes
back is a message here. Each message makes a new scene, and the panes are drawn from that by pure functions.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping
from dataclasses import replace

from textual.events import Resize

from polaris_nl.answers import change_in_words
from polaris_nl.model.text import capital
from polaris_nl.render.remembered import remembered
from polaris_nl.snapshot import Answer
from polaris_tui import messages as told
from polaris_tui.keyed import Keyed
from polaris_tui.messages import VoiceState
from polaris_tui.progress import advanced
from polaris_tui.reasons import NO_RUN
from polaris_tui.scene import Reading
from polaris_tui.transcript import Entry, answer_entries, event_entry

PATIENCE_S = 0.15
"""How long a new plan may take before the screen says that it is being made: most come sooner."""
SLOW_S = 0.5
"""How often the parts of a plan that takes long are shown."""
END_S = 5.0
"""How long leaving waits for what the session is doing."""

VOICE: Mapping[VoiceState, str] = {
    "": "",
    "opening": "opening the microphone",
    "listening": "listening",
    "waiting": '{key} to talk; "stop" works',
    "asleep": "asleep",
    "speaking": "speaking",
    "deaf": "no microphone",
    "off": "",
}
"""What the status line says about the voice."""

NO_FILE = "Nothing is saved without a program file; to keep this, start with: polaris-nl tui FILE"
KEPT = "This program has no name yet, and is kept all the same; :save-as gives it one."
LEFT = "An earlier session ended without a name for its program; :recover brings it back."
RUN_GOES_ON = "The run goes on with the program that was read out; this counts from the next run."
STOPPED_FIRST = "You said stop before it began, so nothing runs."
ONE_RUN = "A run is going on. Stop it with F9 before you start another."


class PolarisApp(Keyed):
    """The application, with what it hears from threads and widgets; see `BaseApp` for its arguments."""

    def on_mount(self) -> None:
        """Shows the first screen; language and planner are loaded behind it."""
        self.board.prompt.focus()
        if self.session.path is None:
            self.state.note(Entry(NO_FILE, tone="faint"))
        elif self.state.kept:
            self.state.note(Entry(KEPT, tone="faint"))
        if self.leftovers:
            self.state.note(Entry(LEFT))
        self.draw()
        self._unsubscribe = self.session.subscribe(lambda snapshot: self.tell(told.Changed()))
        self.call_after_refresh(self._conversation.start)
        if self._first_log is not None:
            self.open_log(self._first_log)

    def on_unmount(self) -> None:
        """Leaves no thread behind that still uses the session."""
        self._unsubscribe()
        if self.talking is not None:
            self.talking.end()
        current = self.state.current
        gone = sys.__stdin__ is None or not sys.__stdin__.isatty()
        if current is not None and not self.is_headless and gone:
            self.state.hung_up = True
        if current is not None and not (current.ours and self.state.hung_up):
            current.end()
        self._conversation.end(END_S)

    async def action_quit(self) -> None:
        """Textual's own key for quitting, too, stops a run first."""
        self.action_do("quit")

    def on_hung_up(self) -> None:
        """The terminal is gone: leaves it alone, and lets a run go on (see `remote`)."""
        self.state.hung_up = self.state.current is not None
        self.exit(0)

    def on_warmed(self, message: told.Warmed) -> None:
        """Says things in the words of the domain from now on."""
        self.state.progress = replace(self.state.progress, activity="")
        if message.failure:
            self.state.note(Entry(message.failure, "! ", "bad"))
        else:
            self.state.wording = remembered(self.session.wording)
        if self._elsewhere:
            self.attach()
        if self.talking is not None and self.talking.at_once:
            self.talking.begin()
        self.draw()

    def on_changed(self) -> None:
        """Shows the newest program and plan."""
        if self.session.snapshot.planning == "planning":
            if not self._patient:  # Parts of a plan may come many times a second.
                self._patient = True
                self.set_timer(SLOW_S if self.state.slow else PATIENCE_S, self._still_planning)
        else:
            self.state.slow = False
            self._tell_news()
            self.want_purpose()
            self.draw()

    def _still_planning(self) -> None:
        self._patient = False
        self.state.slow = self.session.snapshot.planning == "planning"
        self.draw()

    def on_answered(self, message: told.Answered) -> None:
        """Shows an answer, and does what it leaves to the screen."""
        answer, state = message.answer, self.state
        command = answer.interpretation.command
        before = state.awaited_plan
        state.awaited_plan = answer.snapshot.plan
        entries = answer_entries(answer)
        starts = answer.confirmed and not state.current and message.ticket > state.stopped_at
        if command in ("stop", "pause", "resume") and not state.current:
            entries = [Entry(NO_RUN)]
        elif answer.confirmed and not starts:
            entries = [Entry(ONE_RUN if state.current else STOPPED_FIRST, "! ")]
        elif command == "run" and self.session.awaits_yes and state.robot:
            entries.insert(0, Entry(f"{capital(state.robot)} will move.", "! "))
        elif state.current and answer.snapshot.automaton != state.current.snapshot.automaton:
            entries.append(Entry(RUN_GOES_ON))
        state.transcript = state.transcript.answer(message.ticket, entries)
        if starts and answer.snapshot.plan is not None:
            self._start(answer.snapshot, answer.snapshot.plan)
        elif command == "help":
            state.view = "help"
        elif command == "quit":
            self.leave()
        elif command == "run" and state.asks_to_start:
            state.asks_to_start = False
            if answer.snapshot.plan is not None and answer.snapshot.plan.segments:
                self.deeds.confirm(answer.say)
        if answer.snapshot.planning == "planning":
            state.awaited = (message.ticket, answer.snapshot.revision, before)
            self._tell_news()
        self._pick_edited(answer)
        self.draw()

    def on_edited(self, message: told.Edited) -> None:
        """Shows what a change by keys did."""
        state, after = self.state, message.after
        entries = [Entry(message.failure, "! ", "bad")] if message.failure else []
        if state.current:
            entries.append(Entry(RUN_GOES_ON))
        if after.planning == "planning":
            state.awaited = (message.ticket, after.revision, message.before)
        news = change_in_words(
            "", message.before, after.plan, after.planning == "planning", after.failure
        ).strip()
        state.transcript = state.transcript.answer(
            message.ticket, [*entries, Entry(news or "Done.")]
        )
        self._tell_news()
        if message.focus:
            state.picked = message.focus
        self.draw()
        if message.focus:
            self.board.main.pick(message.focus)

    def _pick_edited(self, answer: Answer) -> None:
        """Picks the checkpoint that a sentence has made or changed last."""
        for edit in reversed(answer.interpretation.edits):
            checkpoint = getattr(edit, "checkpoint", None)
            found = getattr(checkpoint, "id", checkpoint)
            if found in answer.snapshot.automaton.checkpoints:
                self.state.picked = str(found)
                return

    def _tell_news(self) -> None:
        """Adds what a change did to the plan, where the answer came before the plan."""
        if self.state.awaited is None:
            return
        ticket, revision, before = self.state.awaited
        now = self.session.snapshot
        if now.planning == "planning" and now.revision == revision:
            return
        self.state.awaited = None
        if now.revision == revision:
            news = change_in_words("", before, now.plan, False, now.failure).strip()
            entries = [Entry(news)] if news else []
            self.state.transcript = self.state.transcript.answer(ticket, entries)

    def on_told(self, message: told.Told) -> None:
        """Shows something else that was asked for."""
        self.state.transcript = self.state.transcript.answer(message.ticket, message.entries)
        self.draw()

    def on_explained(self, message: told.Explained) -> None:
        """Shows why a step of the plan is there."""
        self.state.purposes[message.place] = message.text
        self.draw()

    def on_opened(self, message: told.Opened) -> None:
        """Shows a log."""
        shown = message.replay.shown("")
        self.state.reading = Reading(message.replay, shown[0] if shown else 1)
        self.state.read_wording = remembered(message.wording)
        self.state.view = "review"
        self.draw()
        if not self.board.prompt.has_focus:  # Who writes sentences goes on doing so.
            self.screen.set_focus(self.board.main)
        self.board.main.reset()

    def on_happened(self, message: told.Happened) -> None:
        """Shows an event of a run."""
        state, event = self.state, message.event
        if state.current is None:
            return
        state.progress = advanced(state.progress, event, state.current.plan)
        started = state.progress.started or 0.0
        entry = event_entry(event, event.time - started, state.glyphs)
        if entry is not None:
            state.note(entry)
        self.draw()

    def on_listened(self, message: told.Listened) -> None:
        """Shows whether it listens; why not, where it can't."""
        if message.text:
            lead = "! " if message.state == "deaf" else "  "
            self.state.note(Entry(message.text, lead))
        if message.state:
            key = self.keymap.first("talk")
            self.state.voice = VOICE[message.state].format(key=key)
        self.draw()

    def on_ordered(self, message: told.Ordered) -> None:
        """Shows that "stop" or "pause" was heard, and sees to it also where a run has begun just now."""
        self.state.voice = f"heard: {message.order}"
        if self.state.current is not None:
            self.state.note(said=self.state.voice)
        self.order(message.order)
        self.draw()

    def on_spoken(self, message: told.Spoken) -> None:
        """Shows what was heard, and what came of it, as if it was typed."""
        reply, state = message.reply, self.state
        state.voice = f"heard: {reply.said.text}"
        if reply.answer is not None:
            if reply.answer.interpretation.command in ("yes", "no"):
                self.deeds.close()
            ticket = state.note(said=state.voice)
            self.on_answered(told.Answered(ticket, reply.answer))
        elif reply.text:
            state.note(Entry(reply.text), said=state.voice)
        self.draw()

    def on_run_over(self, message: told.RunOver) -> None:
        """Goes back to editing."""
        self.state.current = None
        self.session.running = False
        self.state.progress = replace(self.state.progress, activity="", at=None)
        self.state.note(*message.entries)
        if self.state.leaving:
            self.exit(0)
        self.draw()

    def on_resize(self, event: Resize) -> None:
        """Shares the rows of the screen out anew."""
        self.call_after_refresh(self.draw)
