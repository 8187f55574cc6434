"""Edits as JSON values, for `--json`, logs and repairs.

An example: `{"edit": "rename-checkpoint", "checkpoint": "c1", "name": "told"}`.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from polaris_nl.automaton.automaton import Automaton
from polaris_nl.automaton.edits import (
    AddCheckpoint,
    Connect,
    Disconnect,
    Edit,
    InsertCheckpoint,
    MoveCheckpoint,
    RemoveCheckpoint,
    RenameCheckpoint,
    ReplaceProgram,
    SetConditional,
    SetGoals,
)
from polaris_nl.automaton.program import (
    Program,
    checkpoint_json,
    checkpoint_of,
    parse_action,
    program_json,
    program_of,
    transition_json,
    transition_of,
)
from polaris_nl.model.errors import FormatError, did_you_mean
from polaris_nl.model.formula import Literal, parse_formula, parse_literal


def edit_json(edit: Edit) -> dict[str, Any]:
    """The JSON value of an edit; `edit_of(edit_json(e)) == e`."""
    match edit:
        case AddCheckpoint(checkpoint, transition):
            return {
                "edit": "add-checkpoint",
                "checkpoint": checkpoint_json(checkpoint),
                "transition": transition_json(transition),
            }
        case InsertCheckpoint(checkpoint, on, onward, when):
            return {
                "edit": "insert-checkpoint",
                "checkpoint": checkpoint_json(checkpoint),
                "on": on,
                "onward": onward,
                "when": _texts(when),
            }
        case RemoveCheckpoint(checkpoint, subtree):
            return {"edit": "remove-checkpoint", "checkpoint": checkpoint, "subtree": subtree}
        case RenameCheckpoint(checkpoint, name):
            return {"edit": "rename-checkpoint", "checkpoint": checkpoint, "name": name}
        case SetGoals(checkpoint, goals, action):
            value: dict[str, Any] = {
                "edit": "set-goals",
                "checkpoint": checkpoint,
                "goals": [str(g) for g in goals],
            }
            return value if action is None else {**value, "action": str(action)}
        case SetConditional(transition, when):
            return {"edit": "set-conditional", "transition": transition, "when": _texts(when)}
        case MoveCheckpoint(checkpoint, to, when):
            return {
                "edit": "move-checkpoint",
                "checkpoint": checkpoint,
                "to": to,
                "when": _texts(when),
            }
        case Connect(transition):
            return {"edit": "connect", "transition": transition_json(transition)}
        case Disconnect(transition):
            return {"edit": "disconnect", "transition": transition}
        case ReplaceProgram(program):
            return {"edit": "replace-program", "program": program_json(Program(program, "", ""))}


def edit_of(value: Any) -> Edit:
    """Makes an edit of its JSON value.

    Raises:
        FormatError: it is none.
    """
    if not isinstance(value, dict) or value.get("edit") not in _READ:
        kind = value.get("edit") if isinstance(value, dict) else value
        raise FormatError(f"{kind!r} is no edit.{did_you_mean(str(kind), _READ)}")
    try:
        return _READ[value["edit"]](value)
    except (KeyError, TypeError, AttributeError) as error:
        raise FormatError(f"The edit {value['edit']} lacks or garbles {error}.") from error


_READ: dict[str, Callable[[Any], Edit]] = {
    "add-checkpoint": lambda v: AddCheckpoint(
        checkpoint_of(v["checkpoint"]), transition_of(v["transition"])
    ),
    "insert-checkpoint": lambda v: InsertCheckpoint(
        checkpoint_of(v["checkpoint"]), v["on"], v["onward"], _literals(v.get("when", []))
    ),
    "remove-checkpoint": lambda v: RemoveCheckpoint(v["checkpoint"], bool(v.get("subtree", False))),
    "rename-checkpoint": lambda v: RenameCheckpoint(v["checkpoint"], v["name"]),
    "set-goals": lambda v: SetGoals(
        v["checkpoint"],
        tuple(parse_formula(g) for g in v["goals"]),
        parse_action(v["action"]) if "action" in v else None,
    ),
    "set-conditional": lambda v: SetConditional(v["transition"], _literals(v["when"])),
    "move-checkpoint": lambda v: MoveCheckpoint(
        v["checkpoint"], v["to"], _literals(v.get("when", []))
    ),
    "connect": lambda v: Connect(transition_of(v["transition"])),
    "disconnect": lambda v: Disconnect(v["transition"]),
    "replace-program": lambda v: ReplaceProgram(_automaton(v["program"])),
}


def _automaton(value: Any) -> Automaton:
    return program_of(value).automaton


def _literals(values: Any) -> tuple[Literal, ...]:
    return tuple(parse_literal(text) for text in values)


def _texts(when: tuple[Literal, ...]) -> list[str]:
    return [str(literal) for literal in when]
