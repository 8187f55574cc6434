"""A log on the screen: its events, and what there is to see at one of them."""

from __future__ import annotations

from collections.abc import Iterable

from polaris_nl.execution.events import Event, Heard, Observed, Planned, RunStarted
from polaris_nl.model.formula import Literal, parse_formula
from polaris_nl.model.text import listed, sentence
from polaris_nl.render.layout import Row, cut, wrapped
from polaris_nl.render.log import event_rows
from polaris_tui.panels import expectation_rows, way_rows
from polaris_tui.scene import Reading, Scene

EVENT = "event"
"""What the rows of events are about, so that the cursor stays with them."""


def review_heading(scene: Scene) -> str:
    """The log's name, and its filter."""
    reading = scene.reading
    if reading is None:
        return "Review"
    words = f", only: {reading.words}" if reading.words else ""
    cut_off = "" if reading.replay.complete else ", cut off"
    return f"Log {reading.replay.path.name}{cut_off}{words}"


def review_rows(scene: Scene, width: int) -> list[Row]:
    """The events that the filter lets through; the row of each carries its number."""
    reading = scene.reading
    if reading is None:
        return wrapped('No log is open; "l" opens one.', width, tone="faint")
    shown = reading.replay.shown(reading.words)
    if not shown:
        return wrapped(
            f"No event matches {reading.words}; / with fewer words.", width, tone="faint"
        )
    return [row for number in shown for row in _event(reading, number, scene, width)]


def _event(reading: Reading, number: int, scene: Scene, width: int) -> list[Row]:
    event = reading.replay.events[number - 1]
    # One row an event; what is cut off stands below in full.
    seconds, text = event.time - start(reading), text_of(event, scene)
    (row, *_) = event_rows(seconds, event.severity, text, scene.glyphs, 100_000, number)
    return [Row(cut(row.text, width, scene.glyphs.more), row.tone, EVENT, number)]


def start(reading: Reading) -> float:
    """The time that others count from: the run's begin, what was said for it comes before; else the first."""
    events = reading.replay.events
    begun = next((e for e in events if isinstance(e, RunStarted)), None)
    return begun.time if begun is not None else events[0].time if events else 0.0


def text_of(event: Event, scene: Scene) -> str:
    """What an event says; what it is where it says nothing."""
    if event.text:
        return event.text
    if isinstance(event, Heard):
        way = "Heard" if event.source == "voice" else "Typed"
        return f"{way}: {event.utterance}"
    if isinstance(event, Planned):
        return f"The plan is {event.status}."
    if isinstance(event, Observed):
        facts = [*_facts(event.added), *(x.negation for x in _facts(event.removed))]
        return sentence(f"seen: {listed([scene.wording.fact(x) for x in facts])}")
    return type(event).__name__


def _facts(texts: Iterable[str]) -> list[Literal]:
    return [x for text in texts if isinstance(x := parse_formula(text), Literal)]


def detail_heading(scene: Scene) -> str:
    """What stands above the details."""
    reading = scene.reading
    titles = {
        "event": "Event",
        "compare": "Expected and perceived at event",
        "chain": "What led to event",
    }
    return f"{titles[reading.below]} {reading.number}" if reading else ""


def detail_rows(scene: Scene, width: int) -> list[Row]:
    """An event in full, what was expected and perceived then, or what led to it."""
    reading = scene.reading
    if reading is None or not reading.replay.events:
        return []
    event = reading.replay.events[reading.number - 1]
    seconds = event.time - start(reading)
    if reading.below == "chain":
        return [
            row
            for number in reading.replay.chain(reading.number)
            for row in _event(reading, number, scene, width)
        ]
    rows = wrapped(text_of(event, scene), width, f"{seconds:.1f} s: ", "  ", "strong")
    if reading.below == "compare":
        return [*rows, *_compared(scene, reading, width)]
    return [*rows, *way_rows(scene, scene.progress, width), *_fields(event, scene, width)]


def _compared(scene: Scene, reading: Reading, width: int) -> list[Row]:
    rows = expectation_rows(scene, scene.progress, width)
    known = {*scene.progress.expected, *scene.progress.missed}
    for literal, holds in reading.replay.differences(reading.number):
        if literal not in known:
            sign = f"{scene.glyphs.good} yes" if holds else f"{scene.glyphs.bad} no"
            rows += wrapped(f"{scene.wording.fact(literal)}: {sign}", width)
    return rows or wrapped("Nothing was expected at that moment.", width)


def _fields(event: Event, scene: Scene, width: int) -> list[Row]:
    """What became true and false, in words, where the event says so."""
    rows: list[Row] = []
    for name, lead in (("added", "Now: "), ("removed", "No longer: "), ("observed", "Seen: ")):
        said = [scene.wording.fact(x) for x in _facts(getattr(event, name, ()))]
        rows += wrapped("; ".join(said), width, lead) if said else []
    return rows
