"""What was heard by too narrow a margin is asked about, and only that."""

from __future__ import annotations

import pytest

from polaris_nl.speech.doubt import Case, Reading, doubts, is_sure, opposite
from polaris_nl.speech.hearing import utterance
from polaris_nl.speech.recogniser import Spoken
from polaris_nl.speech.weight import Weight

CUP, TRAY = "move the cup to the desk", "move the tray to the desk"
NOISE = "who's a threat to the best"


def asked(
    chosen: Reading,
    *others: Reading,
    free: str = NOISE,
    different: float = 0.1,
    weight: Weight = Weight.CHANGING,
) -> tuple[str, ...]:
    return doubts(Case(chosen, others, free, different, weight), means)


def means(text: str) -> str:
    return text.replace("then ", "")


def test_another_reading_that_is_as_likely_is_asked_about_too() -> None:
    assert asked(Reading(CUP, 2.0), Reading(TRAY, 1.5)) == (CUP, TRAY)
    assert asked(Reading(CUP, 2.0), Reading(TRAY, 3.0)) == (CUP, TRAY)


@pytest.mark.parametrize(
    "other",
    [Reading(TRAY, 0.9), Reading(f"then {CUP}", 2.0), Reading(TRAY, None)],
    ids=["less likely", "means the same", "not known"],
)
def test_other_readings_are_no_doubt(other: Reading) -> None:
    assert asked(Reading(CUP, 2.0), other) == ()


def test_what_little_speaks_for_is_asked_about() -> None:
    assert asked(Reading(CUP, -0.1), different=0.4) == (CUP,)
    assert asked(Reading(CUP, 2.0, rank=8), different=0.4) == (CUP,)
    assert asked(Reading(CUP, -0.1), different=0.2) == ()
    assert asked(Reading(CUP, 2.0, rank=7), different=0.4) == ()
    assert asked(Reading("redo", -0.1), free="when do", different=0.57) == ()


@pytest.mark.parametrize("weight", [Weight.ASKING, Weight.HARMLESS])
def test_only_what_changes_something_is_asked_about(weight: Weight) -> None:
    assert asked(Reading(CUP, 2.0), Reading(TRAY, 2.0), weight=weight) == ()


def test_what_is_heard_freely_as_the_same_is_done() -> None:
    assert asked(Reading(CUP, -1.0), Reading(TRAY, 0.0), free=f"then {CUP}", different=0.4) == ()
    assert asked(Reading(CUP, -1.0), Reading(TRAY, 0.0), free="", different=0.4) == ()


@pytest.mark.parametrize(
    ("gains", "free", "accepted"),
    [
        ((1.0, 0.5), "move the cap to the desk", False),
        ((3.0, 0.5), "move the cap to the desk", True),
        ((1.0, 0.5), CUP, True),
    ],
    ids=["as likely", "likelier", "heard freely as well"],
)
def test_an_utterance_is_left_alone_where_it_is_doubtful(
    gains: tuple[float, ...], free: str, accepted: bool
) -> None:
    piece = Spoken((CUP, TRAY), b"", free, gains)

    def weigh(text: str) -> Weight | None:
        return Weight.CHANGING if text in (CUP, TRAY) else None

    assert utterance([piece], weigh).accepted, "nobody can be asked"
    said = utterance([piece], weigh, means=str)
    assert said.text == CUP
    assert said.accepted is accepted
    assert said.doubts == (() if accepted else (CUP, TRAY))
    assert bool(said.why_not) is not accepted


@pytest.mark.parametrize(
    ("one", "other", "found"),
    [
        ("it should be open", "it shouldn't be open", True),
        ("do not go", "do go", True),
        ("it should be open", "it should be open", False),
        ("it should be open", "it shouldn't be shut", False),
        ("put the knot away", "put the k away", False),
    ],
)
def test_the_opposite_differs_by_a_not(one: str, other: str, found: bool) -> None:
    assert opposite(one, other) is opposite(other, one) is found


def test_a_lost_not_is_asked_about_whatever_was_heard_freely() -> None:
    opened, shut = "the door should be left open", "the door shouldn't be left open"
    assert asked(Reading(opened, 13.0), Reading(shut, 10.6), free=opened) == (opened, shut)
    assert asked(Reading(opened, 13.0), Reading(shut, 9.9), free=opened) == ()
    piece = Spoken((opened, TRAY, shut), b"", opened, (13.0, 12.5, 10.6))
    said = utterance([piece], lambda text: Weight.CHANGING, means=str)
    assert said.doubts == (opened, shut)


@pytest.mark.parametrize(
    ("case", "sure"),
    [
        (Case(Reading(CUP, 1.0), [Reading(TRAY, 0.9)], f"then {CUP}", 0.1, Weight.CHANGING), True),
        (Case(Reading(CUP, 1.0), [Reading(TRAY, -3.0)], NOISE, 0.3, Weight.CHANGING), True),
        (Case(Reading(CUP, 1.0), [Reading(TRAY, -1.0)], NOISE, 0.3, Weight.CHANGING), False),
        (Case(Reading(CUP, 1.0), [], NOISE, 0.4, Weight.CHANGING), False),
        (Case(Reading(CUP, -4.0), [], NOISE, 0.1, Weight.CHANGING), False),
        (Case(Reading(CUP, None), [], CUP, 0.0, Weight.CHANGING), False),
        (Case(Reading(CUP, 1.0), [], CUP, 0.0, Weight.ASKING), False),
    ],
    ids=["both mean it", "likelier", "narrowly", "far", "unlikely", "unknown", "in part"],
)
def test_what_both_decodings_bear_out_is_sure(case: Case, sure: bool) -> None:
    assert is_sure(case, means) is sure
