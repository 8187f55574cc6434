"""Runs the real command, in this process where that is quicker, and as a process where it matters."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

from polaris_nl.cli import main

ROOT = Path(__file__).parents[2]


@dataclass(frozen=True)
class Result:
    code: int
    out: str
    err: str

    @property
    def json(self) -> Any:
        return json.loads(self.out)

    @property
    def lines(self) -> list[Any]:
        return [json.loads(line) for line in self.out.splitlines()]


class Command:
    def __init__(self, capfd: pytest.CaptureFixture[str]) -> None:
        self._capfd = capfd

    def __call__(self, *arguments: object) -> Result:
        self._capfd.readouterr()
        try:
            code = main([str(a) for a in arguments])
        except SystemExit as end:
            code = int(end.code or 0)
        out, err = self._capfd.readouterr()
        return Result(code, out, err)


@pytest.fixture
def command(
    capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> Command:
    monkeypatch.chdir(tmp_path)
    return Command(capfd)


def process(
    *arguments: object, stdin: bytes = b"", cwd: Path | None = None, stdout: Any = subprocess.PIPE
) -> subprocess.CompletedProcess[bytes]:
    return subprocess.run(
        [sys.executable, "-m", "polaris_nl.cli", *map(str, arguments)],
        input=stdin,
        stdout=stdout,
        stderr=subprocess.PIPE,
        cwd=cwd or ROOT,
        env={**os.environ, "PYTHONPATH": f"{ROOT}{os.pathsep}{ROOT / 'tui'}"},
        timeout=120,
        check=False,
    )


def one_sentence(text: str | bytes) -> str:
    """Checks an error: one line, no traceback, and names the program."""
    text = text.decode() if isinstance(text, bytes) else text
    assert text.startswith("polaris-nl: "), text
    assert text.count("\n") == 1, text
    assert "Traceback" not in text
    return text


LUNCH = (
    "Tell the resident that lunch is ready. Once she acknowledges, bring a full tray to her table and then go "
    "home. If she dismisses it, just go home."
)
TIDY = (
    "Put the cup and the plate on the countertop.",
    "Wait until both are on the drying rack.",
    "Open the cupboard, then put both dishes in the cupboard.",
)


@pytest.fixture
def lunch(command: Command, tmp_path: Path) -> Path:
    path = tmp_path / "lunch.polaris.json"
    assert command("say", "--world", "care-home", "--program", path, LUNCH).code == 0
    return path
