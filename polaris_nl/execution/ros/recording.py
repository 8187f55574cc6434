"""The robot's own messages for the log: as they are on the wire, with their definitions, thinned out."""

from __future__ import annotations

import importlib
import os
import queue
import re
import threading
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from polaris_nl.execution.clock import Clock
from polaris_nl.execution.ros.profile import Profile

RATES_HZ: Mapping[str, float] = {
    "joint_states": 10.0,
    "odom": 10.0,
    "tf": 5.0,
    "markers": 5.0,
    "perceived": 5.0,
    "battery": 1.0,
    "mode": 1.0,
    "is_homed": 1.0,
    "is_runstopped": 10.0,
    "is_streaming_position": 1.0,
    "cmd_vel": 20.0,
}
"""The most messages a second that are kept of a topic; all of the others are. A driver sends 30."""
OWN = "/polaris/"
KEPT_AS = "/polaris/ros/"
"""Topics of ours are kept under this, since events have the names without it."""
_RULE = "=" * 80

Write = Callable[[str, "Definition", float, bytes], object]


@dataclass(frozen=True, slots=True)
class Definition:
    """A message type: its full name, and its definition with those of all types in it."""

    name: str
    text: str


class Recorder:
    """Takes messages in the owner's thread and hands them on as bytes in a thread of its own.

    So the disk never keeps the thread that watches over the robot waiting.

    Args:
        write: takes topic, definition, time (seconds) and bytes.
        profile: the robot's names, for what is thinned out.
        clock: the run's clock.

    Attributes:
        failure: why no more messages are kept, or "".
    """

    def __init__(self, write: Write, profile: Profile, clock: Clock) -> None:
        self._write = write
        self._clock = clock
        self._gaps = {profile.topics[n]: 0.9 / hz for n, hz in RATES_HZ.items()}
        self._last: dict[str, float] = {}
        self._definitions: dict[str, Definition] = {}
        self.failure = ""
        self._queue: queue.SimpleQueue[tuple[str, str, float, Any] | None] = queue.SimpleQueue()
        self._thread = threading.Thread(target=self._run, name="robot-log", daemon=True)
        self._thread.start()

    def __call__(self, topic: str, kind: str, message: Any) -> None:
        """Keeps a message, unless there are more of its topic than are wanted."""
        now = self._clock.now()
        if now - self._last.get(topic, -1e9) >= self._gaps.get(topic, 0.0):
            self._last[topic] = now
            self._queue.put((topic, kind, now, message))

    def close(self) -> None:
        """Writes what is left and ends."""
        self._queue.put(None)
        self._thread.join(10.0)

    def _run(self) -> None:
        while (item := self._queue.get()) is not None:
            if self.failure:
                continue
            try:
                self._keep(*item)
            except Exception as error:
                self.failure = f"The robot's messages can't be kept any more: {error}"

    def _keep(self, topic: str, kind: str, time: float, message: Any) -> None:
        if kind not in self._definitions:
            self._definitions[kind] = definition_of(kind)
        serialise = importlib.import_module("rclpy.serialization").serialize_message
        name = KEPT_AS + topic.removeprefix(OWN) if topic.startswith(OWN) else topic
        self._write(name, self._definitions[kind], time, bytes(serialise(message)))


def definition_of(kind: str) -> Definition:
    """The definition of a message type in the form that logs keep (`ros2msg`).

    Args:
        kind: such as `nav_msgs/msg/Odometry`.

    Raises:
        FileNotFoundError: its package brings no definition file.
    """
    texts: dict[str, str] = {}
    waiting = [kind]
    while waiting:
        name = waiting.pop(0)
        if name not in texts:
            texts[name] = _file_of(name).read_text(encoding="utf-8").strip()
            waiting += _fields_of(name, texts[name])
    first, *others = texts
    parts = [texts[first]]
    parts += [f"{_RULE}\nMSG: {_short(name)}\n{texts[name]}" for name in others]
    return Definition(kind, "\n".join(parts) + "\n")


def _fields_of(name: str, text: str) -> Iterable[str]:
    """The message types of a definition's fields."""
    package = name.split("/")[0]
    for line in text.splitlines():
        found = re.match(
            r"\s*(?:([a-z][a-z0-9_]*)/(?:msg/)?)?([A-Z]\w*)(?:\[[^\]]*\])?\s+\w+", line
        )
        if found:
            yield f"{found[1] or package}/msg/{found[2]}"


def _short(name: str) -> str:
    package, _, short = name.split("/")
    return f"{package}/{short}"


def _file_of(name: str) -> Path:
    package, kind, short = name.split("/")
    prefixes = [Path(p) for p in os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep) if p]
    module = importlib.import_module(package)
    prefixes += list(Path(module.__file__ or ".").resolve().parents)
    for prefix in prefixes:
        path = prefix / "share" / package / kind / f"{short}.msg"
        if path.is_file():
            return path
    raise FileNotFoundError(f"The definition of {name} isn't installed.")
