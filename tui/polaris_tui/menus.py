"""What the user is asked by keys: menus, texts, and what comes of them. Values only.

A menu leads to another menu, to a text that is asked for, or to something that is done. Both faces,
the screen and the line mode, show the same menus.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from polaris_nl.automaton.edits import Edit


@dataclass(frozen=True, slots=True)
class Change:
    """Edits of the program, undone as one step; `focus` is the checkpoint to pick afterwards."""

    label: str
    edits: tuple[Edit, ...]
    focus: str = ""


@dataclass(frozen=True, slots=True)
class Perform:
    """An action of the application, with what it is about."""

    action: str
    about: str = ""


@dataclass(frozen=True, slots=True)
class Note:
    """Something to say; nothing is done."""

    text: str


@dataclass(frozen=True, slots=True)
class Option:
    """One line of a menu.

    Attributes:
        text: what it says.
        then: what comes when it is chosen, or what makes that.
        note: more about it, said after it.
        reason: why it can't be chosen, or "".
    """

    text: str
    then: Step | Callable[[], Step]
    note: str = ""
    reason: str = ""

    def step(self) -> Step:
        """What comes when it is chosen."""
        return self.then() if callable(self.then) else self.then


@dataclass(frozen=True, slots=True)
class Menu:
    """Options to choose one from, below a text that says more than the title."""

    title: str
    options: tuple[Option, ...]
    about: str = ""

    def matching(self, text: str) -> tuple[Option, ...]:
        """The options that hold all words of a text, or the one of a number; those that begin so first."""
        words = text.lower().split()
        found = tuple(
            o for o in self.options if all(w in f"{o.text} {o.note}".lower() for w in words)
        )
        found = tuple(sorted(found, key=lambda o: not o.text.lower().startswith(text.lower())))
        if len(words) == 1 and words[0].isdecimal():
            number = int(words[0])
            picked = self.options[number - 1 : number] if number else ()
            return picked or found
        return found


@dataclass(frozen=True, slots=True)
class Ask:
    """A text to be typed.

    Attributes:
        title: what is asked for.
        then: what comes of the text.
        initial: the text to start from.
    """

    title: str
    then: Callable[[str], Step]
    initial: str = ""


Step = Menu | Ask | Change | Perform | Note
