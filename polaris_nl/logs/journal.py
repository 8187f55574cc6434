"""A journal: an MCAP file without chunks that grows record by record, each in one piece.

What was appended is the system's and survives the end of this process, however it ends. A record that
doesn't fit on the disk any more is taken back, so that a journal never ends in the middle of one.
"""

from __future__ import annotations

import contextlib
import fcntl
import os
from collections.abc import Mapping
from pathlib import Path

from mcap.records import Attachment, Channel, Header, Metadata, Schema

from polaris_nl import __version__
from polaris_nl.logs.framing import END, MAGIC, encoded, message

PROFILE = "ros2"


class Journal:
    """An open journal. Not safe to use from several threads.

    Args:
        path: the file to make; it must not exist.

    Attributes:
        size: its bytes so far.

    Raises:
        OSError: it can't be made.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.size = 0
        self._schemas = 0
        self._channels: dict[str, int] = {}
        self._file = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_CLOEXEC, 0o644)
        with contextlib.suppress(OSError):  # Tells readers that it is still being written.
            fcntl.flock(self._file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        header = encoded(Header(PROFILE, f"polaris-nl {__version__}"))
        self.append(MAGIC + header)

    def append(self, records: bytes) -> None:
        """Appends whole records.

        Raises:
            OSError: they don't fit; nothing of them is there then.
        """
        rest = records
        try:
            while rest:
                rest = rest[os.write(self._file, rest) :]
        except OSError:
            with contextlib.suppress(OSError):
                os.ftruncate(self._file, self.size)
                os.lseek(self._file, self.size, os.SEEK_SET)
            raise
        self.size += len(records)

    def metadata(self, name: str, values: Mapping[str, str]) -> None:
        """Appends a metadata record."""
        self.append(encoded(Metadata(name, dict(values))))

    def attach(self, name: str, kind: str, data: bytes, nanoseconds: int = 0) -> None:
        """Appends a file: its name, media type and content."""
        self.append(encoded(Attachment(nanoseconds, nanoseconds, name, kind, data)))

    def channel(self, topic: str) -> int | None:
        """The number of a topic's channel, or None where it has none yet."""
        return self._channels.get(topic)

    def add_channel(
        self, topic: str, message_encoding: str, schema: str, encoding: str, definition: bytes
    ) -> int:
        """Makes a channel with a schema of its own, and returns its number."""
        number = self._schemas + 1
        qos = {"offered_qos_profiles": ""} if message_encoding == "cdr" else {}
        channel = Channel(number, topic, message_encoding, qos, number)
        self.append(encoded(Schema(number, definition, encoding, schema)) + encoded(channel))
        self._schemas = number
        self._channels[topic] = number
        return number

    def message(self, channel: int, sequence: int, nanoseconds: int, data: bytes) -> bytes:
        """A message of a channel, to be appended, alone or with others in one piece."""
        return message(channel, sequence & 0xFFFFFFFF, nanoseconds, data)

    def force(self) -> None:
        """Waits until all of it is on the disk."""
        os.fsync(self._file)

    def end(self) -> None:
        """Appends what ends a file."""
        self.append(END)

    def close(self) -> None:
        """Closes the file, ended or not."""
        os.close(self._file)
