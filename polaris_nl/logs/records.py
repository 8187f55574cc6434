"""The files of a log while it is written: events as records, in one journal after the other.

Knows nothing of threads; `logs/writer.py` sees to it that one caller is here at a time.
"""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Mapping
from pathlib import Path

from polaris_nl import __version__
from polaris_nl.execution.events import Event, Stepped
from polaris_nl.logs import rosout
from polaris_nl.logs.journal import Journal
from polaris_nl.logs.keeping import ABOUT, LogSettings, RawKind
from polaris_nl.logs.paths import part_path
from polaris_nl.logs.privacy import KEEP_ALL
from polaris_nl.logs.schema import names_of, schema_of
from polaris_nl.logs.tracing import Tracer

SCHEMA = "polaris-log/1"
_UNCHANGED = {name: getattr(Stepped(time=-1.0), name) for name in names_of(Stepped)}
_encode = json.JSONEncoder(ensure_ascii=False, separators=(",", ":")).encode


class Records:
    """Puts events and other messages into files.

    Args:
        path: the first file; it must not exist.
        attachments: texts that each file begins with, by name.
        settings: how the log is kept.
        retire: is given each journal that is full, or of yesterday, to end, close and compress it.

    Attributes:
        journal: the present one.
        count: how many events were written.
        time: of the last one, in seconds since the epoch.

    Raises:
        OSError: the file can't be made; also of the methods, where they can't write.
    """

    def __init__(
        self,
        path: Path,
        attachments: Mapping[str, str],
        settings: LogSettings,
        retire: Callable[[Journal], None],
    ) -> None:
        self.path = path
        self.count = 0
        self.attachments = settings.privacy.of_attachments(attachments)
        self._settings = settings
        self._retire = retire
        self._tracer = Tracer()
        self.time = 0.0
        self._part, self._until = 1, 0
        if part_path(path, 2).exists():
            raise FileExistsError(part_path(path, 2))  # It would be taken for a part of this log.
        self.journal = self._begin(path)

    def write(self, event: Event) -> None:
        """Writes an event, with its line for ROS tools where it has a text, in one piece."""
        event = self._settings.privacy.of_event(event)
        nanoseconds = max(int(event.time * 1e9), 0)
        value = {name: getattr(event, name) for name in names_of(type(event))}
        self._turn_over(nanoseconds)
        if isinstance(event, Stepped):  # In most steps nothing has changed.
            value = {name: x for name, x in value.items() if x != _UNCHANGED[name]}
        else:
            value["id"], value["causes"] = self._tracer.take(event)
            self.count, self.time = self.count + 1, event.time
        data = _encode(value).encode("utf-8", "backslashreplace")
        journal = self.journal
        channel = journal.channel(event.topic) or self._add_channel(journal, event)
        records = journal.message(channel, self.count, nanoseconds, data)
        if event.text:
            said = rosout.log_message(event, nanoseconds)
            records += journal.message(
                journal.channel(rosout.TOPIC) or 0, self.count, nanoseconds, said
            )
        journal.append(records)

    def write_raw(self, topic: str, kind: RawKind, time: float, data: bytes) -> None:
        """Writes a message that is bytes already."""
        nanoseconds = max(int(time * 1e9), 0)
        self._turn_over(nanoseconds)
        journal = self.journal
        channel = journal.channel(topic) or journal.add_channel(
            topic, kind.message_encoding, kind.name, kind.encoding, kind.definition.encode()
        )
        journal.append(journal.message(channel, self.count, nanoseconds, data))

    @staticmethod
    def _add_channel(journal: Journal, event: Event) -> int:
        schema = schema_of(type(event))
        text = json.dumps(schema).encode()
        return journal.add_channel(event.topic, "json", schema["title"], "jsonschema", text)

    def _turn_over(self, nanoseconds: int) -> None:
        """Goes on in another file where the day is over, or the file is long enough."""
        if nanoseconds < self._until and self.journal.size < self._settings.part_bytes:
            return
        first, self._until = not self._until, _midnight_after(nanoseconds)
        if first:
            return
        self._part += 1
        before, self.journal = self.journal, self._begin(part_path(self.path, self._part))
        self._retire(before)

    def _begin(self, path: Path) -> Journal:
        journal = Journal(path)
        about = {"version": __version__, "schema": SCHEMA, "part": str(self._part)}
        about["first_event"] = str(self.count + 1)
        if self._part > 1:
            about["follows"] = part_path(self.path, self._part - 1).name
        if self._settings.privacy is not KEEP_ALL:
            about["left_out"] = self._settings.privacy.words
        journal.metadata(ABOUT, about)
        for name, text in self.attachments.items():
            kind = "application/json" if name.endswith(".json") else "text/plain"
            journal.attach(name, kind, text.encode())
        definition = rosout.DEFINITION.encode()
        journal.add_channel(rosout.TOPIC, "cdr", rosout.TYPE, "ros2msg", definition)
        return journal


def _midnight_after(nanoseconds: int) -> int:
    """When the day of a time is over, where this computer is, in nanoseconds since the epoch."""
    day = time.localtime(nanoseconds // 10**9)
    return int(time.mktime((*day[:2], day.tm_mday + 1, 0, 0, 0, 0, 0, -1))) * 10**9
