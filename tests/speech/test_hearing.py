"""Choosing among readings."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from polaris_nl.speech.hearing import Utterance, Ways, utterance
from polaris_nl.speech.lexicon import SoundAlikes
from polaris_nl.speech.recogniser import Decoded, Spoken
from polaris_nl.speech.repair import Repairer
from polaris_nl.speech.weight import Weigh, Weight

AUDIO = b"\0\0" * 16_000


def spoken(*alternatives: str, free: str = "") -> Spoken:
    return Spoken(alternatives, AUDIO, free)


def when(parses: Callable[[str], bool], weight: Weight = Weight.CHANGING) -> Weigh:
    return lambda text: weight if parses(text) else None


def test_the_first_reading_that_parses_wins() -> None:
    said = utterance(
        [spoken("go hum", "go home", "go to the hall")],
        when(lambda t: "home" in t or "hall" in t),
    )
    assert (said.text, said.accepted, said.audio_s) == ("go home", True, 1.0)


def test_pieces_are_sentences_or_more_of_the_last_one() -> None:
    good = {
        "go home",
        "bring the cup",
        "bring the cup to the table",
        "go home. bring the cup to the table",
    }
    weigh = when(good.__contains__)
    two = utterance([spoken("go home"), spoken("bring the cup to the table")], weigh)
    assert two.text == "go home. bring the cup to the table"
    one = utterance([spoken("bring the cup"), spoken("to the table")], weigh)
    assert one.text == "bring the cup to the table"


def test_nothing_that_parses_keeps_the_words_and_is_not_accepted() -> None:
    said = utterance([spoken("the weather is nice", "the weather is ice")], when(lambda t: False))
    assert (said.text, said.accepted) == ("the weather is nice", False)
    assert said.why_not == "not understood"
    assert not utterance([], when(lambda t: True)).accepted


def test_unknown_sounds_are_never_accepted() -> None:
    said = utterance([spoken("[unk] go home")], when(lambda t: True))
    assert not said.accepted


def test_free_listening_must_bear_the_words_out() -> None:
    weigh = when(lambda t: t == "stop", Weight.HARMLESS)
    assert utterance([spoken("stop", free="stopped")], weigh).accepted
    said = utterance([spoken("stop", free="what a lovely day it is")], weigh)
    assert not said.accepted
    assert said.why_not.startswith("heard freely it is 0.")


@pytest.mark.parametrize(("weight", "accepted"), [(Weight.HARMLESS, True), (Weight.MOVING, False)])
def test_what_moves_the_robot_needs_more_agreement(weight: Weight, accepted: bool) -> None:
    piece = spoken("run it now", free="rum it now mostly")
    assert utterance([piece], when(lambda t: t == "run it now", weight)).accepted is accepted


def test_of_readings_that_make_sense_the_one_heard_freely_wins() -> None:
    piece = spoken(
        "close the cup and closet", "close the cup and close it", free="close the cup and close it"
    )
    assert utterance([piece], when(lambda t: True)).text == "close the cup and close it"


def test_a_reading_that_makes_sense_only_in_part_gives_way_to_a_whole_one() -> None:
    piece = spoken(
        "put the bowl and the table", "put the bowl on the table", free="put the bowl and the table"
    )

    def weigh(text: str) -> Weight | None:
        return Weight.CHANGING if " on " in text else Weight.ASKING

    assert utterance([piece], weigh).text == "put the bowl on the table"


def test_talk_that_makes_sense_only_in_part_is_left_alone() -> None:
    piece = spoken(
        "please don't the dock at the table", free="please don't feed the dog at the table"
    )
    assert not utterance([piece], when(lambda t: "dock" in t, Weight.ASKING)).accepted


def test_a_sentence_with_words_of_another_world_is_left_alone() -> None:
    piece = spoken(
        "please go via the dock at the table", free="please don't feed the dog at the table"
    )
    ways = Ways(repairer=Repairer(["please", "go", "via", "the", "dock", "at", "table"]))
    weigh = when(lambda t: "dock" in t)
    assert utterance([piece], weigh).accepted
    said = utterance([piece], weigh, ways)
    assert not said.accepted
    assert said.why_not == "it is about don't, feed"


def test_a_short_command_may_be_heard_freely_as_what_sounds_alike() -> None:
    weigh = when(lambda t: t == "redo")
    assert utterance([spoken("redo", free="read though")], weigh).accepted


def repaired(piece: Spoken, good: str) -> Utterance:
    ways = Ways(
        repairer=Repairer(["bring", "the", "red", "cup", "to", "blue", "table", "go", "home"])
    )
    return utterance([piece], when(lambda t: t == good), ways)


def test_what_was_heard_freely_is_a_reading_too() -> None:
    piece = spoken("bring the red to table", free="bring the red cup to the table")
    said = repaired(piece, "bring the red cup to the table")
    assert (said.text, said.accepted) == ("bring the red cup to the table", True)
    assert said.repaired == "bring the red to table"


def test_a_word_that_sounds_alike_is_tried_on_the_parser() -> None:
    piece = spoken("bring the red to table", free="bring the red cop to the table")
    said = repaired(piece, "bring the red cup to the table")
    assert (said.text, said.accepted) == ("bring the red cup to the table", True)


def test_no_repair_goes_far_from_what_was_heard() -> None:
    piece = spoken("[unk] cup", free="we had a cup of cocoa with grandma")
    assert not repaired(piece, "bring the red cup to the table").accepted


def test_words_that_were_listened_for_under_others_are_put_back() -> None:
    ways = Ways(SoundAlikes({"zorblax": "zor blacks"}))
    said = utterance(
        [spoken("bring the zor blacks", free="bring the soar blacks")],
        when(lambda t: t == "bring the zorblax"),
        ways,
    )
    assert (said.text, said.accepted) == ("bring the zorblax", True)


ASTRAY = "what a lovely day it is outside"


def judged(gain: float, weight: Weight, text: str, free: str = ASTRAY) -> Utterance:
    """A text that makes sense, heard freely as something else, that gains so much in likelihood a word."""
    piece = Spoken((text,), AUDIO, free, (gain * len(text.split()),))
    return utterance([piece], when(lambda t: t == text, weight))


def test_phrases_that_explain_the_sound_better_are_right_whatever_was_heard_freely() -> None:
    sentence = "bring the cup to the table"
    assert judged(0.2, Weight.CHANGING, sentence).accepted
    assert judged(0.2, Weight.CHANGING, sentence).gain == pytest.approx(0.2)
    assert not judged(-1.0, Weight.CHANGING, sentence).accepted
    assert not judged(0.2, Weight.MOVING, "start to run it now").accepted


def test_phrases_that_explain_it_far_worse_are_not_believed_even_where_the_words_are_alike() -> (
    None
):
    sentence = "why have you moved the cup"
    almost = "why have you moved a cup"
    assert judged(-1.2, Weight.CHANGING, sentence, almost).accepted
    said = judged(-1.2, Weight.HARMLESS, sentence, almost)
    assert said.why_not == "it is likelier to be what was heard freely, by 1.2 a word"
    assert not judged(-1.6, Weight.CHANGING, sentence, almost).accepted
    # The fewer words, the less can be told by them.
    assert judged(-2.4, Weight.CHANGING, "have you moved it", "have you moved").accepted
    assert not judged(-2.6, Weight.CHANGING, "have you moved it", "have you moved").accepted
    assert judged(-3.4, Weight.CHANGING, "move it there", "move it they're").accepted
    # A word or two are too short to be sure of, and among many phrases each is unlikely by itself.
    assert judged(-8.0, Weight.HARMLESS, "yeah", "yeah").accepted


def test_the_gain_is_that_of_the_reading_that_is_chosen() -> None:
    piece = Spoken(("go hum", "go home"), AUDIO, ASTRAY, (9.0, 1.0))
    assert utterance([piece], when(lambda t: t == "go home")).gain == pytest.approx(0.5)
    nowhere = Spoken(("go hum",), AUDIO, "go home", (9.0,))
    found = utterance(
        [nowhere], when(lambda t: t == "go home"), Ways(repairer=Repairer(["go", "home"]))
    )
    assert (found.text, found.gain) == ("go home", pytest.approx(0.5))


def test_without_likelihoods_nothing_is_gained() -> None:
    assert Spoken.of(Decoded(("go home",)), Decoded(("go home",), (3.0,)), AUDIO).gains == ()
    assert Spoken.of(Decoded(("go home",), (5.0,)), None, AUDIO).gains == ()
    assert Spoken.of(Decoded(("a", "b"), (5.0, 4.0)), Decoded(("c",), (3.0,)), AUDIO).gains == (
        2.0,
        1.0,
    )
    assert utterance([spoken("go home")], when(lambda t: True)).gain is None


def test_readings_that_are_far_behind_are_not_even_understood() -> None:
    asked: list[str] = []

    def weigh(text: str) -> Weight:
        asked.append(text)
        return Weight.CHANGING

    texts = ("go home", "go hum", "go comb", "go phone")
    piece = Spoken(texts, AUDIO, "go homer phone", (9.0, 7.0, 3.0, 2.0))
    # One about as likely could cast a doubt on the first; one nearer to what was heard freely could win.
    utterance([piece], weigh, means=str)
    assert set(asked) == {"go home", "go hum", "go phone"}
