"""Where the shipped domains and grammars are: in the installed package or in the checkout."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from polaris_nl.model.errors import FileError, did_you_mean

_PACKAGE = Path(__file__).parent.parent


def data_folder(name: str) -> Path:
    """The folder `domains` or `grammars`.

    Raises:
        FileError: neither the package nor the checkout has it.
    """
    for folder in (_PACKAGE / name, _PACKAGE.parent / name):
        if folder.is_dir():
            return folder
    raise FileError(f"The {name} that ship with Polaris NL are missing. Install it again.")


def shipped_domains() -> dict[str, Path]:
    """Name to domain file."""
    return {p.parent.name: p for p in sorted(data_folder("domains").glob("*/domain.pddl"))}


def shipped_worlds() -> dict[str, Path]:
    """Name to world file."""
    found = sorted(data_folder("domains").glob("*/worlds/*.yaml"))
    return {p.stem: p for p in found if not p.name.endswith(".map.yaml")}


def domain_path(name: str, relative_to: Path | None = None) -> Path:
    """The file of a shipped domain, or of one named by a path.

    Raises:
        FileError: there is neither.
    """
    return _find(name, relative_to, shipped_domains, "domain", (".pddl",))


def world_path(name: str, relative_to: Path | None = None) -> Path:
    """The file of a shipped world, or of one named by a path.

    Raises:
        FileError: there is neither.
    """
    return _find(name, relative_to, shipped_worlds, "world", (".yaml", ".yml", ".pddl"))


def _find(
    name: str,
    relative_to: Path | None,
    shipped: Callable[[], dict[str, Path]],
    what: str,
    suffixes: tuple[str, ...],
) -> Path:
    if name.endswith(suffixes) or "/" in name:
        path = (relative_to or Path()) / Path(name).expanduser()
        if path.is_file():
            return path
        raise FileError(f"There is no {what} file {path}. Check the path.")
    known = shipped()
    if name not in known:
        hint = did_you_mean(name, known) or f" See them with: polaris-nl {what}s"
        raise FileError(f"There is no {what} called {name}.{hint}")
    return known[name]
