"""Writes events to MCAP so that a crash loses nothing that was written.

While a run lasts, the file is a journal: no chunks, every message flushed, and forced to the disk
at the moments that matter. On closing it is written anew with compression and an index, and moved
into the journal's place.
"""

from __future__ import annotations

import contextlib
import json
import os
import threading
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import IO, Any

from mcap.writer import CompressionType, Writer

from polaris_nl import __version__
from polaris_nl.execution.events import (
    Edited,
    Event,
    GoalConfirmed,
    GoalSent,
    Halted,
    RunEnded,
    RunStarted,
)
from polaris_nl.logs import rosout
from polaris_nl.logs.schema import event_json, schema_of
from polaris_nl.model.errors import LogError

PROFILE = "ros2"
FORCED: tuple[type[Event], ...] = (Edited, GoalSent, GoalConfirmed, Halted, RunStarted, RunEnded)
"""Events after which the file is forced to the disk, so that even a power cut keeps them."""


@dataclass(frozen=True, slots=True)
class RawKind:
    """What raw messages are: the type's name and definition, and how both are written."""

    name: str
    definition: str
    encoding: str = "ros2msg"
    message_encoding: str = "cdr"


class LogWriter:
    """An open log. Safe to use from several threads.

    Args:
        path: the file to make; it must not exist.
        attachments: files that make the log explain itself elsewhere, by name: program, domain,
            world.

    Raises:
        LogError: the file can't be made.
    """

    def __init__(self, path: Path, attachments: Mapping[str, str] | None = None) -> None:
        self.path = path
        self.failure = ""
        self.count = 0
        self._lock = threading.Lock()
        self._channels: dict[str, int] = {}
        self._last_time = 0
        try:
            self._file: IO[bytes] = path.open("xb")
        except FileExistsError as error:
            raise LogError(
                f"There is a file {path} already; choose another name for the log."
            ) from error
        except OSError as error:
            raise LogError(
                f"Can't write the log {path}: {error.strerror}. Choose another place."
            ) from error
        self._writer = Writer(self._file, use_chunking=False, compression=CompressionType.NONE)
        try:
            self._start(attachments or {})
        except OSError as error:
            self._fail(error)

    def _start(self, attachments: Mapping[str, str]) -> None:
        self._writer.start(profile=PROFILE, library=f"polaris-nl {__version__}")
        self._writer.add_metadata("polaris", {"version": __version__, "schema": "polaris-log/1"})
        for name, text in attachments.items():
            kind = "application/json" if name.endswith(".json") else "text/plain"
            self._writer.add_attachment(0, 0, name, kind, text.encode())
        definition = rosout.DEFINITION.encode()
        schema = self._writer.register_schema(rosout.TYPE, "ros2msg", definition)
        qos = {"offered_qos_profiles": ""}
        self._channels[rosout.TOPIC] = self._writer.register_channel(
            rosout.TOPIC, "cdr", schema, qos
        )
        self._flush()

    def write(self, event: Event) -> bool:
        """Writes an event.

        Returns:
            Whether it is in the file. After a failure (`failure` says which) nothing more is
            written, and what was written stays.
        """
        with self._lock:
            if self.failure or self._file.closed:
                return False
            try:
                self._write(event)
            except OSError as error:
                self._fail(error)
                return False
            self.count += 1
            return True

    __call__ = write

    def write_raw(self, topic: str, kind: RawKind, time: float, data: bytes) -> bool:
        """Writes a message that is bytes already, such as one of the robot's own.

        Args:
            topic: its topic; not one of an event.
            kind: what the bytes are.
            time: seconds since the epoch.
            data: the message.

        Returns:
            Whether it is in the file, as for `write`.
        """
        with self._lock:
            if self.failure or self._file.closed:
                return False
            try:
                if topic not in self._channels:
                    schema = self._writer.register_schema(
                        kind.name, kind.encoding, kind.definition.encode()
                    )
                    qos = {"offered_qos_profiles": ""}
                    self._channels[topic] = self._writer.register_channel(
                        topic, kind.message_encoding, schema, qos
                    )
                self._message(self._channels[topic], max(int(time * 1e9), 0), data)
                self._flush()
            except OSError as error:
                self._fail(error)
                return False
            return True

    def attach(self, name: str, kind: str, data: bytes, time: float) -> bool:
        """Adds a file, such as the sound of what was said.

        Args:
            name: its name in the log.
            kind: its media type.
            data: its content.
            time: when it was made, in seconds since the epoch.

        Returns:
            Whether it is in the log.
        """
        with self._lock:
            if self.failure or self._file.closed:
                return False
            try:
                nanoseconds = max(int(time * 1e9), 0)
                self._writer.add_attachment(nanoseconds, nanoseconds, name, kind, data)
                self._flush()
            except OSError as error:
                self._fail(error)
                return False
            return True

    def close(self) -> None:
        """Ends the log and makes the compressed, indexed file of it; the journal stays where that fails."""
        with self._lock:
            if self._file.closed:
                return
            with contextlib.suppress(OSError):
                if not self.failure:
                    self._writer.finish()  # type: ignore[no-untyped-call] # mcap leaves it out
                    self._force()
            with contextlib.suppress(OSError):
                self._file.close()
        if not self.failure:
            try:
                finalise(self.path)
            except (OSError, LogError) as error:
                self.failure = f"The log {self.path} is whole, but couldn't be compressed: {error}."

    def __enter__(self) -> LogWriter:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()

    def _write(self, event: Event) -> None:
        nanoseconds = max(int(event.time * 1e9), 0)
        data = json.dumps(event_json(event), ensure_ascii=False).encode("utf-8", "backslashreplace")
        self._message(self._channel(event), nanoseconds, data)
        if event.text:
            message = rosout.log_message(event, nanoseconds)
            self._message(self._channels[rosout.TOPIC], nanoseconds, message)
        self._flush()
        if isinstance(event, FORCED):
            self._force()

    def _message(self, channel: int, nanoseconds: int, data: bytes) -> None:
        self._writer.add_message(channel, nanoseconds, data, nanoseconds, self.count)

    def _channel(self, event: Event) -> int:
        if event.topic not in self._channels:
            schema = schema_of(type(event))
            number = self._writer.register_schema(
                schema["title"], "jsonschema", json.dumps(schema).encode()
            )
            self._channels[event.topic] = self._writer.register_channel(event.topic, "json", number)
        return self._channels[event.topic]

    def _flush(self) -> None:
        self._writer.flush()  # type: ignore[no-untyped-call] # mcap leaves it out
        self._file.flush()

    def _force(self) -> None:
        os.fsync(self._file.fileno())

    def _fail(self, error: OSError) -> None:
        self.failure = (
            f"The log {self.path} can't be written any more: {error.strerror}. "
            "The run goes on without it."
        )


def finalise(path: Path, source: Path | None = None) -> None:
    """Makes an indexed, compressed file of a journal and moves it into place.

    Args:
        path: the file to make.
        source: the journal; `path` itself by default.

    Raises:
        OSError: it can't be written; the journal is untouched.
    """
    from polaris_nl.logs.recovery import copy_records

    temporary = path.with_name(f".{path.name}.new")
    try:
        with temporary.open("w+b") as out:
            copy_records(source or path, out)
            out.flush()
            os.fsync(out.fileno())
        temporary.replace(path)
    finally:
        temporary.unlink(missing_ok=True)


def attachments_of(program: Mapping[str, Any], domain: str, world: str) -> dict[str, str]:
    """The attachments that make a log explain itself: program, domain and world as text."""
    return {
        "program.polaris.json": json.dumps(program, indent=2),
        "domain.pddl": domain,
        "world.yaml": world,
    }
