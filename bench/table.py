"""Rows of the table, and how they are measured and printed."""

from __future__ import annotations

import statistics
import sys
import time
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class Row:
    """One line.

    Attributes:
        what: what is measured.
        aim: the aim of the design, as text.
        times: milliseconds (or the unit), ours.
        plain: the same, of the plain way; empty where there is none.
        plain_way: what the plain way is.
        note: what has to be known to read it.
    """

    what: str
    aim: str
    times: Sequence[float]
    plain: Sequence[float] = ()
    plain_way: str = ""
    unit: str = "ms"
    note: str = ""


def timed(work: Callable[[], object], times: int) -> list[float]:
    """How long something takes, in milliseconds, each time."""
    found = []
    for _ in range(times):
        started = time.perf_counter()
        work()
        found.append((time.perf_counter() - started) * 1000)
    return found


def percentile(values: Sequence[float], share: float) -> float:
    """A percentile of few or many values."""
    if len(values) == 1:
        return values[0]
    return statistics.quantiles(values, n=100, method="inclusive")[round(share) - 1]


HEAD = ("what", "aim", "p50", "p95", "plain p50", "ratio", "plain way")


def show(rows: Iterable[Row]) -> None:
    """Prints each row as soon as it is measured."""
    widths = (50, 14, 9, 9, 10, 7, 0)
    _line(HEAD, widths)
    for row in rows:
        p50, p95 = percentile(row.times, 50), percentile(row.times, 95)
        cells = [
            row.what,
            row.aim,
            _number(p50, row.unit),
            _number(p95, row.unit),
            "",
            "",
            row.plain_way,
        ]
        if row.plain:
            plain = percentile(row.plain, 50)
            cells[4] = _number(plain, row.unit)
            cells[5] = f"{plain / p50:.1f}x" if p50 else ""
        _line(cells, widths)
        if row.note:
            sys.stdout.write(f"    {row.note}\n")


def _line(cells: Sequence[str], widths: Sequence[int]) -> None:
    sys.stdout.write(
        "  ".join(f"{c:<{w}}" for c, w in zip(cells, widths, strict=True)).rstrip() + "\n"
    )
    sys.stdout.flush()


def _number(value: float, unit: str) -> str:
    digits = 2 if value < 10 else 1 if value < 100 else 0
    return f"{value:.{digits}f} {unit}"
