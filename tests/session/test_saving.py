"""Programs in files: saved with each change, loaded, and what becomes of files that cannot be."""

from __future__ import annotations

from pathlib import Path

import pytest

from polaris_nl.automaton.automaton import Automaton
from polaris_nl.automaton.program import read_program
from polaris_nl.execution.events import (
    Failed,
)
from tests.session.conftest import (
    CUP,
    HOME,
    TABLE,
    Open,
    Watched,
    add,
    goals,
)


def test_every_change_is_saved_and_can_be_loaded_elsewhere(
    open_session: Open, tmp_path: Path
) -> None:
    path = tmp_path / "a.polaris.json"
    first = open_session(path)
    first.say(CUP)
    assert read_program(path) == first.program
    first.say(HOME)
    assert read_program(path) == first.program
    first.say("undo")
    assert read_program(path) == first.program
    second = open_session(path)
    loaded = second.say("load")
    assert loaded.snapshot.automaton == first.snapshot.automaton
    assert loaded.snapshot.planning == "planned"
    assert path.name in loaded.say
    assert second.say("undo").snapshot.automaton == Automaton()
    assert read_program(path).automaton == Automaton()


def test_loading_brings_back_what_is_in_the_file(open_session: Open, tmp_path: Path) -> None:
    path = tmp_path / "a.polaris.json"
    session = open_session(path)
    session.say(CUP)
    saved = path.read_text(encoding="utf-8")
    session.say("new")
    path.write_text(saved, encoding="utf-8")
    assert goals(session.say("load").snapshot.automaton) == [[TABLE]]


@pytest.mark.parametrize("text", [None, "{", '{"schema": "polaris-program/99"}'])
def test_a_file_that_cannot_be_loaded_is_refused_and_nothing_lost(
    open_session: Open, tmp_path: Path, text: str | None
) -> None:
    path = tmp_path / "a.polaris.json"
    session = open_session(path)
    session.say(CUP)
    before = session.snapshot
    path.unlink()
    if text is not None:
        path.write_text(text, encoding="utf-8")
    answer = session.say("load")
    assert answer.interpretation.outcome == "refused"
    assert str(path) in answer.say
    assert session.snapshot == before


def test_save_and_load_without_a_file_are_refused(session: Watched) -> None:
    for command in ("save", "load"):
        answer = session.say(command)
        assert answer.interpretation.outcome == "refused"
        assert answer.interpretation.command is None
        assert "--program" in answer.say


def test_a_file_that_cannot_be_written_is_reported_and_nothing_lost(
    open_session: Open, tmp_path: Path
) -> None:
    path = tmp_path / "gone" / "a.polaris.json"
    session = open_session(path)
    answer = session.say(CUP)
    assert answer.interpretation.outcome == "applied"
    assert goals(answer.snapshot.automaton) == [[TABLE]]
    assert answer.snapshot.planning == "planned"
    assert str(path) in answer.failure
    (failed,) = (e for e in session.events if isinstance(e, Failed))
    assert (failed.what, failed.text) == ("save", answer.failure)
    assert str(path) in add(session, "(robot-at home)")
    for command in ("undo", "redo", "new", "undo"):
        assert str(path) in session.say(command).failure, command
    refused = session.say("save")
    assert refused.interpretation.outcome == "refused"
    assert str(path) in refused.say
    path.parent.mkdir()
    assert session.say("save").interpretation.outcome == "command"
    assert read_program(path) == session.program
    assert goals(session.program.automaton) == [[TABLE], ["(robot-at home)"]]
