"""Makes compressed, indexed files of records: what a journal becomes when it is closed.

The events of a run are kept apart from what is many (the robot's own messages, the executor's inputs), in
chunks of their own, so that a reader of the story never unpacks the rest. The index lists the ROS schemas
before the channels and the others behind them: `rosbags` gives up at the first schema that is no ROS
one, but looks a channel's schema up as it meets the channel. Readers that know JSON Schema collect the index
first and see no difference.
"""

from __future__ import annotations

import struct
import zlib
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import IO

import zstandard
from mcap.opcode import Opcode
from mcap.records import (
    Attachment,
    AttachmentIndex,
    Channel,
    Chunk,
    ChunkIndex,
    DataEnd,
    Header,
    McapRecord,
    Metadata,
    MetadataIndex,
    Schema,
    Statistics,
)

from polaris_nl.logs.framing import HEAD, MAGIC, MESSAGE, encoded, index_end
from polaris_nl.logs.keeping import ABOUT
from polaris_nl.logs.salvage import Gap, Piece

CHUNK_BYTES = 1 << 20
LEVEL = 1
"""Of compression: a journal shrinks about as much at the others, and takes much longer."""
STORY = "/polaris/"
"""Topics of events begin with this."""
NOT_STORY = ("/polaris/inputs", "/polaris/ros/")

_MESSAGE = struct.Struct("<HIQ")
_INDEX = struct.Struct("<BQHI")


def is_story(topic: str) -> bool:
    """Whether a topic's messages are events of a run."""
    return topic.startswith(STORY) and not topic.startswith(NOT_STORY)


@dataclass
class _Pile:
    """The chunk that is being filled."""

    data: bytearray = field(default_factory=bytearray)
    index: dict[int, list[int]] = field(default_factory=dict)


class Compactor:
    """Writes a compressed, indexed file.

    Args:
        out: the file, open for writing, empty.

    Attributes:
        messages: how many it has so far.
        about: what the log says about itself.
        gaps: what was missing in the source.
        complete: whether the source had its end.
    """

    def __init__(self, out: IO[bytes]) -> None:
        self._out = out
        self._at = 0
        self._started = False
        self._schemas: dict[int, Schema] = {}
        self._channels: dict[int, Channel] = {}
        self._piles = {True: _Pile(), False: _Pile()}
        self._pile_of: dict[int, _Pile] = {}
        self._chunks: list[ChunkIndex] = []
        self._files: list[McapRecord] = []
        self._counts: Counter[int] = Counter()
        self._compress = zstandard.ZstdCompressor(level=LEVEL).compress
        self.about: dict[str, str] = {}
        self.gaps: list[Gap] = []
        self.complete = False

    @property
    def messages(self) -> int:
        """How many messages it has."""
        return self._counts.total()

    def take(self, found: Iterable[Piece | Gap]) -> None:
        """Takes records over, from a journal or another file."""
        piles, unpack = self._pile_of, _MESSAGE.unpack_from
        for piece in found:
            if isinstance(piece, Gap):
                self.gaps.append(piece)
            elif piece.opcode != MESSAGE:
                self._take_other(piece)
            else:
                channel, _, time = unpack(piece.data, piece.start)
                pile = piles.get(channel)
                if pile is None:
                    continue
                index = pile.index.get(channel)
                if index is None:
                    index = pile.index[channel] = []
                index += (time, len(pile.data))
                pile.data += piece.data[piece.start - HEAD : piece.stop]
                if len(pile.data) >= CHUNK_BYTES:
                    self._write_chunk(pile)

    def finish(self) -> None:
        """Writes what is left, and the index."""
        for pile in self._piles.values():
            self._write_chunk(pile)
        self._start(Header("ros2", "polaris-nl"))
        self._write(encoded(DataEnd(0)))
        index = b"".join(map(encoded, self._summary()))
        self._write(index + index_end(index, self._at) + MAGIC)

    def _summary(self) -> Iterable[McapRecord]:
        schemas = [s for s in self._schemas.values() if s.encoding == "ros2msg"]
        others = [s for s in self._schemas.values() if s.encoding != "ros2msg"]
        yield from (*schemas, *self._channels.values(), *others)
        yield Statistics(
            attachment_count=sum(isinstance(x, AttachmentIndex) for x in self._files),
            channel_count=len(self._channels),
            channel_message_counts=dict(self._counts),
            chunk_count=len(self._chunks),
            message_count=self.messages,
            message_end_time=max((c.message_end_time for c in self._chunks), default=0),
            message_start_time=min((c.message_start_time for c in self._chunks), default=0),
            metadata_count=sum(isinstance(x, MetadataIndex) for x in self._files),
            schema_count=len(self._schemas),
        )
        yield from (*self._chunks, *self._files)

    def _take_other(self, piece: Piece) -> None:
        record = piece.decoded()
        if isinstance(record, Header):
            self._start(record)
            return
        if piece.opcode == Opcode.FOOTER:
            self.complete = True
            return
        self._start(Header("ros2", "polaris-nl"))
        at = self._at
        if isinstance(record, Schema):
            if record.id not in self._schemas:
                self._schemas[record.id] = record
                self._write(piece.whole)
        elif isinstance(record, Channel):
            if record.id not in self._channels:
                self._channels[record.id] = record
                self._pile_of[record.id] = self._piles[is_story(record.topic)]
                self._write(piece.whole)
        elif isinstance(record, Attachment):
            self._write(encoded(record))
            self._files.append(
                AttachmentIndex(
                    offset=at,
                    length=self._at - at,
                    log_time=record.log_time,
                    create_time=record.create_time,
                    data_size=len(record.data),
                    name=record.name,
                    media_type=record.media_type,
                )
            )
        elif isinstance(record, Metadata):
            self.about |= record.metadata if record.name == ABOUT else {}
            self._write(encoded(record))
            self._files.append(MetadataIndex(at, self._at - at, record.name))

    def _start(self, header: Header) -> None:
        if not self._started:
            self._started = True
            self._write(MAGIC + encoded(header))

    def _write_chunk(self, pile: _Pile) -> None:
        if not pile.index:
            return
        data = bytes(pile.data)
        times = [time for index in pile.index.values() for time in index[::2]]
        packed = self._compress(data)
        chunk = Chunk("zstd", packed, max(times), min(times), zlib.crc32(data), len(data))
        start = self._at
        self._write(encoded(chunk))
        length, offsets = self._at - start, {}
        for channel, index in pile.index.items():
            offsets[channel] = self._at
            self._counts[channel] += len(index) // 2
            size = 8 * len(index)
            head = _INDEX.pack(int(Opcode.MESSAGE_INDEX), size + 6, channel, size)
            self._write(head + struct.pack(f"<{len(index)}Q", *index))
        self._chunks.append(
            ChunkIndex(
                chunk_length=length,
                chunk_start_offset=start,
                compression="zstd",
                compressed_size=len(packed),
                message_end_time=chunk.message_end_time,
                message_index_length=self._at - start - length,
                message_index_offsets=offsets,
                message_start_time=chunk.message_start_time,
                uncompressed_size=len(data),
            )
        )
        pile.data.clear()
        pile.index.clear()

    def _write(self, data: bytes) -> None:
        self._out.write(data)
        self._at += len(data)
