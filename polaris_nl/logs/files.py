"""One file of a log, open for reading: by its index, a page at a time, or from end to end where it has none."""

from __future__ import annotations

import json
from bisect import bisect_right
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import ExitStack
from functools import lru_cache
from pathlib import Path
from types import TracebackType
from typing import Any

from mcap.opcode import Opcode
from mcap.records import (
    Attachment,
    AttachmentIndex,
    Channel,
    Chunk,
    ChunkIndex,
    McapRecord,
    Metadata,
    MetadataIndex,
    Statistics,
)

from polaris_nl.execution.events import Event, Stepped
from polaris_nl.logs.compacting import is_story
from polaris_nl.logs.finalising import content
from polaris_nl.logs.framing import HEAD, MESSAGE, MESSAGE_HEAD
from polaris_nl.logs.keeping import ABOUT, CUT_OFF
from polaris_nl.logs.recovery import missing
from polaris_nl.logs.salvage import Gap, Piece, index_records, pieces, unpacked
from polaris_nl.logs.schema import event_of

AUDIO = "audio/"
_NUMBER = int.from_bytes


def open_log(path: Path) -> LogFile:
    """Opens one file of a log for reading by pages.

    Raises:
        LogError: the file can't be read, or is no log.
    """
    stack = ExitStack()
    try:
        data = stack.enter_context(content(path))
        index = index_records(data)
        if any(isinstance(record, Statistics) for record in index):
            return _Indexed(path, data, index, stack)
        return _Walked(path, data, stack)
    except BaseException:
        stack.close()
        raise


class LogFile:
    """An open log file.

    Attributes:
        complete: False where it is cut off or damaged, as far as is known without reading all of it.
        missing: what is missing then.
    """

    complete = True
    missing = ""

    def __init__(self, path: Path, stack: ExitStack) -> None:
        self.path = path
        self._stack = stack

    def __enter__(self) -> LogFile:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._stack.close()

    def __len__(self) -> int:
        """How many events it has."""
        raise NotImplementedError

    def events(self, start: int = 0, stop: int | None = None) -> Iterator[Event]:
        """Events in their order, from one place in the file to another, both counted from 0."""
        raise NotImplementedError

    def inputs(self) -> Iterator[Stepped]:
        """What the executor's steps were given."""
        raise NotImplementedError

    def attachments(self) -> Iterator[tuple[str, str | bytes]]:
        """Names and contents: texts, and sounds as bytes."""
        raise NotImplementedError

    def metadata(self) -> dict[str, str]:
        """What the log says about itself."""
        raise NotImplementedError

    def topics(self) -> dict[str, int]:
        """How many messages there are of each topic."""
        raise NotImplementedError


