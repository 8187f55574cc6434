"""Walks through MCAP files of any state: whole, cut off, or damaged in the middle.

Where a record makes no sense, the next place is looked for from which records make sense again, so that
damage costs what it touches and no more.
"""

from __future__ import annotations

import re
import struct
import zlib
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, NamedTuple

import zstandard
from mcap.opcode import Opcode
from mcap.records import Channel, Chunk, Footer, McapRecord

from polaris_nl.logs.framing import CHUNK, HEAD, MAGIC, MESSAGE, MESSAGE_HEAD, OPCODES, decoded

_LENGTH = struct.Struct("<Q")
_CHANNEL = struct.Struct("<H")
_INDEX_START = struct.Struct("<QQI")
_STARTS = re.compile(rb"[\x01-\x0f][\s\S]{4}\0\0\0\0")
"""Where a record may start: an operation code, and a length below 4 GB."""
_FOOTER_SIZE = HEAD + _INDEX_START.size


@dataclass(frozen=True, slots=True)
class Gap:
    """Bytes that no record could be made of.

    Attributes:
        offset: where they begin in the file; of a damaged chunk, where that begins.
        length: how many they are.
        at_end: whether nothing follows: the file is cut off there.
    """

    offset: int
    length: int
    at_end: bool = False


class Piece(NamedTuple):
    """A record, where it is: `data[start:stop]` is its body, the whole of it begins `HEAD` before."""

    opcode: int
    data: Any
    start: int
    stop: int

    @property
    def body(self) -> bytes:
        """The body."""
        return bytes(self.data[self.start : self.stop])

    @property
    def whole(self) -> bytes:
        """The record with its head."""
        return bytes(self.data[self.start - HEAD : self.stop])

    def decoded(self) -> McapRecord | None:
        """The record; None where it is a message, an index of messages, or can't be made out."""
        try:
            return decoded(self.opcode, self.body)
        except Exception:
            return None  # The format's reader raises whatever damaged bytes lead to.


def pieces(data: Any) -> Iterator[Piece | Gap]:
    """All records of a file's data section, those in chunks too, and the gaps between.

    Chunks themselves and the index at the end are left out. A `Footer` is given where the file has
    its end.

    Args:
        data: the whole file: bytes, or a map of it.
    """
    if data[: len(MAGIC)] != MAGIC:
        yield Gap(0, len(data), at_end=True)
        return
    known = _channels_of_index(data)
    for piece in _walk(data, len(MAGIC), len(data), known):
        if isinstance(piece, Gap):
            yield piece
        elif piece.opcode == CHUNK:
            yield from _in_chunk(piece, known)
        elif piece.opcode in _GIVEN:
            yield piece
        elif piece.opcode == Opcode.DATA_END:
            footer = _footer(data)
            if footer is not None:
                yield footer
                return


_GIVEN = frozenset(
    map(
        int,
        (
            Opcode.HEADER,
            Opcode.SCHEMA,
            Opcode.CHANNEL,
            Opcode.MESSAGE,
            Opcode.ATTACHMENT,
            Opcode.METADATA,
        ),
    )
)


def _walk(data: Any, at: int, end: int, known: set[int]) -> Iterator[Piece | Gap]:
    while at < end:
        stop = _stop(data, at, end, known)
        if stop:
            opcode = data[at]
            if opcode == Opcode.CHANNEL:
                known.add(_CHANNEL.unpack_from(data, at + HEAD)[0])
            yield Piece(opcode, data, at + HEAD, stop)
            at = stop
        else:
            found = _next(data, at + 1, end, known)
            yield Gap(at, found - at, found == end)
            at = found


def _stop(data: Any, at: int, end: int, known: set[int]) -> int:
    """Where a record that makes sense stops; 0 where there is none."""
    if end - at < HEAD or data[at] not in OPCODES:
        return 0
    stop: int = at + HEAD + _LENGTH.unpack_from(data, at + 1)[0]
    if stop > end or not (stop == end or _likely(data, stop, end) or _is_json(data, at, stop)):
        return 0
    if data[at] == MESSAGE and (
        stop - at < HEAD + MESSAGE_HEAD or _CHANNEL.unpack_from(data, at + HEAD)[0] not in known
    ):
        return 0
    return stop if data[at] != Opcode.CHANNEL or stop - at > HEAD + 2 else 0


