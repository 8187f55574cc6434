"""Makes whole logs of cut-off and damaged ones, beside the original, and says what is missing."""

from __future__ import annotations

import contextlib
import fcntl
import os
from dataclasses import dataclass
from pathlib import Path

from polaris_nl.logs.finalising import compact
from polaris_nl.logs.keeping import CUT_OFF
from polaris_nl.logs.salvage import Gap
from polaris_nl.model.errors import LogError
from polaris_nl.model.text import listed

CUT = "the program was cut off while writing"
_SMALL = 4096
"""Fewer bytes than this at the end are one record that was being written."""


@dataclass(frozen=True, slots=True)
class Recovery:
    """What a recovery found.

    Attributes:
        path: the whole file that was made.
        messages: how many messages it has.
        complete: whether the original had its end, and no gap, so that nothing is missing.
        missing: what is missing, as a sentence, or "".
    """

    path: Path
    messages: int
    complete: bool
    missing: str = ""


def recovered_path(path: Path) -> Path:
    """Where the mended file of a log goes."""
    return path.with_name(f"{path.stem}.recovered.mcap")


def recover(path: Path, target: Path | None = None) -> Recovery:
    """Makes a whole, indexed file of one that may be cut off or damaged, beside the original.

    Raises:
        LogError: the file is no log, or the new one can't be written.
    """
    target = target or recovered_path(path)
    try:
        found = compact(path, target)
    except OSError as error:
        raise LogError(
            f"Can't write {target}: {error.strerror}. Make room, or choose another place."
        ) from error
    whole = found.complete and not found.gaps
    said = missing(found.gaps, found.complete, found.about.get(CUT_OFF, ""))
    return Recovery(target, found.messages, whole, said)


def missing(gaps: list[Gap], complete: bool, cut_off: str = "") -> str:
    """What is missing in a log, as a sentence; "" where nothing is.

    Args:
        gaps: what no records could be made of.
        complete: whether the log has its end.
        cut_off: why it has none, where that is known.
    """
    inside = [gap for gap in gaps if not gap.at_end]
    parts = []
    if inside:
        places = [f"{_size(gap.length)} from byte {gap.offset}" for gap in inside[:3]]
        more = f" and {len(inside) - 3} more places" if len(inside) > 3 else ""
        parts.append(
            f"It is damaged inside ({listed(places)}{more}); what stands before and after that is kept."
        )
    if not complete:
        tail = sum(gap.length for gap in gaps if gap.at_end)
        lost = f"; its last {_size(tail)} make no whole message" if tail else ""
        why = f"it couldn't be written any more ({cut_off})" if cut_off else CUT
        parts.append(f"It has no end, as {why}{lost}.")
    return " ".join(parts)


def being_written(path: Path) -> bool:
    """Whether a program is writing a log just now."""
    with contextlib.suppress(OSError):
        file = os.open(path, os.O_RDONLY | os.O_CLOEXEC)
        try:
            fcntl.flock(file, fcntl.LOCK_SH | fcntl.LOCK_NB)
        except BlockingIOError:
            return True
        finally:
            os.close(file)
    return False


def _size(count: int) -> str:
    if count < _SMALL:
        return f"{count} byte{'' if count == 1 else 's'}"
    return f"{count / 1024:.0f} KB" if count < 1 << 20 else f"{count / (1 << 20):.1f} MB"
