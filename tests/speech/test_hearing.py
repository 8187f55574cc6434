"""Choosing among readings."""

from __future__ import annotations

from polaris_nl.speech.hearing import utterance
from polaris_nl.speech.recogniser import Spoken

AUDIO = b"\0\0" * 16_000


def spoken(*alternatives: str) -> Spoken:
    return Spoken(alternatives, AUDIO)


def test_the_first_reading_that_parses_wins() -> None:
    said = utterance(
        [spoken("go hum", "go home", "go to the hall")], lambda t: "home" in t or "hall" in t
    )
    assert (said.text, said.accepted, said.audio_s) == ("go home", True, 1.0)


def test_pieces_are_sentences_or_more_of_the_last_one() -> None:
    good = {
        "go home",
        "bring the cup",
        "bring the cup to the table",
        "go home. bring the cup to the table",
    }
    two = utterance([spoken("go home"), spoken("bring the cup to the table")], good.__contains__)
    assert two.text == "go home. bring the cup to the table"
    one = utterance([spoken("bring the cup"), spoken("to the table")], good.__contains__)
    assert one.text == "bring the cup to the table"


def test_nothing_that_parses_keeps_the_words_and_is_not_accepted() -> None:
    said = utterance([spoken("the weather is nice", "the weather is ice")], lambda t: False)
    assert (said.text, said.accepted) == ("the weather is nice", False)
    assert not utterance([], lambda t: True).accepted


def test_unknown_sounds_are_never_accepted() -> None:
    said = utterance([spoken("[unk] go home")], lambda t: True)
    assert not said.accepted


def test_free_listening_must_bear_the_words_out() -> None:
    piece = [spoken("stop")]
    assert utterance(piece, lambda t: True, lambda audio: "stopped").accepted
    assert not utterance(piece, lambda t: True, lambda audio: "what a lovely day it is").accepted
