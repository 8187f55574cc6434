"""What is there waits for something, no longer does, is done elsewhere, or gives way to something else."""

from __future__ import annotations

import pytest

from bench.speech_meaning import Context

from .test_requests import understanding

FRIDGE = ("if the fridge is open close it", "then go to the laundry")
KITCHEN = ("go to the kitchen", "then open the fridge")
BINGO = (
    "tell tom bingo is starting",
    "once he acknowledges bring the glasses to tom",
    "if he dismisses it go home",
)
BLANKET = ("open the wardrobe", "then bring the blanket to miss green", "then close the wardrobe")
NEWSPAPER = ("put the newspaper on the dining table and the plate on the desk",)
PAPER_BOOK = ("put the newspaper on the desk", "then put the book on the table")
TOLD = "start [(alerted-to mr-brown bingo) [when (acknowledged bingo): (has mr-brown glasses)]"


def after(said: str, before: tuple[str, ...]) -> str:
    return Context(understanding("care-home"), before).understood(said)[1]


@pytest.mark.parametrize(
    ("before", "said", "program"),
    [
        (KITCHEN, "open it only if tom is in the kitchen and otherwise go home",
         "start [(robot-at kitchen) [(robot-at home)] [when (person-in mr-brown kitchen): (open fridge)]]"),
        (KITCHEN, "wait till tom is in the kitchen before you open the fridge",
         "start [(robot-at kitchen) [when (person-in mr-brown kitchen): (open fridge)]]"),
        (FRIDGE, "you close it only if it's open and the water bottle is inside",
         "start [when (in water-bottle fridge) & (open fridge): (not (open fridge)) [(robot-at laundry)]]"),
        (("tell tom bingo is starting", "once he acknowledges fill the tray", "then go home"),
         "don't wait for his answer, fill it straight away",
         "start [(alerted-to mr-brown bingo) [(is-full tray) [(robot-at home)]]]"),
        (("tell tom bingo is starting", "once he acknowledges fill the tray", "then go home"),
         "don't wait for him", "start [(alerted-to mr-brown bingo) [(is-full tray) [(robot-at home)]]]"),
        (KITCHEN, "don't open the fridge while i'm in the kitchen", "refused"),
        (FRIDGE, "close the fridge in any case", "start [(not (open fridge)) [(robot-at laundry)]]"),
        (KITCHEN, "then go home only if tom is in the kitchen",
         "start [(robot-at kitchen) [(open fridge) [when (person-in mr-brown kitchen): (robot-at home)]]]"),
        (BLANKET, "bring her the blanket only if she's actually in her room mind",
         "start [(open wardrobe) [when (person-in resident room-1): (has resident blanket) "
         "[(not (open wardrobe))]]]"),
        (PAPER_BOOK, "the book only if the resident is in her room",
         "start [(at newspaper desk) [when (person-in resident room-1): (at book table)]]"),
    ],
)  # fmt: skip
def test_what_is_there_waits_or_no_longer_does(
    before: tuple[str, ...], said: str, program: str
) -> None:
    assert after(said, before) == program


@pytest.mark.parametrize(
    ("before", "said", "program"),
    [
        (BINGO, "if he dismisses it don't go home, bring him the newspaper",
         f"{TOLD} [when (dismissed bingo): (has mr-brown newspaper)]]"),
        (BINGO[:2], "or if he's in the lounge go there",
         f"{TOLD} [when (person-in mr-brown recreation-area): (robot-at recreation-area)]]"),
        (KITCHEN, "don't open it close it", "start [(robot-at kitchen) [(not (open fridge))]]"),
        (KITCHEN, "please do not open the fridge, close it",
         "start [(robot-at kitchen) [(not (open fridge))]]"),
        (KITCHEN, "if tom is in the kitchen open the cupboard instead of the fridge",
         "start [(robot-at kitchen) [(open fridge)] [when (person-in mr-brown kitchen): (open cupboard)]]"),
        (FRIDGE, "forget about the fridge", "start [(robot-at laundry)]"),
        (("tell tom bingo is starting", "once he acknowledges fill the tray", "then bring it to him"),
         "skip filling it",
         "start [(alerted-to mr-brown bingo) [when (acknowledged bingo): (has mr-brown tray)]]"),
        (BLANKET, "you can leave the wardrobe open when you're done with it",
         "start [(open wardrobe) [(has resident blanket)]]"),
        (BLANKET, "leave the wardrobe closed",
         "start [(open wardrobe) [(has resident blanket) [(not (open wardrobe))]]]"),
    ],
)  # fmt: skip
def test_something_else_is_done(before: tuple[str, ...], said: str, program: str) -> None:
    assert after(said, before) == program


