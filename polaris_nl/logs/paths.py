"""Where logs are written."""

from __future__ import annotations

import re
import time
from pathlib import Path

from polaris_nl.model.errors import LogError


def log_folder() -> Path:
    """`logs/` in a checkout, else the user's state folder (XDG)."""
    checkout = Path(__file__).parents[2]
    if (checkout / "pyproject.toml").is_file() and (checkout / "logs").is_dir():
        return checkout / "logs"
    import platformdirs

    return Path(platformdirs.user_state_dir("polaris-nl")) / "logs"


def new_log_path(name: str, folder: Path | None = None) -> Path:
    """A path that nothing has yet, by time and name.

    Raises:
        LogError: the folder can't be made.
    """
    folder = folder or log_folder()
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise LogError(
            f"Can't make the log folder {folder}: {error.strerror}. Use --log FILE."
        ) from error
    stem = f"{time.strftime('%Y-%m-%d_%H-%M-%S')}_{re.sub(r'[^a-z0-9-]+', '-', name.lower())}"
    path, number = folder / f"{stem}.mcap", 2
    while path.exists():
        path, number = folder / f"{stem}_{number}.mcap", number + 1
    return path


def part_path(first: Path, number: int) -> Path:
    """Where a log goes on: `lunch.mcap`, `lunch.part2.mcap`, ..."""
    return first if number == 1 else first.with_name(f"{first.stem}.part{number}{first.suffix}")


def parts_of(path: Path) -> list[Path]:
    """A log's files, in their order, from the one that is named on."""
    found = re.fullmatch(r"(.+)\.part(\d+)", path.stem)
    first = path.with_name(f"{found[1]}{path.suffix}") if found else path
    number = int(found[2]) if found else 1
    parts = [path]
    while (later := part_path(first, number + len(parts))).is_file():
        parts.append(later)
    return parts
