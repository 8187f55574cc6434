"""Golden files: texts that a person has read and found good.

`POLARIS_NL_GOLDEN=write` writes them anew; read the difference before it is committed.
"""

from __future__ import annotations

import os
from pathlib import Path

FOLDER = Path(__file__).parent


def check_golden(name: str, text: str) -> None:
    """Compares a text with a golden file."""
    path = FOLDER / name
    lines = [line.rstrip() for line in text.splitlines()]
    if os.environ.get("POLARIS_NL_GOLDEN") == "write":
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    assert path.is_file(), f"there is no golden file {name}; write it with POLARIS_NL_GOLDEN=write"
    assert lines == path.read_text(encoding="utf-8").splitlines()
