"""What was asked for isn't to be done where something holds, and conditions that stand behind."""

from __future__ import annotations

import pytest

from bench.speech_meaning import Context
from polaris_nl.automaton.automaton import Automaton
from polaris_nl.automaton.edits import apply_all

from .test_requests import understanding

LUNCH = (
    "tell the resident that lunch is ready",
    "once she acknowledges, bring a full tray to her table, then go home",
    "if she dismisses it just go home",
)
PAPER = ("give her the newspaper", "then go home")
FRIDGE = ("open the fridge", "then go home")
GLASSES = ("tell tom bingo is starting", "then bring the glasses to tom")
LOUNGE = (
    "start [(alerted-to mr-brown bingo) [(has mr-brown glasses)] "
    "[when (person-in mr-brown recreation-area): -]]"
)
TOLD = "start [(alerted-to resident lunchtime)"
BROUGHT = "[when (acknowledged lunchtime): (at tray table) & (is-full tray) [(robot-at home)]]"
SPARED = (
    "start [(has resident newspaper) [(robot-at home)]] "
    "[when (person-in resident kitchen): (robot-at home)]"
)


def after(said: str, before: tuple[str, ...] = ()) -> str:
    return Context(understanding("care-home"), before).understood(said)[1]


@pytest.mark.parametrize(
    ("before", "said", "program"),
    [
        # Within what is done then, it is left out, and nothing is waited for in vain.
        (LUNCH, "don't go home if she dismisses it", f"{TOLD} {BROUGHT} [when (dismissed lunchtime): -]]"),
        (LUNCH, "if she dismisses it, please don't go home",
         f"{TOLD} {BROUGHT} [when (dismissed lunchtime): -]]"),
        (LUNCH, "when she dismisses it you needn't go home",
         f"{TOLD} {BROUGHT} [when (dismissed lunchtime): -]]"),
        (LUNCH, "don't fill the tray if she acknowledges",
         f"{TOLD} [when (acknowledged lunchtime): (at tray table) [(robot-at home)]] "
         "[when (dismissed lunchtime): (robot-at home)]]"),
        (LUNCH, "don't bring the tray if she acknowledges",
         f"{TOLD} [when (acknowledged lunchtime): (robot-at home)] "
         "[when (dismissed lunchtime): (robot-at home)]]"),
        (LUNCH, "don't go home unless she dismisses it",
         f"{TOLD} [when (acknowledged lunchtime): (at tray table) & (is-full tray)] "
         "[when (dismissed lunchtime): (robot-at home)]]"),
        # Elsewhere there is a way on without it, with all that comes after it.
        (PAPER, "don't give her the newspaper if she's in the kitchen", SPARED),
        (PAPER, "give her the newspaper unless she's in the kitchen", SPARED),
        (PAPER, "if she's in the kitchen skip the newspaper", SPARED),
        (FRIDGE, "don't open the fridge if it's open",
         "start [(open fridge) [(robot-at home)]] [when (open fridge): (robot-at home)]"),
        (LUNCH, "don't tell her that lunch is ready if she's in the kitchen",
         f"{TOLD} {BROUGHT} [when (dismissed lunchtime): (robot-at home)]] "
         "[when (person-in resident kitchen): -]"),
        (GLASSES, "don't bother with the glasses if he's in the lounge", LOUNGE),
        (GLASSES, "no need for the glasses if he's in the lounge", LOUNGE),
        (GLASSES, "leave out the glasses if he's in the lounge", LOUNGE),
        # Of what isn't said whole, too, it is known which step is meant.
        (GLASSES, "only bring the glasses if he's in the kitchen",
         "start [(alerted-to mr-brown bingo) [when (person-in mr-brown kitchen): (has mr-brown glasses)]]"),
        (LUNCH, "bring the tray only if she's in her room",
         f"{TOLD} [when (acknowledged lunchtime) & (person-in resident room-1): (at tray table) & "
         "(is-full tray) [(robot-at home)]] [when (dismissed lunchtime): (robot-at home)]]"),
        # What isn't to be so is a goal.
        (("go home",), "if the fridge is open don't leave it open",
         "start [(robot-at home) [when (open fridge): (not (open fridge))]]"),
        (LUNCH, "if she dismisses it don't go to the kitchen", "refused"),
    ],
)  # fmt: skip
def test_what_is_there_is_left_out_then(before: tuple[str, ...], said: str, program: str) -> None:
    assert after(said, before) == program


