"""What widgets tell the application, at once and in order: keys, lines, where the cursor is."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from polaris_tui.board import Board
from polaris_tui.completion import names_of
from polaris_tui.deeds import Deeds
from polaris_tui.face import Face
from polaris_tui.pane import Pane
from polaris_tui.phrases import Order, action_asked, order_in, view_asked


class Keyed(Face):
    """An application that does what keys and lines mean."""

    def make_board(self) -> Board:
        """The panes, which tell this application of keys."""
        self.deeds = Deeds(self, self.state)
        return Board(self, self.state.glyphs, self.state.look)

    def order(self, order: Order) -> None:
        """Commands the run."""
        self.deeds.order(order)

    def action_do(self, id: str) -> None:
        """Does an action that a key means everywhere."""
        self.deeds.perform(id)

    def pane_key(self, pane: Pane, key: str, character: str | None) -> bool:
        """Does what a letter means in a pane."""
        action = self.keymap.letter(key, self.state.view)
        if action is not None:
            self.deeds.perform(action.id)
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
            self.deeds.perform(action.id)
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
            self.deeds.chosen(line)
            self.draw()
            return
        view, order, action = view_asked(line), order_in(line), action_asked(line)
        if order and (state.current or order == "stop"):
            if state.current:
                state.note(said=line)
            self.deeds.order(order)
        elif action is not None:
            known = any(a.id == action for a in self.keymap.actions)
            self.deeds.perform(action if known else "actions")
        elif view is not None:
            if view != state.view:  # A map after the plan is of the step that was picked there.
                state.before_view, state.view = state.view, view
        elif line.isdecimal() and state.current and 0 < int(line) <= len(state.progress.waiting):
            self.deeds.perform("tell", line)
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
