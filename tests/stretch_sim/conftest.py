"""Simulators as processes of their own, and clients of them."""

from __future__ import annotations

import json
import os
import selectors
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from tests.execution.ros.processes import new_domain
from tests.stretch_sim.client import Client

ROOT = Path(__file__).parents[2]
READY_S = 40.0


class Process:
    """A simulator's process; its first line says that it is ready."""

    def __init__(self, world: str, *options: str) -> None:
        self.world = world
        code = [sys.executable, "-m", "polaris_nl.cli", "stretch-sim", "--json", "--world", world]
        self.process = subprocess.Popen(
            [*code, *options],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            cwd=ROOT,
            env={**os.environ, "PYTHONPATH": f"{ROOT}{os.pathsep}{ROOT / 'tui'}"},
        )
        self.ready = json.loads(self._line())

    def _line(self) -> str:
        assert self.process.stdout is not None
        with selectors.DefaultSelector() as selector:
            selector.register(self.process.stdout, selectors.EVENT_READ)
            end = time.monotonic() + READY_S
            while time.monotonic() < end:
                if selector.select(0.2):
                    line = self.process.stdout.readline()
                    if line:
                        return line
                if self.process.poll() is not None:
                    break
        self.process.kill()
        raise AssertionError(f"it didn't start: {self.process.communicate()[1]}")

    def stop(self) -> dict[str, object]:
        """Ends it as a person would; what it says at the end."""
        self.process.send_signal(signal.SIGINT)
        out, err = self.process.communicate(timeout=60)
        assert self.process.returncode == 0, err
        return dict(json.loads(out.splitlines()[-1]))


Start = Callable[..., tuple[Process, Client]]


@pytest.fixture
def start(monkeypatch: pytest.MonkeyPatch) -> Iterator[Start]:
    """Starts a simulator on a domain of its own, and a client of it; both end with the test."""
    monkeypatch.setenv("ROS_DOMAIN_ID", new_domain())
    monkeypatch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    processes: list[Process] = []
    clients: list[Client] = []

    def begin(*options: str, world: str = "care-home") -> tuple[Process, Client]:
        processes.append(Process(world, *options))
        clients.append(Client(world))
        return processes[-1], clients[-1]

    try:
        yield begin
    finally:
        for client in clients:
            client.close()
        for process in processes:
            if process.process.poll() is None:
                process.process.kill()
            # Shown where a test fails.
            print(process.process.communicate()[1])


@pytest.fixture
def sim(start: Start) -> Client:
    """A client of a kinematic simulator whose people do nothing, at twenty times real time."""
    return start("--kinematic", "--people", "none", "--speed", "20")[1]
