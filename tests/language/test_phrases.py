"""The recogniser's phrases: few enough, always the same, spoken words, and all that people need."""

from __future__ import annotations

import re

import pytest

from polaris_nl.language.phrases import MOST, MOST_SAID, SAID

from .reader import FOLDER, language_of, read_cases, spoken

WORLDS = ("care-home", "dinner-party")
SPOKEN = re.compile(r"[a-z']+( [a-z']+)*")


@pytest.mark.parametrize("world", WORLDS)
def test_there_are_no_more_than_the_recogniser_takes(world: str) -> None:
    phrases = language_of(world).phrases()
    assert 1_000 < len(phrases) <= MOST + MOST_SAID
    grammars = phrases[: -SAID * len(language_of(world).grammar.said)]
    assert len(set(grammars)) == len(grammars) <= MOST == 28_000


@pytest.mark.parametrize("world", WORLDS)
def test_they_are_the_same_each_time(world: str) -> None:
    language_of.cache_clear()
    first = language_of(world).phrases()
    language_of.cache_clear()
    assert language_of(world).phrases() == first


@pytest.mark.parametrize("world", WORLDS)
def test_they_are_words_as_they_are_spoken(world: str) -> None:
    strange = [p for p in language_of(world).phrases() if not SPOKEN.fullmatch(p)]
    assert not strange


def test_they_have_every_word_of_the_caregiving_programs() -> None:
    known = {word for phrase in language_of("care-home").phrases() for word in phrase.split()}
    said = {
        word
        for case in read_cases(FOLDER / "caregiving_program.yaml")
        for text in (*case.given, *case.say)
        for word in spoken(text).split()
    }
    # "The resident's table" is not among the phrases yet: no owner is, but "her" and "his".
    assert {word for word in said - known if not word.endswith("'s")} == set()
