"""The plan as text in all its forms, of a program of each shipped world."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import pytest

from polaris_nl.automaton.program import write_program
from tests.golden.files import check_golden
from tests.session.test_contrast import PROGRAMS, SOLVER_WORDS, opened

from .conftest import Command

FORMS = {
    "care-home": (("--short",), ("--full",), ("--branch", "cancelled"), ("--state", "0"), ("--state", "7")),
    "dinner-party": (("--short",), ("--full", "--branch", "opened"), ("--state", "10")),
}  # fmt: skip


@pytest.fixture(scope="module")
def programs(tmp_path_factory: pytest.TempPathFactory) -> Mapping[str, Path]:
    """A program file for each shipped world."""
    found = {}
    for world in PROGRAMS:
        found[world] = tmp_path_factory.mktemp(world) / "program.json"
        with opened(world) as session:
            write_program(session.program, found[world])
    return found


@pytest.mark.parametrize("world", PROGRAMS)
def test_the_forms_read_well(command: Command, programs: Mapping[str, Path], world: str) -> None:
    text = ""
    for options in FORMS[world]:
        result = command("plan", programs[world], *options)
        assert (result.code, result.err) == (0, "")
        assert not SOLVER_WORDS.search(result.out)
        text += f"$ plan {' '.join(options)}\n{result.out}\n"
    check_golden(f"answers/plan-{world}.txt", text)


def test_a_branch_keeps_the_numbers_of_the_whole_plan(
    command: Command, programs: Mapping[str, Path]
) -> None:
    path = programs["care-home"]
    out = command("plan", path, "--branch", "cancelled").out
    assert "14 go to the caregiver's office" in out
    assert "tray" not in out
    assert "I go to the caregiver's office" in command("why", path, "--action", 14).out
    value = command("plan", "--json", path, "--branch", "cancelled").json
    assert [s["to"] for s in value["segments"]] == ["c1", "c4"]
    assert value["branches"] == [{"checkpoints": ["c0", "c1", "c4"], "actions": 5}]
    assert set(value) >= {"status", "ms", "segments", "branches", "tree", "problems", "warnings"}


def test_the_state_after_an_action_as_json(command: Command, programs: Mapping[str, Path]) -> None:
    path = programs["care-home"]
    value = command("plan", "--json", path, "--state", 6).json
    assert value["action"] == "(pick tray empty-trays)"
    assert {"(holding tray)", "(acknowledged lunchtime)"} <= set(value["added"])
    assert {"(at tray empty-trays)", "(hand-empty)"} <= set(value["removed"])
    assert set(value["added"]) <= set(value["facts"])
    start = command("plan", "--json", path, "--state", 0).json
    assert (start["action"], start["added"], start["removed"]) == (None, [], [])


def test_a_form_of_a_plan_with_a_problem(command: Command, tmp_path: Path) -> None:
    path = tmp_path / "p.json"
    said = "Go to the kitchen. Then hold the cup and the plate."
    command("say", "--world", "care-home", "--program", path, said)
    for form in ("--short", "--full"):
        result = command("plan", path, form)
        assert result.code == 1
    assert "can't be done from" in command("plan", path, "--short").out
    assert "at once" in command("plan", path, "--full").out


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--state", 99), "There is no action 99"),
        (("--state", -1), "There is no action -1"),
        (("--branch", "canceled"), "cancelled"),
        (("--short", "--full"), "not allowed with"),
        (("--state", 1, "--short"), "not allowed with"),
    ],
)
def test_wrong_usage(
    command: Command, programs: Mapping[str, Path], options: tuple[object, ...], words: str
) -> None:
    result = command("plan", programs["care-home"], *options)
    assert result.code == 2
    assert words in result.err


def test_why_not_names_the_price_and_an_earlier_place(
    command: Command, programs: Mapping[str, Path]
) -> None:
    path = programs["care-home"]
    told = command("why", path, "--not", "(at cup desk)").out.replace("\n", " ")
    assert "It is possible after" in told
    assert "more actions: I go to the hall" in told
    assert command("why", path, "--not", "the resident is in the office").code == 1
