"""Reads logs back as events."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

from mcap.records import Attachment, Channel, DataEnd, Message

from polaris_nl.execution.events import Event
from polaris_nl.logs.recovery import records
from polaris_nl.logs.schema import event_of


@dataclass
class Log:
    """A log as it was read.

    Attributes:
        events: in file order.
        attachments: text by name.
        sounds: recordings by name.
        complete: False where the file is cut off.
    """

    path: Path
    events: list[Event] = field(default_factory=list)
    attachments: dict[str, str] = field(default_factory=dict)
    sounds: dict[str, bytes] = field(default_factory=dict)
    complete: bool = False


def read_log(path: Path) -> Log:
    """Reads a log, whole or cut off.

    Raises:
        LogError: the file can't be read, or is no log.
    """
    log = Log(path)
    topics: dict[int, str] = {}
    for record in records(path):
        if isinstance(record, Channel):
            if record.message_encoding == "json":
                topics[record.id] = record.topic
        elif isinstance(record, Message) and record.channel_id in topics:
            event = _event(topics[record.channel_id], record.data)
            if event is not None:
                log.events.append(event)
        elif isinstance(record, Attachment):
            if record.media_type.startswith("audio/"):
                log.sounds[record.name] = record.data
            else:
                log.attachments[record.name] = record.data.decode("utf-8", "replace")
        elif isinstance(record, DataEnd):
            log.complete = True
    return log


def _event(topic: str, data: bytes) -> Event | None:
    try:
        value = json.loads(data)
    except ValueError:
        return None
    return event_of(topic, value) if isinstance(value, dict) else None


def filtered(events: list[Event], *tests: Callable[[Event], bool]) -> Iterator[tuple[int, Event]]:
    """The events that pass all tests, with their numbers in the log, counted from 1."""
    for number, event in enumerate(events, 1):
        if all(test(event) for test in tests):
            yield number, event
