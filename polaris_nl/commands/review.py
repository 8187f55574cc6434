"""`review`: reads a log back."""

from __future__ import annotations

import csv
import difflib
import json
import sys
from argparse import Namespace
from collections.abc import Sequence
from dataclasses import asdict

from polaris_nl.commands.common import print_json, print_rows, print_text, width
from polaris_nl.execution.events import Event
from polaris_nl.logs.reader import Log, filtered, read_log
from polaris_nl.logs.recovery import recover
from polaris_nl.logs.review import Summary, matcher, rows, story, summary
from polaris_nl.logs.schema import event_json
from polaris_nl.model.errors import UsageError
from polaris_nl.model.text import listed
from polaris_nl.render.glyphs import glyphs_for, plain
from polaris_nl.render.log import event_rows


def run(arguments: Namespace) -> int:
    """Shows the summary, or what the options ask for; 1 where the run didn't end well or runs differ."""
    if arguments.recover:
        return _recover(arguments)
    log = read_log(arguments.log)
    if arguments.export:
        return _export(log, arguments)
    if arguments.diff is not None:
        return _diff(log, read_log(arguments.diff), arguments.json)
    if arguments.step is not None:
        return _step(log, arguments.step, arguments.json)
    if arguments.filter or arguments.events:
        return _events(log, arguments)
    return show_summary(log, arguments.json)


def _recover(arguments: Namespace) -> int:
    found = recover(arguments.log)
    if arguments.json:
        print_json({"log": str(found.path), "messages": found.messages, "complete": found.complete})
    else:
        state = (
            "it was whole"
            if found.complete
            else "it was cut off, and all that was written is there"
        )
        print_text(f"{found.messages} messages, {state}: {found.path}")
    return 0


def show_summary(log: Log, as_json: bool) -> int:
    """The summary of a log."""
    short = summary(log.events)
    if as_json:
        print_json({"log": str(log.path), "complete": log.complete, **asdict(short)})
    else:
        for line in summary_lines(log):
            print_text(line)
    return 0 if short.outcome in ("", "done") and log.complete else 1


def summary_lines(log: Log) -> list[str]:
    """A log in a few sentences."""
    short = summary(log.events)
    lines = [f'You said: "{plain(text)}"' for text in short.said]
    lines += [f"Understood: {text}" for text in short.understood if text]
    return [*lines, *run_lines(log, short)]


def run_lines(log: Log, short: Summary) -> list[str]:
    """What the run of a log did."""
    lines: list[str] = []
    if short.plan:
        lines.append(
            f"Plan: {short.plan}. {short.goals_done} of {short.goals_sent} actions that were begun got done."
        )
    lines += [f"Waited: {text}" for text in short.waited]
    lines += [f"Decided: {text}" for text in short.transitions]
    if short.checkpoints:
        lines.append(f"Reached: {listed(short.checkpoints)}.")
    lines += [f"Event {number}: {text}" for number, text in short.problems]
    if short.outcome:
        lines.append(f"End: {short.outcome}, after {short.seconds:.0f} s. {short.reason}")
    else:
        lines.append("The run has no end in this log.")
    if not log.complete:
        lines.append(f"The file is cut off; mend it with: polaris-nl review {log.path} --recover")
    return lines


def _events(log: Log, arguments: Namespace) -> int:
    found = list(filtered(log.events, matcher(arguments.filter)))
    start = _start(log.events)
    for number, event in found:
        if arguments.json:
            print_json({"number": number, **event_json(event)})
        elif event.text or arguments.filter:
            text = event.text or _whole(event)
            print_rows(
                event_rows(event.time - start, event.severity, text, glyphs_for(), width(), number)
            )
    if not found and not arguments.json:
        print_text("No event matches; try fewer or shorter filters.")
    return 0


def _step(log: Log, number: int, as_json: bool) -> int:
    if not 1 <= number <= len(log.events):
        raise UsageError(f"There is no event {number}; the log has {len(log.events)}.")
    event = log.events[number - 1]
    if as_json:
        print_json({"number": number, **event_json(event)})
        return 0
    print_rows(
        event_rows(
            event.time - _start(log.events),
            event.severity,
            event.text,
            glyphs_for(),
            width(),
            number,
        )
    )
    for key, value in event_json(event).items():
        if key not in ("time", "text"):
            print_text(json.dumps(value, ensure_ascii=False), f"{key}: ")
    return 0


def _diff(one: Log, other: Log, as_json: bool) -> int:
    lines = list(
        difflib.unified_diff(
            story(one.events), story(other.events), one.path.name, other.path.name, lineterm="", n=2
        )
    )
    if as_json:
        print_json({"equal": not lines, "diff": lines})
    elif lines:
        for line in lines:
            print(plain(line))
    else:
        print_text("The two runs did and decided the same.")
    return 1 if lines else 0


def _export(log: Log, arguments: Namespace) -> int:
    found = [number for number, _ in filtered(log.events, matcher(arguments.filter))]
    if arguments.export == "jsonl":
        for number in found:
            print_json({"number": number, **event_json(log.events[number - 1])})
        return 0
    table = rows(log.events)
    writer = csv.DictWriter(sys.stdout, table[0].keys() if table else ("number",))
    writer.writeheader()
    writer.writerows(table[number - 1] for number in found)
    return 0


def _start(events: Sequence[Event]) -> float:
    return events[0].time if events else 0.0


def _whole(event: Event) -> str:
    return f"{type(event).__name__} {json.dumps(event_json(event), ensure_ascii=False)}"
