"""World files: what is read, and what each mistake is told."""

from __future__ import annotations

from pathlib import Path

import pytest

from polaris_nl.model.errors import FileError, FormatError, PolarisError
from polaris_nl.model.formula import parse_literal
from polaris_nl.model.world import World
from polaris_nl.model.world_file import load_world, read_world

from .conftest import DOMAIN, WORLD, Write


def test_a_world_is_read_whole(flat: World) -> None:
    assert flat.name == "flat"
    assert flat.domain.name == "errands"
    assert list(flat.entities) == ["kitchen", "shelf", "red-cup", "plate", "ann"]
    cup = flat.entities["red-cup"]
    assert (cup.spoken, cup.noun, cup.adjectives, cup.synonyms) == (
        "red cup",
        "cup",
        ("red",),
        ("mug",),
    )
    assert flat.entities["kitchen"].area == ((0.0, 0.0), (4.0, 3.0))
    assert flat.user is flat.entities["ann"]
    assert parse_literal("(at red-cup shelf)") in flat.initial
    assert flat.scenario.human_actions[0].when == (parse_literal("(called ann)"),)
    assert flat.kinds == {"dish": {"red-cup", "plate"}}


def test_places_are_found_through_surfaces_and_the_hand(flat: World) -> None:
    assert flat.place_of("red-cup", flat.initial) == "kitchen"
    held = flat.initial.change(
        [parse_literal("(at red-cup shelf)")], [parse_literal("(holding red-cup)")]
    )
    assert flat.place_of("red-cup", held) == "kitchen"
    assert flat.place_of("plate", flat.initial) is None


@pytest.mark.parametrize(
    ("old", "new", "line", "reason"),
    [
        ("name: flat", "nam: flat", 2, "no field 'nam'. Did you mean name?"),
        ("polaris-world/1", "polaris-world/2", 1, "newer than polaris-world/1"),
        ("polaris-world/1", "polaris-program/1", 1, "no world file"),
        ("type: surface", "type: surfaces", 6, "no type surfaces. Did you mean surface?"),
        ("{name: plate, type", "{name: shelf, type", 8, "another shelf on line 6"),
        ("{name: plate, type: object, ", "{name: plate, ", 8, "has no type"),
        ("{name: plate, type", "{name: The Plate, type", 8, "no entity name"),
        (
            "kinds: [dish]}\n  - {name: ann",
            "kins: [dish]}\n  - {name: ann",
            8,
            "Did you mean kinds?",
        ),
        ("kinds: [dish]}\n  - {name: ann", "owner: anne}\n  - {name: ann", 8, "Did you mean ann?"),
        (
            "(at red-cup shelf)",
            "(at red-cop shelf)",
            10,
            "nothing called red-cop. Did you mean red-cup?",
        ),
        (
            "(at red-cup shelf)",
            "(at shelf red-cup)",
            10,
            "shelf is a surface, but an object is needed",
        ),
        ("(at red-cup shelf)", "(at red-cup)", 10, "has 1 arguments, but takes 2"),
        ("(at red-cup shelf)", "(not (at red-cup shelf))", 10, "needn't be said"),
        ("(robot-at kitchen)", "(robot-in kitchen)", 10, "Did you mean robot-at?"),
        ("(robot-at kitchen)", "(robot-at kitchen", 10, "never closed"),
        ("[[4.0, 3.0], [0.0, 0.0]]", "[[4.0, 3.0], [4.0, 0.0]]", 5, "area is empty"),
        ("[1.0, 1.0, 0.0]", "[1.0, 1.0]", 6, "pose is 3 numbers"),
        ("[1.0, 1.0, 0.0]", "[1.0, .nan, 0.0]", 6, "pose is 3 numbers"),
        ("gender: female", "gender: f", 9, "female or male"),
        ("user: true", "user: maybe", 9, "true or false"),
        ("effect: [", "effects: [", 14, "Did you mean effect?"),
        ("entities:", "entities: &x", None, None),
    ],
)
def test_every_mistake_is_named_with_its_line(
    write: Write, old: str, new: str, line: int | None, reason: str | None
) -> None:
    assert old in WORLD
    path = write(WORLD.replace(old, new, 1))
    if reason is None:
        assert read_world(path).name == "flat"
        return
    with pytest.raises(FormatError) as caught:
        read_world(path)
    assert reason.split(".")[0] in str(caught.value)
    assert caught.value.line == line
    assert caught.value.path == path
    assert "\n" not in str(caught.value)


def test_a_fault_in_the_domain_is_told_with_the_domains_path(write: Write) -> None:
    path = write(domain=DOMAIN.replace("(hand-empty)\n", "(hand-empty\n", 1))
    with pytest.raises(FormatError, match=r"errands\.pddl, line 1: The parenthesis opened here"):
        read_world(path)


def test_a_missing_world_names_the_ones_there_are() -> None:
    with pytest.raises(FileError, match="care-home"):
        load_world("care-hom")


@pytest.mark.parametrize("content", [b"", b"\xff\xfe\x00", b"a: [", b"- 1\n- 2", b"a: &b [*b]"])
def test_files_that_are_no_worlds_raise_one_sentence(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "w.yaml"
    path.write_bytes(content)
    with pytest.raises(PolarisError) as caught:
        read_world(path)
    assert "\n" not in str(caught.value)
    assert str(path) in str(caught.value)
