"""Reads logs back as events."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from polaris_nl.execution.events import Event, Stepped
from polaris_nl.logs.files import open_log as open_log
from polaris_nl.logs.paths import parts_of


@dataclass
class Log:
    """A log as it was read.

    Attributes:
        events: in file order.
        attachments: text by name.
        sounds: recordings by name.
        complete: False where the file is cut off or damaged.
        missing: what is missing then, as a sentence.
        inputs: what the executor's steps were given, where that was asked for.
        metadata: what the log says about itself.
        parts: the files that it was read from.
    """

    path: Path
    events: list[Event] = field(default_factory=list)
    attachments: dict[str, str] = field(default_factory=dict)
    sounds: dict[str, bytes] = field(default_factory=dict)
    complete: bool = False
    missing: str = ""
    inputs: list[Stepped] = field(default_factory=list)
    metadata: dict[str, str] = field(default_factory=dict)
    parts: tuple[Path, ...] = ()


def read_log(path: Path, inputs: bool = False) -> Log:
    """Reads the events of a log, whole or cut off, with the parts in which it goes on.

    Args:
        path: the file, or the first part of several.
        inputs: read what the executor was given, too.

    Raises:
        LogError: the file can't be read, or is no log.
    """
    parts = tuple(parts_of(path))
    log = Log(path, complete=True, parts=parts)
    for part in parts:
        with open_log(part) as file:
            log.events += file.events()
            if inputs:
                log.inputs += file.inputs()
            for name, data in file.attachments():
                if isinstance(data, str):
                    log.attachments.setdefault(name, data)
                else:
                    log.sounds.setdefault(name, data)
            log.metadata = {**file.metadata(), **log.metadata}
            log.complete = log.complete and file.complete
            log.missing = " ".join(x for x in (log.missing, file.missing) if x)
    # Logs of older versions have no numbers in them.
    log.events = [e if e.id else replace(e, id=n) for n, e in enumerate(log.events, 1)]
    return log


def read_page(path: Path, start: int, stop: int) -> tuple[list[Event], int]:
    """Some events of a log of any length, over all its parts, and how many events there are.

    Raises:
        LogError: a file can't be read, or is no log.
    """
    found: list[Event] = []
    count = 0
    for part in parts_of(path):
        with open_log(part) as file:
            found += file.events(max(start - count, 0), max(stop - count, 0))
            count += len(file)
    return found, count


def filtered(
    events: Sequence[Event], *tests: Callable[[Event], bool]
) -> Iterator[tuple[int, Event]]:
    """The events that pass all tests, with their numbers in the log, counted from 1."""
    for number, event in enumerate(events, 1):
        if all(test(event) for test in tests):
            yield event.id or number, event
