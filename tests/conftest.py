"""What all tests share: a home of their own, repeatable property tests, no leftover processes."""

from __future__ import annotations

import os
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings

settings.register_profile(
    "repeatable",
    derandomize=True,
    deadline=None,
    database=None,
    max_examples=60,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.function_scoped_fixture],
)
settings.load_profile("repeatable")

_MODEL_CACHE = Path.home() / ".cache" / "vosk" / "vosk-model-small-en-us-0.15"


@pytest.fixture(scope="session", autouse=True)
def _own_home(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """Tests see an empty home, but the user's speech model."""
    home = tmp_path_factory.mktemp("home")
    changes = {
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


@pytest.fixture(autouse=True)
def _no_leftovers() -> Iterator[None]:
    """A test ends the processes it started, and the planning threads."""
    yield
    assert not _children(), "a test left a process running"
    left = [t.name for t in threading.enumerate() if t.name == "planning"]
    assert not left, "a test left a session open"


def _children() -> list[int]:
    found = []
    for task in Path("/proc/self/task").glob("*/children"):
        try:
            found += [int(pid) for pid in task.read_text().split()]
        except OSError:
            continue
    return found
