"""Events as ROS 2 log messages (`rcl_interfaces/msg/Log` on `/rosout`), which every ROS tool shows.

CDR in little endian, written by hand: the message has seven fields, and a generator would be larger.
"""

from __future__ import annotations

import struct
from collections.abc import Mapping

from polaris_nl.execution.events import Event

TOPIC = "/rosout"
TYPE = "rcl_interfaces/msg/Log"
DEFINITION = """\
byte DEBUG=10
byte INFO=20
byte WARN=30
byte ERROR=40
byte FATAL=50
builtin_interfaces/Time stamp
uint8 level
string name
string msg
string file
string function
uint32 line
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
"""
LEVELS: Mapping[str, int] = {"debug": 10, "info": 20, "warning": 30, "error": 40}


NAME = "polaris"


def log_message(event: Event, nanoseconds: int) -> bytes:
    """The CDR bytes of an event's text."""
    return encoded(nanoseconds, LEVELS[event.severity], event.text, type(event).__name__)


def encoded(nanoseconds: int, level: int, text: str, kind: str) -> bytes:
    """The CDR bytes of a line: time, level, text, and the name of what it is about."""
    body = struct.pack("<iIB", nanoseconds // 10**9, nanoseconds % 10**9, level)
    for field in (NAME, text, kind, ""):
        data = field.encode("utf-8", "backslashreplace") + b"\0"
        body += b"\0" * (-len(body) % 4) + struct.pack("<I", len(data)) + data
    body += b"\0" * (-len(body) % 4) + struct.pack("<I", 0)
    return b"\0\1\0\0" + body


def parsed(data: bytes) -> tuple[int, str, str]:
    """Level, text and kind of a line."""
    body, at, fields = data[4:], 9, []
    for _ in range(3):
        at += -at % 4
        (length,) = struct.unpack_from("<I", body, at)
        fields.append(body[at + 4 : at + 4 + length - 1].decode("utf-8", "replace"))
        at += 4 + length
    return body[8], fields[1], fields[2]
