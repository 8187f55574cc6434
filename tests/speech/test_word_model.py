"""How words follow each other in phrases."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from polaris_nl.speech.word_model import END, START, WordModel

PHRASES = ["bring the cup", "bring the tray", "bring the tray to the table", "open the fridge"]
WORDS = st.sampled_from(["bring", "the", "cup", "tray", "to", "table", "open", "fridge", "now"])


def likely(model: WordModel, word: str, *before: str) -> float:
    return math.exp(model.log_probability(word, (START, *before)))


def test_what_phrases_say_is_likelier_than_what_they_do_not() -> None:
    model = WordModel(PHRASES)
    assert likely(model, "tray", "bring", "the") > likely(model, "fridge", "bring", "the")
    assert likely(model, "fridge", "bring", "the") > likely(model, "table", "open", "bring")
    assert likely(model, "window", "open", "the") < 1e-4


def test_only_the_last_two_words_count() -> None:
    model = WordModel(PHRASES)
    assert likely(model, "table", "tray", "to", "the") == likely(model, "table", "cup", "to", "the")


def test_what_is_said_more_often_counts_more_but_not_as_much_more() -> None:
    model = WordModel(["go home", *["go on"] * 16])
    assert likely(model, "home", "go") < likely(model, "on", "go") < 5 * likely(model, "home", "go")


def test_it_knows_the_words_and_what_they_begin_with() -> None:
    model = WordModel(["go home"])
    assert model.words == {"go", "home"}
    assert model.beginnings == {"", "g", "go", "h", "ho", "hom", "home"}
    assert WordModel([]).words == frozenset()


@given(
    st.lists(st.lists(WORDS, min_size=1, max_size=5).map(" ".join), min_size=1, max_size=12),
    st.lists(WORDS, max_size=3),
)
def test_likelihoods_add_up_to_one(phrases: list[str], before: list[str]) -> None:
    model = WordModel(phrases)
    total = sum(likely(model, word, *before) for word in (*model.words, END))
    assert total == pytest.approx(1, abs=1e-4)
