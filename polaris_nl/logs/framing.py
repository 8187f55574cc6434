"""MCAP records as bytes: what `mcap` has for whole files, in the pieces that journals and repairs need.

Layout after the MCAP specification 0 (https://mcap.dev/spec): an operation code of one byte, the length
of the body in eight, the body.
"""

from __future__ import annotations

import io
import struct
import zlib
from collections.abc import Mapping

from mcap.data_stream import ReadDataStream, RecordBuilder
from mcap.opcode import Opcode
from mcap.records import (
    Attachment,
    AttachmentIndex,
    Channel,
    Chunk,
    ChunkIndex,
    DataEnd,
    Footer,
    Header,
    McapRecord,
    Metadata,
    MetadataIndex,
    Schema,
    Statistics,
)

MAGIC = b"\x89MCAP0\r\n"
HEAD = 9
"""Bytes before the body of a record."""
OPCODES = frozenset(int(code) for code in Opcode)
MESSAGE, CHUNK = int(Opcode.MESSAGE), int(Opcode.CHUNK)
MESSAGE_HEAD = 22
"""Bytes of a message's body before its data."""

_KINDS: Mapping[int, type[McapRecord]] = {
    int(Opcode.HEADER): Header,
    int(Opcode.FOOTER): Footer,
    int(Opcode.SCHEMA): Schema,
    int(Opcode.CHANNEL): Channel,
    int(Opcode.CHUNK): Chunk,
    int(Opcode.CHUNK_INDEX): ChunkIndex,
    int(Opcode.ATTACHMENT): Attachment,
    int(Opcode.ATTACHMENT_INDEX): AttachmentIndex,
    int(Opcode.STATISTICS): Statistics,
    int(Opcode.METADATA): Metadata,
    int(Opcode.METADATA_INDEX): MetadataIndex,
    int(Opcode.DATA_END): DataEnd,
}
_MESSAGE = struct.Struct("<BQHIQQ")


def encoded(record: McapRecord) -> bytes:
    """A record as bytes."""
    builder = RecordBuilder()
    record.write(builder)
    return bytes(builder.end())  # type: ignore[no-untyped-call] # mcap leaves it out


def decoded(opcode: int, body: bytes) -> McapRecord | None:
    """A record from its body; None for messages, message indexes and what isn't known.

    Raises:
        Exception: of many kinds, where the body is damaged.
    """
    kind = _KINDS.get(opcode)
    if kind is None:
        return None
    found: McapRecord = kind.read(ReadDataStream(io.BytesIO(body)))  # type: ignore[attr-defined] # each kind has its own read
    return found


def message(channel: int, sequence: int, nanoseconds: int, data: bytes) -> bytes:
    """A message record."""
    size = MESSAGE_HEAD + len(data)
    return _MESSAGE.pack(MESSAGE, size, channel, sequence, nanoseconds, nanoseconds) + data


def index_end(index: bytes, start: int) -> bytes:
    """The footer that follows an index, with its checksum.

    Args:
        index: its records.
        start: where it begins in the file.
    """
    footer = encoded(Footer(start, 0, 0))
    return encoded(Footer(start, 0, zlib.crc32(footer[:-4], zlib.crc32(index))))


END = encoded(DataEnd(0)) + encoded(Footer(0, 0, 0)) + MAGIC
"""What ends a file without an index."""
