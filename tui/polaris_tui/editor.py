"""The program in the user's own editor."""

from __future__ import annotations

import os
import shlex
import subprocess
import sys
import tempfile
from contextlib import AbstractContextManager
from pathlib import Path

from polaris_nl.automaton.automaton import Automaton
from polaris_nl.automaton.program import Program, read_program, write_program


def editor() -> str:
    """The user's editor, or ""."""
    return os.environ.get("VISUAL") or os.environ.get("EDITOR") or ""


def edited(program: Program, suspended: AbstractContextManager[None]) -> Automaton:
    """What the user's editor leaves of a program.

    Args:
        program: what is edited.
        suspended: gives the terminal to the editor meanwhile.

    Raises:
        PolarisError: what it leaves is no program.
        OSError: there is no such editor, or no room.
    """
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "program.polaris.json"
        write_program(program, path)
        with suspended:
            command = [*shlex.split(editor()), str(path)]
            subprocess.run(command, check=False, stderr=sys.__stderr__)
        return read_program(path).automaton
