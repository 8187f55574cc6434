"""What the sub-commands share: finding the world of a program, opening sessions, printing."""

from __future__ import annotations

import json
import shutil
import sys
from argparse import Namespace
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from polaris_nl.model.data import shipped_worlds
from polaris_nl.model.errors import FileError, PolarisError, UsageError
from polaris_nl.model.world import World
from polaris_nl.model.world_file import load_world
from polaris_nl.render.glyphs import DEFAULT_WIDTH
from polaris_nl.render.layout import Row, wrapped

if TYPE_CHECKING:  # Loaded where they are needed: a log is read without them, and much sooner.
    from polaris_nl.automaton.program import Program
    from polaris_nl.session import Session

WIDEST = 100
"""Lines longer than this are hard to read."""


def width() -> int:
    """The characters in a line of this terminal."""
    return max(min(shutil.get_terminal_size((DEFAULT_WIDTH, 24)).columns, WIDEST), 30)


def print_json(value: Any) -> None:
    """One JSON value on one line, at once."""
    print(json.dumps(value, ensure_ascii=False), flush=True)


def print_text(text: str, lead: str = "") -> None:
    """A paragraph for a person."""
    print_rows(wrapped(text, width(), lead))


def print_rows(rows: Iterable[Row]) -> None:
    """Rows of a drawing."""
    for row in rows:
        print(row.text.rstrip(), flush=True)


def shown_path(path: Path) -> str:
    """A path as short as it can be said here."""
    here = Path.cwd()
    return str(path.relative_to(here)) if path.is_relative_to(here) else str(path)


def complain(text: str) -> None:
    """A sentence to the error output."""
    print(f"polaris-nl: {' '.join(text.split())}", file=sys.stderr, flush=True)


def world_for(named: str | None, program: Program | None, beside: Path | None) -> World:
    """The world that is named, or the one that a program belongs to.

    Args:
        named: a shipped name or a path, or None.
        program: the program, if there is one.
        beside: the program's file: its world may lie in the same folder.

    Raises:
        UsageError: neither names a world.
        FileError: the program's world can't be found.
    """
    if named is not None:
        world = load_world(named)
        if program is not None and program.world and program.world != world.name:
            raise FileError(
                f"The program {beside} belongs to the world {program.world}, not to {world.name}; start a new "
                "program, or leave --world out."
            )
        return world
    if program is None or not program.world:
        known = ", ".join(shipped_worlds())
        raise UsageError(f"Which world? Name one with --world. Shipped: {known}.")
    if program.world in shipped_worlds():
        return load_world(program.world)
    return _world_beside(program.world, beside)


def _world_beside(name: str, beside: Path | None) -> World:
    folders = [beside.parent] if beside else []
    for folder in (*folders, Path()):
        patterns = ("*.yaml", "worlds/*.yaml", "*.pddl")
        for path in sorted(found for pattern in patterns for found in folder.glob(pattern)):
            try:
                world = load_world(str(path))
            except PolarisError:
                continue
            if world.name == name:
                return world
    raise FileError(f"The program's world {name} isn't shipped; name its file with --world FILE.")


def opened(arguments: Namespace) -> tuple[Program, World]:
    """The program file of a command that needs one, and its world.

    Raises:
        PolarisError: either can't be read.
    """
    from polaris_nl.automaton.program import read_program

    program = read_program(arguments.program)
    return program, world_for(arguments.world, program, arguments.program)


def session_of(arguments: Namespace) -> Session:
    """A session on the program file of a command, which may not be there yet.

    Raises:
        PolarisError: the world or the program can't be read.
    """
    from polaris_nl.automaton.automaton import Automaton
    from polaris_nl.automaton.program import read_program
    from polaris_nl.session import Session

    path: Path | None = arguments.program
    program = read_program(path) if path is not None and path.exists() else None
    world = world_for(arguments.world, program, path)
    return Session(world, program.automaton if program else Automaton(), path)
