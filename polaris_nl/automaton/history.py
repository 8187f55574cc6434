"""Undo and redo."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from polaris_nl.automaton.automaton import Automaton
from polaris_nl.automaton.edits import Edit, apply_all

LIMIT = 1000
"""Steps that can be undone; automata share their unchanged checkpoints, so a step is small."""


@dataclass(frozen=True, slots=True)
class Step:
    """One change that is undone as a whole.

    Attributes:
        edits: what was done.
        label: what was done, in words.
        before: the program before it.
    """

    edits: tuple[Edit, ...]
    label: str
    before: Automaton


@dataclass(frozen=True, slots=True)
class History:
    """A program with what can be undone and redone.

    Attributes:
        present: the program now.
        past: the steps that led here, the latest last.
        future: undone steps with the program each led to, the next to redo last.
    """

    present: Automaton = Automaton()
    past: tuple[Step, ...] = ()
    future: tuple[tuple[Step, Automaton], ...] = ()

    def do(self, edits: Iterable[Edit], label: str) -> History:
        """Applies edits as one step; what was undone before can't be redone any more.

        Raises:
            EditError: an edit doesn't fit; nothing has changed then.
        """
        edits = tuple(edits)
        changed = apply_all(self.present, edits)
        return History(changed, (*self.past, Step(edits, label, self.present))[-LIMIT:])

    def undo(self) -> History | None:
        """One step back, or None where there is nothing to undo."""
        if not self.past:
            return None
        step = self.past[-1]
        return History(step.before, self.past[:-1], (*self.future, (step, self.present)))

    def redo(self) -> History | None:
        """One undone step forward again, or None where there is nothing to redo."""
        if not self.future:
            return None
        step, after = self.future[-1]
        return History(after, (*self.past, step), self.future[:-1])
