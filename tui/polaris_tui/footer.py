"""The keys in the status line."""

from __future__ import annotations

from collections.abc import Mapping

from polaris_tui.actions import Keymap
from polaris_tui.reasons import Situation

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
