"""Program files, and what is wrong with programs."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from polaris_nl.automaton.automaton import Automaton, Checkpoint, Transition
from polaris_nl.automaton.program import (
    program_json,
    program_of,
    read_program,
    write_program,
)
from polaris_nl.automaton.validation import validate
from polaris_nl.model.errors import FileError, FormatError
from polaris_nl.model.formula import parse_formula, parse_literal
from polaris_nl.model.world import World
from polaris_nl.model.world_file import load_world

EXAMPLE: dict[str, Any] = {
    "schema": "polaris-program/1",
    "domain": "caregiving",
    "world": "care-home",
    "checkpoints": [
        {"id": "c0", "name": "start", "goals": []},
        {"id": "c1", "name": "alerted", "goals": ["(alerted-to resident lunchtime)"]},
        {"id": "c2", "name": "placed", "goals": [], "action": "(place tray table)"},
    ],
    "transitions": [
        {"id": "t1", "from": "c0", "to": "c1", "when": []},
        {
            "id": "t2",
            "from": "c1",
            "to": "c2",
            "when": ["(acknowledged lunchtime)"],
            "on": "success",
        },
    ],
}


@pytest.fixture(scope="module")
def care_home() -> World:
    """The shipped world."""
    return load_world("care-home")


def test_the_example_survives_a_round_trip(tmp_path: Path) -> None:
    path = tmp_path / "p.polaris.json"
    write_program(program_of(EXAMPLE), path)
    assert program_json(read_program(path)) == EXAMPLE


@pytest.mark.parametrize(
    ("path", "value", "reason"),
    [
        (["schema"], "polaris-program/9", "newer than polaris-program/1"),
        (["schema"], "polaris-world/1", "no program file"),
        (["checkpoints"], {}, "checkpoints of the program is a list"),
        (["checkpoints", 0, "id"], "c7", "has no start"),
        (["checkpoints", 1, "id"], "c0", "Two checkpoints have the id c0"),
        (["checkpoints", 1, "goals"], ["(alerted-to"], "never closed"),
        (["checkpoints", 1, "goals"], [7], "is a text, not 7"),
        (["checkpoints", 1, "goal"], [], "no field 'goal'"),
        (["checkpoints", 2, "goals"], ["(robot-at home)"], "leave one of them out"),
        (["checkpoints", 2, "action"], "place", "no action"),
        (["checkpoints", 1], "alerted", "A checkpoint is a JSON object"),
        (["transitions", 0, "to"], 1, "is a text, not 1"),
        (["transitions", 1, "id"], "t1", "Two transitions have the id t1"),
        (["transitions", 1, "when"], ["(and (a))"], "not a single fact"),
        (["transitions", 1, "on"], "maybe", "success or failure"),
    ],
)
def test_a_mistake_in_a_program_file_is_named(
    tmp_path: Path, path: list[str | int], value: object, reason: str
) -> None:
    program = json.loads(json.dumps(EXAMPLE))
    place = program
    for key in path[:-1]:
        place = place[key]
    place[path[-1]] = value
    file = tmp_path / "p.json"
    file.write_text(json.dumps(program), encoding="utf-8")
    with pytest.raises(FormatError) as caught:
        read_program(file)
    assert reason in str(caught.value)
    assert str(file) in str(caught.value)


@pytest.mark.parametrize("content", [b"", b"{", b"[1]", b"\xff", b"null", b"[" * 5000])
def test_files_that_are_no_programs_raise_one_sentence(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "p.json"
    path.write_bytes(content)
    with pytest.raises(FileError) as caught:
        read_program(path)
    assert "\n" not in str(caught.value)


def test_every_cut_off_file_is_refused_and_none_is_half_read(tmp_path: Path) -> None:
    whole = json.dumps(EXAMPLE)
    path = tmp_path / "p.json"
    for length in range(len(whole) - 1):
        path.write_text(whole[:length], encoding="utf-8")
        with pytest.raises(FileError):
            read_program(path)


def test_a_failed_write_keeps_the_old_file(tmp_path: Path) -> None:
    folder = tmp_path / "programs"
    folder.mkdir()
    path = folder / "p.json"
    write_program(program_of(EXAMPLE), path)
    before = path.read_bytes()
    missing = folder / "none" / "p.json"
    with pytest.raises(FileError, match="Can't write"):
        write_program(program_of(EXAMPLE), missing)
    assert path.read_bytes() == before
    assert [p.name for p in folder.iterdir()] == ["p.json"]


def test_a_sound_program_has_no_faults(care_home: World) -> None:
    assert validate(program_of(EXAMPLE).automaton, care_home) == ()


def start() -> Checkpoint:
    return Checkpoint("c0", "start")


def automaton(checkpoints: list[Checkpoint], transitions: list[Transition]) -> Automaton:
    return Automaton({c.id: c for c in checkpoints}, {t.id: t for t in transitions})


HOME = (parse_literal("(robot-at home)"),)


@pytest.mark.parametrize(
    ("broken", "cause", "text"),
    [
        (automaton([Checkpoint("c0", "start", HOME)], []), "structure", "The start has goals"),
        (automaton([start(), Checkpoint("c1", "x")], []), "structure", "Nothing leads to x"),
        (
            automaton([start()], [Transition("t1", "c0", "c9")]),
            "structure",
            "c9, which isn't there",
        ),
        (
            automaton(
                [start(), Checkpoint("c1", "x")],
                [Transition("t1", "c0", "c1"), Transition("t2", "c1", "c0")],
            ),
            "structure",
            "leads back to the start",
        ),
        (
            automaton(
                [start(), Checkpoint("c1", "x"), Checkpoint("c2", "y")],
                [
                    Transition("t1", "c0", "c1"),
                    Transition("t2", "c0", "c2", HOME),
                    Transition("t3", "c1", "c2"),
                ],
            ),
            "structure",
            "Several transitions lead to y",
        ),
        (
            automaton([start(), Checkpoint("c1", "start")], [Transition("t1", "c0", "c1")]),
            "structure",
            "2 checkpoints are called start",
        ),
        (
            automaton(
                [start(), Checkpoint("c1", "x", (parse_formula("(at troy table)"),))],
                [Transition("t1", "c0", "c1")],
            ),
            "invalid",
            "In x: There is nothing called troy. Did you mean tray",
        ),
        (
            automaton(
                [start(), Checkpoint("c1", "x")],
                [Transition("t1", "c0", "c1", (parse_literal("(open table)"),))],
            ),
            "invalid",
            "In the conditional to x: In (open table), table is a surface, but a container is needed.",
        ),
        (
            automaton(
                [start(), Checkpoint("c1", "x"), Checkpoint("c2", "y")],
                [
                    Transition("t1", "c0", "c1", (*HOME, parse_literal("(open cupboard)"))),
                    Transition("t2", "c0", "c2", (parse_literal("(open cupboard)"), *HOME)),
                ],
            ),
            "underspecified",
            "From start, both x and y come next under the same condition",
        ),
    ],
)
def test_each_fault_is_told_with_its_cause(
    care_home: World, broken: Automaton, cause: str, text: str
) -> None:
    faults = validate(broken, care_home)
    assert (cause, True) in {(f.cause, text in f.text) for f in faults}
