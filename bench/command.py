"""Start-up of the command."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator

from bench.table import Row, timed


def rows() -> Iterator[Row]:
    """The row about the command line."""
    yield Row(
        "polaris-nl --help",
        "<= 250",
        timed(lambda: _run("-m", "polaris_nl.cli", "--help"), 10),
        timed(lambda: _run("-c", "import argparse"), 10),
        "import argparse",
    )


def _run(*arguments: str) -> None:
    subprocess.run([sys.executable, *arguments], check=True, capture_output=True)