class _Indexed(LogFile):
    """A finished file, of which only what is asked for is read."""

    def __init__(
        self, path: Path, data: Any, index: Sequence[McapRecord], stack: ExitStack
    ) -> None:
        super().__init__(path, stack)
        self._data = data
        self._index = index
        self._channels = {c.id: c for c in index if isinstance(c, Channel)}
        chunks = [c for c in index if isinstance(c, ChunkIndex)]
        self._story = [c for c in chunks if self._of(c, is_story)]
        self._others = [c for c in chunks if self._of(c, lambda t: t == Stepped.topic)]
        self._ends: list[int] = []
        for chunk in self._story:
            count = sum(
                _NUMBER(data[at + HEAD + 2 : at + HEAD + 6], "little") // 16
                for channel, at in chunk.message_index_offsets.items()
                if is_story(self._topic(channel))
            )
            self._ends.append((self._ends[-1] if self._ends else 0) + count)
        self._unpacked = lru_cache(4)(self._unpack)

    def __len__(self) -> int:
        return self._ends[-1] if self._ends else 0

    def events(self, start: int = 0, stop: int | None = None) -> Iterator[Event]:
        stop = len(self) if stop is None else min(stop, len(self))
        at = bisect_right(self._ends, start)
        begun = self._ends[at - 1] if at else 0
        while at < len(self._story) and begun < stop:
            data = self._unpacked(self._story[at].chunk_start_offset)
            if data is None:
                self.complete = False
                self.missing = missing([Gap(self._story[at].chunk_start_offset, 0)], True)
            else:
                first, last = max(start - begun, 0), stop - begun
                yield from self._events_in(data, is_story, first, last)
            begun = self._ends[at]
            at += 1

    def inputs(self) -> Iterator[Stepped]:
        for chunk in self._others:
            data = self._unpacked(chunk.chunk_start_offset) or b""
            for event in self._events_in(data, lambda t: t == Stepped.topic, 0, len(data)):
                if isinstance(event, Stepped):
                    yield event

    def attachments(self) -> Iterator[tuple[str, str | bytes]]:
        for entry in self._index:
            if isinstance(entry, AttachmentIndex):
                record = self._record(entry.offset, entry.length)
                if isinstance(record, Attachment):
                    yield record.name, _text(record)

    def metadata(self) -> dict[str, str]:
        found: dict[str, str] = {}
        for entry in self._index:
            if isinstance(entry, MetadataIndex) and entry.name == ABOUT:
                record = self._record(entry.offset, entry.length)
                found |= record.metadata if isinstance(record, Metadata) else {}
        return found

    def topics(self) -> dict[str, int]:
        counts = next(x for x in self._index if isinstance(x, Statistics)).channel_message_counts
        return {self._topic(channel): count for channel, count in counts.items()}

    def _events_in(
        self, data: bytes, wanted: Callable[[str], bool], first: int, last: int
    ) -> Iterator[Event]:
        at, number = 0, -1
        while at + HEAD <= len(data) and number < last:
            stop = at + HEAD + _NUMBER(data[at + 1 : at + HEAD], "little")
            if data[at] == MESSAGE:
                topic = self._topic(_NUMBER(data[at + HEAD : at + HEAD + 2], "little"))
                if wanted(topic):
                    number += 1
                    if first <= number < last:
                        event = _event(topic, data[at + HEAD + MESSAGE_HEAD : stop])
                        if event is not None:
                            yield event
            at = stop

    def _unpack(self, offset: int) -> bytes | None:
        length = HEAD + _NUMBER(self._data[offset + 1 : offset + HEAD], "little")
        record = self._record(offset, length)
        return unpacked(record) if isinstance(record, Chunk) else None

    def _record(self, offset: int, length: int) -> McapRecord | None:
        piece = Piece(self._data[offset], self._data, offset + HEAD, offset + length)
        return piece.decoded()

    def _topic(self, channel: int) -> str:
        found = self._channels.get(channel)
        return found.topic if found and found.message_encoding == "json" else ""

    def _of(self, chunk: ChunkIndex, wanted: Callable[[str], bool]) -> bool:
        return any(wanted(self._topic(c)) for c in chunk.message_index_offsets)


class _Walked(LogFile):
    """A file without an index, read from end to end."""

    def __init__(self, path: Path, data: Any, stack: ExitStack) -> None:
        super().__init__(path, stack)
        self._events: list[Event] = []
        self._inputs: list[Stepped] = []
        self._attachments: list[Attachment] = []
        self._metadata: dict[str, str] = {}
        self._topics: dict[str, int] = {}
        self._take(pieces(data))

    def _take(self, found: Iterable[Piece | Gap]) -> None:
        topics: dict[int, tuple[str, bool]] = {}
        gaps, complete = [], False
        for piece in found:
            if isinstance(piece, Gap):
                gaps.append(piece)
            elif piece.opcode == MESSAGE:
                channel = _NUMBER(piece.data[piece.start : piece.start + 2], "little")
                topic, readable = topics.get(channel, ("", False))
                self._topics[topic] = self._topics.get(topic, 0) + 1
                event = _event(topic, piece.body[MESSAGE_HEAD:]) if readable else None
                if isinstance(event, Stepped):
                    self._inputs.append(event)
                elif event is not None:
                    self._events.append(event)
            elif piece.opcode == Opcode.FOOTER:
                complete = True
            else:
                record = piece.decoded()
                if isinstance(record, Channel):
                    topics[record.id] = record.topic, record.message_encoding == "json"
                elif isinstance(record, Attachment):
                    self._attachments.append(record)
                elif isinstance(record, Metadata) and record.name == ABOUT:
                    self._metadata |= record.metadata
        self.complete = complete and not gaps
        self.missing = missing(gaps, complete, self._metadata.get(CUT_OFF, ""))

    def __len__(self) -> int:
        return len(self._events)

    def events(self, start: int = 0, stop: int | None = None) -> Iterator[Event]:
        return iter(self._events[start:stop])

    def inputs(self) -> Iterator[Stepped]:
        return iter(self._inputs)

    def attachments(self) -> Iterator[tuple[str, str | bytes]]:
        return ((x.name, _text(x)) for x in self._attachments)

    def metadata(self) -> dict[str, str]:
        return self._metadata

    def topics(self) -> dict[str, int]:
        return self._topics


def _text(record: Attachment) -> str | bytes:
    sound = record.media_type.startswith(AUDIO)
    return record.data if sound else record.data.decode("utf-8", "replace")


def _event(topic: str, data: bytes) -> Event | None:
    try:
        value = json.loads(data)
    except (ValueError, RecursionError):
        return None
    return event_of(topic, value) if isinstance(value, dict) else None
