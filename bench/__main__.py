"""`python -m bench [part ...]`: prints the table."""

from __future__ import annotations

import itertools
import os
import platform
import sys

from bench import command, execution, language, logs, planning, robot, speech, tui
from bench.table import show

PARTS = {
    "command": command,
    "language": language,
    "speech": speech,
    "planning": planning,
    "execution": execution,
    "logs": logs,
    "tui": tui,
    "robot": robot,
}


def main() -> None:
    """Measures the parts that are named, or all."""
    names = sys.argv[1:] or list(PARTS)
    unknown = [name for name in names if name not in PARTS]
    if unknown:
        raise SystemExit(f"bench: there is no part {unknown[0]}; parts: {', '.join(PARTS)}")
    # Processes that are started here find compiled modules, as a user's do from the second start on.
    os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
    sys.stdout.write(
        f"Python {platform.python_version()}, {platform.machine()}; caches warm; times in ms unless said.\n"
    )
    show(itertools.chain.from_iterable(PARTS[name].rows() for name in names))


if __name__ == "__main__":
    main()
