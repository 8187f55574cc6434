"""What actions do with the program."""

from __future__ import annotations

from pathlib import Path

from polaris_nl.planning.result import Problem, Warning
from polaris_nl.render.explanation import offers
from polaris_tui import offering
from polaris_tui.deeds_run import Going
from polaris_tui.menus import Change


class Editing(Going):
    """Mends, explains, undoes and saves."""

    def _mend(self) -> None:
        plan = self._app.session.snapshot.plan
        found = offers(plan) if plan else ()
        self.follow(offering.mend_menu([(self._named(t), r.text, r.edits) for t, r in found]))

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

    def _pick(self, about: str) -> None:
        if about:
            self._app.pick(about)
        else:
            self.follow(offering.pick_menu(self._app.desk()))

    def _travel(self, about: str, command: str) -> None:
        if about:
            self._app.travel(int(about) if command == "undo" else -int(about))
        else:
            self._app.say(command)

    def _history(self) -> None:
        snapshot = self._app.session.snapshot
        self.follow(offering.history_menu(snapshot.undoable, snapshot.redoable))

    def _recover(self, about: str) -> None:
        if about:
            self._app.load(Path(about), "the program of an earlier session")
            return
        self.follow(offering.leftover_menu(self._app.leftovers, self._app.read_back))

    def _shape(self) -> None:
        self._state.tree = not self._app.as_tree

    def _save_as(self, about: str) -> None:
        if about:
            self._app.save_as(Path(about).expanduser())
            return
        self.follow(offering.save_menu(self._app.session.world.name))
