"""Every action of the application, once for all: what it does, its keys, and why it can't be done now.

Key bindings, the status line, the help, the list of actions (F10) and the line mode's commands are all
made from this list. Reasons are sentences: a key that does nothing says why.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Literal as OneOf

from polaris_nl.automaton.automaton import START

View = OneOf["program", "map", "plan", "run", "review", "answers", "help"]
Group = OneOf["Program", "Plan", "Run", "Review", "Screen"]


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


def _always(now: Situation) -> str:
    return ""


def _no_review(now: Situation) -> str:
    return "A log can't be changed; F2 goes back to the program." if now.view == "review" else ""


def _filled(now: Situation) -> str:
    return "The program has no checkpoint but the start." if now.empty else ""


def _picked(now: Situation) -> str:
    if now.view == "review":
        return _no_review(now)
    if now.empty:
        return 'There is no checkpoint yet; "a" adds one, or say what the robot should achieve.'
    if now.checkpoint == START:
        return "The start always stays as it is; pick another checkpoint first."
    return ""


def _loose(now: Situation) -> str:
    return _picked(now) or ("" if now.loose else "No checkpoint is unconnected; m moves this one.")


def _undoable(now: Situation) -> str:
    return "" if now.undoable else "There is nothing to undo."


def _redoable(now: Situation) -> str:
    return "" if now.redoable else "There is nothing to redo."


def _repairs(now: Situation) -> str:
    return "" if now.repairs else "The plan has no problem that has a way out."


def _planned(now: Situation) -> str:
    return "" if now.planned else "There is no plan to step through yet."


def _runnable(now: Situation) -> str:
    if now.running:
        return "A run is going on. Stop it with F9 before you start another."
    return "" if now.view != "review" else "This is a log; F2 goes back to the program."


NO_RUN = 'There is no run. F5, or "run it", starts one.'


def _running(now: Situation) -> str:
    return "" if now.running else NO_RUN


def _waiting(now: Situation) -> str:
    return _running(now) or ("" if now.waiting else "The robot waits for nothing just now.")


def _reviewing(now: Situation) -> str:
    return "" if now.view == "review" else 'This is for logs; "l" opens one.'


def _stepping(now: Situation) -> str:
    return "" if now.view == "plan" else "This is for the plan step by step; F4 opens it."


def _elsewhere(now: Situation) -> str:
    return _runnable(now) or ("" if now.elsewhere else "No run goes on in another terminal.")


def _listens(now: Situation) -> str:
    if now.listens:
        return ""
    return "Nothing listens here; without a screen, polaris-nl listen takes speech."


def _leftover(now: Situation) -> str:
    return "" if now.leftover else "No earlier session has left anything unsaved."


def _editor(now: Situation) -> str:
    if now.editor:
        return _no_review(now)
    return "There is no editor: set the environment variable EDITOR, such as EDITOR=nano."


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
    reason: Reason = _always


def _action(
    group: Group,
    id: str,
    does: str,
    keys: str = "",
    letters: str = "",
    reason: Reason = _always,
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
    _action("Program", "add", "add a checkpoint after this one", "", "a", _no_review, "add", _EDITED),
    _action("Program", "insert", "insert a checkpoint before this one", "", "b", _picked, "", _EDITED),
    _action("Program", "goals", "change the goals", "", "e", _picked, "goals", _EDITED),
    _action("Program", "condition", "change when this is reached", "", "c", _picked, "condition", _EDITED),
    _action("Program", "rename", "rename it", "", "r", _picked, "rename", _EDITED),
    _action("Program", "delete", "delete it", "", "d delete", _picked, "delete", _EDITED),
    _action("Program", "move", "move it, with all that comes after it", "", "m", _picked, "move", _EDITED),
    _action("Program", "connect", "lead from here to an unconnected checkpoint", "", "x", _loose, "", _EDITED),
    _action("Program", "disconnect", "unconnect it from the one before", "", "X", _picked, "", _EDITED),
    _action("Program", "mend", "ways out of the problems", "ctrl+r", "f", _repairs, "mend"),
    _action("Program", "pick", "go to a checkpoint by its name", "", "slash", _filled, "", _EDITED),
    _action("Program", "why", "why it is there, what it takes", "", "w", _always, "why", (*_EDITED, "plan")),
    _action("Program", "undo", "undo", "f7 ctrl+z", "u", _undoable),
    _action("Program", "redo", "redo", "f8 ctrl+y", "U", _redoable),
    _action("Program", "recover", "a program that an earlier session left unsaved", "", "", _leftover),
    _action("Program", "history", "all that was changed, and go back to any of it", "", "h", _always),
    _action("Program", "shape", "outline, or drawn as a tree", "", "g", _always, "tree", ("program",)),
    _action("Program", "editor", "the program file in your editor", "", "E", _editor),
    _action("Program", "save-as", "keep the program in a file of another name", "", "s", _no_review),
    _action("Plan", "plan", "the plan step by step, and back", "f4", "p", _planned, "steps"),
    _action("Plan", "next", "the step after it", "", "right", _stepping, "", ("plan",)),
    _action("Plan", "previous", "the step before it", "", "left", _stepping, "", ("plan",)),
    _action("Plan", "next-way", "the next way, where ways part", "", "down", _stepping, "", ("plan",)),
    _action("Plan", "other-way", "the way before, where ways part", "", "up", _stepping, "", ("plan",)),
    _action("Plan", "first-step", "the first step", "", "home", _stepping, "", ("plan",)),
    _action("Plan", "last-step", "the last step", "", "end", _stepping, "", ("plan",)),
    _action("Run", "run", 'run it; it starts after your "yes"', "f5", "", _runnable),
    _action("Run", "watch", "the run: what is done, expected, perceived, waited for", "", "v", _always),
    _action("Run", "pause", "pause the run, and resume it", "f6", "", _running),
    _action("Run", "stop", "stop the run, at any time", "f9 ctrl+c", "", _always, "", (), True),
    _action("Run", "tell", "tell the robot what has happened", "ctrl+t", "t", _waiting, "tell"),
    _action("Run", "attach", "see a run that goes on without its terminal", "", "", _elsewhere),
    _action("Run", "talk", "push to talk: what is said is taken as if typed", "ctrl+@ ctrl+g", "", _listens),
    _action("Review", "log", "open the log of a run", "", "l", _always),
    _action("Review", "next-problem", "the next problem", "", "n", _reviewing, "next problem", ("review",)),
    _action("Review", "last-problem", "the problem before", "", "N", _reviewing, "", ("review",)),
    _action("Review", "filter", "show only some events", "", "slash", _reviewing, "filter", ("review",)),
    _action("Review", "compare", "expected beside perceived", "", "d", _reviewing, "compare", ("review",)),
    _action("Review", "chain", "what led to this event", "", "c", _reviewing, "chain", ("review",)),
    _action("Screen", "help", "this help, and back", "f1", "question_mark"),
    _action("Screen", "program", "the program, with its actions or without", "f2"),
    _action("Screen", "map", "the map, and back", "f3"),
    _action("Screen", "answers", "all that was said, and back", "ctrl+l"),
    _action("Screen", "actions", "all actions, to find one by its name", "f10 ctrl+p", "colon"),
    _action("Screen", "copy", "copy what is picked, or an answer, to your clipboard", "", "y"),
    _action("Screen", "theme", "other colours", ""),
    _action("Screen", "open", "in the program: open the step, the repair, the question", "", "enter"),
    _action("Screen", "up", "the row above", "", "up", _always, "", _LISTS),
    _action("Screen", "down", "the row below", "", "down", _always, "", _LISTS),
    _action("Screen", "left", "in a tree: the checkpoint before", "", "left", _always, "", _LISTS),
    _action("Screen", "right", "in a tree: the checkpoint after", "", "right", _always, "", _LISTS),
    _action("Screen", "page-up", "scroll up", "pageup"),
    _action("Screen", "page-down", "scroll down", "pagedown"),
    _action("Screen", "top", "the first row", "", "home", _always, "", _LISTS),
    _action("Screen", "bottom", "the last row", "", "end", _always, "", _LISTS),
    _action("Screen", "next-pane", "from the input line to the program, the problems, the answers, and back"
            "; at the beginning of a name: completes it", "tab"),
    _action("Screen", "previous-pane", "the same, backwards", "shift+tab"),
    _action("Screen", "prompt", "back to the input line, then to the program", "escape", "i"),
    _action("Screen", "quit", "quit; stops a run first", "ctrl+q", "", _always, "", (), True),
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


FOOTERS: Mapping[str, tuple[str, ...]] = {
    "prompt": ("help", "program", "map", "plan", "run", "actions", "quit"),
    "program": ("add", "goals", "condition", "rename", "delete", "mend", "why", "shape", "prompt"),
    "plan": ("next", "next-way", "map", "why", "prompt"),
    "run": ("stop", "pause", "tell", "map", "help"),
    "review": ("next-problem", "filter", "compare", "chain", "map", "prompt"),
}
"""The actions that the status line shows, by what has the focus; those that don't fit are left out."""

_WORDS = {
    "help": "help",
    "program": "program",
    "map": "map",
    "plan": "steps",
    "run": "run",
    "actions": "actions",
    "quit": "quit",
    "next": "step",
    "next-way": "way",
    "stop": "stop",
    "pause": "pause",
    "prompt": "back",
}


_IN_A_MENU = "Up, Down, Enter choose  letters filter  {back} back"


def footer(place: str, keymap: Keymap, now: Situation, room: int) -> str:
    """Keys with their meanings, as many as fit; those that can't be used now are left out."""
    if place == "ask":
        text = f"Enter takes it  {keymap.first('prompt')} back"
        return text if len(text) <= room else ""
    if place == "menu":
        text = _IN_A_MENU.format(back=keymap.first("prompt"))
        return text if len(text) <= room else f"{keymap.first('prompt')} back"
    shown = ""
    for id in FOOTERS[place]:
        action = keymap.of(id)
        key = keymap.first(id)
        if not key or action.reason(now):
            continue
        more = f"{shown}  {key} {action.short or _WORDS.get(id, id)}"
        if len(more) - 2 > room:
            break
        shown = more
    return shown.strip()