def _likely(data: Any, at: int, end: int) -> bool:
    """Whether a record may begin here; the last one may be cut off."""
    if data[at] not in OPCODES:
        return data[at : at + len(MAGIC)] == MAGIC and at + len(MAGIC) == end
    return end - at < HEAD or data[at + 5 : at + HEAD] == b"\0\0\0\0"


def _is_json(data: Any, at: int, stop: int) -> bool:
    """Whether a record is a message that begins and ends as JSON objects do, whatever follows it."""
    start = at + HEAD + MESSAGE_HEAD
    return bool(data[at] == MESSAGE and data[start : start + 1] == b"{" and data[stop - 1] == 0x7D)


def _next(data: Any, at: int, end: int, known: set[int]) -> int:
    """The next place where records make sense; the end where there is none."""
    for found in _STARTS.finditer(data, at, end):
        if _stop(data, found.start(), end, known):
            return found.start()
    return end


def _in_chunk(piece: Piece, known: set[int]) -> Iterator[Piece | Gap]:
    chunk = piece.decoded()
    offset, length = piece.start - HEAD, piece.stop - piece.start + HEAD
    if not isinstance(chunk, Chunk):
        yield Gap(offset, length)
        return
    data = unpacked(chunk)
    if data is None:
        yield Gap(offset, length)
        return
    for inner in _walk(data, 0, len(data), known):
        if isinstance(inner, Gap):
            yield Gap(offset, inner.length)
        elif inner.opcode in _GIVEN:
            yield inner


def unpacked(chunk: Chunk) -> bytes | None:
    """The content of a chunk; None where it is damaged."""
    try:
        if chunk.compression == "zstd":
            data = zstandard.decompress(chunk.data, chunk.uncompressed_size)
        elif chunk.compression == "lz4":
            import lz4.frame  # type: ignore[import-untyped] # it ships no types

            data = lz4.frame.decompress(chunk.data)
        elif chunk.compression == "":
            data = chunk.data
        else:
            return None
    except (zstandard.ZstdError, RuntimeError, ValueError, MemoryError, OverflowError):
        return None
    right = not chunk.uncompressed_crc or zlib.crc32(data) == chunk.uncompressed_crc
    return bytes(data) if right else None


def _footer(data: Any) -> Piece | None:
    """The footer, where the file has its end."""
    at = len(data) - len(MAGIC) - _FOOTER_SIZE
    ends = at >= 0 and data[-len(MAGIC) :] == MAGIC and data[at] == Opcode.FOOTER
    return Piece(int(Opcode.FOOTER), data, at + HEAD, at + _FOOTER_SIZE) if ends else None


def _channels_of_index(data: Any) -> set[int]:
    """The numbers of the channels that the index lists, if there is one."""
    return {r.id for r in index_records(data) if isinstance(r, Channel)}


def index_records(data: Any) -> list[McapRecord]:
    """The records of a file's index: schemas, channels, where chunks and attachments are.

    None where there is no index, or a damaged one.
    """
    footer = _footer(data)
    record = footer.decoded() if footer else None
    if footer is None or not isinstance(record, Footer) or not record.summary_start:
        return []
    at, end, found = record.summary_start, footer.start - HEAD, []
    if record.summary_crc and record.summary_crc != zlib.crc32(data[at : footer.stop - 4]):
        return []
    while at + HEAD <= end:
        stop = at + HEAD + _LENGTH.unpack_from(data, at + 1)[0]
        if stop > end or data[at] not in OPCODES:
            break
        decoded_record = Piece(data[at], data, at + HEAD, stop).decoded()
        if decoded_record is not None:
            found.append(decoded_record)
        at = stop
    return found
