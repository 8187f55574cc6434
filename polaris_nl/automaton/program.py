"""Programs as files and JSON values (`polaris-program/1`, DESIGN sections 6 and 7)."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from polaris_nl.automaton.automaton import START, Automaton, Checkpoint, Transition
from polaris_nl.model.domain import Action
from polaris_nl.model.errors import FileError, FormatError, ProgramError
from polaris_nl.model.files import read_small_text
from polaris_nl.model.formula import Literal, parse_formula
from polaris_nl.model.schema import check_schema
from polaris_nl.model.sexpr import Group, Word, read_one

SCHEMA = "polaris-program/1"
MIGRATIONS: Mapping[int, Callable[[dict[str, Any]], dict[str, Any]]] = {}
"""For each older version n, the function that makes version n + 1 of a program's JSON value."""


@dataclass(frozen=True, slots=True)
class Program:
    """What a program file holds: an automaton, and the domain and world it is for, by name."""

    automaton: Automaton
    domain: str
    world: str


def program_json(program: Program) -> dict[str, Any]:
    """The JSON value of a program (DESIGN section 6)."""
    return {
        "schema": SCHEMA,
        "domain": program.domain,
        "world": program.world,
        "checkpoints": [checkpoint_json(c) for c in program.automaton.checkpoints.values()],
        "transitions": [transition_json(t) for t in program.automaton.transitions.values()],
    }


def checkpoint_json(checkpoint: Checkpoint) -> dict[str, Any]:
    """The JSON value of a checkpoint."""
    value: dict[str, Any] = {
        "id": checkpoint.id,
        "name": checkpoint.name,
        "goals": [str(g) for g in checkpoint.goals],
    }
    if checkpoint.action is not None:
        value["action"] = str(checkpoint.action)
    return value


def transition_json(transition: Transition) -> dict[str, Any]:
    """The JSON value of a transition."""
    value: dict[str, Any] = {
        "id": transition.id,
        "from": transition.source,
        "to": transition.target,
        "when": [str(x) for x in transition.when],
    }
    if transition.on is not None:
        value["on"] = transition.on
    return value


def program_of(value: Any) -> Program:
    """Makes a program of its JSON value; an older version is migrated.

    Raises:
        FormatError: the value is no program; the offending part is named.
    """
    if not isinstance(value, dict):
        raise FormatError("This is no program file: it holds no JSON object.")
    version = check_schema(_text(value, "schema", "the program", ""), SCHEMA, "program")
    while version in MIGRATIONS:
        value = MIGRATIONS[version](value)
        version += 1
    checkpoints: dict[str, Checkpoint] = {}
    for item in _list(value, "checkpoints", "the program"):
        checkpoint = checkpoint_of(item)
        if checkpoint.id in checkpoints:
            raise FormatError(
                f"Two checkpoints have the id {checkpoint.id}; give one of them another."
            )
        checkpoints[checkpoint.id] = checkpoint
    transitions: dict[str, Transition] = {}
    for item in _list(value, "transitions", "the program"):
        transition = transition_of(item)
        if transition.id in transitions:
            raise FormatError(
                f"Two transitions have the id {transition.id}; give one of them another."
            )
        transitions[transition.id] = transition
    if not checkpoints:
        checkpoints = dict(Automaton().checkpoints)
    elif START not in checkpoints:
        raise FormatError(
            f"The program has no start: a checkpoint with the id {START} and no goals."
        )
    world, domain = (
        _text(value, "world", "the program", ""),
        _text(value, "domain", "the program", ""),
    )
    return Program(Automaton(checkpoints, transitions), domain, world)


def checkpoint_of(value: Any) -> Checkpoint:
    """Makes a checkpoint of its JSON value.

    Raises:
        FormatError: it is none.
    """
    item = _object(value, "A checkpoint", ("id", "name", "goals", "action"))
    checkpoint = _text(item, "id", "a checkpoint")
    what = f"the checkpoint {checkpoint}"
    action = parse_action(_text(item, "action", what)) if item.get("action") is not None else None
    goals = tuple(
        parse_formula(_string(goal, f"a goal of {what}")) for goal in _list(item, "goals", what)
    )
    if goals and action is not None:
        raise FormatError(f"{what} has goals and insists on an action; leave one of them out.")
    return Checkpoint(
        checkpoint, _text(item, "name", what, checkpoint), tuple(dict.fromkeys(goals)), action
    )


