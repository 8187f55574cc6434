"""Replays every run's log that a test makes: the same inputs have to lead to the same decisions."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from polaris_nl.logs.reader import read_log
from polaris_nl.logs.writer import LogWriter
from polaris_nl.replays import replayed

OF_RUNS = "settings.json"
"""An attachment that only logs of runs have."""


class ReplayedLogs:
    """The logs that were closed since the last look."""

    def __init__(self) -> None:
        self._closed: list[Path] = []
        self.runs = 0

    def watch(self, patch: pytest.MonkeyPatch) -> None:
        """Catches each log of a run as it is closed."""
        close, closed = LogWriter.close, self._closed

        def watched(log: LogWriter, *args: Any) -> None:
            close(log, *args)
            if OF_RUNS in log._records.attachments and not log.failure and log.path not in closed:
                closed.append(log.path)

        patch.setattr(LogWriter, "close", watched)

    def faults(self) -> list[str]:
        """What replays did otherwise."""
        found = []
        closed, self._closed[:] = list(self._closed), []
        for path in closed:
            if path.exists() and _has_run(path):
                self.runs += 1
                found += differences(path)
        return found


def differences(path: Path) -> list[str]:
    """What the replay of a log's runs did otherwise."""
    return [f"{path.name}: {x.difference}" for x in replayed(path) if x.difference is not None]


def _has_run(path: Path) -> bool:
    return any(e.topic == "/polaris/run" for e in read_log(path).events)
