"""Modes of cutting an utterance: what can follow what, in which role, and what that costs."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Literal as OneOf

from polaris_nl.language.clauses import Clause
from polaris_nl.language.tokens import BREAK, COMMA

Connective = OneOf[
    "and", "or", "then", "if", "until", "unless", "else", "not", "before", "done", "purpose", "given",
    "polite", "nothing",
]  # fmt: skip
Mark = Connective | OneOf["assure", "comma", "break"]
Role = OneOf["goal", "condition", "fact", "topic", "again", "except", "mark", "unknown"]
Mode = OneOf[
    "plain", "assured", "condition", "after-condition", "either", "state", "negated", "event", "telling"
]  # fmt: skip
"""What stands before a position: `either` is "if ..., and", where another condition or a goal can come;
`assured` is "make sure ...", where "and" can bring another state that is wished for."""

PRESENT_COST = 0.15
"""What it costs to take "once you go there" for something to do, rather than for a condition."""
UNDOING_COST = 0.1
"""What it costs to take "once you have put it down" for something to do, rather than for a condition."""
SMALL_COST = 0.7
"""What it costs to let a state lean on the verb of the one before: "... and the cupboard closed"."""
LEANING_COST = 0.5
"""What it costs to let a state lean on a condition: "once the cup is clean and the plate in the sink, ..."."""
WISH_COST = 0.15
"""What it costs to take "if ..., and the cup is not on the desk" for a wish, rather than for a condition."""
ASSURED_COST = 0.2
"""What it costs to take "make sure to fill it" for a goal, rather than for a state."""
FACT_COST = 0.8
"""What it costs to take a state for something told in passing rather than for a condition or a wish."""

FINAL: tuple[Mode, ...] = ("plain", "assured", "after-condition", "either")
OPEN: tuple[Mode, ...] = ("plain", "assured", "either", "after-condition")
"""Modes in which a new clause may start."""
_JOINERS = ("and", "but", COMMA)
"""Words after which a state can lean on what was said before it."""
_MARK_MODES: Mapping[str, Mode] = {
    "if": "condition",
    "until": "condition",
    "unless": "condition",
    "assure": "state",
    "not": "negated",
    "before": "event",
    "done": "event",
    "polite": "event",
    "given": "telling",
}


def roles(mode: Mode, clause: Clause, before: str) -> Iterator[tuple[Role, float, Mode]]:
    """The roles that a clause can have in a mode.

    Args:
        mode: what came before.
        clause: the clause.
        before: the token in front of it, or "".

    Yields:
        Each role, what it costs besides the clause, and the mode after it.
    """
    if clause.form != "base":
        if mode == "event":
            yield "goal", 0.0 if clause.positive else UNDOING_COST, "plain"
    elif mode == "telling":
        if clause.kind in ("told", "state"):
            yield "fact", 0.0, "plain"
    elif clause.kind == "told":
        if mode == "plain":
            yield "fact", 0.0, "plain"
    elif clause.kind == "state":
        yield from _state_roles(mode, clause, before)
    elif clause.kind == "small":
        if mode == "state":
            yield "goal", 0.0, "assured"
        if mode == "assured" and before in _JOINERS:
            yield "goal", ASSURED_COST, "assured"
        if mode == "either" and before == "and":
            yield "condition", LEANING_COST, "after-condition"
        alone = before in ("", BREAK) and len(clause.bindings) == 1  # "Fridge shut, please."
        if mode == "plain" and (before in (*_JOINERS, "then") or alone):
            yield "goal", SMALL_COST, "plain"
    elif clause.kind == "wish":
        if mode in (*OPEN, "state"):
            yield "goal", WISH_COST if mode in ("either", "after-condition") else 0.0, "plain"
    elif clause.kind == "goal":
        yield from _goal_roles(mode)
    elif mode in OPEN:
        yield "goal", 0.0, "plain"


def _state_roles(mode: Mode, clause: Clause, before: str) -> Iterator[tuple[Role, float, Mode]]:
    if mode in ("condition", "either"):
        yield "condition", 0.0, "after-condition"
    if mode == "state":
        yield "goal", 0.0, "assured"
    if mode == "assured" and before in _JOINERS:
        yield "goal", ASSURED_COST, "assured"
    if mode == "plain" and clause.tellable:
        yield "fact", FACT_COST, "plain"


def _goal_roles(mode: Mode) -> Iterator[tuple[Role, float, Mode]]:
    if mode in (*OPEN, "negated"):
        yield "goal", 0.0, "plain"
    elif mode == "event":
        yield "goal", PRESENT_COST, "plain"
    elif mode == "state":
        yield "goal", ASSURED_COST, "plain"


def after_mark(mode: Mode, mark: Mark) -> Mode | None:
    """The mode after a connective, or None where it can't stand."""
    if mode == "negated" and mark == "assure":
        return "state"
    if mode in ("condition", "state", "negated", "event", "telling"):
        return mode if mark == "comma" else None
    if mark in _MARK_MODES:
        return _MARK_MODES[mark]
    if mode == "assured" and mark in ("and", "comma"):
        return "assured"
    if mode == "after-condition" and mark in ("and", "comma"):
        return "either"
    return "plain"
