"""What acting on an interpretation would cost if it hadn't been said."""

from __future__ import annotations

from functools import cache

from polaris_nl.language.interpretation import Interpretation
from polaris_nl.session import Session
from polaris_nl.speech.weight import Weigh, Weight

_MOVING = ("run", "resume", "new", "load", "quit")
_CHANGING = ("undo", "redo", "save")


def weight_of(meant: Interpretation, awaits_yes: bool = False) -> Weight | None:
    """The weight of an interpretation; None for a refusal, and for what is understood only in part.

    Words of which some ask for nothing are typed on purpose ("the cup, put it there"); heard, they are mostly
    misheard ("silver tray and put it there"), and what was asked for in them would be lost.

    Args:
        meant: what was understood.
        awaits_yes: a yes would start a run.
    """
    if meant.outcome == "refused" or meant.aside:
        return None
    if meant.outcome == "question":
        return Weight.ASKING
    if meant.command in _MOVING or (awaits_yes and meant.command == "yes"):
        return Weight.MOVING
    if meant.edits or meant.command in _CHANGING:
        return Weight.CHANGING
    return Weight.HARMLESS


class Sense:
    """What words mean in a session as it is now, each understood once; changes nothing.

    Args:
        session: where they would be said; it mustn't change meanwhile.
    """

    def __init__(self, session: Session) -> None:
        self._awaits_yes = session.awaits_yes
        self._understood = cache(session.understood)

    def weigh(self, text: str) -> Weight | None:
        """What words weigh."""
        return weight_of(self._understood(text), self._awaits_yes)

    def means(self, text: str) -> object:
        """What words would do: two that do the same are equal."""
        meant = self._understood(text)
        return meant.outcome, meant.edits, meant.command, meant.query


def weigher(session: Session) -> Weigh:
    """Weighs words in a session as it is at each time; changes nothing."""
    return lambda text: weight_of(session.understood(text), session.awaits_yes)
