"""Two programs that part ways: by conditions only, and with an otherwise."""

from __future__ import annotations

from polaris_nl.planning.planner import Planner
from tests.execution.story import FULL_TRAY, Case, case, literals

ACKNOWLEDGED, DISMISSED = literals("(acknowledged lunchtime)", "(dismissed lunchtime)")
ALERT = ("start", "alerted", (), ("(alerted-to resident lunchtime)",))
SERVE = ("alerted", "served", (str(ACKNOWLEDGED),), FULL_TRAY)
HOME = ("served", "home", (), ("(robot-at home)", "(at tray table)"))
CANCEL = ("alerted", "cancelled", (str(DISMISSED),), ("(robot-at home)",))
GIVE_UP = ("alerted", "left", (), ("(robot-at home)",))
PROGRAMS = ("labelled", "otherwise")


def programs_of(care: Planner) -> dict[str, Case]:
    """Both, by name."""
    return {
        "labelled": case(care, ALERT, SERVE, HOME, CANCEL),
        "otherwise": case(care, ALERT, SERVE, HOME, GIVE_UP),
    }
