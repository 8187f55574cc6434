"""What each action does on the screen."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial

from polaris_nl.model.errors import PolarisError
from polaris_tui import authoring, stepping
from polaris_tui.actions import BY_ID
from polaris_tui.choosing import Choosing
from polaris_tui.deeds_program import Editing
from polaris_tui.menus import Ask, Change, Menu, Note, Option, Perform, Step
from polaris_tui.pane import Pane
from polaris_tui.reasons import View
from polaris_tui.screen import Screen
from polaris_tui.state import State
from polaris_tui.styles import LOOKS
from polaris_tui.transcript import Entry


class Deeds(Editing):
    """Carries actions out.

    Args:
        app: the application, for what only it can do.
        state: what it remembers.
    """

    def __init__(self, app: Screen, state: State) -> None:
        super().__init__(app, state)
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

    def follow(self, step: Step) -> None:
        """Goes on with what a menu or an action led to."""
        state = self._state
        if isinstance(step, Menu | Ask):
            state.choosing = state.choosing.asked(step)
            self._app.ask(step)
            return
        before, state.choosing = state.choosing.open, Choosing()
        if isinstance(step, Change):
            self._app.edit(step)
        elif isinstance(step, Perform):
            self.perform(step.action, step.about)
        else:
            state.note(Entry(step.text))
        if state.choosing.last is not None:  # An action has asked something, below what led to it.
            state.choosing = Choosing((*before, *state.choosing.open))
        elif before:
            self._app.asked_enough()

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
        offered = [a for a in keymap.actions if a.id not in skipped]
        offered.sort(key=lambda a: bool(a.reason(now)))  # What can be done comes first.
        options = [
            Option(f"{a.id}: {a.does}", Perform(a.id), keymap.shown(a.id), a.reason(now))
            for a in offered
        ]
        self.follow(Menu("Actions", tuple(options)))

    def show(self, view: View) -> None:
        """Shows something else in the largest pane; the same again goes back."""
        state = self._state
        if view == state.view:
            view = state.before_view if state.before_view != view else self._home
        state.before_view, state.view = state.view, view
        self._app.board.main.reset()
        if view in ("plan", "review"):  # There the arrows step.
            self._app.screen.set_focus(self._app.board.main)
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
            self._app.screen.set_focus(self._app.board.prompt)
        elif state.view != "program":
            state.view = self._home if state.view != "review" else "program"
            state.reading = state.reading if state.view == "review" else None
