"""Every action of the application, once for all: what it does, its keys, and why it can't be done now.

Key bindings, the status line, the help, the list of actions (F10) and the line mode's commands are all
made from this list.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Literal as OneOf

from polaris_tui import reasons as why
from polaris_tui.reasons import Reason, View

Group = OneOf["Program", "Plan", "Run", "Review", "Screen"]


@dataclass(frozen=True, slots=True)
class Action:
    """Something that the user can do.

    Attributes:
        id: its name in settings and, after a colon, in the input line.
        does: what it does, for the help and the list of actions.
        short: one or two words for the status line; "" where it isn't shown there.
        keys: keys that work everywhere, as Textual names them.
        letters: keys that work while the program (or plan, or log) has the focus.
        views: where the letters work; everywhere where it is empty.
        group: where the help lists it.
        first: it works before all that was typed earlier, and nothing that has the focus may take its keys.
        reason: why it can't be done.
    """

    id: str
    does: str
    short: str = ""
    keys: tuple[str, ...] = ()
    letters: tuple[str, ...] = ()
    views: tuple[View, ...] = ()
    group: Group = "Screen"
    first: bool = False
    reason: Reason = why.always


def _action(
    group: Group,
    id: str,
    does: str,
    keys: str = "",
    letters: str = "",
    reason: Reason = why.always,
    short: str = "",
    views: tuple[View, ...] = (),
    first: bool = False,
) -> Action:
    return Action(
        id, does, short, tuple(keys.split()), tuple(letters.split()), views, group, first, reason
    )


_EDITED: tuple[View, ...] = ("program", "map", "answers", "run")
_LISTS: tuple[View, ...] = ("program", "map", "answers", "help", "review", "run")

ACTIONS: tuple[Action, ...] = (
    _action("Program", "add", "add a checkpoint after this one", "", "a", why.no_review, "add", _EDITED),
    _action("Program", "insert", "insert a checkpoint before this one", "", "b", why.picked, "", _EDITED),
    _action("Program", "goals", "change the goals", "", "e", why.picked, "goals", _EDITED),
    _action("Program", "condition", "change when this is reached", "", "c", why.picked, "condition", _EDITED),
    _action("Program", "rename", "rename it", "", "r", why.picked, "rename", _EDITED),
    _action("Program", "delete", "delete it", "", "d delete", why.picked, "delete", _EDITED),
    _action("Program", "move", "move it, with all that comes after it", "", "m", why.picked, "move", _EDITED),
    _action("Program", "connect", "lead from here to one that is unconnected", "", "x", why.loose, "", _EDITED),
    _action("Program", "disconnect", "unconnect it from the one before", "", "X", why.picked, "", _EDITED),
    _action("Program", "mend", "ways out of the problems", "ctrl+r", "f", why.repairs, "mend"),
    _action("Program", "pick", "go to a checkpoint by its name", "", "slash", why.filled, "", _EDITED),
    _action("Program", "why", "why it is there, what it takes", "", "w", why.always, "why", (*_EDITED, "plan")),
    _action("Program", "undo", "undo", "f7 ctrl+z", "u", why.undoable, "", (*_EDITED, "plan")),
    _action("Program", "redo", "redo", "f8 ctrl+y", "U", why.redoable, "", (*_EDITED, "plan")),
    _action("Program", "recover", "a program that an earlier session left unsaved", "", "", why.leftover),
    _action("Program", "history", "all that was changed, and go back to any of it", "", "h", why.always),
    _action("Program", "shape", "outline, or drawn as a tree", "", "g", why.always, "tree", ("program",)),
    _action("Program", "editor", "the program file in your editor", "", "E", why.editor),
    _action("Program", "save-as", "keep the program in a file of another name", "", "s", why.no_review),
    _action("Plan", "plan", "the plan step by step, and back", "f4", "p", why.planned, "steps"),
    _action("Plan", "next", "the step after it", "", "right", why.stepping, "", ("plan",)),
    _action("Plan", "previous", "the step before it", "", "left", why.stepping, "", ("plan",)),
    _action("Plan", "next-way", "the next way, where ways part", "", "down", why.stepping, "", ("plan",)),
    _action("Plan", "other-way", "the way before, where ways part", "", "up", why.stepping, "", ("plan",)),
    _action("Plan", "first-step", "the first step", "", "home", why.stepping, "", ("plan",)),
    _action("Plan", "last-step", "the last step", "", "end", why.stepping, "", ("plan",)),
    _action("Run", "run", 'run it; it starts after your "yes"', "f5", "", why.runnable),
    _action("Run", "watch", "the run: what is done, expected, perceived, waited for", "", "v", why.always),
    _action("Run", "pause", "pause the run, and resume it", "f6", "", why.running),
    _action("Run", "stop", "stop the run, at any time", "f9 ctrl+c", "", why.always, "", (), True),
    _action("Run", "tell", "tell the robot what has happened", "ctrl+t", "t", why.waiting, "tell"),
    _action("Run", "attach", "see a run that goes on without its terminal", "", "", why.elsewhere),
    _action("Run", "talk", "push to talk: what is said is taken as if typed", "ctrl+@ ctrl+g", "", why.listens),
    _action("Review", "log", "open the log of a run", "", "l", why.always),
    _action("Review", "next-problem", "the next problem", "", "n", why.reviewing, "next problem", ("review",)),
    _action("Review", "last-problem", "the problem before", "", "N", why.reviewing, "", ("review",)),
    _action("Review", "filter", "show only some events", "", "slash", why.reviewing, "filter", ("review",)),
    _action("Review", "compare", "expected beside perceived", "", "d", why.reviewing, "compare", ("review",)),
    _action("Review", "chain", "what led to this event", "", "c", why.reviewing, "chain", ("review",)),
    _action("Screen", "help", "this help, and back", "f1", "question_mark"),
    _action("Screen", "program", "the program, with its actions or without", "f2"),
    _action("Screen", "map", "the map, and back", "f3"),
    _action("Screen", "answers", "all that was said, and back", "ctrl+l"),
    _action("Screen", "actions", "all actions, to find one by its name", "f10 ctrl+p", "colon"),
    _action("Screen", "copy", "copy what is picked, or an answer, to your clipboard", "", "y"),
    _action("Screen", "theme", "other colours", ""),
    _action("Screen", "open", "in the program: open the step, the repair, the question", "", "enter"),
    _action("Screen", "up", "the row above", "", "up", why.always, "", _LISTS),
    _action("Screen", "down", "the row below", "", "down", why.always, "", _LISTS),
    _action("Screen", "left", "in a tree: the checkpoint before", "", "left", why.always, "", _LISTS),
    _action("Screen", "right", "in a tree: the checkpoint after", "", "right", why.always, "", _LISTS),
    _action("Screen", "page-up", "scroll up", "pageup"),
    _action("Screen", "page-down", "scroll down", "pagedown"),
    _action("Screen", "top", "the first row", "", "home", why.always, "", _LISTS),
    _action("Screen", "bottom", "the last row", "", "end", why.always, "", _LISTS),
    _action("Screen", "next-pane", "from the input line to the program, the problems, the answers, and back"
            "; at the beginning of a name: completes it", "tab"),
    _action("Screen", "previous-pane", "the same, backwards", "shift+tab"),
    _action("Screen", "prompt", "back to the input line, then to the program", "escape", "i"),
    _action("Screen", "quit", "quit; stops a run first", "ctrl+q", "", why.always, "", (), True),
)  # fmt: skip
"""In the order of help and list."""

BY_ID: Mapping[str, Action] = {action.id: action for action in ACTIONS}

_SHOWN = {
    "question_mark": "?",
    "slash": "/",
    "colon": ":",
    "at": "@",
    "escape": "Esc",
    "enter": "Enter",
    "pageup": "PgUp",
    "pagedown": "PgDn",
    "ctrl+@": "ctrl+space",
}


def key_shown(key: str) -> str:
    """A key as it is written for people: `F4`, `ctrl+z`, `?`."""
    if key in _SHOWN:
        return _SHOWN[key]
    if len(key) == 1 or key.startswith("ctrl+"):
        return key
    return key.upper() if key[:1] == "f" and key[1:].isdigit() else key.capitalize()


class Keymap:
    """Which keys mean which actions.

    Args:
        changes: other keys for some actions, by their ids, from the user's settings.
    """

    def __init__(self, changes: Mapping[str, tuple[str, ...]] = {}) -> None:
        self.actions = tuple(_changed(action, changes.get(action.id)) for action in ACTIONS)
        self._by_id = {action.id: action for action in self.actions}

    def of(self, id: str) -> Action:
        """An action with its keys."""
        return self._by_id[id]

    def letter(self, key: str, view: View) -> Action | None:
        """The action of a key where the program, the plan or the log has the focus."""
        for action in self.actions:
            if key in action.letters and (not action.views or view in action.views):
                return action
        return None

    def anywhere(self, key: str) -> Action | None:
        """The action of a key that works everywhere."""
        return next((action for action in self.actions if key in action.keys), None)

    def shown(self, id: str) -> str:
        """The keys of an action for people, the first ones first; "" where it has none."""
        action = self._by_id[id]
        return ", ".join(map(key_shown, (*action.keys, *action.letters)))

    def first(self, id: str) -> str:
        """One key of an action for people."""
        return self.shown(id).split(", ")[0]

    def help(self) -> Iterator[tuple[Group, str, str]]:
        """Group, keys and meaning of each action that has a key."""
        for action in self.actions:
            if self.shown(action.id):
                yield action.group, self.shown(action.id), action.does


def _changed(action: Action, keys: tuple[str, ...] | None) -> Action:
    """An action with the user's keys: letters stay letters, others work everywhere."""
    if keys is None:
        return action
    letters = tuple(k for k in keys if len(k) == 1 or (k in _SHOWN and not k.startswith("ctrl+")))
    return replace(action, keys=tuple(k for k in keys if k not in letters), letters=letters)


def clashes(keymap: Keymap) -> Iterator[tuple[str, Action, Action]]:
    """Keys that mean two actions at the same place."""
    for number, one in enumerate(keymap.actions):
        for other in keymap.actions[number + 1 :]:
            for key in {*one.keys, *one.letters} & {*other.keys, *other.letters}:
                apart = one.views and other.views and not {*one.views} & {*other.views}
                if not apart:
                    yield key, one, other
