"""Words that the recogniser lacks."""

from __future__ import annotations

import pytest

from polaris_nl.speech.ears import gaps_in_words
from polaris_nl.speech.lexicon import SoundAlikes, sound_alikes

KNOWN = frozenset(
    [
        "the",
        "bring",
        "tray",
        "trays",
        "ice",
        "box",
        "home",
        "blacks",
        "black",
        "zor",
        "night",
        "stand",
        "is",
        "hall",
    ]
)


@pytest.mark.parametrize(
    ("missing", "alike"),
    [
        ("icebox", "ice box"),
        ("nightstand", "night stand"),
        ("tray's", "trays"),
        ("blaks", "blacks"),
        ("zorblax", "zor blacks"),
    ],
)
def test_what_stands_for_a_missing_word(missing: str, alike: str) -> None:
    table = sound_alikes([missing, "home"], KNOWN.__contains__, lambda: sorted(KNOWN))
    assert table.inward == {missing: alike}
    assert table.listened_for([f"bring the {missing}", "home"]) == [f"bring the {alike}", "home"]
    assert table.put_back(f"bring the {alike}") == (f"bring the {alike}", f"bring the {missing}")


def test_a_word_that_nothing_stands_for_is_a_gap_and_its_phrases_are_left_out() -> None:
    table = sound_alikes(["qwv", "home"], KNOWN.__contains__, lambda: sorted(KNOWN))
    assert table.gaps == ("qwv",)
    assert table.listened_for(["bring the qwv", "home"]) == ["home"]
    assert table.put_back("home") == ("home",)


def test_gaps_are_told_of_names_only() -> None:
    table = SoundAlikes({"icebox": "ice box", "due's": "dues"}, ("qwv", "unheard"))
    told = gaps_in_words(table, ["the icebox", "qwv"])
    assert told == [
        'I listen for "icebox" as "ice box".',
        'I can\'t hear the word "qwv"; give what it names a synonym in the world file.',
    ]
