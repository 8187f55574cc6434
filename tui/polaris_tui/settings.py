"""The user's settings: a TOML file with few fields, each of which has a default.

It lies in the configuration folder (XDG): `polaris-nl/tui.toml`. All fields, with their defaults:

    theme = "terminal"   # terminal, dark, light, contrast or colour-blind; F10 "theme" tries them out
    glyphs = "auto"      # auto, unicode or ascii
    mouse = false        # true: a click goes to a row; the terminal's own selecting needs Shift then
    tree = "auto"        # auto: a drawn tree from 140 columns on; always or never
    logs = ""            # the folder for the logs of runs; "" for the usual one

    [keys]               # other keys for actions, by the names that F10 shows; "" takes a key away
    next-problem = "j"
    undo = "f7 u"
"""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from polaris_nl.model.errors import FormatError, did_you_mean
from polaris_nl.render.glyphs import ASCII, UNICODE, Glyphs, glyphs_for
from polaris_tui.actions import BY_ID, Keymap, clashes
from polaris_tui.styles import LOOKS

_CHOICES: Mapping[str, tuple[str, ...]] = {
    "theme": tuple(LOOKS),
    "glyphs": ("auto", "unicode", "ascii"),
    "tree": ("auto", "always", "never"),
}


@dataclass(frozen=True)
class Settings:
    """What the user has set.

    Attributes:
        theme: one of `styles.LOOKS`.
        glyphs: `auto` (as the terminal says), `unicode` or `ascii`.
        mouse: whether clicks are taken.
        tree: `auto`, `always` or `never`: whether the program is drawn as a tree at first.
        logs: the folder for the logs of runs; "" for the usual one.
        keys: other keys for actions, by their ids.
    """

    theme: str = "terminal"
    glyphs: str = "auto"
    mouse: bool = False
    tree: str = "auto"
    logs: str = ""
    keys: Mapping[str, tuple[str, ...]] = field(default_factory=dict)

    def glyphs_for_terminal(self) -> Glyphs:
        """The signs to draw with."""
        return {"unicode": UNICODE, "ascii": ASCII}.get(self.glyphs) or glyphs_for()

    @property
    def logs_folder(self) -> Path | None:
        """The folder for the logs of runs; None for the usual one."""
        return Path(self.logs).expanduser() if self.logs else None

    @property
    def keymap(self) -> Keymap:
        """The keys of all actions."""
        return Keymap(self.keys)


def settings_path() -> Path:
    """Where the settings are."""
    import platformdirs

    return Path(platformdirs.user_config_dir("polaris-nl")) / "tui.toml"


def read_settings(path: Path | None = None) -> Settings:
    """Reads the settings; the defaults where there is no file.

    Raises:
        FormatError: a field isn't known, or has a value that it can't have; it is named.
    """
    path = path or settings_path()
    try:
        text = path.read_text(encoding="utf-8")
    except FileNotFoundError:
        return Settings()
    except (OSError, UnicodeDecodeError) as error:
        raise FormatError(f"The settings can't be read ({error}).", path) from error
    try:
        return settings_of(tomllib.loads(text))
    except tomllib.TOMLDecodeError as error:
        raise FormatError(f"The settings are no TOML: {error}.", path) from error
    except FormatError as error:
        raise FormatError(error.reason, path) from error


def settings_of(value: Mapping[str, Any]) -> Settings:
    """Settings of their TOML value.

    Raises:
        FormatError: as `read_settings`.
    """
    known = (*_CHOICES, "mouse", "logs", "keys")
    for name in value:
        if name not in known:
            raise FormatError(f"There is no setting {name}.{did_you_mean(name, known)}")
    chosen = {name: _choice(name, value[name]) for name in _CHOICES if name in value}
    mouse = value.get("mouse", False)
    if not isinstance(mouse, bool):
        raise FormatError("mouse is true or false.")
    logs = value.get("logs", "")
    if not isinstance(logs, str):
        raise FormatError('logs is a folder, such as "~/robot-logs".')
    keys = _keys(value.get("keys", {}))
    settings = Settings(mouse=mouse, logs=logs, keys=keys, **chosen)
    for key, one, other in clashes(settings.keymap):
        raise FormatError(
            f"The key {key} means both {one.id} and {other.id}; give one of them another."
        )
    return settings


def _choice(name: str, value: object) -> str:
    if value not in _CHOICES[name]:
        choices = ", ".join(_CHOICES[name])
        raise FormatError(f"{name} is one of {choices}, not {value!r}.")
    return str(value)


def _keys(value: object) -> Mapping[str, tuple[str, ...]]:
    if not isinstance(value, Mapping):
        raise FormatError("keys is a table: [keys], then a line for each action.")
    found = {}
    for id, keys in value.items():
        if id not in BY_ID:
            raise FormatError(f"There is no action {id}.{did_you_mean(id, BY_ID)}")
        if not isinstance(keys, str):
            raise FormatError(f'The keys of {id} are a text, such as "f7 u".')
        found[id] = tuple("ctrl+@" if key == "ctrl+space" else key for key in keys.split())
    if found.get("stop") == ():
        raise FormatError("stop has to have a key.")
    return found
