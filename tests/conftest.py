"""What all tests share: a home of their own, repeatable property tests, no leftover processes."""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings

from tests.checked_plans import CheckedPlans
from tests.replayed_logs import ReplayedLogs

settings.register_profile(
    "repeatable",
    derandomize=True,
    deadline=None,
    database=None,
    max_examples=60,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.function_scoped_fixture],
)
settings.load_profile("repeatable")

PLANS = CheckedPlans()
LOGS = ReplayedLogs()
ENDING_S = 1.0
"""How long what is ending already may take to be gone."""
_MODEL_CACHE = Path.home() / ".cache" / "vosk" / "vosk-model-small-en-us-0.15"


@pytest.fixture(scope="session", autouse=True)
def _own_home(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """Tests see an empty home, but the user's speech model."""
    home = tmp_path_factory.mktemp("home")
    # Whoever asks for microphones makes a folder in /tmp otherwise.
    pulse = tmp_path_factory.mktemp("pulse")
    changes = {
        "PULSE_RUNTIME_PATH": str(pulse),
        "HOME": str(home),
        "XDG_CACHE_HOME": str(home / ".cache"),
        "XDG_STATE_HOME": str(home / ".local/state"),
        "COLUMNS": "80",
        "NO_COLOR": "1",
        "POLARIS_NL_DURATIONS": "off",
    }
    if "POLARIS_NL_MODEL" not in os.environ:
        changes["POLARIS_NL_MODEL"] = str(_MODEL_CACHE)
    patch = pytest.MonkeyPatch()
    for name, value in changes.items():
        patch.setenv(name, value)
    patch.delenv("POLARIS_NL_ASCII", raising=False)
    yield home
    patch.undo()


@pytest.fixture(scope="session", autouse=True)
def _watched_plans() -> Iterator[None]:
    """Plans are caught from the first test on."""
    with pytest.MonkeyPatch.context() as patch:
        PLANS.watch(patch)
        LOGS.watch(patch)
        yield


@pytest.fixture(autouse=True)
def _right_plans() -> Iterator[None]:
    """Every plan that a test makes is valid, and shortest where it is said to be."""
    yield
    assert PLANS.faults() == []


@pytest.fixture(autouse=True)
def _same_replays() -> Iterator[None]:
    """Every run that a test logs makes the same decisions when it is replayed."""
    yield
    assert LOGS.faults() == []


@pytest.fixture(autouse=True)
def _no_leftovers() -> Iterator[None]:
    """A test ends the processes it started, and the planning threads."""
    yield
    left = _left()
    deadline = time.monotonic() + ENDING_S
    while left and time.monotonic() < deadline:  # What is just ending is no leftover.
        time.sleep(0.01)
        left = _left()
    assert not left, f"a test left these behind: {left}"


def _left() -> list[str]:
    threads = [t.name for t in threading.enumerate() if t.name.startswith("planning")]
    return [*(f"process {pid}" for pid in _children()), *(f"thread {name}" for name in threads)]


def _children() -> list[int]:
    found = []
    for task in Path("/proc/self/task").glob("*/children"):
        try:
            found += [int(pid) for pid in task.read_text().split()]
        except OSError:
            continue
    return found
