"""`review` of many logs: a table of them, and how long things took in all."""

from __future__ import annotations

import time
from dataclasses import asdict
from pathlib import Path

from polaris_nl.commands.common import print_json, print_text, width
from polaris_nl.logs.reader import read_log
from polaris_nl.logs.statistics import Entry, durations, entry, logs_in
from polaris_nl.model.errors import LogError
from polaris_nl.render.glyphs import glyphs_for, plain
from polaris_nl.render.layout import cut


def show_folder(folder: Path, as_json: bool) -> int:
    """The logs of a folder as a table, the oldest first; 1 where one can't be read."""
    found = [entry(path) for path in logs_in(folder)]
    if as_json:
        print_json([{**asdict(e), "path": str(e.path)} for e in found])
    elif not found:
        print_text(f"There are no logs in {folder}.")
    else:
        names = min(max(len(e.path.name) for e in found), max(width() - _BESIDE - _ROOM, 10))
        print(f"{'log':<{names}}  {'when':<16}  {'s':>5}  {'end':<8}  problem".rstrip())
        for one in found:
            print(_row(one, names))
    return 1 if any(e.error for e in found) else 0


def _row(one: Entry, names: int) -> str:
    more = glyphs_for().more
    name = cut(one.path.name, names, more)
    if one.error:
        return cut(f"{name:<{names}}  {plain(one.error)}", width(), more)
    when = time.strftime("%Y-%m-%d %H:%M", time.localtime(one.started)) if one.started else ""
    end = one.outcome or ("cut off" if one.robot else "no run")
    row = f"{name:<{names}}  {when:<16}  {one.seconds:5.0f}  {end:<8}  {_problem(one, names)}"
    return cut(row.rstrip(), width(), more)


def _problem(one: Entry, names: int) -> str:
    """A sentence where there is room for one, else what kind of problem it is."""
    if not one.kind or width() - names - _BESIDE >= _SENTENCE:
        return plain(one.problem)
    mended = ", mended" if one.outcome == "done" else ""
    return f"{one.kind}{mended}"


_BESIDE = 39
"""Columns that when, seconds and end take, with the space between."""
_ROOM, _SENTENCE = 16, 40
"""Columns for what kind of problem it is, and for a sentence about it."""


def show_durations(path: Path, as_json: bool) -> int:
    """How long actions, waits and deviations took in a log, or in all of a folder."""
    logs = []
    for one in logs_in(path) if path.is_dir() else [path]:
        try:
            logs.append(read_log(one).events)
        except LogError:
            if not path.is_dir():
                raise
    found = durations(logs)
    if as_json:
        print_json([asdict(d) for d in found])
    elif not found:
        print_text("Nothing was done in these logs.")
    else:
        names = max(len("what"), *(len(d.what) for d in found))
        print(f"{'what':<{names}}  begun  done  mean s  median s   95 % s  longest s")
        for d in found:
            print(
                f"{plain(d.what):<{names}}  {d.count:5}  {d.done:4}  {d.mean:6.1f}  {d.median:8.1f}"
                f"  {d.p95:7.1f}  {d.longest:9.1f}"
            )
    return 0
