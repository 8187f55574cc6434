"""Numbered choices."""

from __future__ import annotations

import pytest

from polaris_nl.hands_free.choices import Choices, choice_phrases, choices_among

CHOICES = Choices(("bring the cup", "bring the cap", "help"), "I didn't get that.")


@pytest.mark.parametrize(
    ("answer", "chosen"),
    [
        ("one", "bring the cup"),
        ("number two", "bring the cap"),
        ("the second one", "bring the cap"),
        ("i meant the third", "help"),
        ("bring the cap", "bring the cap"),
        ("none of these", ""),
        ("never mind", ""),
        ("go home", None),
        ("four", None),
    ],
)
def test_answers(answer: str, chosen: str | None) -> None:
    assert CHOICES.chosen(answer) == chosen


def test_the_question_numbers_them() -> None:
    assert CHOICES.say == (
        "I didn't get that. Did you mean one: bring the cup; two: bring the cap; or three: help? Say "
        "the number, or none."
    )


def test_a_number_that_isn_t_offered_is_no_answer() -> None:
    assert Choices(("help",)).chosen("two") is None


def test_choices_are_filled_up_without_repeating() -> None:
    found = choices_among(["help"], ["help", "read me the program", "a", "b"])
    assert found == Choices(("help", "read me the program", "a"), "I didn't get that.")
    assert choices_among([], []) is None


def test_every_answer_can_be_heard() -> None:
    phrases = choice_phrases()
    assert {"one", "the second one", "number three", "none of these"} <= set(phrases)
    assert len(phrases) == len(set(phrases))


def test_one_sentence_is_a_question_for_yes_or_no() -> None:
    one = Choices(("bring the cup",))
    assert one.say == "Did you mean: bring the cup? Say yes or no."
    assert one.chosen("yes") == one.chosen("the first one") == "bring the cup"
    assert one.chosen("no") == ""
    assert one.chosen("go home") is None
    assert CHOICES.chosen("yes") is None
