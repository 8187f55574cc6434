"""The terminal application: one screen, one input line, the same sentences as everywhere.

Keys become actions or sentences, sentences go to the session in a thread of its own, and whatever comes
back is a message here. Each message makes a new scene, and the panes are drawn from that by pure functions.
"""

from __future__ import annotations

import contextlib
import sys
from collections.abc import Callable, Iterable
from dataclasses import replace
from pathlib import Path
from typing import ClassVar

from textual.app import App, ComposeResult
from textual.events import Resize
from textual.message import Message
from textual.widget import Widget

from polaris_nl.answers import change_in_words
from polaris_nl.automaton.automaton import START, Automaton
from polaris_nl.automaton.program import write_program
from polaris_nl.execution.state import HumanCommand
from polaris_nl.logs.paths import new_log_path
from polaris_nl.model.errors import PolarisError
from polaris_nl.model.state import Mutexes
from polaris_nl.model.wording import PlainWording
from polaris_nl.planning.result import BranchingPlan
from polaris_nl.render.explanation import offers
from polaris_nl.render.remembered import remembered
from polaris_nl.render.timeline import Stop, branch_stops
from polaris_nl.session import Session
from polaris_nl.snapshot import Answer, Snapshot
from polaris_tui import messages as told
from polaris_tui import stepping, styles
from polaris_tui.actions import Keymap, Situation
from polaris_tui.authoring import Desk
from polaris_tui.board import Board
from polaris_tui.completion import names_of
from polaris_tui.conversation import Conversation
from polaris_tui.deeds import Deeds, editor
from polaris_tui.keeping import Leftover
from polaris_tui.layout import TREE
from polaris_tui.menus import Ask, Change, Menu
from polaris_tui.pane import Pane
from polaris_tui.phrases import action_asked, order_in, view_asked
from polaris_tui.progress import Progress, advanced
from polaris_tui.running import Running
from polaris_tui.scene import Reading, Scene
from polaris_tui.settings import Settings
from polaris_tui.state import State
from polaris_tui.styles import LOOKS, Look
from polaris_tui.transcript import Entry, answer_entries, event_entry

PATIENCE_S = 0.15
"""How long a new plan may take before the screen says that it is being made: most come sooner."""
SLOW_S = 0.5
"""How often the parts of a plan that takes long are shown."""
END_S = 5.0
"""How long leaving waits for a run to stop, and for what the session is doing."""

NO_FILE = "Nothing is saved without a program file; to keep this, start with: polaris-nl tui FILE"
KEPT = "This program has no name yet, and is kept all the same; :save-as gives it one."
LEFT = "An earlier session ended without a name for its program; :recover brings it back."
NO_RUN = 'There is no run. F5, or "run it", starts one.'
RUN_GOES_ON = "The run goes on with the program that was read out; this counts from the next run."
ATTACHED = (
    "This run was begun in another terminal. It can be stopped from here; quitting lets it go on."
)
STOPPED_FIRST = "You said stop before it began, so nothing runs."
ONE_RUN = "A run is going on. Stop it with F9 before you start another."


