"""What is taken back in mid-sentence is not asked for, and what only sounds like it is."""

from __future__ import annotations

import pytest

from bench.speech_meaning import Context

from .test_requests import understanding


@pytest.mark.parametrize(
    ("world", "said", "meant"),
    [
        ("dinner-party", "open the fridge no open the drawer", "start [(open drawer)]"),
        ("dinner-party", "go to the kitchen no go home", "start [(robot-at home)]"),
        ("dinner-party", "take the cup no take the plate", "start [(holding plate)]"),
        (
            "dinner-party",
            "open the fridge then go home no go to the pantry",
            "start [(open fridge) [(robot-at pantry)]]",
        ),
        (
            "care-home",
            "tell tom bingo is starting no tell miss green",
            "start [(alerted-to resident bingo)]",
        ),
        (
            "care-home",
            "if she is in the kitchen open the fridge no open the cupboard",
            "start [when (person-in resident kitchen): (open cupboard)]",
        ),
        (
            "care-home",
            "if the fridge is open close it no close the cupboard",
            "start [when (open fridge): (not (open cupboard))]",
        ),
        (
            "care-home",
            "when the tray is full bring it to mr brown no bring it to the resident",
            "start [when (is-full tray): (has resident tray)]",
        ),
        (
            "care-home",
            "if she is in the kitchen, open the fridge, no, open the cupboard",
            "start [when (person-in resident kitchen): (open cupboard)]",
        ),
        # What comes on top takes nothing back, nor does a "no" that somebody else says.
        (
            "dinner-party",
            "open the fridge no open the drawer too",
            "start [(open drawer) & (open fridge)]",
        ),
        (
            "care-home",
            "tell the lady that lunch is ready and if she says no tell the nurse that lunch is ready",
            "start [(alerted-to resident lunchtime)"
            " [when (dismissed lunchtime): (alerted-to caregiver lunchtime)]]",
        ),
    ],
)
def test_the_same_verb_after_a_no_says_the_clause_again(world: str, said: str, meant: str) -> None:
    assert Context(understanding(world)).understood(said)[1] == meant


@pytest.mark.parametrize(
    ("said", "meant"),
    [
        ("do the plates", "start [(has host spoon) [(is-clean plate)]]"),
        ("do it", "command: run"),
        ("that's great go ahead and do it", "command: run"),
        ("that's great do it", "command: run"),
    ],
)
def test_to_do_it_is_not_to_wash_it(said: str, meant: str) -> None:
    after = ("take the host the spoon",)
    assert Context(understanding("dinner-party"), after).understood(said)[1] == meant


def test_what_one_is_done_with_needs_no_washing() -> None:
    said = "we're done with the napkin so throw it in the trash"
    meant = Context(understanding("dinner-party")).understood(said)[1]
    assert meant == "start [(in napkin trash-can)]"
