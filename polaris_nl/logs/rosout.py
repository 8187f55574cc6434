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


def log_message(event: Event, nanoseconds: int) -> bytes:
    """The CDR bytes of an event's text."""
    body = struct.pack("<iIB", nanoseconds // 10**9, nanoseconds % 10**9, LEVELS[event.severity])
    for text in ("polaris", event.text, type(event).__name__, ""):
        data = text.encode() + b"\0"
        body += b"\0" * (-len(body) % 4) + struct.pack("<I", len(data)) + data
    body += b"\0" * (-len(body) % 4) + struct.pack("<I", 0)
    return b"\0\x01\0\0" + body
