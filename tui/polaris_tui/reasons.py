"""What decides whether an action can be done, and why not, in sentences: a key that does nothing says why."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal as OneOf

from polaris_nl.automaton.automaton import START

View = OneOf["program", "map", "plan", "run", "review", "answers", "help"]


@dataclass(frozen=True, slots=True)
class Situation:
    """What decides whether an action can be done.

    Attributes:
        view: what the largest pane shows.
        checkpoint: the id of the checkpoint that is picked; the start where none is.
        empty: the program has no checkpoint but the start.
        running: a run goes on.
        waiting: how many conditionals the robot waits for.
        undoable, redoable: there is something to undo, to redo.
        repairs: ways out and changes that the plan offers.
        planned: there is a plan with at least one action or checkpoint.
        loose: checkpoints that nothing leads to.
        elsewhere: a run of this world goes on in another terminal, or without one.
        leftover: an earlier session has left a program unsaved.
        listens: something is there that push-to-talk can start.
        editor: the user's editor is known.
    """

    view: View = "program"
    checkpoint: str = START
    empty: bool = True
    running: bool = False
    waiting: int = 0
    undoable: bool = False
    redoable: bool = False
    repairs: int = 0
    planned: bool = False
    loose: bool = False
    elsewhere: bool = False
    leftover: bool = False
    listens: bool = False
    editor: bool = False


Reason = Callable[[Situation], str]
"""Why an action can't be done now, in a sentence; "" where it can."""


def always(now: Situation) -> str:
    """Can always be done."""
    return ""


def no_review(now: Situation) -> str:
    """Needs the program, not a log."""
    return "A log can't be changed; F2 goes back to the program." if now.view == "review" else ""


def filled(now: Situation) -> str:
    """Needs a checkpoint."""
    return "The program has no checkpoint but the start." if now.empty else ""


def picked(now: Situation) -> str:
    """Needs a checkpoint that is picked."""
    if now.view == "review":
        return no_review(now)
    if now.empty:
        return 'There is no checkpoint yet; "a" adds one, or say what the robot should achieve.'
    if now.checkpoint == START:
        return "The start always stays as it is; pick another checkpoint first."
    return ""


def loose(now: Situation) -> str:
    """Needs a checkpoint that nothing leads to."""
    return picked(now) or ("" if now.loose else "No checkpoint is unconnected; m moves this one.")


def undoable(now: Situation) -> str:
    """Needs something to undo."""
    return "" if now.undoable else "There is nothing to undo."


def redoable(now: Situation) -> str:
    """Needs something to do again."""
    return "" if now.redoable else "There is nothing to redo."


def repairs(now: Situation) -> str:
    """Needs a way out of a problem."""
    return "" if now.repairs else "The plan has no problem that has a way out."


def planned(now: Situation) -> str:
    """Needs a plan."""
    return "" if now.planned else "There is no plan to step through yet."


def runnable(now: Situation) -> str:
    """Needs that no run goes on."""
    if now.running:
        return "A run is going on. Stop it with F9 before you start another."
    return "" if now.view != "review" else "This is a log; F2 goes back to the program."


NO_RUN = 'There is no run. F5, or "run it", starts one.'


def running(now: Situation) -> str:
    """Needs a run that goes on."""
    return "" if now.running else NO_RUN


def waiting(now: Situation) -> str:
    """Needs a run that waits for something."""
    return running(now) or ("" if now.waiting else "The robot waits for nothing just now.")


def reviewing(now: Situation) -> str:
    """Needs a log."""
    return "" if now.view == "review" else 'This is for logs; "l" opens one.'


def stepping(now: Situation) -> str:
    """Needs the plan step by step."""
    return "" if now.view == "plan" else "This is for the plan step by step; F4 opens it."


def elsewhere(now: Situation) -> str:
    """Needs a run of another terminal."""
    return runnable(now) or ("" if now.elsewhere else "No run goes on in another terminal.")


def listens(now: Situation) -> str:
    """Needs something that listens."""
    if now.listens:
        return ""
    return "Nothing listens here; without a screen, polaris-nl listen takes speech."


def leftover(now: Situation) -> str:
    """Needs a program that was left unsaved."""
    return "" if now.leftover else "No earlier session has left anything unsaved."


def editor(now: Situation) -> str:
    """Needs an editor."""
    if now.editor:
        return no_review(now)
    return "There is no editor: set the environment variable EDITOR, such as EDITOR=nano."
