"""Reads the small text files that people write."""

from __future__ import annotations

from pathlib import Path

from polaris_nl.model.errors import FileError, FormatError

MAX_BYTES = 16_000_000
"""A larger file is refused: nobody wrote that, and reading it would take all memory."""


def read_small_text(path: Path, what: str, error: type[FormatError]) -> str:
    """The text of a file.

    Args:
        path: the file.
        what: what it is said to be: "program file".
        error: raised where it is too large.

    Raises:
        FileError: it can't be read.
        FormatError: of the kind given, where it is too large.
    """
    try:
        if path.stat().st_size > MAX_BYTES:
            article = "An" if what[:1] in "AEIOU" else "A"
            raise error(f"{article} {what} of more than {MAX_BYTES // 10**6} MB is refused.", path)
        return path.read_text(encoding="utf-8")
    except UnicodeDecodeError as failed:
        reason = "it is not UTF-8 text"
        raise FileError(f"Can't read the {what} {path}: {reason}. Check the path.") from failed
    except OSError as failed:
        raise FileError(
            f"Can't read the {what} {path}: {failed.strerror}. Check the path."
        ) from failed
