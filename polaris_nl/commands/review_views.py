"""What there is to see of a log: one function an option of `review`."""

from __future__ import annotations

import csv
import json
import sys
from argparse import Namespace
from collections.abc import Callable, Mapping
from dataclasses import asdict

from polaris_nl.commands.common import (
    print_json,
    print_rows,
    print_text,
    width,
)
from polaris_nl.commands.review_folder import show_durations
from polaris_nl.commands.review_text import (
    chain_rows,
    expected_lines,
    line_rows,
    more_line,
    replay_line,
    report_markdown,
    step_rows,
    summary_lines,
)
from polaris_nl.commands.review_words import words_of
from polaris_nl.execution.events import Event
from polaris_nl.logs.asking import ask
from polaris_nl.logs.chain import chain
from polaris_nl.logs.comparing import compare
from polaris_nl.logs.diagnosis import diagnoses
from polaris_nl.logs.expected import expectations
from polaris_nl.logs.filters import matcher, start_of
from polaris_nl.logs.reader import Log, filtered, read_log
from polaris_nl.logs.review import next_problem, rows, summary
from polaris_nl.logs.runs_in import runs_in
from polaris_nl.logs.sayings import said
from polaris_nl.logs.schema import event_json
from polaris_nl.logs.spans import spans
from polaris_nl.model.errors import LogError, UsageError
from polaris_nl.render.glyphs import glyphs_for, plain
from polaris_nl.render.run_timeline import timeline_rows


def show_summary(log: Log, arguments: Namespace) -> int:
    """The summary; 1 where the run ended badly or the log isn't whole."""
    short = summary(log.events)
    if arguments.json:
        value = {"log": str(log.path), "complete": log.complete, "missing": log.missing}
        print_json(
            {**value, **asdict(short), "diagnoses": [asdict(d) for d in diagnoses(log.events)]}
        )
    else:
        for line in (*summary_lines(log, words_of(log)), more_line(log)):
            print_text(line)
    return 0 if short.outcome in ("", "done") and log.complete else 1


def show_events(log: Log, arguments: Namespace) -> int:
    """Events, those that the filters let through."""
    found = list(filtered(log.events, matcher(arguments.filter, log.events)))
    start = start_of(log.events)
    for number, event in found:
        if arguments.json:
            print_json({"number": number, **event_json(event)})
        elif event.severity != "debug" or arguments.filter:
            print_rows(line_rows(event, start, words_of(log), glyphs_for(), width()))
    if not found and not arguments.json:
        print_text("No event matches; try fewer or shorter filters.")
    return 0


def _ask(log: Log, arguments: Namespace) -> int:
    reply = ask(log.events, arguments.ask, words_of(log))
    if arguments.json:
        print_json(
            {
                "question": arguments.ask,
                "answer": reply.text,
                "event": reply.number,
                "chain": [{"number": e.id, "text": said(e, words_of(log))} for e in reply.chain],
            }
        )
        return 0
    print_text(reply.text)
    if reply.chain:
        print()
        print_rows(chain_rows(reply.chain, log, words_of(log), glyphs_for(), width()))
    return 0


def _timeline(log: Log, arguments: Namespace) -> int:
    if arguments.json:
        found = [s for run in runs_in(log.events) for s in spans(run)]
        print_json([{**asdict(s), "seconds": round(s.seconds, 3)} for s in found])
    else:
        for run in runs_in(log.events) or [[]]:
            print_rows(timeline_rows(spans(run), glyphs_for(), width()))
    return 0


def _step(log: Log, arguments: Namespace) -> int:
    event = _event(log, arguments.step)
    if arguments.json:
        print_json({"number": event.id, **event_json(event)})
        return 0
    print_rows(line_rows(event, start_of(log.events), words_of(log), glyphs_for(), width()))
    for key, value in event_json(event).items():
        if key not in ("time", "text", "id") and value not in ("", [], {}, None):
            print_text(json.dumps(value, ensure_ascii=False), f"{key}: ")
    return 0


def _next(log: Log, arguments: Namespace) -> int:
    number = next_problem(log.events, arguments.next)
    if arguments.json:
        print_json({"number": number})
    elif number is None:
        print_text(f"Nothing went wrong after event {arguments.next}.")
    else:
        print_rows(
            line_rows(
                _event(log, number), start_of(log.events), words_of(log), glyphs_for(), width()
            )
        )
        print_text(f"After it: --next {number}; what led to it: --chain {number}.")
    return 0


