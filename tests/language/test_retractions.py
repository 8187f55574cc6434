"""What was asked for and is taken back, limited or put first."""

from __future__ import annotations

import pytest

from bench.speech_meaning import Context
from polaris_nl.language.understanding import Understanding
from polaris_nl.model.world_file import load_world

BEFORE = ("bring the tray to the table", "then go home")
TRAY = "start [(at tray table)"


@pytest.mark.parametrize(
    ("said", "program"),
    [
        ("don't go home", f"{TRAY}]"),
        ("don't go home go to the kitchen", f"{TRAY} [(robot-at kitchen)]]"),
        ("don't go home but go to the kitchen", f"{TRAY} [(robot-at kitchen)]]"),
        ("don't go to the kitchen", f"{TRAY} [(robot-at home) [(not (robot-at kitchen))]]]"),
        (
            "don't go home before you fill the tray",
            f"{TRAY} [(is-full tray) [(robot-at home)]]]",
        ),
        (
            "only go home if the resident is in her room",
            f"{TRAY} [when (person-in resident room-1): (robot-at home)]]",
        ),
        ("instead of the tray bring the plate", "start [(at plate table) [(robot-at home)]]"),
        ("the tray should go on the desk instead", "start [(at tray desk) [(robot-at home)]]"),
    ],
)
def test_what_was_asked_for_is_changed(said: str, program: str) -> None:
    context = Context(Understanding(load_world("care-home")), BEFORE)
    assert context.understood(said)[1] == program


@pytest.mark.parametrize(
    ("said", "program"),
    [
        ("shut the fridge but first put the plate in it",
         "start [(in plate fridge) [(not (open fridge))]]"),
        ("put the plate in the fridge and close it afterwards",
         "start [(in plate fridge) [(not (open fridge))]]"),
        ("before you go to the kitchen close the fridge",
         "start [(not (open fridge)) [(robot-at kitchen)]]"),
        ("wait until the resident is in her room before you open the wardrobe",
         "start [when (person-in resident room-1): (open wardrobe)]"),
        ("open the fridge put the plate inside and close it",
         "start [(in plate fridge) & (open fridge) [(not (open fridge))]]"),
    ],
)  # fmt: skip
def test_what_is_to_come_first_comes_first(said: str, program: str) -> None:
    context = Context(Understanding(load_world("care-home")))
    assert context.understood(said)[1] == program
