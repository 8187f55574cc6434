"""Settings, keys and actions: one list, no clashes, and sentences about what is wrong."""

from __future__ import annotations

from pathlib import Path

import pytest

from polaris_nl.model.errors import FormatError
from polaris_tui import settings as module
from polaris_tui.actions import ACTIONS, Keymap, clashes
from polaris_tui.footer import FOOTERS, footer
from polaris_tui.reasons import Situation
from polaris_tui.settings import Settings, read_settings
from tests.tui.conftest import Play, Stage


def read(tmp_path: Path, text: str) -> Settings:
    path = tmp_path / "tui.toml"
    path.write_text(text)
    return read_settings(path)


def test_no_two_actions_share_a_key() -> None:
    assert list(clashes(Keymap())) == []
    assert len({a.id for a in ACTIONS}) == len(ACTIONS)
    assert len({a.does for a in ACTIONS}) == len(ACTIONS)


def test_keys_get_through_terminals() -> None:
    """Letters, digits, signs, F1 to F10, arrows and ctrl with letters: the rest is eaten somewhere."""
    plain = {"up", "down", "left", "right", "home", "end", "pageup", "pagedown", "tab", "shift+tab"}
    plain |= {"enter", "escape", "delete", "slash", "colon", "question_mark", "ctrl+@"}
    for action in ACTIONS:
        for key in (*action.keys, *action.letters):
            function = key[:1] == "f" and key[1:].isdigit() and int(key[1:]) <= 10
            control = key.startswith("ctrl+") and len(key) == 6
            assert key in plain or function or control or len(key) == 1, key


def test_the_space_bar_with_ctrl_is_a_key_of_its_own(tmp_path: Path) -> None:
    keymap = read(tmp_path, '[keys]\ntalk = "ctrl+space T"\n').keymap
    assert keymap.shown("talk") == "ctrl+space, T"
    found = keymap.anywhere("ctrl+@")
    assert found is not None
    assert found.id == "talk"


def test_every_action_is_in_the_help_or_has_a_name() -> None:
    helped = {does for _, _, does in Keymap().help()}
    assert all(a.does in helped or not (a.keys or a.letters) for a in ACTIONS)


@pytest.mark.parametrize("place", [*FOOTERS, "menu", "ask"])
def test_the_status_line_shows_what_fits_and_can_be_done(place: str) -> None:
    for room in range(0, 120, 7):
        text = footer(place, Keymap(), Situation(), room)
        assert len(text) <= max(room, 8)
    assert "rename" not in footer("program", Keymap(), Situation(), 200)
    picked = Situation(empty=False, checkpoint="c1")
    assert "r rename" in footer("program", Keymap(), picked, 200)


def test_no_file_is_the_defaults(tmp_path: Path) -> None:
    assert read_settings(tmp_path / "none.toml") == Settings()


def test_the_documented_file_is_a_settings_file(tmp_path: Path) -> None:
    lines = (module.__doc__ or "").split("defaults:\n")[1].splitlines()
    found = read(tmp_path, "\n".join(line.strip() for line in lines))
    assert (found.theme, found.glyphs, found.mouse, found.tree, found.logs) == (
        "terminal",
        "auto",
        False,
        "auto",
        "",
    )
    assert set(found.keys) == {"next-problem", "undo"}


def test_other_keys(play: Play, tmp_path: Path) -> None:
    settings = read(tmp_path, '[keys]\nundo = "f7 z"\nrename = "R"\ndelete = ""\n')
    assert settings.keymap.shown("undo") == "F7, z"
    assert settings.keymap.shown("delete") == ""

    async def script(stage: Stage) -> None:
        await stage.say("open the fridge")
        await stage.press("tab", "R")
        await stage.see("New name of opened")
        await stage.press("escape", "d")
        await stage.see('"d" means nothing here.')
        await stage.press("z")
        await stage.see("Undone: Open the fridge")
        await stage.answered()

    play(script, settings=settings)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("themes = 1", "There is no setting themes. Did you mean theme"),
        ('theme = "pink"', "theme is one of terminal, dark, light"),
        ("mouse = 1", "mouse is true or false."),
        ("logs = 1", "logs is a folder"),
        ("keys = 1", "keys is a table"),
        ('[keys]\nundos = "x"', "There is no action undos. Did you mean undo?"),
        ("[keys]\nundo = 1", "The keys of undo are a text"),
        ('[keys]\nundo = "r"', "The key r means both rename and undo"),
        ('[keys]\nstop = ""', "stop has to have a key."),
        ("theme = ", "The settings are no TOML"),
    ],
)
def test_what_is_wrong_is_named(tmp_path: Path, text: str, said: str) -> None:
    with pytest.raises(FormatError) as caught:
        read(tmp_path, text)
    assert said in str(caught.value)
    assert "tui.toml" in str(caught.value)


def test_a_file_that_is_no_text(tmp_path: Path) -> None:
    (tmp_path / "tui.toml").write_bytes(b"\xff\xfe")
    with pytest.raises(FormatError, match="can't be read"):
        read_settings(tmp_path / "tui.toml")
