"""How long things take, over many logs, and what each log is about."""

from __future__ import annotations

import statistics
from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from polaris_nl.execution.events import Event
from polaris_nl.logs.diagnosis import diagnoses, in_short
from polaris_nl.logs.reader import read_log
from polaris_nl.logs.review import summary
from polaris_nl.logs.runs_in import runs_in
from polaris_nl.logs.spans import Span, spans
from polaris_nl.model.errors import LogError


@dataclass(frozen=True, slots=True)
class Durations:
    """How long one kind of thing took.

    Attributes:
        what: an operator, `wait`, `deviation` or `pause`.
        count: how often it was begun; done: how often it came to its end.
        mean, median, p95, longest: seconds, of those that came to their end; 0 where none did.
    """

    what: str
    count: int
    done: int
    mean: float
    median: float
    p95: float
    longest: float


@dataclass(frozen=True, slots=True)
class Entry:
    """One log of a folder.

    Attributes:
        started: when, in seconds since the epoch; 0 where it is empty.
        problem: what ended the run, or disturbed it last, or ""; kind: in a word or two.
        error: why the file can't be read, or "".
    """

    path: Path
    started: float = 0.0
    seconds: float = 0.0
    robot: str = ""
    outcome: str = ""
    checkpoints: int = 0
    problem: str = ""
    kind: str = ""
    complete: bool = False
    error: str = ""


def durations(logs: Iterable[Sequence[Event]]) -> list[Durations]:
    """How long actions, waits and deviations took over many logs, by operator, the commonest first."""
    by_kind: dict[str, list[Span]] = defaultdict(list)
    for run in (run for events in logs for run in runs_in(events)):
        for span in spans(run):
            if span.kind == "action":
                by_kind[span.action.strip("()").partition(" ")[0]].append(span)
            elif span.kind != "segment":
                by_kind[span.kind].append(span)
    found = [_durations(what, some) for what, some in by_kind.items()]
    return sorted(found, key=lambda d: (-d.count, d.what))


def _durations(what: str, some: Sequence[Span]) -> Durations:
    seconds = sorted(s.seconds for s in some if s.done)
    if not seconds:
        return Durations(what, len(some), 0, 0.0, 0.0, 0.0, 0.0)
    p95 = seconds[min(len(seconds) - 1, int(0.95 * len(seconds)))]
    return Durations(
        what,
        len(some),
        len(seconds),
        statistics.fmean(seconds),
        statistics.median(seconds),
        p95,
        seconds[-1],
    )


def logs_in(folder: Path) -> list[Path]:
    """The logs of a folder, the oldest first; parts and mended copies belong to their originals.

    Raises:
        LogError: the folder can't be read.
    """
    try:
        paths = [p for p in folder.iterdir() if p.suffix == ".mcap" and not p.name.startswith(".")]
    except OSError as error:
        raise LogError(f"Can't read the folder {folder}: {error.strerror}.") from error
    later = (".recovered", ".part")
    return sorted(p for p in paths if not any(x in p.stem for x in later))


def entry(path: Path) -> Entry:
    """What a log is about, in one row; a file that can't be read is a row, too."""
    try:
        log = read_log(path)
    except LogError as error:
        return Entry(path, error=str(error))
    short = summary(log.events)
    found = [d for d in diagnoses(log.events) if d.kind not in ("not-understood",)]
    return Entry(
        path,
        short.started,
        short.seconds,
        short.robot,
        short.outcome,
        len(short.checkpoints),
        found[-1].what if found else "",
        in_short(found[-1]) if found else "",
        log.complete,
    )