@pytest.mark.parametrize(
    "said", ["don't bring the tray if she dismisses it", "if she dismisses it don't bring her the tray"]
)  # fmt: skip
def test_what_isn_t_done_then_anyway_is_said_to_be_so(said: str) -> None:
    language, program, dialogue = understanding("care-home"), Automaton(), None
    for sentence in LUNCH:
        meant, dialogue = language.interpret(sentence, program, dialogue)
        program = apply_all(program, meant.edits)
    meant, _ = language.interpret(said, program, dialogue)
    assert (meant.outcome, meant.say) == ("answer", "That isn't done then anyway; nothing changes.")


def test_a_changed_mind_is_asked_what_instead() -> None:
    language, program, dialogue = understanding("care-home"), Automaton(), None
    meant, dialogue = language.interpret("give her the newspaper", program, dialogue)
    program = apply_all(program, meant.edits)
    meant, _ = language.interpret("i changed my mind about the newspaper", program, dialogue)
    assert meant.outcome == "refused"
    assert meant.say.startswith("What about the newspaper? Say what should be done, or")


@pytest.mark.parametrize(
    ("said", "program"),
    [
        ("close the fridge if it is open then go home",
         "start [when (open fridge): (not (open fridge)) [(robot-at home)]]"),
        ("open the fridge unless it is open, then go home",
         "start [(open fridge) [(robot-at home)]] [when (open fridge): -]"),
        ("give her the newspaper if she is in the kitchen, then go home",
         "start [when (person-in resident kitchen): (has resident newspaper) [(robot-at home)]]"),
        ("tell the resident that lunch is ready if she dismisses it, then go home",
         f"{TOLD} [when (dismissed lunchtime): (robot-at home)]]"),
        ("close the fridge if it is open and go home",
         "start [when (open fridge): (not (open fridge)) [(robot-at home)]]"),
        ("open the cupboard if it isn't open and put the cup inside",
         "start [when (not (open cupboard)): (open cupboard) [(in cup cupboard)]]"),
        ("put the book on the table unless she has it and go home",
         "start [(at book table) [(robot-at home)]] [when (has resident book): -]"),
        ("give her the newspaper but only if she's in her room then go home",
         "start [when (person-in resident room-1): (has resident newspaper) [(robot-at home)]]"),
        ("don't open the fridge unless she's in the kitchen",
         "start [when (person-in resident kitchen): (open fridge)]"),
        ("open the fridge and if it's open put the water in",
         "start [(open fridge) [when (open fridge): (in water-bottle fridge)]]"),
        ("go to the kitchen, if the fridge is open, then close it",
         "start [(robot-at kitchen) [when (open fridge): (not (open fridge))]]"),
    ],
)  # fmt: skip
def test_a_condition_behind_a_goal_is_for_that_goal(said: str, program: str) -> None:
    assert after(said) == program


@pytest.mark.parametrize(
    ("before", "said", "program"),
    [
        (("bring the glasses to the desk",), "no, to the kitchen", "start [(at glasses worktop)]"),
        (("bring the glasses to the desk",), "to the kitchen instead", "start [(at glasses worktop)]"),
        (("bring the book to the table", "then bring the glasses to the desk", "then go home"),
         "the second one should be to the kitchen",
         "start [(at book table) [(at glasses worktop) [(robot-at home)]]]"),
        (("go to the office",), "no, to the kitchen", "start [(robot-at kitchen)]"),
    ],
)  # fmt: skip
def test_a_place_instead_is_for_the_thing_that_is_taken_there(
    before: tuple[str, ...], said: str, program: str
) -> None:
    assert after(said, before) == program
