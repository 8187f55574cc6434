"""What `review` says, as lines."""

from __future__ import annotations

import time
from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from polaris_nl.execution.events import CommandGiven, Event, Heard, Planned, RunStarted, Understood
from polaris_nl.logs.comparing import Step
from polaris_nl.logs.diagnosis import Diagnosis, diagnoses
from polaris_nl.logs.expected import Expectation
from polaris_nl.logs.filters import start_of
from polaris_nl.logs.keeping import PROGRAM_TEXT
from polaris_nl.logs.reader import Log
from polaris_nl.logs.review import Summary, summary
from polaris_nl.logs.runs_in import runs_in
from polaris_nl.logs.sayings import facts, said
from polaris_nl.logs.spans import spans
from polaris_nl.logs.whats import expectation_text
from polaris_nl.model.text import listed, sentence
from polaris_nl.model.wording import Wording
from polaris_nl.render.glyphs import ASCII, Glyphs, plain
from polaris_nl.render.layout import Row
from polaris_nl.render.log import event_rows
from polaris_nl.render.run_timeline import timeline_rows

if TYPE_CHECKING:
    from polaris_nl.replays import Replayed

REPORT_WIDTH = 96
_WORDS, _MANY = 24, 8
"""So many lines about words, and about each other thing, are shown of a long log."""


def summary_lines(log: Log, wording: Wording | None = None) -> list[str]:
    """A log in a few sentences: what was asked, understood, planned and done, and what went wrong."""
    short = summary(log.events)
    words = []
    for event in log.events:
        if isinstance(event, Heard):
            words.append(f'{_who(event)}: "{plain(event.utterance)}"')
        elif isinstance(event, Understood) and event.text:
            words.append(f"Answer: {event.text}")
    if len(words) > _WORDS:
        left = (
            f"{len(words) - _WORDS} lines more were said before; --filter topic=heard lists them."
        )
        words = [left, *words[-_WORDS:]]
    return [_heading(log, short), *words, *run_lines(log, wording)]


def _heading(log: Log, short: Summary) -> str:
    parts = [log.path.name]
    if short.started:
        parts.append(time.strftime("%a %d %b %Y, %H:%M", time.localtime(short.started)))
    if short.robot:
        parts.append(f"robot: {'simulated world' if short.robot == 'world' else short.robot}")
    if log.metadata.get("version"):
        parts.append(f"polaris-nl {log.metadata['version']}")
    if log.metadata.get("left_out"):
        parts.append(f"without {log.metadata['left_out']}")
    return f"{'; '.join(parts)}."


def _who(event: Heard) -> str:
    return "Typed" if event.source == "typed" else "Heard"


def run_lines(log: Log, wording: Wording | None = None) -> list[str]:
    """What the runs of a log did, and what went wrong in them."""
    lines: list[str] = []
    if PROGRAM_TEXT in log.attachments:
        lines.append(f"Program: {log.attachments[PROGRAM_TEXT]}")
    planned = next((e for e in reversed(log.events) if isinstance(e, Planned)), None)
    if planned is not None:
        lines.append(said(planned))
        lines += [f"Not planned: {p['text']}" for p in planned.plan.get("problems", ())[:3]]
    runs = runs_in(log.events)
    of_runs = {e.id for run in runs for e in run}
    aside = [e for e in log.events if e.id not in of_runs]
    lines += _few([_problem_line(d) for d in diagnoses(aside)])
    for number, run in enumerate(runs, 1):
        if len(runs) > 1:
            at = time.strftime("%H:%M:%S", time.localtime(run[0].time))
            lines.append(f"Run {number} of {len(runs)}, from {at} on:")
        lines += _one_run(run, wording)
    if not log.complete:
        lines.append(f"The file is not whole. {log.missing}")
    return lines


def _one_run(run: Sequence[Event], wording: Wording | None) -> list[str]:
    short, wrong, start = summary(run), diagnoses(run), run[0].time
    lines: list[str] = []
    if short.goals_sent:
        count = f"{short.goals_done} of {short.goals_sent} actions that were begun"
        names = short.checkpoints
        if len(names) > _MANY:
            names = (*names[:_MANY], f"{len(names) - _MANY} more")
        reached = f" It reached {listed(names)}." if names else ""
        lines.append(f"Done: {count}.{reached}")
    waits = [s for s in spans(run) if s.kind == "wait"]
    lines += _few([f"Waited: {s.seconds:.1f} s, {s.label.removeprefix('wait ')}." for s in waits])
    lines += _few([f"Decided: {text}" for text in short.transitions])
    told = [e for e in run if isinstance(e, CommandGiven)]
    lines += _few([_told_line(e, start, wording) for e in told])
    lines += _few([_problem_line(d) for d in wrong])
    if short.outcome:
        reason = short.reason
        for found in wrong:  # It has been said already.
            reason = reason.replace(found.what, "")
        stopped = any(d.kind == "stopped" for d in wrong)
        reason = "" if stopped else reason.strip()
        lines.append(f"End: {short.outcome}, after {short.seconds:.0f} s. {reason}".strip())
    return lines


