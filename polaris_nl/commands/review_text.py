"""What `review` says, as lines."""

from __future__ import annotations

import time
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

from polaris_nl.execution.events import CommandGiven, Event, Heard, Planned, Understood
from polaris_nl.logs.diagnosis import Diagnosis, diagnoses
from polaris_nl.logs.expected import Expectation
from polaris_nl.logs.filters import start_of
from polaris_nl.logs.reader import Log
from polaris_nl.logs.review import Summary, summary
from polaris_nl.logs.sayings import fact, said
from polaris_nl.logs.spans import spans
from polaris_nl.model.text import listed, sentence
from polaris_nl.model.wording import Wording
from polaris_nl.render.glyphs import ASCII, Glyphs, plain
from polaris_nl.render.layout import Row
from polaris_nl.render.log import event_rows
from polaris_nl.render.run_timeline import timeline_rows

if TYPE_CHECKING:
    from polaris_nl.replays import Replayed

REPORT_WIDTH = 96


def summary_lines(log: Log, wording: Wording | None = None) -> list[str]:
    """A log in a few sentences: what was asked, understood, planned and done, and what went wrong."""
    short = summary(log.events)
    lines = [_heading(log, short)]
    for event in log.events:
        if isinstance(event, Heard):
            lines.append(f'{_who(event)}: "{plain(event.utterance)}"')
        elif isinstance(event, Understood) and event.text:
            lines.append(f"Answer: {event.text}")
    return [*lines, *run_lines(log, short, wording)]


def _heading(log: Log, short: Summary) -> str:
    parts = [log.path.name]
    if short.started:
        parts.append(time.strftime("%a %d %b %Y, %H:%M", time.localtime(short.started)))
    if short.robot:
        parts.append(f"robot: {short.robot}")
    if log.metadata.get("version"):
        parts.append(f"polaris-nl {log.metadata['version']}")
    if log.metadata.get("left_out"):
        parts.append(f"without {log.metadata['left_out']}")
    return f"{'; '.join(parts)}."


def _who(event: Heard) -> str:
    return "Typed" if event.source == "typed" else "Heard"


def run_lines(log: Log, short: Summary, wording: Wording | None = None) -> list[str]:
    """What the run of a log did, and what went wrong in it."""
    lines: list[str] = []
    planned = next((e for e in reversed(log.events) if isinstance(e, Planned)), None)
    if planned is not None:
        lines.append(said(planned))
        lines += [f"Not planned: {p['text']}" for p in planned.plan.get("problems", ())[:3]]
    if short.goals_sent:
        count = f"{short.goals_done} of {short.goals_sent} actions that were begun"
        reached = f" It reached {listed(short.checkpoints)}." if short.checkpoints else ""
        lines.append(f"Done: {count}, in {short.seconds:.0f} s.{reached}")
    lines += [f"Waited: {text}" for text in short.waited]
    lines += [f"Decided: {text}" for text in short.transitions]
    commands = [said(e, wording) for e in log.events if isinstance(e, CommandGiven)]
    lines += [f"Commanded: {text}" for text in commands]
    lines += [_problem_line(d) for d in diagnoses(log.events)]
    if short.outcome:
        lines.append(
            f"End: {short.outcome}, after {short.seconds:.0f} s. {_reason(log, short)}".strip()
        )
    if not log.complete:
        lines.append(f"The file is not whole. {log.missing}")
    return lines


def _reason(log: Log, short: Summary) -> str:
    """Why the run ended, unless that has been said as what went wrong."""
    told = {d.what for d in diagnoses(log.events)}
    return "" if short.reason in told else short.reason


def _problem_line(found: Diagnosis) -> str:
    lead = "Mended" if found.mended else "Problem"
    return f"{lead} (event {found.number}): {found.what} {found.why}".rstrip()


def line_rows(
    event: Event, start: float, wording: Wording | None, glyphs: Glyphs, width: int
) -> list[Row]:
    """An event as rows: number, time since the start, and what it says."""
    text = said(event, wording)
    return event_rows(event.time - start, event.severity, text, glyphs, width, event.id)


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
    lines = []
    for one in found:
        expected = f"Expected: {fact(one.literal, wording)}."
        if one.stale:
            seen = f"{glyphs.bad} It had not been seen for a while."
        elif one.holds:
            seen = f"{glyphs.good} So it was."
        elif one.instead:
            seen = f"{glyphs.bad} Seen: {listed([fact(x, wording) for x in one.instead])}."
        else:
            seen = f"{glyphs.bad} It was not so."
        lines.append(f"{expected} {seen}")
    return lines


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
    lines += [f"- {_escaped(line)}" for line in run_lines(log, short, wording)]
    lines += ["", "## Timeline", "", "```text"]
    lines += [row.text for row in timeline_rows(spans(log.events), ASCII, REPORT_WIDTH)]
    lines += ["```", "", "## Events", "", "| number | s | what |", "|---:|---:|---|"]
    told = [e for e in log.events if e.severity != "debug" and said(e)]
    lines += [f"| {e.id} | {e.time - start:.1f} | {_escaped(said(e, wording))} |" for e in told]
    if not wrong:
        lines += ["", "Nothing went wrong."]
    return "\n".join(lines)


def _escaped(text: str) -> str:
    """Text that means nothing to Markdown."""
    text = plain(text)
    for sign in "\\`*_<>|[]#":
        text = text.replace(sign, f"\\{sign}")
    return text
