"""Which steps an edit is about where they aren't named, and which it can't be about."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from polaris_nl.automaton.automaton import START, Automaton
from polaris_nl.language.dialogue import Dialogue
from polaris_nl.model.errors import EditError

NOT_START: Mapping[str, str] = {
    "remove": "The start can't be removed; it is where every program begins. Name another step.",
    "rename": "The start can't be renamed; it is where every program begins. Name another step.",
    "move": "The start can't be moved; it is where every program begins. Name another step.",
    "move-before": "The start can't be moved; it is where every program begins. Name another step.",
    "split": "The start has no goals; name another step.",
    "replace": "The start has no goals; say what comes after it.",
    "also": "The start has no goals; say what comes after it.",
    "remove-rest": 'The start can\'t be removed; say "start over" for an empty program.',
    "merge": "The start has no goals; name another step.",
    "swap": "Nothing can come before the start; name another step.",
    "else": "The start can't be a branch; name another step.",
    "condition": "The start waits for nothing; name another step.",
    "unconditional": "The start waits for nothing; name another step.",
}
"""By intent, why it can't be done to the start."""


def pair(
    intent: str,
    named: Mapping[str, str],
    latest: str,
    program: Automaton,
    tokens: Sequence[str] = (),
) -> tuple[str, str]:
    """The two checkpoints of an edit; one that isn't named is the latest, or what is beside it.

    "The first two" are the first; "in the opposite order" names none, so there must be no more than two.

    Raises:
        EditError: there are not two.
    """
    made = [c for c in program.checkpoints if c != START]
    if not named and "order" in tokens and len(made) != 2:
        raise EditError("Say which two steps should change places.")
    if not named and "first" in tokens:
        first = program.children(START)[:1]
        second = program.children(first[0])[:1] if first else ()
        if not second:
            raise EditError("There are not two steps for that; name them.")
        return second[0], first[0]
    this = named.get("k", latest)
    if "l" in named:
        return this, named["l"]
    if intent == "move":
        leaves = [c for c in program.leaves() if c != this]
        other = leaves[-1] if leaves else None
    elif intent == "move-before":
        first = program.children(START)
        other = first[0] if first else None
        if other == this:
            raise EditError(f"{program.checkpoints[this].name} is the first step already.")
    else:
        other = program.parent(this)
    if other is None or START in (this, other):
        raise EditError("There are not two steps for that; name them.")
    return this, other


def latest_step(program: Automaton, dialogue: Dialogue) -> str:
    """The checkpoint that was changed last."""
    touched = [c for c in dialogue.touched if c in program.checkpoints]
    here = dialogue.here if dialogue.here in program.checkpoints else None
    return touched[-1] if touched else here or list(program.checkpoints)[-1]


def going_on(
    touched: Sequence[str], program: Automaton, changed: Automaton, dialogue: Dialogue
) -> str | None:
    """Where the next step goes: after a new step or a last one, else where it would have gone."""
    latest = touched[-1] if touched else None
    if latest is not None and (latest not in program.checkpoints or not changed.outgoing(latest)):
        return latest
    return dialogue.here if dialogue.here in changed.checkpoints else None