class PolarisApp(App[int]):
    """The application.

    Args:
        session: program, language and planner; it belongs to the caller.
        settings: the user's.
        live: runs go in real time; otherwise as fast as the machine can.
        logs: the folder for the logs of runs; the usual one by default.
        kept: the program's file is not the user's, but one that keeps it until it has a name.
        leftovers: what earlier sessions left unsaved.
        log: a log to be opened at once.
        listens_at: the folder where runs listen to other terminals; None for nowhere.
        elsewhere: where runs of this world listen that go on already.
        talk: starts listening, where something can.
        settings_file: where settings are, for what is said about them.
    """

    ENABLE_COMMAND_PALETTE = False
    CSS = styles.CSS
    HORIZONTAL_BREAKPOINTS = styles.BREAKPOINTS
    BINDINGS: ClassVar = []

    def __init__(
        self,
        session: Session,
        settings: Settings = Settings(),
        *,
        live: bool = True,
        logs: Path | None = None,
        kept: bool = False,
        leftovers: Iterable[Leftover] = (),
        log: Path | None = None,
        listens_at: Path | None = None,
        elsewhere: Iterable[Path] = (),
        talk: Callable[[], None] | None = None,
        settings_file: str = "the settings",
    ) -> None:
        super().__init__()
        self.session = session
        self.settings = settings
        self.settings_file = settings_file
        self.keymap: Keymap = settings.keymap
        self.logs = logs
        self.leftovers = tuple(leftovers)
        self.animation_level = "none"
        self._live = live
        self._first_log = log
        self._talk = talk
        self._patient = False  # a timer is set to show that a plan is still being made
        self._listens_at = listens_at
        self._elsewhere = tuple(elsewhere)
        glyphs = settings.glyphs_for_terminal()
        self.state = State(
            glyphs,
            LOOKS[settings.theme],
            PlainWording(session.world),
            Progress(session.world.initial, activity="loading"),
            tree={"always": True, "never": False}.get(settings.tree),
            kept=kept,
        )
        for theme in styles.themes():
            self.register_theme(theme)
        self.theme = self.state.look.theme
        self._unsubscribe: Callable[[], None] = lambda: None
        self._focused_before: Widget | None = None
        self._conversation = Conversation(session, self.tell)
        self._deeds = Deeds(self, self.state)
        self.board = Board(self, glyphs, self.state.look)
        for action in self.keymap.actions:
            if action.keys:
                self._bindings.bind(
                    ",".join(action.keys), f"do('{action.id}')", show=False, priority=action.first
                )

    def compose(self) -> ComposeResult:
        """One screen."""
        yield self.board

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
        current = self.state.current
        gone = sys.__stdin__ is None or not sys.__stdin__.isatty()
        if current is not None and not self.is_headless and gone:
            self.state.hung_up = True
        if isinstance(current, Running) and not self.state.hung_up:
            current.command(HumanCommand("stop"))
            current.wait(END_S)
        elif current is not None and not isinstance(current, Running):
            current.leave()
            current.wait(END_S)
        self._conversation.end(END_S)

    def on_hung_up(self) -> None:
        """The terminal is gone: leaves it alone, and lets a run go on (see `remote`)."""
        self.state.hung_up = self.state.current is not None
        self.exit(0)

    # What the threads tell

    def tell(self, message: Message) -> None:
        """Sends a message from any thread; a screen that is gone already needs none."""
        with contextlib.suppress(RuntimeError):
            self.post_message(message)

    def on_warmed(self, message: told.Warmed) -> None:
        """Says things in the words of the domain from now on."""
        self.state.progress = replace(self.state.progress, activity="")
        if message.failure:
            self.state.note(Entry(message.failure, "! ", "bad"))
        else:
            self.state.wording = remembered(self.session.wording)
        if self._elsewhere:
            self.attach()
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
                self._deeds.confirm(answer.say)
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
        self.board.main.focus()
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

    def on_run_over(self, message: told.RunOver) -> None:
        """Goes back to editing."""
        self.state.current = None
        self.session.running = False
        self.state.progress = replace(self.state.progress, activity="", at=None)
        self.state.note(*message.entries)
        if self.state.leaving:
            self.exit(0)
        self.draw()

    # What the user does; these are called by the widgets at once, so that keys keep their order

    def action_do(self, id: str) -> None:
        """Does an action that a key means everywhere."""
        self._deeds.perform(id)

    def pane_key(self, pane: Pane, key: str, character: str | None) -> bool:
        """Does what a letter means in a pane."""
        action = self.keymap.letter(key, self.state.view)
        if action is not None:
            self._deeds.perform(action.id)
            return True
        if self.key_anywhere(key):
            return True
        if character is not None and character.isprintable():
            help_key, back = self.keymap.first("help"), self.keymap.first("prompt")
            self.tell_briefly(
                f'"{character}" means nothing here. {help_key} lists the keys; {back} goes to the input line.'
            )
            return True
        return False

    def key_anywhere(self, key: str) -> bool:
        """Does what a key means everywhere."""
        action = self.keymap.anywhere(key)
        if action is not None:
            self._deeds.perform(action.id)
        return action is not None

    def pane_moved(self, pane: Pane) -> None:
        """Keeps what is picked with the cursor."""
        row, state = pane.row, self.state
        if pane is self.board.main and row is not None:
            if state.view == "program" and not self.as_tree and row.checkpoint:
                state.picked = row.checkpoint
            elif state.view == "review" and state.reading is not None and row.action:
                state.reading = replace(state.reading, number=row.action)
        self.call_later(self.draw)

    def pane_entered(self, pane: Pane) -> None:
        """Goes on where the program was changed last."""
        row, state = pane.row, self.state
        program = pane is self.board.main and state.view == "program" and not self.as_tree
        if program and (row is None or row.checkpoint != state.picked):
            pane.pick(state.picked)
        self.call_later(self.draw)

    def pane_left(self, pane: Pane) -> None:
        """Shows other keys."""
        self.call_later(self.draw)

    def take_line(self, line: str) -> None:
        """Takes a line of the input line."""
        state = self.state
        if state.choosing.last is not None:
            self._deeds.chosen(line)
            self.draw()
            return
        view, order, action = view_asked(line), order_in(line), action_asked(line)
        if order and (state.current or order == "stop"):
            if state.current:
                state.note(said=line)
            self._deeds.order(order)
        elif action is not None:
            known = any(a.id == action for a in self.keymap.actions)
            self._deeds.perform(action if known else "actions")
        elif view is not None:
            state.view = view
        elif line.isdecimal() and state.current and 0 < int(line) <= len(state.progress.waiting):
            self._deeds.perform("tell", line)
        else:
            self.say(line)
        self.draw()

    def filter_menu(self, text: str) -> None:
        """Filters the menu that is open."""
        self.state.choosing = self.state.choosing.filtered(text)
        self.draw()

    def move_menu(self, by: int) -> None:
        """Picks another option."""
        self.state.choosing = self.state.choosing.moved(by)
        self.draw()

    def names(self) -> Iterable[str]:
        """What can be completed."""
        return names_of(self.session.world, self.session.snapshot.automaton)

    def on_resize(self, event: Resize) -> None:
        """Shares the rows of the screen out anew."""
        self.call_after_refresh(self.draw)

    # What the actions need

    def say(self, sentence: str) -> None:
        """Says a sentence, typed or meant by a key."""
        ticket = self.state.note(said=sentence)
        self._conversation.say(sentence, ticket, self.state.current)

    @property
    def busy(self) -> bool:
        """Whether something that was asked for is still to be done."""
        return self._conversation.busy

    def edit(self, change: Change) -> None:
        """Changes the program."""
        self._conversation.edit(change, self.state.note(said=change.label))

    def travel(self, steps: int) -> None:
        """Goes back or forward in the program's history."""
        word = "undo" if steps > 0 else "redo"
        self._conversation.travel(steps, self.state.note(said=f"{word} {abs(steps)}"))

    def explain(self, checkpoint: str, action: int | None) -> None:
        """Says why something is in the program."""
        found = self.session.snapshot.automaton.checkpoints.get(checkpoint)
        name = found.name if found else checkpoint
        asked = f"why action {action}?" if action else f"what about {name}?"
        self._conversation.explain(checkpoint, action, self.state.note(said=asked))

    def load(self, path: Path, label: str) -> None:
        """Takes another program from a file."""
        self._conversation.load(path, label, self.state.note(said=label))

    def save_as(self, path: Path) -> None:
        """Gives the program's file another name."""
        self.state.kept = False
        self._conversation.save_as(path, self.state.note(said=f"save as {path.name}"))

    def open_log(self, path: Path) -> None:
        """Opens a log."""
        self._conversation.open_log(path, self.state.note(said=f"log {path.name}"))

    def talk(self) -> None:
        """Starts listening."""
        if self._talk is not None:
            self._talk()

    def edit_file(self) -> None:
        """Opens the program in the user's editor, and takes what it leaves."""
        import shlex
        import subprocess
        import tempfile

        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "program.polaris.json"
            try:
                write_program(self.session.program, path)
                with self.suspend():
                    subprocess.run([*shlex.split(editor()), str(path)], check=False)
                kept = path.rename(Path(folder) / "edited.polaris.json")
                from polaris_nl.automaton.edits import ReplaceProgram
                from polaris_nl.automaton.program import read_program

                program = read_program(kept).automaton
            except (PolarisError, OSError) as error:
                self.state.note(Entry(f"The program stays as it was. {error}", "! ", "bad"))
                return
        if program == self.session.snapshot.automaton:
            self.state.note(Entry("Nothing was changed."))
        else:
            self.edit(Change("edit the file", (ReplaceProgram(program),)))

    def scroll_pane(self, pages: int) -> None:
        """Scrolls the pane that has the focus, else the largest one."""
        focused = self.focused
        if isinstance(focused, Pane):
            focused.scroll_rows(pages)
        else:
            board = self.board
            (board.answers if self.state.view == "answers" else board.main).scroll_rows(pages)

    def ask(self, question: Menu | Ask) -> None:
        """Lets the input line serve a menu or take a text."""
        if not self.board.prompt.has_focus:
            self._focused_before = self.focused
        if isinstance(question, Ask):
            self.board.prompt.serve("ask", question.initial)
        else:
            self.board.prompt.serve("menu")
        self.board.prompt.focus()

    def asked_enough(self) -> None:
        """Gives the input line back to sentences, and the focus to where it was."""
        self.board.prompt.serve("sentence")
        if self._focused_before is not None:
            self._focused_before.focus()
        self._focused_before = None

    def pick(self, checkpoint: str) -> None:
        """Goes to a checkpoint of the program."""
        self.state.view = "program"
        self.state.picked = checkpoint
        self.draw()
        self.board.main.focus()
        self.board.main.pick(checkpoint)

    def tell_briefly(self, text: str) -> None:
        """Says something that isn't worth keeping twice."""
        self.state.note(Entry(text))
        self.draw()

    def read_back(self, automaton: Automaton) -> str:
        """A program in a sentence."""
        return self.session.understanding.read_back(automaton)

    def dress(self, look: Look) -> None:
        """Takes other colours."""
        self.state.look = look
        self.theme = look.theme
        self.board.dress(look)

    def want_purpose(self) -> None:
        """Has it worked out why the step that is picked is there, unless that is known."""
        stop = self.stop() if self.state.view == "plan" else None
        place = (self.session.snapshot.revision, stop.number or 0) if stop else None
        if stop and stop.number and place not in self.state.purposes:
            self._conversation.purpose(stop.number)

    def stops(self, leaf: str) -> tuple[Stop, ...]:
        """The stops of a branch of the present plan."""
        snapshot = self.session.snapshot
        if snapshot.plan is None or leaf not in snapshot.automaton.checkpoints:
            return ()
        return branch_stops(snapshot.automaton, snapshot.plan, leaf, self.state.wording)

    def stop(self) -> Stop | None:
        """The step of the plan that is picked."""
        stops = self.stops(self.state.steps.leaf)
        return stops[min(self.state.steps.at, len(stops) - 1)] if stops else None

    def follow_reading(self) -> None:
        """Goes to the row of the event that is read."""
        reading = self.state.reading
        self.draw()
        if reading is not None:
            rows = self.board.main.rows
            at = next((n for n, r in enumerate(rows) if (r.action or 0) >= reading.number), 0)
            self.board.main.go_to(at)

    def leave(self) -> None:
        """Quits; a run is stopped first, and the second time nothing is waited for."""
        if not isinstance(self.state.current, Running) or self.state.leaving:
            self.exit(0)  # A run of another terminal goes on.
            return
        self.state.leaving = True
        self._deeds.order("stop")

    # Parts

    def _start(self, snapshot: Snapshot, plan: BranchingPlan) -> None:
        log = new_log_path(self.session.world.name, self.logs) if self.logs else None
        run = Running(self.session, snapshot, plan, self.tell, self._live, log)
        if self._listens_at is not None:
            run.tell = self._served(run)
        self.state.current = run
        self.state.progress = Progress(self.session.world.initial, activity="running")
        if self.state.view != "map":
            self.state.view = "run"
        self.session.running = True
        self.state.ran = snapshot
        self.state.current.start()

    def _served(self, run: Running) -> Callable[[Message], object]:
        """Lets other terminals see and command a run; returns whom it tells what happens."""
        from polaris_nl.automaton.program import program_json
        from polaris_nl.planning.plan_json import plan_json
        from polaris_tui.remote import RunServer

        program = program_json(self.session.program_of(run.snapshot.automaton))
        plan = plan_json(run.plan, run.snapshot.automaton)
        hello = {"world": self.session.world.name, "program": program, "plan": plan}
        try:
            assert self._listens_at is not None
            server = RunServer(hello, run.command, self._listens_at)
        except OSError as error:
            text = f"No other terminal will be able to stop this run ({error})."
            self.state.note(Entry(text, "! "))
            return self.tell

        def both(message: Message) -> None:
            server.tell(message)
            self.tell(message)

        return both

    def attach(self) -> None:
        """Shows the run that goes on elsewhere; it can be stopped, paused and told things from here."""
        from polaris_tui.remote import RemoteRun

        try:
            run = RemoteRun(self._elsewhere[-1], self.tell)
        except PolarisError as error:
            self.state.note(Entry(str(error), "! ", "bad"))
            return
        self._elsewhere = self._elsewhere[:-1]
        self.state.current, self.state.ran = run, run.snapshot
        self.state.progress = Progress(self.session.world.initial, activity="running")
        self.state.view = "run"
        self.state.note(Entry(ATTACHED))
        run.start()

    @property
    def as_tree(self) -> bool:
        """Whether the program is drawn as a tree."""
        return self.size.width >= TREE if self.state.tree is None else self.state.tree

    def desk(self) -> Desk:
        """What is edited."""
        automaton = self.session.snapshot.automaton
        picked = self.state.picked if self.state.picked in automaton.checkpoints else START
        return Desk(
            self.session.world,
            self.state.wording,
            automaton,
            picked,
            self.session.understanding.names.checkpoint,
            self.session.understanding.names.renamed,
        )

    def situation(self) -> Situation:
        """What can be done now."""
        state, snapshot = self.state, self.session.snapshot
        automaton, plan = snapshot.automaton, snapshot.plan
        ways_out = offers(plan) if plan else ()
        return Situation(
            view=state.view,
            checkpoint=state.picked if state.picked in automaton.checkpoints else START,
            empty=len(automaton.checkpoints) == 1,
            running=state.current is not None,
            waiting=len(state.progress.waiting),
            undoable=bool(snapshot.undoable),
            redoable=bool(snapshot.redoable),
            repairs=len(ways_out),
            planned=plan is not None and bool(plan.segments or plan.problems),
            loose=len(automaton.transitions) < len(automaton.checkpoints) - 1,
            elsewhere=bool(self._elsewhere),
            leftover=bool(self.leftovers),
            listens=self._talk is not None,
            editor=bool(editor()),
        )

    def scene(self) -> Scene:
        """All that the panes show."""
        state, session = self.state, self.session
        running, path, reading = state.current, session.path, state.reading
        snapshot = running.snapshot if running else session.snapshot
        if state.view == "run":
            snapshot = state.ran or snapshot
        world, wording, progress = session.world, state.wording, state.progress
        file = "(no name)" if state.kept else path.name if path else "(no file)"
        if reading is not None:
            replay = reading.replay
            world, wording, file = replay.world, state.read_wording or wording, replay.path.name
            snapshot = Snapshot(0, replay.automaton, replay.plan, "planned")
            progress = replay.progress(reading.number)
        else:
            state.steps = stepping.kept(state.steps, snapshot.automaton, snapshot.plan)
        stop = self.stop() if state.view == "plan" else None
        place = (snapshot.revision, stop.number or 0) if stop else (0, 0)
        loaded = "planner" in session.__dict__
        return Scene(
            world,
            file,
            snapshot,
            wording,
            progress,
            state.glyphs,
            self.keymap,
            self.situation(),
            session.planner.mutexes if loaded else Mutexes(),
            self.as_tree and state.view == "program",
            state.actions,
            state.picked,
            state.steps,
            state.purposes.get(place, ""),
            reading,
            state.slow,
            state.view == "map" and state.before_view == "plan" and reading is None,
        )

    def draw(self) -> None:
        """Shows how things are now."""
        if self.is_running:
            self.board.show(
                self.scene(), self.state.view, self.state.transcript, self.state.choosing
            )
