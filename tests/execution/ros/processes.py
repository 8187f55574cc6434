"""Drivers as processes of their own, and an onlooker at what they do."""

from __future__ import annotations

import contextlib
import json
import os
import queue
import signal
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from polaris_nl.execution.clock import RealClock
from polaris_nl.execution.ros.middleware import interface
from polaris_nl.execution.ros.owner import Owner

ROOT = Path(__file__).parents[3]
READY_S = 30.0
MOVING = 0.02


_claims: list[socket.socket] = []


def new_domain() -> str:
    """A ROS domain that no other test on this machine uses; it is claimed by a port until the next one."""
    for turn in range(100):
        # One after the other, since those that were killed stay visible for a while.
        domain = 1 + (os.getpid() * 37 + len(_claims) + turn) % 100
        claim = socket.socket()
        try:
            claim.bind(("127.0.0.1", 21_000 + domain))
        except OSError:
            claim.close()
            continue
        for old in _claims:
            old.close()
        _claims.append(claim)
        return str(domain)
    raise AssertionError("all ROS domains are in use")


class Process:
    """A Python module as a process; it prints a line when it is ready."""

    def __init__(self, module: str, *arguments: str) -> None:
        self.popen = subprocess.Popen(
            [sys.executable, "-m", module, *arguments],
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            cwd=ROOT,
            env={**os.environ, "PYTHONPATH": f"{ROOT}{os.pathsep}{ROOT / 'tui'}"},
        )
        self._lines: queue.SimpleQueue[str] = queue.SimpleQueue()
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def _read(self) -> None:
        assert self.popen.stdout is not None
        for line in self.popen.stdout:
            self._lines.put(line)
        self._lines.put("")

    def line(self, seconds: float = READY_S) -> str:
        """The next line that it prints; "" if none comes, or it has ended."""
        try:
            return self._lines.get(timeout=seconds)
        except queue.Empty:
            return ""

    def wait_for(self, text: str) -> None:
        """Waits for a line with a text."""
        end, seen = time.monotonic() + READY_S, []
        while time.monotonic() < end:
            line = self.line(0.5)
            seen.append(line)
            if text in line:
                return
            if not line and self.popen.poll() is not None:
                break
        self.kill()
        raise AssertionError(f"it didn't start: {''.join(seen)[-2000:]}")

    def kill(self) -> None:
        """SIGKILL."""
        with contextlib.suppress(ProcessLookupError):
            self.popen.kill()

    def freeze(self) -> None:
        """SIGSTOP."""
        self.popen.send_signal(signal.SIGSTOP)

    def thaw(self) -> None:
        """SIGCONT."""
        self.popen.send_signal(signal.SIGCONT)

    def close(self) -> None:
        """Ends it, whatever state it is in; politely first, so that others know at once that it is gone."""
        with contextlib.suppress(ProcessLookupError):
            self.thaw()
            self.popen.terminate()
        try:
            self.popen.wait(3)
        except subprocess.TimeoutExpired:
            self.kill()
            self.popen.wait(10)
        self._reader.join(10)
        if self.popen.stdout is not None:
            self.popen.stdout.close()


class Onlooker:
    """Sees from outside what a driver does: its odometry, and what it was asked.

    Attributes:
        moved_at: when its odometry showed motion.
        asked: what it was asked, by our clock when the news came; `told`: the same by the driver's.
    """

    def __init__(self, clock: RealClock, fault_topic: str = "/mock/fault") -> None:
        self.clock = clock
        self.moved_at: list[float] = []
        self.asked: list[tuple[float, str, Any]] = []
        self.told: list[tuple[float, str, Any]] = []
        self.odometry_at = 0.0
        self._topic = fault_topic
        self._faults: Any = None
        self._owner = Owner("onlooker", self._set_up)

    def _set_up(self, node: Any) -> None:
        text = interface("std_msgs/msg/String")
        node.create_subscription(interface("nav_msgs/msg/Odometry"), "/odom", self._odom, 10)
        node.create_subscription(text, "/mock/log", self._note, 100)
        self._faults = node.create_publisher(text, self._topic, 10)

    def _odom(self, message: Any) -> None:
        self.odometry_at = self.clock.now()
        twist = message.twist.twist
        if abs(twist.linear.x) > MOVING or abs(twist.angular.z) > MOVING:
            self.moved_at.append(self.odometry_at)

    def _note(self, message: Any) -> None:
        value = json.loads(message.data)
        self.asked.append((self.clock.now(), value["what"], value["value"]))
        self.told.append((value["at"], value["what"], value["value"]))

    def fault(self, fault: Mapping[str, Any]) -> None:
        """Has a fault strike."""
        text = interface("std_msgs/msg/String")(data=json.dumps(fault))

        async def publish() -> None:
            self._faults.publish(text)

        self._owner.do(publish(), 5.0)

    def wait(self, ready: Callable[[], bool], seconds: float = 10.0) -> None:
        """Waits until something is so."""
        end = time.monotonic() + seconds
        while not ready():
            assert time.monotonic() < end, "it didn't come to that"
            time.sleep(0.01)

    def ready(self) -> None:
        """Waits until the driver is seen, and hears us."""
        self.wait(lambda: self.odometry_at > 0 and self._faults.get_subscription_count() > 0)

    def close(self) -> None:
        self._owner.close()
