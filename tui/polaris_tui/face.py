"""What the actions need of the application: sentences, edits, menus, runs."""

from __future__ import annotations

from pathlib import Path

from polaris_nl.automaton.automaton import Automaton
from polaris_nl.automaton.edits import ReplaceProgram
from polaris_nl.logs.paths import new_log_path
from polaris_nl.model.errors import PolarisError
from polaris_nl.planning.result import BranchingPlan
from polaris_nl.snapshot import Snapshot
from polaris_tui.base import BaseApp
from polaris_tui.editor import edited
from polaris_tui.menus import Ask, Change, Menu
from polaris_tui.pane import Pane
from polaris_tui.phrases import Order
from polaris_tui.progress import Activity, Progress
from polaris_tui.remote import ATTACHED, RemoteRun
from polaris_tui.running import Running
from polaris_tui.serving import served
from polaris_tui.styles import Look
from polaris_tui.transcript import Entry


class Face(BaseApp):
    """An application that can be told what to do."""

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

    def open_log(self, path: Path, go_there: bool = True) -> None:
        """Opens a log; `go_there`: the focus goes there, even if sentences are being written."""
        if go_there:
            self.screen.set_focus(self.board.main)
        self._conversation.open_log(path, self.state.note(said=f"log {path.name}"))

    def talk(self) -> None:
        """Starts listening, or listens again."""
        if self.talking is not None:
            self.talking.key()

    def edit_file(self) -> None:
        """Opens the program in the user's editor, and takes what it leaves."""
        try:
            program = edited(self.session.program, self.suspend())
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
        self.screen.set_focus(self.board.prompt)

    def asked_enough(self) -> None:
        """Gives the input line back to sentences, and the focus to where it was."""
        self.board.prompt.serve("sentence")
        if self._focused_before is not None:
            self.screen.set_focus(self._focused_before)
        self._focused_before = None

    def pick(self, checkpoint: str) -> None:
        """Goes to a checkpoint of the program."""
        self.state.view = "program"
        self.state.picked = checkpoint
        self.draw()
        self.screen.set_focus(self.board.main)
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
        current = self.state.current
        if current is None or not current.ours or self.state.leaving:
            self.exit(0)  # A run of another terminal goes on.
            return
        self.state.leaving = True
        self.order("stop")

    def order(self, order: Order) -> None:
        """Commands the run."""
        raise NotImplementedError

    def take_line(self, line: str) -> None:
        """Takes a line of the input line."""
        raise NotImplementedError

    def _start(self, snapshot: Snapshot, plan: BranchingPlan) -> None:
        log = new_log_path(self.session.world.name, self.logs) if self.logs else None
        before, profile = self.session.past, self._profile
        run = Running(self.session, snapshot, plan, self.tell, self._live, log, before, profile)
        if self._listens_at is not None:
            run.tell, trouble = served(run, self.session, self._listens_at, self.tell)
            if trouble:
                self.state.note(Entry(trouble, "! "))
        self.state.current, self.state.ran_on = run, self.state.robot
        activity: Activity = "connecting" if self.state.robot else "running"
        self.state.progress = Progress(self.session.world.initial, activity=activity)
        if self.state.view == "map":
            self.state.before_view = "run"  # It is of the run now, no more of a step of the plan.
        else:
            self.state.view = "run"
        self.session.running = True
        self.state.ran, self.state.attached = snapshot, False
        self.state.current.start()

    def attach(self) -> None:
        """Shows the run that goes on elsewhere; it can be stopped, paused and told things from here."""
        try:
            run = RemoteRun(self._elsewhere[-1], self.tell)
        except PolarisError as error:
            self.state.note(Entry(str(error), "! ", "bad"))
            return
        self._elsewhere = self._elsewhere[:-1]
        self.state.current, self.state.ran = run, run.snapshot
        self.state.ran_on, self.state.attached = run.robot, True
        self.state.progress = Progress(self.session.world.initial, activity="running")
        self.state.view = "run"
        self.state.note(Entry(ATTACHED))
        run.start()
