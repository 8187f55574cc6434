"""What acting on an interpretation would cost if it hadn't been said."""

from __future__ import annotations

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


def weigher(session: Session) -> Weigh:
    """Weighs words in a session as it is now; changes nothing."""
    return lambda text: weight_of(session.understood(text), session.awaits_yes)
