"""The keys, once for all: what the application binds, and what its help says about them."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Key:
    """A key, or several that do the same.

    Attributes:
        shown: as the help writes them.
        does: what they do, for the help.
        keys: as Textual names them; "" where a widget binds them itself.
        action: the application's action.
        first: they work before all that was typed earlier, and nothing that has the focus may take them.
    """

    shown: str
    does: str
    keys: str = ""
    action: str = ""
    first: bool = False


KEYS = (
    Key("F1", "this help, and back", "f1", "view('help')"),
    Key("F2", "the program without its actions, and back", "f2", "view('outline')"),
    Key("F3", "the map, and back", "f3", "view('map')"),
    Key("F4", "all that was said, and back", "f4", "view('answers')"),
    Key("F5", 'run it in the simulated world; it starts after your "yes"', "f5", "run"),
    Key("F6", "pause the run, and resume it", "f6", "pause"),
    Key("F7, ctrl+z", "undo", "f7,ctrl+z", "say('undo')"),
    Key("F8, ctrl+y", "redo", "f8,ctrl+y", "say('redo')"),
    Key("F9, ctrl+c", "stop the run", "f9,ctrl+c", "stop", True),
    Key("Up, Down", "in the input line: what was typed before"),
    Key("PgUp, PgDn", "scroll", "pageup", "scroll(-1)"),
    Key("", "", "pagedown", "scroll(1)"),
    Key("Tab", "to the program, the problems, the answers, and back"),
    Key("Enter", "in the program: why an action is there, what a checkpoint takes"),
    Key("Esc", "back to the input line and the program", "escape", "home"),
    Key("ctrl+q", "quit; stops a run first", "ctrl+q,f10", "quit", True),
)
