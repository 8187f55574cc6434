"""What the session answers to questions: short, in words, and true of the plan and the world."""

from __future__ import annotations

from collections.abc import Mapping

import pytest

from polaris_nl.model.data import shipped_worlds
from polaris_nl.model.world_file import read_world
from polaris_nl.session import Session

CARE = (
    "Tell the resident that lunch is ready. Once she acknowledges, bring a full tray to her table "
    "and then go home. If she dismisses it, just go home."
)
CARE_ANSWERS = {
    "What will you do first?": "First I go to the hall, so that I can tell the resident that lunch is ready.",
    "What will you do last?": "Last of all I go home.",
    "What comes after fetched?": "Then I go to the hall and go home.",
    "Why do you go to the cafeteria first?": "I go to the cafeteria, so that I can pick up the tray from the",
    "Why are you going home?": "I go home, as you asked me to.",
    "Why don't you open the fridge?": "You haven't asked me to open the fridge, but I could.",
    "Are you able to open the fridge?": "Yes, I can open the fridge: I go to the hall, go to the kitchen and",
    "How long is the plan?": "The program has 4 steps, and the plan for it takes 14 actions",
    "When will you go home?": 'After "fetched" and once',
    "Are you going to open the wardrobe?": "No, that isn't in the program.",
    "Where are you?": "I'm at home.",
    "Where's the tray?": "The tray is on the empty trays, in the cafeteria.",
    "What is on the desk?": "The resident's pill box is on the caregiver's desk.",
    "Who has the pills?": "Nobody has the resident's pill box, as far as I know.",
    "Is mr brown in the kitchen?": "No, Mr Brown is in room 2.",
    "Does mr brown have his glasses?": "No, Mr Brown's glasses are on the coffee table,",
    "Is anyone in the kitchen?": "No, nobody is in the kitchen, as far as I know.",
    "Which containers are open?": "The laundry basket is open.",
    "How many cups are there?": "There are three cups: the cup, the blue cup and the red cup.",
    "Who is Tom?": "Mr Brown is a person, also called",
    "Whose is the book?": "The book belongs to the resident.",
}  # fmt: skip
PARTY_ANSWERS = {
    "Which dishes are dirty?": "The cup and the plate are dirty.",
    "How many dishes are dirty?": "Two: the cup and the plate are dirty.",
    "Is the cup clean already?": "No, the cup is dirty.",
    "Where's the bowl?": "The green bowl is on the sideboard, in the dining area. The white bowl is on",
    "Who's in the living room?": "The guest and the kid are in the living room.",
    "What is a dish?": "There are two dishes: the cup and the plate.",
    "Where do you put the cup?": "I bring the cup to the countertop.",
}  # fmt: skip


@pytest.mark.parametrize(
    ("world", "program", "answers"),
    [
        ("care-home", CARE, CARE_ANSWERS),
        ("dinner-party", "Bring the cup to the countertop.", PARTY_ANSWERS),
    ],
    ids=["care-home", "dinner-party"],
)
def test_answers(world: str, program: str, answers: Mapping[str, str]) -> None:
    with opened(world) as session:
        session.say(program)
        before = session.snapshot.automaton
        said = {question: session.say(question) for question in answers}
        assert session.snapshot.automaton == before
    assert {a.interpretation.outcome for a in said.values()} == {"answer"}
    found = {question: said[question].say[: len(answer)] for question, answer in answers.items()}
    assert found == answers


def test_yes_go_ahead_is_a_yes_only_to_what_was_read_out() -> None:
    with opened("dinner-party") as session:
        session.say("Bring the cup to the countertop.")
        assert session.say("Yes, go ahead.").interpretation.command == "run"
        confirmed = session.say("Yes, go ahead.")
        assert (confirmed.interpretation.command, confirmed.confirmed) == ("yes", True)
        assert session.say("Run it.").interpretation.command == "run"
        assert session.say("Run it.").interpretation.command == "run"


def test_without_a_program_there_is_no_plan_to_ask_about() -> None:
    with opened("care-home") as session:
        assert session.say("What will you do first?").say.startswith("There is no plan yet")
        assert session.say("Why?").say.startswith("There is no plan yet")


def opened(world: str) -> Session:
    return Session(read_world(shipped_worlds()[world]))
