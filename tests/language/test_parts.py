"""What is asked for amid words that aren't understood: done, offered, or left alone."""

from __future__ import annotations

from functools import cache

import pytest

from polaris_nl.automaton.automaton import Automaton
from polaris_nl.automaton.edits import apply_all
from polaris_nl.hands_free.weight import weight_of
from polaris_nl.language.dialogue import Dialogue
from polaris_nl.language.interpretation import Interpretation
from polaris_nl.language.understanding import Understanding
from polaris_nl.model.world_file import load_world


@cache
def understanding() -> Understanding:
    return Understanding(load_world("care-home"))


def said(
    *utterances: str,
) -> tuple[Interpretation, Dialogue, Automaton]:
    """What the last of some utterances means, with what is offered; and the program after it."""
    program, dialogue = Automaton(), Dialogue()
    language = understanding()
    meant = Interpretation("", "refused")
    for utterance in utterances:
        meant, dialogue = language.interpret(utterance, program, dialogue)
        if meant.outcome == "refused":
            meant, dialogue = language.offered(meant, program, dialogue)
        program = apply_all(program, meant.edits)
    return meant, dialogue, program


def goals(program: Automaton) -> list[str]:
    return [str(goal) for c in program.checkpoints.values() for goal in c.goals]


@pytest.mark.parametrize(
    ("utterance", "goal"),
    [
        ("the phone is ringing so you take the pills to the nurse", "(has caregiver pill-box)"),
        ("the soup needs a stir could you go to the laundry", "(robot-at laundry)"),
        ("we start gymnastics in the lounge so go to the laundry", "(robot-at laundry)"),
        (
            "the blanket is rather whiffy put it in the laundry basket",
            "(in blanket laundry-basket)",
        ),
    ],
)
def test_what_is_told_first_may_hold_any_words(utterance: str, goal: str) -> None:
    meant, _, program = said(utterance)
    assert (meant.outcome, goals(program)) == ("applied", [goal])
    # Heard, such a sentence is mostly misheard.
    assert weight_of(meant) is None


@pytest.mark.parametrize(
    "utterance",
    [
        "the doorbell is ringing put it on the desk",  # What "it" is isn't known.
        "her son asked could you go to the kitchen the other day",
        "her son said go to the kitchen whenever it snows",
        "could you not open the wardrobe",
        "if the doorbell rings go to the kitchen",
        "she did not want you to go to the kitchen",
        "the frobnicator is broken unless you go to the kitchen",
        "is the doorbell ringing then go to the kitchen",
    ],
)
def test_what_would_change_the_request_isnt_passed_over(utterance: str) -> None:
    meant, _, program = said("bring the cup to the table", utterance)
    assert meant.outcome != "applied"
    assert goals(program) == ["(at cup table)"]


def test_a_part_is_offered_and_done_after_a_yes() -> None:
    refused = "do the hoovering would you and take the pills to the nurse"
    meant, dialogue, program = said(refused)
    assert meant.outcome == "refused"
    assert meant.refusal is not None
    assert meant.refusal.unknown == ("hoovering",)
    assert meant.say.endswith('Did you mean only "take the pills to the nurse"?')
    assert dialogue.pending is not None
    assert goals(program) == []
    for yes in ("yes", "only that", "yes please"):
        assert goals(said(refused, yes)[2]) == ["(has caregiver pill-box)"]


def test_a_no_leaves_it_and_something_else_is_taken_as_such() -> None:
    refused = "do the hoovering would you and take the pills to the nurse"
    meant, dialogue, program = said(refused, "no")
    assert (meant.say, goals(program)) == ("All right, I left that out. Say it another way.", [])
    assert dialogue.pending is None
    assert goals(said(refused, "go home")[2]) == ["(robot-at home)"]


def test_a_yes_is_to_what_was_offered_last() -> None:
    refused = "do the hoovering would you and take the pills to the nurse"
    assert goals(said(refused, "what did you say", "yes")[2]) == ["(has caregiver pill-box)"]
    assert goals(said(refused, "gobbledygook", "yes")[2]) == []
    assert goals(said(refused, "where is the cup", "yes")[2]) == []


@pytest.mark.parametrize(
    ("utterance", "command"),
    [
        ("stop you're dripping", "stop"),
        ("oh heavens stop the cat is right in front of you", "stop"),
        ("stop right there wet floor", "stop"),
        ("pause a moment dear i've dropped my stick", "pause"),
    ],
)
def test_a_stop_counts_whatever_follows(utterance: str, command: str) -> None:
    meant, _, _ = said(utterance)
    assert meant.command == command
    assert weight_of(meant) is None  # What is heard so is left to the quick words.


@pytest.mark.parametrize(
    "utterance",
    ["don't stop the music", "stop when the soup is cold", "the bus stop is far from unicorns"],
)
def test_not_every_stop_is_one(utterance: str) -> None:
    assert said(utterance)[0].outcome == "refused"


def test_everything_on_it_is_what_is_on_the_thing_spoken_of() -> None:
    on_table = "(forall (?x - object) (imply (at ?x coffee-table) (at ?x dining-table)))"
    asked = "i am wiping the coffee table so put everything on it on the dining table"
    assert goals(said(asked)[2]) == [on_table]
    assert said("put everything on it on the dining table")[0].outcome == "question"


def test_what_goes_on_with_what_is_asked_for_isnt_only_told() -> None:
    assert goals(said("fridge shut and closet open")[2]) == [
        "(not (open fridge))",
        "(open wardrobe)",
    ]
    assert said("fridge shut closet open")[0].say.startswith("Should that be so, too?")
