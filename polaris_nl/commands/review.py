"""`review`: reads a log back, or a folder of logs."""

from __future__ import annotations

from argparse import Namespace
from dataclasses import asdict
from pathlib import Path

from polaris_nl.commands.common import (
    complain,
    print_json,
    print_rows,
    print_text,
    shown_path,
    width,
)
from polaris_nl.commands.review_folder import show_durations, show_folder
from polaris_nl.commands.review_text import line_rows
from polaris_nl.commands.review_views import VIEWS, show_events, show_summary
from polaris_nl.logs.filters import check, start_of
from polaris_nl.logs.privacy import privacy_of
from polaris_nl.logs.reader import Log, open_log, read_log, read_page
from polaris_nl.logs.recovery import being_written, recover, recovered_path
from polaris_nl.logs.redacting import redact
from polaris_nl.logs.schema import event_json
from polaris_nl.model.errors import LogError, UsageError
from polaris_nl.render.glyphs import glyphs_for

PAGE = 20
"""Events on a page."""


def run(arguments: Namespace) -> int:
    """Shows the summary, or what the options ask for; 1 where the run didn't end well or runs differ."""
    check(arguments.filter)
    path: Path = arguments.log
    if path.is_dir():
        return _folder(arguments)
    if arguments.recover:
        return _recover(arguments)
    if arguments.redact:
        return _redact(arguments)
    if arguments.page is not None:
        return _page(arguments)
    log = _opened(path)
    for name, show in VIEWS.items():
        asked = getattr(arguments, name)
        if asked is not None and asked is not False:
            return show(log, arguments)
    return show_events(log, arguments) if arguments.filter else show_summary(log, arguments)


def _folder(arguments: Namespace) -> int:
    if arguments.durations:
        return show_durations(arguments.log, arguments.json)
    return show_folder(arguments.log, arguments.json)


def _opened(path: Path) -> Log:
    """A log; one that was cut off is mended beside the original, and what is missing is said."""
    log = read_log(path)
    if log.complete:
        return log
    if being_written(log.parts[-1]):
        complain("This log is still being written; what follows is what it holds so far.")
        return log
    complain(f"The log isn't whole. {log.missing}")
    for part in log.parts:
        _mend(part)
    return log


def _mend(part: Path) -> None:
    """Makes a whole file of one that isn't, once, and says where it is."""
    with open_log(part) as file:
        list(file.events())  # A damaged chunk is found when it is read.
        if file.complete:
            return
    target = recovered_path(part)
    if not target.exists() or target.stat().st_mtime < part.stat().st_mtime:
        try:
            recover(part)
        except LogError as error:
            complain(str(error))
            return
    complain(f"A whole file of what is there: {shown_path(target)}")


def _recover(arguments: Namespace) -> int:
    found = recover(arguments.log)
    if arguments.json:
        print_json(
            {
                "log": str(found.path),
                "messages": found.messages,
                "complete": found.complete,
                "missing": found.missing,
            }
        )
    else:
        print_text(found.missing or "Nothing was missing.")
        print_text(f"{found.messages} messages are in {shown_path(found.path)}")
    return 0


def _redact(arguments: Namespace) -> int:
    path: Path = arguments.log
    target = arguments.out or path.with_name(f"{path.stem}.redacted.mcap")
    privacy = privacy_of(arguments.redact)
    found = redact(path, target, privacy)
    if arguments.json:
        print_json({**asdict(found), "path": str(found.path), "without": privacy.words})
    else:
        print_text(
            f"{shown_path(found.path)} is a copy without {privacy.words}: {found.changed} messages were"
            f" changed and {found.left_out} left out. The original is as it was."
        )
    return 0


def _page(arguments: Namespace) -> int:
    """Some events of a log of any length, read by its index."""
    if arguments.page < 1:
        raise UsageError("Pages are counted from 1.")
    with open_log(arguments.log) as file:
        start = start_of(list(file.events(0, 200)))
    found, count = read_page(arguments.log, (arguments.page - 1) * PAGE, arguments.page * PAGE)
    pages = -(-count // PAGE)
    if not found:
        raise UsageError(f"There is no page {arguments.page}; the log has {pages}.")
    first = (arguments.page - 1) * PAGE + 1
    for number, event in enumerate(found, first):
        if arguments.json:
            print_json({"number": event.id or number, **event_json(event)})
        else:
            print_rows(line_rows(event, start, None, glyphs_for(), width()))
    if not arguments.json:
        print_text(f"Page {arguments.page} of {pages}.")
    return 0
