"""Programs without a file of their own: kept after every change, found again after a crash."""

from __future__ import annotations

import contextlib
import os
import re
from dataclasses import dataclass
from pathlib import Path

from polaris_nl.automaton.program import Program, read_program, write_program
from polaris_nl.model.errors import FileError, PolarisError
from polaris_nl.session import Session


def state_folder() -> Path:
    """Where the application keeps what it must not lose."""
    import platformdirs

    return Path(platformdirs.user_state_dir("polaris-nl"))


def keeping_path(world: str, folder: Path | None = None) -> Path | None:
    """A file of this process for a program without a name; None where none can be made."""
    folder = folder or state_folder() / "unsaved"
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError:
        return None
    name = re.sub(r"[^a-z0-9-]+", "-", world.lower()).strip("-") or "world"
    return folder / f"{name}-{os.getpid()}.polaris.json"


@dataclass(frozen=True)
class Leftover:
    """A program that a session which is gone has left behind."""

    path: Path
    program: Program


def leftovers(world: str, folder: Path | None = None) -> list[Leftover]:
    """What sessions that are gone have left unsaved of this world, the newest first."""
    folder = folder or state_folder() / "unsaved"
    found = []
    for path in folder.glob("*.polaris.json"):
        owner = path.name.removesuffix(".polaris.json").rpartition("-")[2]
        if not owner.isdecimal() or _alive(int(owner)):
            continue
        with contextlib.suppress(PolarisError, OSError):
            program = read_program(path)
            if program.world == world and len(program.automaton.checkpoints) > 1:
                found.append((path.stat().st_mtime, Leftover(path, program)))
    return [left for _, left in sorted(found, key=lambda x: x[0], reverse=True)]


def tidied(path: Path) -> bool:
    """Removes a kept program that is empty; whether there is still one."""
    try:
        if len(read_program(path).automaton.checkpoints) > 1:
            return True
        path.unlink()
    except (PolarisError, OSError):
        pass
    return False


def saved_as(session: Session, path: Path) -> str:
    """Keeps a session's program in another file from now on; says so.

    Raises:
        FileError: the file is another program's, or can't be written.
        PolarisError: what is there is no program.
    """
    if path.exists() and read_program(path) != session.program:
        raise FileError(f"There is another program in {path} already; choose another name.")
    write_program(session.program, path)
    session.path = path
    return f"Kept in {path.name} from now on."


def _alive(process: int) -> bool:
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except (PermissionError, OverflowError):
        return True
    return True
