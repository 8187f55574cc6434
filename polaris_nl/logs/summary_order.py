"""Orders a log's index so that readers of ROS bags open it, too.

MCAP allows channels of any encoding beside ROS ones, but `rosbags` gives up at the first schema in
the index that it can't read. It looks a channel's schema up as it meets the channel, so ROS schemas
are put before the channels and the others behind them. Readers that know JSON Schema collect the
index first and see no difference.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator
from typing import IO

_MAGIC = 8
_FOOTER = 1 + 8 + 20
_SCHEMA, _CHANNEL, _SUMMARY_OFFSET = 0x03, 0x04, 0x0E
_ROS = b"ros2msg"


def order_summary(file: IO[bytes]) -> None:
    """Rewrites the index of a finished MCAP file in place.

    Args:
        file: open for reading and writing; its position is lost.
    """
    file.seek(-(_FOOTER + _MAGIC), 2)
    footer_at = file.tell()
    footer = file.read(_FOOTER)
    magic = file.read(_MAGIC)
    (start,) = struct.unpack_from("<Q", footer, 9)
    if start == 0:
        return
    file.seek(start)
    records = [r for r in _records(file.read(footer_at - start)) if r[0] != _SUMMARY_OFFSET]
    ordered = sorted(records, key=_rank)
    file.seek(start)
    for record in ordered:
        file.write(record)
    # No offsets of groups and no checksum of the index: both are optional, and 0 says so.
    file.write(footer[:9] + struct.pack("<QQI", start, 0, 0) + magic)
    file.truncate()


def _records(data: bytes) -> Iterator[bytes]:
    at = 0
    while at < len(data):
        (length,) = struct.unpack_from("<Q", data, at + 1)
        yield data[at : at + 9 + length]
        at += 9 + length


def _rank(record: bytes) -> int:
    if record[0] == _SCHEMA:
        return 0 if _encoding(record) == _ROS else 2
    return 1 if record[0] == _CHANNEL else 3


def _encoding(schema: bytes) -> bytes:
    """The encoding field of a Schema record: after the id and the name."""
    at = 9 + 2
    for _ in range(2):
        (length,) = struct.unpack_from("<I", schema, at)
        value = schema[at + 4 : at + 4 + length]
        at += 4 + length
    return value
