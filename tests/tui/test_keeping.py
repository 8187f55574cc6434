"""Programs without a name: kept, found again, named."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from polaris_nl.automaton.automaton import Automaton
from polaris_nl.automaton.edits import ReplaceProgram
from polaris_nl.automaton.program import Program, write_program
from polaris_nl.model.errors import FileError, PolarisError
from polaris_nl.model.world import World
from polaris_nl.session import Session
from polaris_tui.keeping import keeping_path, leftovers, saved_as, state_folder, tidied
from tests.planning.conftest import program
from tests.tui.conftest import LIMIT_S


def test_what_a_dead_session_left_is_found(tmp_path: Path) -> None:
    own = keeping_path("care-home", tmp_path)
    assert own is not None
    write_program(Program(program("open: (open fridge)"), "caregiving", "care-home"), own)
    assert leftovers("care-home", tmp_path) == []  # this process lives
    done = subprocess.run([sys.executable, "-c", "import os; print(os.getpid())"],
                          capture_output=True, text=True, timeout=LIMIT_S, check=True)  # fmt: skip
    left = own.rename(tmp_path / f"care-home-{int(done.stdout)}.polaris.json")
    assert [x.path for x in leftovers("care-home", tmp_path)] == [left]
    assert leftovers("dinner-party", tmp_path) == []
    assert tidied(left)
    write_program(Program(Automaton(), "caregiving", "care-home"), left)
    assert not tidied(left)
    assert not left.exists()
    (tmp_path / "file").write_text("")
    assert keeping_path("x", tmp_path / "file") is None
    (tmp_path / "broken-1x.polaris.json").write_text("{")
    assert leftovers("care-home", tmp_path) == []


def test_names_of_worlds_are_harmless_in_files(tmp_path: Path) -> None:
    for world, expected in (
        ("../../etc", "etc"),
        ("Küche 2", "k-che-2"),
        ("", "world"),
        ("..", "world"),
    ):
        path = keeping_path(world, tmp_path)
        assert path is not None
        assert path.parent == tmp_path
        assert path.name == f"{expected}-{os.getpid()}.polaris.json"


def test_the_newest_comes_first(tmp_path: Path) -> None:
    dead = subprocess.Popen([sys.executable, "-c", ""])
    dead.wait()
    kept = Program(program("open: (open fridge)"), "caregiving", "care-home")
    paths = [tmp_path / f"{name}-{dead.pid}.polaris.json" for name in ("old", "new", "middle")]
    for path, age in zip(paths, (100, 0, 50), strict=True):
        write_program(kept, path)
        os.utime(path, (1_000_000 - age, 1_000_000 - age))
    assert [x.path.name.split("-")[0] for x in leftovers("care-home", tmp_path)] == [
        "new",
        "middle",
        "old",
    ]


def test_a_name_is_given_once(care_home: World, tmp_path: Path) -> None:
    with Session(care_home, program("open: (open fridge)")) as session:
        file = tmp_path / "mine.polaris.json"
        assert saved_as(session, file) == "Kept in mine.polaris.json from now on."
        assert saved_as(session, file).startswith("Kept in")  # the same program
        assert session.path == file
        session.edit([ReplaceProgram(Automaton())], "start over")
        assert len(json.loads(file.read_text())["checkpoints"]) == 1
        other = tmp_path / "other.polaris.json"
        write_program(Program(program("hall: (robot-at hall)"), "caregiving", "care-home"), other)
        with pytest.raises(FileError, match="There is another program"):
            saved_as(session, other)
        with pytest.raises(PolarisError):
            saved_as(session, tmp_path / "none" / "x.polaris.json")
        assert session.path == file


def test_the_state_folder_is_the_users(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path))
    assert state_folder() == tmp_path / "polaris-nl"
