"""Where what was learned of durations is kept: one small file a world, in the user's state folder.

`POLARIS_NL_DURATIONS=off` neither reads nor writes any, so that plans depend on nothing but their program.
"""

from __future__ import annotations

import json
import os
import re
from collections.abc import Iterable
from pathlib import Path

from polaris_nl.automaton.program import write_whole
from polaris_nl.execution.durations import Durations
from polaris_nl.execution.events import Event
from polaris_nl.model.errors import FileError, FormatError
from polaris_nl.model.world import World
from polaris_nl.planning.costs import Extra

SWITCH = "POLARIS_NL_DURATIONS"


def durations_path(world: World) -> Path:
    """The file of a world, by its domain's and its own name."""
    import platformdirs

    folder = Path(platformdirs.user_state_dir("polaris-nl")) / "durations"
    name = re.sub(r"[^a-z0-9-]+", "-", f"{world.domain.name}_{world.name}".lower())
    return folder / f"{name}.json"


def read_durations(world: World) -> Durations:
    """What is known of a world's actions; nothing, where nothing was learned.

    Raises:
        FormatError: the file is broken.
        FileError: it can't be read.
    """
    path = durations_path(world)
    if os.environ.get(SWITCH) == "off" or not path.is_file():
        return Durations()
    reset = "forget it with: polaris-nl durations --reset"
    try:
        return Durations.of_json(json.loads(path.read_text(encoding="utf-8")))
    except ValueError as error:
        raise FormatError(f"{error}; {reset}.", path) from error
    except OSError as error:
        raise FileError(f"Can't read {path}: {error.strerror}; {reset}.") from error


def learned(world: World) -> Extra:
    """What plans make of it; nothing where the file can't be used, which `durations` tells of."""
    try:
        return read_durations(world).extra
    except FileError:
        return {}


def learn(world: World, events: Iterable[Event]) -> None:
    """Learns from a run that is over; what was broken is begun anew.

    Raises:
        FileError: the file can't be written.
    """
    if os.environ.get(SWITCH) == "off":
        return
    try:
        before = read_durations(world)
    except FormatError:
        before = Durations()
    after = before.after(events)
    if after == before:
        return
    path = durations_path(world)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise FileError(f"Can't make the folder {path.parent}: {error.strerror}.") from error
    write_whole(path, json.dumps(after.to_json(), indent=1) + "\n")


def forget(world: World) -> bool:
    """Forgets what is known of a world; whether there was anything.

    Raises:
        FileError: the file can't be removed.
    """
    path = durations_path(world)
    try:
        path.unlink()
    except FileNotFoundError:
        return False
    except OSError as error:
        raise FileError(f"Can't remove {path}: {error.strerror}.") from error
    return True