def transition_of(value: Any) -> Transition:
    """Makes a transition of its JSON value.

    Raises:
        FormatError: it is none.
    """
    item = _object(value, "A transition", ("id", "from", "to", "when", "on"))
    transition = _text(item, "id", "a transition")
    what = f"the transition {transition}"
    when = []
    for text in _list(item, "when", what):
        formula = parse_formula(_string(text, f"the conditional of {what}"))
        if not isinstance(formula, Literal):
            raise FormatError(f"{formula} in {what} is not a single fact such as (at tray table).")
        when.append(formula)
    on = item.get("on")
    if on not in (None, "success", "failure"):
        raise FormatError(f"on of {what} is success or failure, not {on!r}.")
    source, target = _text(item, "from", what), _text(item, "to", what)
    return Transition(transition, source, target, tuple(dict.fromkeys(when)), on)


def parse_action(text: str) -> Action:
    """Reads an action such as `(place tray table)`.

    Raises:
        FormatError: the text is no action.
    """
    node = read_one(text)
    if isinstance(node, Group) and node.head and all(isinstance(item, Word) for item in node.items):
        words = tuple(item.text for item in node.items if isinstance(item, Word))
        return Action(words[0], words[1:])
    raise FormatError(f"{text} is no action such as (place tray table).")


def read_program(path: Path) -> Program:
    """Reads a program file.

    Raises:
        FileError: it can't be read.
        ProgramError: it is no program file; what is wrong is named.
    """
    text = read_small_text(path, "program file", ProgramError)
    try:
        return program_of(json.loads(text))
    except json.JSONDecodeError as error:
        problem = error.msg.lower()
        reason = f"This is no JSON ({problem}); the file may be cut off: take an earlier copy."
        raise ProgramError(reason, path, error.lineno) from error
    except RecursionError as error:
        raise ProgramError("The file is nested too deeply.", path) from error
    except FormatError as error:
        raise ProgramError(error.reason, path, None) from error


def write_program(program: Program, path: Path) -> None:
    """Writes a program file: whole or not at all, so that nothing is lost when it fails half-way.

    Raises:
        FileError: it can't be written.
    """
    text = json.dumps(program_json(program), indent=2, ensure_ascii=False) + "\n"
    write_whole(path, text)


def write_whole(path: Path, text: str) -> None:
    """Writes a text file beside its goal and moves it into place.

    Raises:
        FileError: it can't be written; the old file is still there.
    """
    import os
    import tempfile

    temporary = None
    try:
        with tempfile.NamedTemporaryFile(
            "w", encoding="utf-8", dir=path.parent, prefix=f".{path.name}.", delete=False
        ) as file:
            temporary = Path(file.name)
            file.write(text)
            file.flush()
            os.fsync(file.fileno())
        if path.exists():
            temporary.chmod(path.stat().st_mode & 0o777)
        else:
            temporary.chmod(0o644)
        temporary.replace(path)
    except OSError as error:
        if temporary is not None:
            temporary.unlink(missing_ok=True)
        raise FileError(
            f"Can't write {path}: {error.strerror}. Choose another place, or make room."
        ) from error


def _object(value: Any, what: str, fields: tuple[str, ...]) -> dict[str, Any]:
    if not isinstance(value, dict):
        raise FormatError(
            f"{what} is a JSON object with {', '.join(fields)}, not {json.dumps(value)[:40]}."
        )
    for key in value:
        if key not in fields:
            raise FormatError(f"{what} has no field {key!r}; it has {', '.join(fields)}.")
    return value


def _list(item: dict[str, Any], key: str, what: str) -> list[Any]:
    value = item.get(key, [])
    if not isinstance(value, list):
        raise FormatError(f"{key} of {what} is a list.")
    return value


def _text(item: dict[str, Any], key: str, what: str, default: str | None = None) -> str:
    if key not in item and default is not None:
        return default
    if key not in item:
        raise FormatError(f"{what} has no {key}.")
    return _string(item[key], f"{key} of {what}")


def _string(value: Any, what: str) -> str:
    if not isinstance(value, str):
        raise FormatError(f"{what} is a text, not {json.dumps(value)[:40]}.")
    return value
