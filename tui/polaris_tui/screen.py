"""What the actions need of the application: said here, so that they needn't know it."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Protocol

from textual.screen import Screen as TextualScreen
from textual.widget import Widget

from polaris_nl.automaton.automaton import Automaton
from polaris_nl.render.timeline import Stop
from polaris_nl.session import Session
from polaris_tui.actions import Keymap
from polaris_tui.board import Board
from polaris_tui.desk import Desk
from polaris_tui.keeping import Leftover
from polaris_tui.menus import Ask, Change, Menu
from polaris_tui.reasons import Situation
from polaris_tui.styles import Look


class Screen(Protocol):
    """An application that shows a session and does what its user wants.

    Attributes:
        session: program, language and planner.
        board: the panes.
        keymap: the user's keys.
        logs: the folder for the logs of runs; None for the usual one.
        leftovers: what earlier sessions left unsaved.
        settings_file: where settings are, for what is said about them.
    """

    session: Session
    board: Board
    keymap: Keymap
    logs: Path | None
    leftovers: tuple[Leftover, ...]
    settings_file: str

    # What there is

    @property
    def focused(self) -> Widget | None:
        """The widget that has the focus."""
        ...

    @property
    def screen(self) -> TextualScreen[object]:
        """Textual's screen, whose focus is moved."""
        ...

    @property
    def as_tree(self) -> bool:
        """Whether the program is drawn as a tree."""
        ...

    @property
    def busy(self) -> bool:
        """Whether something that was asked for is still to be done."""
        ...

    def situation(self) -> Situation:
        """What can be done now."""
        ...

    def desk(self) -> Desk:
        """What is edited."""
        ...

    def stop(self) -> Stop | None:
        """The step of the plan that is picked."""
        ...

    def stops(self, leaf: str) -> Sequence[Stop]:
        """The stops of a branch of the present plan."""
        ...

    def read_back(self, automaton: Automaton) -> str:
        """A program in a sentence."""
        ...

    # What is shown

    def draw(self) -> None:
        """Shows how things are now."""
        ...

    def dress(self, look: Look) -> None:
        """Takes other colours."""
        ...

    def ask(self, question: Menu | Ask) -> None:
        """Lets the input line serve a menu or take a text."""
        ...

    def asked_enough(self) -> None:
        """Gives the input line back to sentences."""
        ...

    def tell_briefly(self, text: str) -> None:
        """Says something that isn't worth keeping twice."""
        ...

    def pick(self, checkpoint: str) -> None:
        """Goes to a checkpoint of the program."""
        ...

    def scroll_pane(self, pages: int) -> None:
        """Scrolls the pane that has the focus, else the largest one."""
        ...

    def follow_reading(self) -> None:
        """Goes to the row of the event that is read."""
        ...

    def copy_to_clipboard(self, text: str) -> None:
        """Copies to the clipboard of the user's own terminal."""
        ...

    # What is done

    def say(self, sentence: str) -> None:
        """Says a sentence, typed or meant by a key."""
        ...

    def take_line(self, line: str) -> None:
        """Takes a line of the input line."""
        ...

    def edit(self, change: Change) -> None:
        """Changes the program."""
        ...

    def edit_file(self) -> None:
        """Opens the program in the user's editor, and takes what it leaves."""
        ...

    def travel(self, steps: int) -> None:
        """Goes back or forward in the program's history."""
        ...

    def explain(self, checkpoint: str, action: int | None) -> None:
        """Says why something is in the program."""
        ...

    def want_purpose(self) -> None:
        """Has it worked out why the step that is picked is there."""
        ...

    def load(self, path: Path, label: str) -> None:
        """Takes another program from a file."""
        ...

    def save_as(self, path: Path) -> None:
        """Gives the program's file another name."""
        ...

    def open_log(self, path: Path, go_there: bool = True) -> None:
        """Opens a log; `go_there`: the focus goes there, even if sentences are being written."""
        ...

    def talk(self) -> None:
        """Listens."""
        ...

    def attach(self) -> None:
        """Shows the run that goes on elsewhere."""
        ...

    def leave(self) -> None:
        """Quits."""
        ...
