"""Hearing a stream: pieces, quick words, and being called in the middle."""

from __future__ import annotations

from collections.abc import Iterable

import pytest

from polaris_nl.speech.ears import EarMaker, Ears
from polaris_nl.speech.hearer import Heard, Hearer, Quick, Started
from polaris_nl.speech.wake import MicroWakeWord
from polaris_nl.speech.weight import Weight
from tests.speech.speaking import blocks_of, silence, spoken

PHRASES = (
    "stop", "pause", "go home", "undo that", "bring the cup to the table", "then go home", "yes", "wake up",
)  # fmt: skip
WHOLE = {"stop", "pause", "go home", "undo that", "bring the cup to the table", "yes"}


@pytest.fixture(scope="module")
def ears() -> Ears:
    return EarMaker().ears(PHRASES)


def weigh(text: str) -> Weight | None:
    return Weight.CHANGING if text in WHOLE else None


def happen(hearer: Hearer, blocks: Iterable[bytes], attentive: bool = True) -> list[object]:
    return [h for block in blocks for h in hearer.push(block, attentive)]


def said(text: str, after_s: float = 2.0) -> list[bytes]:
    return [*silence(0.6), *blocks_of(spoken(text)), *silence(after_s)]


def test_a_piece_is_heard_with_both_opinions(ears: Ears) -> None:
    started, heard = happen(Hearer(ears, weigh), said("bring the cup to the table"))
    assert isinstance(started, Started)
    assert isinstance(heard, Heard)
    assert heard.spoken.alternatives[0] == "bring the cup to the table"
    assert heard.spoken.free.startswith("bring the ")


def test_a_short_command_ends_sooner_than_a_goal_and_half_a_goal_latest(ears: Ears) -> None:
    pauses = []
    for text in ("undo that", "bring the cup to the table", "bring the cup to"):
        *_, heard = happen(Hearer(ears, weigh), said(text))
        assert isinstance(heard, Heard)
        pauses.append(heard.pause_s)
    assert pauses == sorted(pauses)
    assert pauses[0] < 0.5
    assert pauses[1] < 0.6
    assert pauses[2] > 1.0


@pytest.mark.parametrize("word", ["stop", "pause"])
@pytest.mark.parametrize("attentive", [True, False])
def test_quick_words_act_before_the_pause(ears: Ears, word: str, attentive: bool) -> None:
    sound = [*silence(0.6), *blocks_of(spoken(word)), *silence(0.4)]
    found = happen(Hearer(ears, weigh), sound[:-1], attentive)
    assert Quick(word) in found


def test_what_isn_t_meant_for_the_robot_is_not_decoded(ears: Ears) -> None:
    found = happen(Hearer(ears, weigh), said("bring the cup to the table"), attentive=False)
    assert [type(h) for h in found] == [Started]


def test_a_quick_word_in_a_sentence_is_none(ears: Ears) -> None:
    found = happen(Hearer(ears, weigh), said("we should stop by the bakery on sunday"))
    assert not any(isinstance(h, Quick) for h in found)


def test_after_a_call_only_what_follows_is_heard(ears: Ears) -> None:
    hearer, wake = Hearer(ears, weigh), MicroWakeWord()
    found: list[object] = []
    called = False
    for block in [
        *silence(1.0), *blocks_of(spoken("hey jarvis")), *silence(0.3), *blocks_of(spoken("go home")),
        *silence(1.5),
    ]:  # fmt: skip
        if wake.heard(block):
            called = True
            hearer.call()
        found += list(hearer.push(block, called))
    heard = [h for h in found if isinstance(h, Heard)]
    assert called
    assert heard[-1].spoken.alternatives[0] == "go home"


def test_the_wake_word_isn_t_heard_in_other_speech() -> None:
    wake = MicroWakeWord()
    texts = ("tell the resident that lunch is ready", "have you heard of the jars in the hall")
    assert not any(wake.heard(b) for text in texts for b in said(text))
