"""Menus that lead somewhere: to checkpoints, ways out, logs, moments of the history. Pure functions."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from polaris_nl.automaton.automaton import Automaton
from polaris_nl.automaton.edits import Edit, ReplaceProgram
from polaris_nl.automaton.program import read_program
from polaris_nl.model.formula import Literal
from polaris_nl.model.wording import Wording
from polaris_tui.desk import Desk
from polaris_tui.keeping import Leftover
from polaris_tui.menus import Ask, Change, Menu, Note, Option, Perform, Step

MOST_LOGS = 30
"""Logs that are offered to be opened; others can be named."""


def pick_menu(desk: Desk) -> Step:
    """All checkpoints, to go to one."""
    return Menu(
        "Go to which checkpoint?",
        tuple(
            Option(c.name, Perform("pick", c.id), desk.wording.goals(c.goals))
            for c in desk.automaton.checkpoints.values()
        ),
    )


def mend_menu(offers: Sequence[tuple[str, str, tuple[Edit, ...]]]) -> Step:
    """The ways out of all problems, and the changes that warnings offer.

    Args:
        offers: what it mends, what it does, and the edits.
    """
    if not offers:
        return Note("The plan has no problem that has a way out.")
    return Menu(
        "Ways out",
        tuple(Option(t, Change(t, e), about) for about, t, e in offers),
    )


def tell_menu(waiting: Sequence[Sequence[Literal]], wording: Wording) -> Step:
    """The conditionals that a run waits for."""
    return Menu(
        "What has happened?",
        tuple(
            Option(wording.events(when), Perform("tell", str(n)))
            for n, when in enumerate(waiting, 1)
        ),
    )


def log_menu(folder: Path | None) -> Step:
    """The newest logs, and any other file."""
    from polaris_nl.logs.paths import log_folder

    found = (folder or log_folder()).glob("*.mcap")
    paths = sorted(found, key=lambda p: p.name, reverse=True)[:MOST_LOGS]
    options = [Option(p.name, Perform("log", str(p))) for p in paths]
    other = Ask("Which file?", lambda x: Perform("log", x))
    return Menu("Which log?", (*options, Option("another file", other)))


def history_menu(undoable: Sequence[str], redoable: Sequence[str]) -> Step:
    """All steps of the program's history, the newest first, "you are here" among them."""
    if not undoable and not redoable:
        return Note("Nothing was changed yet.")
    options = [
        Option(f"after: {label}", Perform("redo", str(n)), f"redo {n}")
        for n, label in reversed(list(enumerate(reversed(redoable), 1)))
    ]
    here = undoable[-1] if undoable else "the beginning"
    options.append(Option(f"now: {here}", Note("You are there."), "you are here"))
    options += [
        Option(f"after: {label}", Perform("undo", str(n)), f"undo {n}")
        for n, label in enumerate(reversed(undoable[:-1]), 1)
    ]
    if undoable:
        count = len(undoable)
        options.append(Option("the beginning", Perform("undo", str(count)), f"undo {count}"))
    return Menu("Where to go back, or forward, to", tuple(options))


def leftover_menu(leftovers: Sequence[Leftover], read_back: Callable[[Automaton], str]) -> Step:
    """The programs that earlier sessions left unsaved, in words."""
    return Menu(
        "Which one?",
        tuple(
            Option(
                read_back(left.program.automaton),
                Perform("recover", str(left.path)),
                left.path.name,
            )
            for left in leftovers
        ),
    )


def recovered(path: Path) -> Change:
    """Takes the program of an earlier session, as a step that can be undone.

    Raises:
        PolarisError: it can't be read.
    """
    program = read_program(path).automaton
    return Change("the program of an earlier session", (ReplaceProgram(program),))


def save_menu(world: str) -> Step:
    """Asks for the file that the program is to be kept in."""
    kept = f"{world}.polaris.json"
    return Ask("Keep the program in which file?", lambda name: Perform("save-as", name), kept)