def _chain(log: Log, arguments: Namespace) -> int:
    event = _event(log, arguments.chain)
    found = chain(log.events, event.id)
    if arguments.json:
        print_json([{"number": e.id, **event_json(e)} for e in found])
    else:
        print_rows(chain_rows(found, log, words_of(log), glyphs_for(), width()))
    return 0


def _expected(log: Log, arguments: Namespace) -> int:
    event = _event(log, arguments.expected)
    found = expectations(log.events, event.id)
    if arguments.json:
        print_json([asdict(x) for x in found])
        return 0
    print_rows(line_rows(event, start_of(log.events), words_of(log), glyphs_for(), width()))
    for line in expected_lines(found, words_of(log), glyphs_for()):
        print_text(line)
    return 0


def _score(log: Log, arguments: Namespace) -> int:
    from polaris_nl.replays import world_of
    from polaris_nl.scoring.score import runtime_score

    world = world_of(log)
    met = runtime_score(log.events, world)
    if met is None:
        raise LogError(f"{log.path} holds no run to score; take the log of a run.")
    count = sum(ok for _, ok in met)
    if arguments.json:
        objectives = [{"name": o.name, "met": ok} for o, ok in met]
        print_json({"met": count, "of": len(met), "objectives": objectives})
    elif not met:
        print_text(f"The world {world.name} has no objectives to count.")
    else:
        print_text(f"{count} of {len(met)} objectives were met when the run was over.")
        for objective, ok in met:
            sign = glyphs_for().good if ok else glyphs_for().bad
            print_text(f"{sign} {plain(objective.name)}")
    return 0 if count == len(met) else 1


def _diff(log: Log, arguments: Namespace) -> int:
    other = read_log(arguments.diff)
    found = compare(log.events, other.events)
    same = not found.steps
    if arguments.json:
        steps = [
            {"sign": s.sign, "line": s.line, "event": s.event.id, "at": round(s.at, 3)}
            for s in found.steps
            if s.sign != "@"
        ]
        print_json(
            {
                "equal": same,
                "diff": steps,
                "slower": [asdict(x) for x in found.slower],
                "seconds": found.seconds,
            }
        )
        return int(not same)
    if same:
        print_text("The two runs did and decided the same.")
    else:
        print_text(log.path.name, "-    ")
        print_text(other.path.name, "+    ")
        for step in found.steps:
            print_rows(step_rows(step, words_of(log), glyphs_for(), width()))
    for slower in found.slower:
        print_text(f"{plain(slower.label)}: {slower.one:.1f} s here, {slower.other:.1f} s there.")
    one, two = found.seconds
    print_text(f"Whole run: {one:.1f} s here, {two:.1f} s there.")
    return int(not same)


def _replay(log: Log, arguments: Namespace) -> int:
    from polaris_nl.replays import replayed

    found = replayed(log.path)
    if arguments.json:
        print_json(
            [
                {
                    "decisions": len(r.decisions),
                    "same": r.difference is None,
                    "differs_at": r.difference.number if r.difference else None,
                }
                for r in found
            ]
        )
    else:
        for one in found:
            print_text(replay_line(one, words_of(log)))
    return 0 if all(r.difference is None for r in found) else 1


def _durations(log: Log, arguments: Namespace) -> int:
    return show_durations(log.path, arguments.json)


def _export(log: Log, arguments: Namespace) -> int:
    found = list(filtered(log.events, matcher(arguments.filter, log.events)))
    values = ({"number": number, **event_json(event)} for number, event in found)
    match arguments.export:
        case "jsonl":
            for value in values:
                print_json(value)
        case "json":
            print_json({"log": log.path.name, "metadata": log.metadata, "events": list(values)})
        case "markdown":
            print(report_markdown(log, words_of(log)))
        case _:
            table = rows([e for _, e in found], start_of(log.events), words_of(log))
            writer = csv.DictWriter(sys.stdout, rows([_NO_EVENT])[0].keys())
            writer.writeheader()
            writer.writerows(table)
    return 0


def _event(log: Log, number: int) -> Event:
    found = next((e for e in log.events if e.id == number), None)
    if found is None:
        raise UsageError(f"There is no event {number}; the log has {len(log.events)}.")
    return found


_NO_EVENT = Event(time=0.0)
VIEWS: Mapping[str, Callable[[Log, Namespace], int]] = {
    "export": _export,
    "diff": _diff,
    "ask": _ask,
    "timeline": _timeline,
    "step": _step,
    "next": _next,
    "chain": _chain,
    "expected": _expected,
    "score": _score,
    "durations": _durations,
    "replay": _replay,
    "events": show_events,
}
"""By the option that asks for each; all give the exit code."""
