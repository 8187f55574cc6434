"""Makes the compressed, indexed file of a journal and moves it into the journal's place."""

from __future__ import annotations

import mmap
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO, Any

from polaris_nl.logs.compacting import Compactor
from polaris_nl.logs.framing import MAGIC
from polaris_nl.logs.salvage import pieces
from polaris_nl.model.errors import LogError


def finalise(path: Path) -> None:
    """Compresses a journal.

    Args:
        path: the journal, which nobody writes any more.

    Raises:
        OSError: it can't be written; the journal is untouched.
        LogError: it can't be read.
    """
    compact(path, path)


def compact(source: Path, target: Path) -> Compactor:
    """Makes a compressed, indexed file of a log in any state.

    Args:
        source: the log.
        target: the file to make, or to put in the place of another one; nothing is there, or
            changed, until it is whole.

    Returns:
        What was found.

    Raises:
        OSError: the target can't be written.
        LogError: the source can't be read.
    """
    with content(source) as data, written(target) as out:
        compactor = Compactor(out)
        compactor.take(pieces(data))
        compactor.finish()
    return compactor


@contextmanager
def written(target: Path) -> Iterator[IO[bytes]]:
    """A file that is put into its place once it is whole and on the disk.

    Raises:
        OSError: it can't be written.
    """
    temporary = target.with_name(f".{target.name}.new")
    try:
        with temporary.open("wb", buffering=1 << 20) as out:
            yield out
            out.flush()
            os.fsync(out.fileno())
        temporary.replace(target)
    finally:
        temporary.unlink(missing_ok=True)


@contextmanager
def content(path: Path) -> Iterator[Any]:
    """A log's bytes, mapped into memory and not loaded.

    Raises:
        LogError: the file can't be read, or is no MCAP file.
    """
    try:
        file = path.open("rb")
    except OSError as error:
        raise LogError(f"Can't read the log {path}: {error.strerror}. Check the path.") from error
    with file:
        start = file.read(len(MAGIC))
        if start != MAGIC:
            if not MAGIC.startswith(start):
                raise LogError(f"{path} is no MCAP log; give a file that a run has written.")
            yield b""  # A run was cut off before it had written anything.
            return
        with mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as data:
            yield data
