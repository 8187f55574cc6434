"""Edits, corrections and half-said sentences: what becomes of the program."""

from __future__ import annotations

from collections.abc import Iterable

import pytest

from polaris_nl.session import Session

from .dialogues_reader import described, world_of


def said(world: str, sentences: Iterable[str]) -> tuple[str, str]:
    """The program after some sentences, and what the last of them came to."""
    outcome = ""
    with Session(world_of(world)) as session:
        for sentence in sentences:
            outcome = session.say(sentence, wait_s=0).interpretation.outcome
        return described(session.snapshot.automaton), outcome


CORRECTED = [
    (["Put the green bowl in the fridge.", "No, the other one."], "(in white-bowl fridge)"),
    (["Put the cup in the fridge.", "No, on the shelf."], "(at cup shelf)"),
    (["Put the cup on the shelf.", "No, give it to the host."], "(has host cup)"),
    (["Put the cup on the shelf.", "Not the shelf, the sideboard."], "(at cup sideboard)"),
    (["Put the cup on the shelf.", "It should be the plate."], "(at plate shelf)"),
    (["Put the cup on the shelf.", "Open the fridge.", "I meant the sideboard."], "(at cup sideboard)"),
    (["Put the cup on the shelf.", "Open the fridge.", "Change the cup to the fork."], "(at fork shelf)"),
    (["Open the fridge.", "No, close it."], "(not (open fridge))"),
    (["If the fridge is open, go home.", "No, if the drawer is open."], "-[(open drawer)]-> home"),
    (["If the fridge is open", "close it"], "-[(open fridge)]-> closed [(not (open fridge))]"),
    (["Bring the bowl to the shelf.", "No, the plate."], "(at plate shelf)"),
    (["Bring the bowl to the shelf.", "The green one.", "No, the white one."], "(at white-bowl shelf)"),
    (["Go to the pantry and open the fridge.", "No, go home and open the drawer."], "home [(robot-at home)]"),
    (["Give the cup to the host.", "The same for the plate."], "[(has host plate)]"),
    (["Open the bathroom.", "I meant, open the fridge."], "(open fridge)"),
]  # fmt: skip


@pytest.mark.parametrize(("sentences", "wanted"), CORRECTED)
def test_a_correction_changes_what_was_just_done(sentences: list[str], wanted: str) -> None:
    program, outcome = said("dinner-party", sentences)
    assert outcome == "applied"
    assert wanted in program


def test_a_correction_renames_what_was_named_automatically() -> None:
    assert said("dinner-party", ["Go to the pantry.", "No, the kitchen."])[0] == (
        "start -[]-> kitchen [(robot-at kitchen)]"
    )
    named = ["Go to the pantry.", "Call that food.", "No, the kitchen."]
    assert "food" in said("dinner-party", named)[0]


def test_another_number_is_meant() -> None:
    program, _ = said(
        "care-home", ["Bring two cups to the desk.", "The blue one and the red one.", "No, three."]
    )
    assert program.count("cup desk") == 3


def test_another_step_is_meant_by_an_edit() -> None:
    steps = ["Open the fridge.", "Go home.", "Remove home.", "No, the first one."]
    assert said("dinner-party", steps)[0] == "start -[]-> home [(robot-at home)]"


THREE = ["Open the fridge.", "Go to the pantry.", "Go home."]


@pytest.mark.parametrize(
    ("edit", "order"),
    [
        ("Swap opened and pantry.", ["pantry", "opened", "home"]),
        ("Swap opened and home.", ["home", "pantry", "opened"]),
        ("Move opened to the end.", ["pantry", "home", "opened"]),
        ("Put home first.", ["home", "opened", "pantry"]),
        ("Move home before pantry.", ["opened", "home", "pantry"]),
        ("Remove opened and home.", ["pantry"]),
        ("Remove the last two steps.", ["opened"]),
        ("Remove everything after opened.", ["opened"]),
        ("Delete steps one and two.", ["home"]),
        ("Before you go home, go to the hall.", ["opened", "pantry", "hall", "home"]),
        ("Between opened and pantry, go to the hall.", ["opened", "hall", "pantry", "home"]),
        ("Before everything else, go to the hall.", ["hall", "opened", "pantry", "home"]),
        ("Insert \"go to the hall\" after opened.", ["opened", "hall", "pantry", "home"]),
        ("But first go to the hall.", ["opened", "pantry", "hall", "home"]),
        ("Instead of going to the pantry, go to the hall.", ["opened", "hall", "home"]),
        ("Rename the last step to base.", ["opened", "pantry", "base"]),
    ],
)  # fmt: skip
def test_an_edit_changes_the_order(edit: str, order: list[str]) -> None:
    program, outcome = said("dinner-party", [*THREE, edit])
    assert outcome == "applied"
    arrows = dict(arrow.split(" [")[0].split(" -[]-> ") for arrow in program.split("; "))
    found, at = [], "start"
    while at in arrows:
        at = arrows[at]
        found.append(at)
    assert found == order


@pytest.mark.parametrize(
    "edit",
    [
        "No, I meant home.",
        "Rename home to home.",
        "Make home unconditional.",
        "Change home to home.",
    ],
)
def test_what_changes_nothing_says_so(edit: str) -> None:
    before, _ = said("dinner-party", THREE)
    assert said("dinner-party", [*THREE, edit]) == (before, "answer")


def test_merging_and_splitting() -> None:
    merged = [*THREE, "Merge opened and pantry."]
    assert "opened [(open fridge), (robot-at pantry)]" in said("dinner-party", merged)[0]
    assert said("dinner-party", [*merged, "Split opened."])[0].count("->") == 3
    assert said("dinner-party", [*THREE, "Split home."])[1] == "refused"


def test_connecting_by_a_word_for_what_happens() -> None:
    program, _ = said(
        "care-home",
        ["Tell the resident that lunch is ready.", "Go home.", "Connect alerted to home when dismissed."],
    )  # fmt: skip
    assert "alerted -[(dismissed lunchtime)]-> home" in program


def test_a_wait_is_no_correction() -> None:
    program, _ = said(
        "dinner-party", ["Put the cup on the countertop.", "Wait until it is on the drying rack."]
    )
    assert "-[(at cup drying-rack)]->" in program
    assert "(at cup countertop)" in program


@pytest.mark.parametrize(
    "sentence",
    [
        "Put every cup in every drawer.",
        "Move all the dishes to every table.",
        "Then put everything in everything.",
    ],
)
def test_all_of_two_kinds_at_once_is_no_goal(sentence: str) -> None:
    program, outcome = said("dinner-party", [sentence])
    assert "?x ?x" not in program
    assert outcome in ("question", "refused")


@pytest.mark.parametrize(
    "edit",
    [
        "Before anything else, open the fridge, then put the cup in it.",
        "Before that, open the fridge, then put the cup in it.",
        "But first open the fridge and then put the cup in it.",
    ],
)
def test_steps_put_between_others_keep_their_order(edit: str) -> None:
    program, _ = said("care-home", ["Go home.", edit])
    opened, put, home = (
        program.index(g) for g in ("(open fridge)", "(in cup fridge)", "(robot-at home)")
    )
    assert opened < put < home
    assert program.count("-[]->") == 3


def test_steps_put_in_front_are_said_back_in_their_order() -> None:
    with Session(world_of("care-home")) as session:
        session.say("Go home.", wait_s=0)
        before = "Before anything else, open the fridge, then put the cup in it."
        said = session.say(before, wait_s=0).interpretation.say
        assert said == "First, open the fridge, then put the cup in the fridge."
