"""What each action does on the screen."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from polaris_nl.automaton.automaton import START
from polaris_nl.execution.state import HumanCommand
from polaris_nl.model.errors import PolarisError
from polaris_nl.planning.result import Problem, Warning
from polaris_nl.render.explanation import offers
from polaris_tui import authoring, stepping
from polaris_tui.actions import BY_ID, View
from polaris_tui.choosing import Choosing
from polaris_tui.menus import Ask, Change, Menu, Note, Option, Perform, Step
from polaris_tui.pane import Pane
from polaris_tui.phrases import Order
from polaris_tui.state import State
from polaris_tui.styles import LOOKS
from polaris_tui.transcript import Entry

if TYPE_CHECKING:
    from polaris_tui.app import PolarisApp


class Deeds:
    """Carries actions out.

    Args:
        app: the application, for what only it can do.
        state: what it remembers.
    """

    def __init__(self, app: PolarisApp, state: State) -> None:
        self._app = app
        self._state = state
        self._do: dict[str, Callable[[str], None]] = {
            "mend": lambda about: self._mend(),
            "why": lambda about: self._why(),
            "pick": self._pick,
            "undo": lambda about: self._travel(about, "undo"),
            "redo": lambda about: self._travel(about, "redo"),
            "history": lambda about: self._history(),
            "recover": self._recover,
            "shape": lambda about: self._shape(),
            "editor": lambda about: app.edit_file(),
            "save-as": self._save_as,
            "plan": lambda about: self._plan(),
            "next": lambda about: self._step(1),
            "previous": lambda about: self._step(-1),
            "next-way": lambda about: self._way(1),
            "other-way": lambda about: self._way(-1),
            "first-step": lambda about: self._step(-1_000_000),
            "last-step": lambda about: self._step(1_000_000),
            "run": lambda about: self._run(),
            "watch": lambda about: self.show("run"),
            "pause": lambda about: self._pause(),
            "stop": lambda about: self.order("stop"),
            "tell": self._tell,
            "attach": lambda about: app.attach(),
            "talk": lambda about: app.talk(),
            "log": self._log,
            "next-problem": lambda about: self._problem(1),
            "last-problem": lambda about: self._problem(-1),
            "filter": lambda about: self._filter(),
            "compare": lambda about: self._below("compare"),
            "chain": lambda about: self._below("chain"),
            "help": lambda about: self.show("help"),
            "program": lambda about: self._program(),
            "map": lambda about: self.show("map"),
            "answers": lambda about: self.show("answers"),
            "actions": lambda about: self._palette(),
            "copy": lambda about: self._copy(about),
            "theme": self._theme,
            "open": lambda about: self._open(),
            "up": lambda about: self._move("up"),
            "down": lambda about: self._move("down"),
            "left": lambda about: self._move("left"),
            "right": lambda about: self._move("right"),
            "top": lambda about: self._pane.move(-1_000_000),
            "bottom": lambda about: self._pane.move(1_000_000),
            "page-up": lambda about: app.scroll_pane(-1),
            "page-down": lambda about: app.scroll_pane(1),
            "next-pane": lambda about: self._focus(1),
            "previous-pane": lambda about: self._focus(-1),
            "prompt": lambda about: self._back(),
            "quit": lambda about: app.leave(),
            "say": app.say,
            "repair": lambda about: self._repair(int(about)),
        }

    def perform(self, id: str, about: str = "") -> None:
        """Does an action, or says why not."""
        action = BY_ID.get(id)
        queued = id in ("undo", "redo") and self._app.busy  # what is queued decides, then
        reason = action.reason(self._app.situation()) if action and not queued else ""
        if reason:
            self._state.note(Entry(reason))
        elif id in self._do:
            self._do[id](about)
        else:
            self.follow(authoring.steps(self._app.desk())[id]())
        self._app.draw()

    # Menus

    def follow(self, step: Step) -> None:
        """Goes on with what a menu or an action led to."""
        state = self._state
        if isinstance(step, Menu | Ask):
            state.choosing = state.choosing.asked(step)
            self._app.ask(step)
            return
        self.close()
        if isinstance(step, Change):
            self._app.edit(step)
        elif isinstance(step, Perform):
            self.perform(step.action, step.about)
        else:
            state.note(Entry(step.text))

    def close(self) -> None:
        """Closes all menus."""
        if self._state.choosing.last is not None:
            self._state.choosing = Choosing()
            self._app.asked_enough()

    def chosen(self, line: str) -> None:
        """Enter in a menu, or below a text that is asked for."""
        choosing = self._state.choosing
        if isinstance(choosing.last, Ask):
            if not line:
                self._app.ask(choosing.last)
                return
            self._guarded(partial(choosing.last.then, line))
            return
        if line != choosing.text:
            choosing = choosing.filtered(line)
        option = choosing.picked
        if option is None:
            self.close()
            if line:
                self._app.take_line(line)  # Not in the menu, so it is meant as a sentence.
        elif option.reason:
            self._state.note(Entry(option.reason))
        else:
            self._guarded(option.step)

    def _guarded(self, then: Callable[[], Step]) -> None:
        try:
            self.follow(then())
        except PolarisError as error:
            self.follow(Note(str(error)))

    def _palette(self) -> None:
        """All actions, with their keys, and why some can't be done now."""
        now, keymap = self._app.situation(), self._app.keymap
        skipped = ("up", "down", "left", "right", "top", "bottom", "actions", "open", "prompt")
        self.follow(
            Menu(
                "Actions",
                tuple(
                    Option(
                        f"{a.id}: {a.does}",
                        Perform(a.id),
                        keymap.shown(a.id),
                        a.reason(now),
                    )
                    for a in keymap.actions
                    if a.id not in skipped
                ),
            )
        )

    # The program

    def _mend(self) -> None:
        plan = self._app.session.snapshot.plan
        found = offers(plan) if plan else ()
        self.follow(authoring.mend_menu([(self._named(t), r.text, r.edits) for t, r in found]))

    def _named(self, trouble: Problem | Warning) -> str:
        """The checkpoint that something is wrong with."""
        automaton = self._app.session.snapshot.automaton
        way = automaton.transitions.get(trouble.transition or "")
        id = getattr(trouble, "checkpoint", None) or (way.target if way else "")
        return f"for {automaton.checkpoints[id].name}" if id in automaton.checkpoints else ""

    def _repair(self, number: int) -> None:
        plan = self._app.session.snapshot.plan
        found = offers(plan) if plan else ()
        if 0 < number <= len(found):
            _, repair = found[number - 1]
            self._app.edit(Change(repair.text, repair.edits))

    def _pick(self, about: str) -> None:
        if about:
            self._app.pick(about)
        else:
            self.follow(authoring.pick_menu(self._app.desk()))

    def _why(self) -> None:
        if self._state.view == "plan":
            stop = self._app.stop()
            if stop is not None:
                self._app.explain(stop.checkpoint, stop.number)
            return
        row = self._app.board.main.row
        if self._state.view == "program" and row and row.checkpoint and not self._app.as_tree:
            self._app.explain(row.checkpoint, row.action)
        else:
            self._app.explain(self._state.picked, None)

    def _travel(self, about: str, command: str) -> None:
        if about:
            self._app.travel(int(about) if command == "undo" else -int(about))
        else:
            self._app.say(command)

    def _history(self) -> None:
        snapshot = self._app.session.snapshot
        self.follow(authoring.history_menu(snapshot.undoable, snapshot.redoable))

    def _recover(self, about: str) -> None:
        if about:
            self._app.load(Path(about), "the program of an earlier session")
            return
        options = tuple(
            Option(
                self._app.read_back(left.program.automaton),
                Perform("recover", str(left.path)),
                left.path.name,
            )
            for left in self._app.leftovers
        )
        self.follow(Menu("Which one?", options))

    def _shape(self) -> None:
        self._state.tree = not self._app.as_tree

    def _save_as(self, about: str) -> None:
        if about:
            self._app.save_as(Path(about).expanduser())
            return
        initial = f"{self._app.session.world.name}.polaris.json"
        self.follow(
            Ask("Keep the program in which file?", lambda x: Perform("save-as", x), initial)
        )

    # The plan

    def _plan(self) -> None:
        state = self._state
        if state.view == "plan":
            state.view = "program"
            return
        main = self._app.board.main
        row = main.row if main.has_focus and state.view == "program" else None
        number = row.action if row is not None and not self._app.as_tree else None
        self.show("plan")
        if row is not None:
            self._at(state.picked, number)
        else:
            leaf = stepping.first_leaf(self._app.session.snapshot.automaton, state.picked)
            state.steps = stepping.Steps(leaf, 0)
            self._app.want_purpose()

    def _at(self, checkpoint: str, number: int | None) -> None:
        """Goes to a step of the plan."""
        automaton = self._app.session.snapshot.automaton
        leaf = stepping.first_leaf(automaton, checkpoint)
        stops = self._app.stops(leaf)
        self._state.steps = stepping.at_action(automaton, checkpoint, stops, number)
        if number is None and checkpoint == START:
            self._state.steps = stepping.Steps(leaf, 0)
        self._app.want_purpose()

    def _step(self, by: int) -> None:
        steps = self._state.steps
        self._state.steps = stepping.moved(steps, self._app.stops(steps.leaf), by)
        self._app.want_purpose()

    def _way(self, by: int) -> None:
        steps, automaton = self._state.steps, self._app.session.snapshot.automaton
        stops = self._app.stops(steps.leaf)
        found = stepping.other_way(steps, stops, automaton, by)
        if found == steps:
            self._state.note(Entry("The ways never part in this program."))
        self._state.steps = found
        self._app.want_purpose()

    # Runs

    def _run(self) -> None:
        self._state.asks_to_start = True
        self._app.say("run it")

    def confirm(self, read_out: str) -> None:
        """Asks for the yes, below what will happen."""
        self.follow(
            Menu(
                "Shall I start?",
                (
                    Option("yes, start", Perform("say", "yes")),
                    Option("no", Perform("say", "no")),
                ),
                read_out,
            )
        )

    def order(self, order: Order) -> None:
        """Commands the run."""
        state = self._state
        if state.current is not None:
            state.current.command(HumanCommand(order))
            if order == "stop":
                state.progress = replace(state.progress, activity="stopping")
        elif order == "stop":
            self.close()
            state.stopped_at = state.transcript.tickets
            self._app.say("stop")  # The session forgets that it asked for a yes.

    def _pause(self) -> None:
        self.order("resume" if self._state.progress.activity == "paused" else "pause")

    def _tell(self, about: str) -> None:
        waiting, wording = self._state.progress.waiting, self._state.wording
        current = self._state.current
        if about and current is not None and 0 < int(about) <= len(waiting):
            when = waiting[int(about) - 1]
            self._state.note(said=wording.events(when))
            current.command(HumanCommand("happened", when))
            return
        self.follow(authoring.tell_menu(waiting, wording))

    # Logs

    def _log(self, about: str) -> None:
        if about:
            self._app.open_log(Path(about).expanduser())
            return
        self.follow(authoring.log_menu(self._app.logs))

    def _problem(self, step: int) -> None:
        reading = self._state.reading
        if reading is None:
            return
        found = reading.replay.problem(reading.number, step)
        if found is None:
            where = "after" if step > 0 else "before"
            self._app.tell_briefly(f"There is no problem {where} this event.")
            return
        words = reading.words if found in reading.replay.shown(reading.words) else ""
        self._state.reading = replace(reading, number=found, words=words)
        self._app.follow_reading()

    def _filter(self) -> None:
        reading = self._state.reading
        if reading is None:
            return

        def filtered(words: str) -> Step:
            wanted = "" if words.strip() == "*" else words.strip()
            self._state.reading = replace(reading, words=wanted)
            self._app.follow_reading()
            return Note("All events again." if not wanted else f"Only events with: {wanted}")

        title = "Only events with these words (topic=goal, severity=warning; * shows all again)"
        self.follow(Ask(title, filtered, reading.words))

    def _below(self, what: str) -> None:
        reading = self._state.reading
        if reading is not None:
            below = "event" if reading.below == what else what
            self._state.reading = replace(reading, below=below)

    # The screen

    def show(self, view: View) -> None:
        """Shows something else in the largest pane; the same again goes back."""
        state = self._state
        if view == state.view:
            view = state.before_view if state.before_view != view else self._home
        state.before_view, state.view = state.view, view
        self._app.board.main.reset()
        if view in ("plan", "review"):  # There the arrows step.
            self._app.board.main.focus()
        if view == "review":
            self._app.follow_reading()

    @property
    def _home(self) -> View:
        return "review" if self._state.reading is not None else "program"

    def _program(self) -> None:
        state = self._state
        if state.view == "program" and state.reading is None:
            state.actions = not state.actions
        state.reading = None
        state.view = state.before_view = "program"

    def _copy(self, about: str) -> None:
        if about:
            self._app.copy_to_clipboard(about)
            self._state.note(Entry("Copied."))
            return
        pane = self._pane
        last = self._state.transcript.last_answer()
        row = pane.row.text.strip() if pane.row else ""
        everything = "\n".join(r.text.rstrip() for r in pane.rows)
        found = (
            ("this row", row),
            ("all rows of this pane", everything),
            ("the last answer", last),
        )
        options = tuple(
            Option(what, Perform("copy", text), text[:60].replace("\n", " "))
            for what, text in found
            if text
        )
        self.follow(Menu("Copy what?", options))

    def _theme(self, about: str) -> None:
        if about:
            self._app.dress(LOOKS[about])
            text = f'To keep it, put theme = "{about}" into {self._app.settings_file}'
            self._state.note(Entry(text))
            return
        options = tuple(
            Option(look.name, Perform("theme", look.name), look.does) for look in LOOKS.values()
        )
        self.follow(Menu("Colours", options))

    @property
    def _pane(self) -> Pane:
        """The pane that has the focus, else the largest one."""
        focused = self._app.focused
        return focused if isinstance(focused, Pane) else self._app.board.main

    def _open(self) -> None:
        pane, row, state = self._pane, self._pane.row, self._state
        if pane is self._app.board.trouble and row is not None:
            if row.repair:
                self._repair(row.repair)
            elif row.checkpoint:
                self._app.pick(row.checkpoint)
        elif state.view == "review":
            if state.reading is not None:
                state.reading = replace(state.reading, below="event")
        elif state.view == "plan":
            self._why()
        elif pane is self._app.board.main and state.view in ("program", "map"):
            if row is not None and row.action is not None and not self._app.as_tree:
                self._plan()
            else:
                self._checkpoint_menu()

    def _checkpoint_menu(self) -> None:
        """What can be done with the checkpoint that is picked."""
        now, keymap = self._app.situation(), self._app.keymap
        ids = (
            "add",
            "goals",
            "condition",
            "rename",
            "why",
            "insert",
            "move",
            "delete",
            "disconnect",
        )
        options = tuple(
            Option(
                keymap.of(id).does,
                Perform(id),
                f"key {keymap.first(id)}",
            )
            for id in (*ids, "connect")
            if not keymap.of(id).reason(now)
        )
        self.follow(Menu(self._app.desk().here.name, options))

    def _move(self, direction: str) -> None:
        state = self._state
        if self._app.as_tree and state.view == "program" and self._pane is self._app.board.main:
            automaton = self._app.session.snapshot.automaton
            state.picked = stepping.beside(automaton, state.picked, direction)
        elif direction in ("up", "down"):
            self._pane.move(-1 if direction == "up" else 1)

    def _focus(self, by: int) -> None:
        if by > 0:
            self._app.screen.focus_next()
        else:
            self._app.screen.focus_previous()

    def _back(self) -> None:
        """One step back: from a menu, to the input line, to the program."""
        state = self._state
        if state.choosing.last is not None:
            state.choosing = state.choosing.back()
            if state.choosing.last is None:
                self._app.asked_enough()
            else:
                self._app.ask(state.choosing.last)
        elif not self._app.board.prompt.has_focus:
            self._app.board.prompt.focus()
        elif state.view != "program":
            state.view = self._home if state.view != "review" else "program"
            state.reading = state.reading if state.view == "review" else None


def editor() -> str:
    """The user's editor, or ""."""
    return os.environ.get("VISUAL") or os.environ.get("EDITOR") or ""