@pytest.mark.parametrize(
    ("before", "said", "program"),
    [
        (NEWSPAPER, "the newspaper belongs on the coffee table",
         "start [(at newspaper coffee-table) & (at plate desk)]"),
        (NEWSPAPER, "actually the newspaper should be on the coffee table",
         "start [(at newspaper coffee-table) & (at plate desk)]"),
        (BLANKET, "the throw is for tom today",
         "start [(open wardrobe) [(has mr-brown blanket) [(not (open wardrobe))]]]"),
        (PAPER_BOOK, "the book goes on the nightstand and the newspaper goes on the coffee table",
         "start [(at newspaper coffee-table) [(at book nightstand)]]"),
        (PAPER_BOOK, "she's asleep so put the book on the nightstand",
         "start [(at newspaper desk) [(at book nightstand)]]"),
        (PAPER_BOOK, "put the book on the nightstand",
         "start [(at newspaper desk) [(at book table) [(at book nightstand)]]]"),
        (PAPER_BOOK, "then the book should be on the nightstand",
         "start [(at newspaper desk) [(at book table) [(at book nightstand)]]]"),
        (("put the towel on the desk",), "it should be all the laundry on the desk not just the towel",
         "start [(forall (?x - object) (imply (kind ?x laundry) (at ?x desk)))]"),
        (("put all dishes on the worktop", "then go home"),
         "let's make that only the plate and not all the dishes",
         "start [(at plate worktop) [(robot-at home)]]"),
        (("put all dishes on the worktop",), "just the plate and the red mug, not the whole lot",
         "start [(at plate worktop) & (at red-cup worktop)]"),
        (("put all dishes on the worktop",), "only the newspaper", "refused"),
        (("put all the laundry in the laundry basket", "then go home"), "all the laundry goes on the desk",
         "start [(forall (?x - object) (imply (kind ?x laundry) (at ?x desk))) [(robot-at home)]]"),
    ],
)  # fmt: skip
def test_what_is_said_of_a_thing_is_no_second_errand(
    before: tuple[str, ...], said: str, program: str
) -> None:
    assert after(said, before) == program


@pytest.mark.parametrize(
    ("before", "said", "program"),
    [
        (PAPER_BOOK, "the book goes first", "start [(at book table) [(at newspaper desk)]]"),
        (PAPER_BOOK, "the book before the newspaper", "start [(at book table) [(at newspaper desk)]]"),
        (PAPER_BOOK, "go to the hall right after the newspaper",
         "start [(at newspaper desk) [(robot-at hall) [(at book table)]]]"),
        (PAPER_BOOK, "between the newspaper and the book go to the hall",
         "start [(at newspaper desk) [(robot-at hall) [(at book table)]]]"),
        (PAPER_BOOK, "newspaper and book in one step", "start [(at book table) & (at newspaper desk)]"),
        (BLANKET, "do it all in one step", "refused"),
        ((*FRIDGE, "then put the towel on the desk"), "do the towel before all the rest",
         "start [(at towel desk) [when (open fridge): (not (open fridge)) [(robot-at laundry)]]]"),
        (BLANKET, "skip the closing bit", "start [(open wardrobe) [(has resident blanket)]]"),
    ],
)  # fmt: skip
def test_things_name_their_steps(before: tuple[str, ...], said: str, program: str) -> None:
    assert after(said, before) == program


@pytest.mark.parametrize(
    ("before", "said", "program"),
    [
        (("put the cup in the cupboard", "then close it"), "put the plate in and then close it",
         "start [(in cup cupboard) [(in plate cupboard) [(not (open cupboard))]]]"),
        (("fill the tray", "then bring it to the resident"), "open the fridge before she gets it",
         "start [(is-full tray) [(open fridge) [(has resident tray)]]]"),
        (BINGO, "if he dismisses it tell the nurse about bingo and only then go home",
         f"{TOLD} [when (dismissed bingo): (alerted-to caregiver bingo) [(robot-at home)]]]"),
        (("go home",), "then fill the tray and go home again",
         "start [(robot-at home) [(is-full tray) [(robot-at home)]]]"),
    ],
)  # fmt: skip
def test_what_leads_up_to_a_step_comes_before_it(
    before: tuple[str, ...], said: str, program: str
) -> None:
    assert after(said, before) == program


@pytest.mark.parametrize(
    ("said", "program"),
    [
        ("forget the book, the staff do that themselves", "start [(at newspaper desk)]"),
        ("go home, it's late", "start [(at newspaper desk) [(at book table) [(robot-at home)]]]"),
        ("what have i told you so far, my memory isn't what it was", "command: read-program"),
        ("hold on, that's the doorbell", "command: pause"),
        ("the book stays where it is, only the newspaper goes on the coffee table", "refused"),
    ],
)
def test_what_is_told_between_commas_is_passed_over(said: str, program: str) -> None:
    assert after(said, PAPER_BOOK) == program
