"""Reads logs that were cut off, and makes whole ones of them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any

from mcap.exceptions import McapError
from mcap.records import (
    Attachment,
    Channel,
    DataEnd,
    Footer,
    Header,
    McapRecord,
    Message,
    Metadata,
    Schema,
)
from mcap.stream_reader import StreamReader
from mcap.writer import CompressionType, Writer

from polaris_nl.logs.summary_order import order_summary
from polaris_nl.model.errors import LogError


@dataclass(frozen=True, slots=True)
class Recovery:
    """What a recovery found.

    Attributes:
        path: the whole file that was made.
        messages: how many messages it has.
        complete: whether the original had its end, so that nothing is missing.
    """

    path: Path
    messages: int
    complete: bool


def records(path: Path) -> Iterator[McapRecord]:
    """Every complete record of a log, in file order; ends quietly where the file is cut off or garbled.

    Raises:
        LogError: the file can't be read, or is no MCAP file.
    """
    try:
        file = path.open("rb")
    except OSError as error:
        raise LogError(f"Can't read the log {path}: {error.strerror}. Check the path.") from error
    with file:
        start = file.read(8)
        if start != b"\x89MCAP0\r\n":
            if b"\x89MCAP0\r\n".startswith(start):
                return
            raise LogError(f"{path} is no MCAP log; give a file that a run has written.")
        file.seek(0)
        try:
            yield from StreamReader(file, record_size_limit=None).records
        except (
            McapError,
            EOFError,
            ValueError,
            KeyError,
            IndexError,
            MemoryError,
            OverflowError,
            ArithmeticError,
        ):
            return
        except Exception as error:
            # The reader's decompressors have exceptions of their own; a damaged chunk ends the reading as well.
            if type(error).__module__.partition(".")[0] in (
                "lz4",
                "zstandard",
                "zstd",
                "struct",
                "builtins",
            ):
                return
            raise


def recover(path: Path, target: Path | None = None) -> Recovery:
    """Makes a whole, indexed file of one that may be cut off, beside the original.

    Raises:
        LogError: the file is no log, or the new one can't be written.
    """
    target = target or path.with_name(f"{path.stem}.recovered.mcap")
    try:
        with target.open("w+b") as out:
            messages, complete = copy_records(path, out)
    except OSError as error:
        raise LogError(
            f"Can't write {target}: {error.strerror}. Make room, or choose another place."
        ) from error
    return Recovery(target, messages, complete)


def copy_records(path: Path, out: IO[bytes]) -> tuple[int, bool]:
    """Copies every complete record into a chunked, compressed, indexed file.

    Returns:
        The number of messages, and whether the original had its end.
    """
    writer = Writer(out, compression=CompressionType.ZSTD)
    state: dict[str, Any] = {"started": False, "complete": False, "messages": 0}
    schemas: dict[int, int] = {0: 0}
    channels: dict[int, int] = {}
    for record in records(path):
        if isinstance(record, Header):
            writer.start(profile=record.profile, library=record.library)
            state["started"] = True
        elif isinstance(record, Schema) and record.id not in schemas:
            schemas[record.id] = writer.register_schema(record.name, record.encoding, record.data)
        elif isinstance(record, Channel) and record.id not in channels:
            schema = schemas.get(record.schema_id, 0)
            channels[record.id] = writer.register_channel(
                record.topic, record.message_encoding, schema, record.metadata
            )
        elif isinstance(record, Message) and record.channel_id in channels:
            writer.add_message(
                channels[record.channel_id],
                record.log_time,
                record.data,
                record.publish_time,
                record.sequence,
            )
            state["messages"] += 1
        elif isinstance(record, Attachment):
            writer.add_attachment(
                record.create_time, record.log_time, record.name, record.media_type, record.data
            )
        elif isinstance(record, Metadata):
            writer.add_metadata(record.name, record.metadata)
        elif isinstance(record, DataEnd | Footer):
            state["complete"] = True
    if not state["started"]:
        writer.start(profile="ros2", library="polaris-nl recovery")
    writer.finish()  # type: ignore[no-untyped-call] # mcap leaves it out
    order_summary(out)
    return int(state["messages"]), bool(state["complete"])
