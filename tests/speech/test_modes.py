"""When speech is meant for the robot."""

from __future__ import annotations

from polaris_nl.speech.modes import WINDOW_S, Attention, cue


def test_always_listens_but_not_to_itself() -> None:
    attention = Attention("always")
    assert attention.hears(0)
    speaking = attention.after("speaks", 1)
    assert speaking.state(1) == "speaking"
    assert not speaking.hears(1)
    assert speaking.after("silent", 2).hears(2)


def test_with_a_headset_it_hears_while_it_speaks() -> None:
    assert Attention("always", half_duplex=False).after("speaks", 1).hears(1)


def test_the_wake_word_opens_a_window_that_closes() -> None:
    waiting = Attention("wake")
    assert waiting.state(0) == "waiting"
    called = waiting.after("wake-word", 10)
    assert called.hears(10 + WINDOW_S - 0.1)
    assert not called.hears(10 + WINDOW_S)
    assert called.at(10 + WINDOW_S) == waiting


def test_the_window_for_more_begins_when_the_answer_has_been_heard() -> None:
    said = Attention("wake").after("wake-word", 0).after("said", 3).after("speaks", 4)
    late = said.at(4 + WINDOW_S).after("silent", 4 + WINDOW_S)
    assert late.hears(4 + WINDOW_S + 1)
    assert not late.hears(5 + 2 * WINDOW_S)


def test_speaking_unasked_opens_no_window() -> None:
    news = Attention("wake").after("speaks", 0).after("silent", 1)
    assert news.state(1) == "waiting"


def test_asleep_until_woken_by_voice_or_key() -> None:
    asleep = Attention("always").after("sleep", 0)
    assert asleep.state(1) == "asleep"
    assert asleep.after("speaks", 1).after("silent", 2).state(2) == "asleep"
    assert asleep.after("wake", 3).hears(3)
    assert asleep.after("key", 3).hears(3)


def test_changes_are_chimed_but_its_own_voice_isn_t() -> None:
    assert cue("waiting", "listening") == "listening"
    assert cue("listening", "waiting") == "waiting"
    assert cue("listening", "asleep") == "asleep"
    assert cue("listening", "speaking") == cue("speaking", "listening") == ""
    assert cue("waiting", "waiting") == ""
