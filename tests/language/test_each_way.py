"""What is to be done at the end of every branch, and where what is spoken of as done is done."""

from __future__ import annotations

import pytest

from bench.speech_meaning import Context

from .test_requests import understanding

BINGO = (
    "tell her bingo is starting", "if she acknowledges give her the book",
    "if she dismisses it give her the newspaper",
)  # fmt: skip
PAPER = ("give her the newspaper", "then go home")
BOOK = "start [(alerted-to resident bingo) [when (acknowledged bingo): (has resident book)"
NEWS = "[when (dismissed bingo): (has resident newspaper)"
HOME, SHUT = "(robot-at home)", "(not (open wardrobe))"


def after(said: str, before: tuple[str, ...]) -> str:
    return Context(understanding("care-home"), before).understood(said)[1]


@pytest.mark.parametrize(
    "said",
    [
        "either way go home",
        "in both cases go home afterwards",
        "whatever she says go home at the end",
        "whatever happens, go home",
        "no matter what she says go home",
        "go home afterwards in both cases",
        "and then go home in any case",
        "go home at the end whatever she says",
    ],
)
def test_it_is_added_to_the_end_of_every_branch(said: str) -> None:
    assert after(said, BINGO) == f"{BOOK} [{HOME}]] {NEWS} [{HOME}]]]"


@pytest.mark.parametrize(
    ("before", "said", "program"),
    [
        (BINGO, "either way close the wardrobe and then go home",
         f"{BOOK} [{SHUT} [{HOME}]]] {NEWS} [{SHUT} [{HOME}]]]]"),
        ((*BINGO, "then go home"), "either way go home", f"{BOOK} [{HOME}]] {NEWS} [{HOME}]]]"),
        (("give her the newspaper",), "either way go home", f"start [(has resident newspaper) [{HOME}]]"),
        (("if the fridge is open close it",), "close the fridge in any case", "start [(not (open fridge))]"),
    ],
)  # fmt: skip
def test_what_ends_so_already_stays_and_one_way_is_each_way(
    before: tuple[str, ...], said: str, program: str
) -> None:
    assert after(said, before) == program


@pytest.mark.parametrize(
    "said", ["go to the kitchen and whatever is on the table", "whatever is on the table go home"]
)
def test_a_thing_of_any_kind_is_no_way(said: str) -> None:
    assert after(said, BINGO).count("robot-at") < 2


@pytest.mark.parametrize(
    ("said", "program"),
    [
        ("once you've given her the newspaper tell her bingo is starting",
         f"start [(has resident newspaper) [(alerted-to resident bingo) [{HOME}]]]"),
        ("when you give her the newspaper tell her bingo is starting",
         f"start [(has resident newspaper) [(alerted-to resident bingo) [{HOME}]]]"),
        ("go home once she has it", f"start [(has resident newspaper) [{HOME}]]"),
        ("go home again once she has it",
         f"start [(has resident newspaper) [{HOME} [when (has resident newspaper): {HOME}]]]"),
        ("once she's in her room go home",
         f"start [(has resident newspaper) [{HOME} [when (person-in resident room-1): {HOME}]]]"),
    ],
)  # fmt: skip
def test_what_is_spoken_of_as_done_is_done_where_it_is(said: str, program: str) -> None:
    assert after(said, PAPER) == program