def _few(lines: list[str]) -> list[str]:
    """The first and the last lines of many."""
    if len(lines) <= _MANY:
        return lines
    left = f"... {len(lines) - _MANY} more of these, then:"
    return [*lines[: _MANY - 2], left, *lines[-2:]]


def more_line(log: Log) -> str:
    """What to look at next."""
    ended = [d.number for d in diagnoses(log.events) if not d.mended and d.kind != "not-understood"]
    if ended:
        last = ended[-1]
        missed = any(e.id == last and getattr(e, "expected", ()) for e in log.events)
        seen = f" --expected {last}," if missed else ""
        return f'More: --ask "why did it end?", --chain {last},{seen} --timeline, --events.'
    if not any(isinstance(e, RunStarted) for e in log.events):
        return 'More: --ask "what was said?", --events, --export markdown.'
    return 'More: --ask "what happened?", --timeline, --events, --export markdown.'


def _told_line(event: CommandGiven, start: float, wording: Wording | None) -> str:
    """A command as it is told the next day: who said what, and when."""
    what = (
        f"that {facts(event.literals, wording)}"
        if event.command == "happened"
        else f"to {event.command}"
    )
    how = f" ({event.source})" if event.source else ""
    return f"Told: {what}, at {event.time - start:.1f} s{how}."


def _problem_line(found: Diagnosis) -> str:
    lead = "Stopped" if found.kind == "stopped" else "Mended" if found.mended else "Problem"
    return f"{lead} (event {found.number}): {found.what} {found.why}".rstrip()


def line_rows(
    event: Event, start: float, wording: Wording | None, glyphs: Glyphs, width: int
) -> list[Row]:
    """An event as rows: number, time since the start, and what it says."""
    text = _told(event, wording)
    return event_rows(event.time - start, event.severity, text, glyphs, width, event.id)


def _told(event: Event, wording: Wording | None) -> str:
    """What an event says; of words, how they came."""
    lead = f"{_who(event)}: " if isinstance(event, Heard) else ""
    return f"{lead}{said(event, wording)}"


def step_rows(step: Step, wording: Wording | None, glyphs: Glyphs, width: int) -> list[Row]:
    """A step of one of two runs, or of both."""
    if step.sign == "@":
        return [Row(glyphs.more, "faint")]
    rows = event_rows(step.at, "info", said(step.event, wording), glyphs, width - 2)
    return [replace(row, text=f"{step.sign} {row.text}") for row in rows]


def chain_rows(
    found: Iterable[Event], log: Log, wording: Wording | None, glyphs: Glyphs, width: int
) -> list[Row]:
    """Events that led to one another, oldest first."""
    start = start_of(log.events)
    return [row for e in found for row in line_rows(e, start, wording, glyphs, width)]


def expected_lines(
    found: Sequence[Expectation], wording: Wording | None, glyphs: Glyphs
) -> list[str]:
    """What was expected beside what was seen."""
    if not found:
        return ["Nothing in particular was expected at that moment."]
    return [
        f"{glyphs.good if one.holds and not one.stale else glyphs.bad} {expectation_text(one, wording)}"
        for one in found
    ]


def replay_line(found: Replayed, wording: Wording | None) -> str:
    """How a replay went."""
    count = len(found.decisions)
    if found.difference is None:
        return f"The replay made the same {count} decisions and reports."
    logged, other = found.difference.logged, found.difference.replayed
    then = sentence(said(logged, wording)) if logged else "the run was over."
    now = sentence(said(other, wording)) if other else "it was over."
    return (
        f"From event {found.difference.number} on the replay went another way. In the log: {then} In the"
        f" replay: {now} The program has changed since, or the log isn't what happened."
    )


def report_markdown(log: Log, wording: Wording | None) -> str:
    """A report of a log, with its timeline drawn, for people."""
    short = summary(log.events)
    wrong = diagnoses(log.events)
    start = start_of(log.events)
    lines = [f"# {plain(log.path.name)}", "", _heading(log, short), "", "## What was said", ""]
    for event in log.events:
        if isinstance(event, Heard):
            lines.append(f"- {_who(event)}: {_escaped(event.utterance)}")
        elif isinstance(event, Understood) and event.text:
            lines.append(f"  - {_escaped(event.text)}")
    lines += ["", "## What happened", ""]
    lines += [f"- {_escaped(line)}" for line in run_lines(log, wording)]
    lines += ["", "## Timeline", "", "```text"]
    for number, run in enumerate(runs_in(log.events)):
        lines += ["", ""] if number else []
        lines += [row.text for row in timeline_rows(spans(run), ASCII, REPORT_WIDTH)]
    lines += ["```", "", "## Events", "", "| number | s | what |", "|---:|---:|---|"]
    told = [e for e in log.events if e.severity != "debug" and said(e)]
    lines += [f"| {e.id} | {e.time - start:.1f} | {_escaped(_told(e, wording))} |" for e in told]
    if not wrong:
        lines += ["", "Nothing went wrong."]
    return "\n".join(lines)


def _escaped(text: str) -> str:
    """Text that means nothing to Markdown."""
    text = plain(text)
    for sign in "\\`*_<>|[]#":
        text = text.replace(sign, f"\\{sign}")
    return text
