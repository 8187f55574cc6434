"""The few words that the screen itself understands; all other sentences go to the session."""

from __future__ import annotations

import re
from typing import Literal as OneOf

from polaris_tui.reasons import View

Order = OneOf["stop", "pause", "resume"]

_SHOW = re.compile(
    r"show(?: me)?(?: the)? (plan|steps|outline|program|map|run|answers|log|help|keys)[.!]?",
    re.IGNORECASE,
)
_VIEWS: dict[str, View] = {
    "plan": "plan",
    "steps": "plan",
    "outline": "program",
    "program": "program",
    "run": "run",
    "map": "map",
    "answers": "answers",
    "log": "answers",
    "help": "help",
    "keys": "help",
}
_ORDER = re.compile(
    r"(?:please )?(?:(?P<stop>stop|halt|freeze|abort)|(?P<pause>pause)|(?P<resume>resume|continue|go on))"
    r"(?: (?:now|it|the run|the robot|please))*[.!]*",
    re.IGNORECASE,
)


def action_asked(line: str) -> str | None:
    """The action that a line names after a colon, such as `:rename`; "actions" for a colon alone."""
    if not line.startswith(":"):
        return None
    return line[1:].strip().lower().replace(" ", "-") or "actions"


def view_asked(line: str) -> View | None:
    """The view that a line asks for, or None."""
    match = _SHOW.fullmatch(line.strip())
    return _VIEWS[match[1].lower()] if match else None


def order_in(line: str) -> Order | None:
    """What a line tells a run, recognised at once and before anything else is looked at; or None."""
    match = _ORDER.fullmatch(line.strip())
    if match is None:
        return None
    return "stop" if match["stop"] else "pause" if match["pause"] else "resume"
