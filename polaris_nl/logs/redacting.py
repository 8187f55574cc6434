"""Copies of logs without what people said, or without some words; checked by a search of every byte."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

from mcap.records import Attachment, Channel, Metadata

from polaris_nl.logs import rosout
from polaris_nl.logs.compacting import Compactor
from polaris_nl.logs.finalising import content, written
from polaris_nl.logs.framing import HEAD, MESSAGE, MESSAGE_HEAD, encoded, message
from polaris_nl.logs.paths import part_path, parts_of
from polaris_nl.logs.privacy import Privacy
from polaris_nl.logs.salvage import Gap, Piece, pieces
from polaris_nl.logs.schema import event_json, event_of
from polaris_nl.model.errors import LogError

AUDIO = "audio/"


@dataclass(frozen=True, slots=True)
class Redacted:
    """A redacted copy.

    Attributes:
        path: where it is.
        changed: how many messages and files were changed; left_out: how many were left out.
    """

    path: Path
    changed: int
    left_out: int


def redact(path: Path, target: Path, privacy: Privacy) -> Redacted:
    """Makes a copy of a log without what isn't to be kept.

    Args:
        path: the log, with the parts in which it goes on; they stay as they are.
        target: the copy, or its first part; it must not exist.
        privacy: what isn't kept.

    Raises:
        LogError: the log can't be read, the copy can't be written, or a word to be left out is
            still found in its bytes (the copy is removed then).
    """
    parts = parts_of(path)
    targets = [part_path(target, number) for number in range(1, len(parts) + 1)]
    for one in targets:
        if one.exists():
            raise LogError(f"There is a file {one} already; choose another name with --out.")
    done = [_redact(*pair, privacy) for pair in zip(parts, targets, strict=True)]
    return Redacted(target, sum(d.changed for d in done), sum(d.left_out for d in done))


def _redact(path: Path, target: Path, privacy: Privacy) -> Redacted:
    """The same for one file."""
    redaction = _Redaction(privacy)
    try:
        with content(path) as data, written(target) as out:
            compactor = Compactor(out)
            compactor.take(redaction.over(pieces(data)))
            compactor.finish()
    except OSError as error:
        raise LogError(f"Can't write {target}: {error.strerror}.") from error
    left = found_words(target, privacy.never)
    if left:
        target.unlink()
        raise LogError(
            f"The copy still held {', '.join(left)}, so it was removed; please report this."
        )
    return Redacted(target, redaction.changed, redaction.left_out)


def found_words(path: Path, words: Iterable[str]) -> list[str]:
    """Which words stand anywhere in a log: in its bytes, and in what is compressed in it."""
    privacy = [Privacy(never=(word,)) for word in words]
    if not privacy:
        return []
    found: set[str] = set()
    with content(path) as data:
        found |= {p.never[0] for p in privacy if p.in_bytes(data[:])}
        for piece in pieces(data):
            if isinstance(piece, Piece):
                body = piece.whole
                found |= {p.never[0] for p in privacy if p.in_bytes(body)}
    return sorted(found)


class _Redaction:
    def __init__(self, privacy: Privacy) -> None:
        self._privacy = privacy
        self._topics: dict[int, str] = {}
        self.changed = self.left_out = 0

    def over(self, found: Iterable[Piece | Gap]) -> Iterator[Piece | Gap]:
        for piece in found:
            if isinstance(piece, Gap):
                yield piece
            elif piece.opcode == MESSAGE:
                data = self._message(piece)
                if data is not None:
                    yield data
            else:
                other = self._other(piece)
                if other is not None:
                    yield other

    def _other(self, piece: Piece) -> Piece | None:
        record = piece.decoded()
        if isinstance(record, Channel):
            self._topics[record.id] = record.topic
        elif isinstance(record, Attachment):
            if record.media_type.startswith(AUDIO):
                if not self._privacy.sound:
                    self.left_out += 1
                    return None
                return piece
            if self._privacy.in_bytes(record.data) or self._privacy.in_bytes(record.name.encode()):
                self.changed += 1
                text = record.data.decode("utf-8", "replace")
                record.data = self._privacy.of_text(record.name, text).encode()
                record.name = self._privacy.of_value(record.name)
                return _piece(encoded(record))
        elif isinstance(record, Metadata):
            values = {**record.metadata, "left_out": self._privacy.words}
            record.metadata = self._privacy.of_value(values)
            return _piece(encoded(record))
        return piece

    def _message(self, piece: Piece) -> Piece | None:
        channel = int.from_bytes(piece.data[piece.start : piece.start + 2], "little")
        topic = self._topics.get(channel, "")
        body = piece.body
        time = int.from_bytes(body[6:14], "little")
        sequence = int.from_bytes(body[2:6], "little")
        data = body[MESSAGE_HEAD:]
        if topic == rosout.TOPIC:
            return self._said(piece, channel, sequence, time, data)
        try:
            value = json.loads(data) if data[:1] == b"{" else None
        except ValueError:
            value = None
        event = event_of(topic, value) if isinstance(value, dict) else None
        if event is None:
            if self._privacy.in_bytes(data):
                self.left_out += 1  # A message of another kind can't be changed, only left out.
                return None
            return piece
        kept = self._privacy.of_event(event)
        new = json.dumps(event_json(kept), ensure_ascii=False, separators=(",", ":"))
        if kept == event:
            return piece
        self.changed += 1
        return _piece(message(channel, sequence, time, new.encode("utf-8", "backslashreplace")))

    def _said(self, piece: Piece, channel: int, sequence: int, time: int, data: bytes) -> Piece:
        """A line for ROS tools."""
        level, text, kind = rosout.parsed(data)
        kept = self._privacy.of_line(kind, text)
        if kept == text:
            return piece
        self.changed += 1
        return _piece(message(channel, sequence, time, rosout.encoded(time, level, kept, kind)))


def _piece(record: bytes) -> Piece:
    return Piece(record[0], record, HEAD, len(record))
