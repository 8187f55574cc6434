"""Hearing a stream: pieces, quick words, and being called in the middle."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import pytest

from polaris_nl.speech.ahead import Ahead
from polaris_nl.speech.audio import level
from polaris_nl.speech.ears import EarMaker, Ears
from polaris_nl.speech.hearer import Heard, Hearer, Quick, Started
from polaris_nl.speech.wake import MicroWakeWord
from polaris_nl.speech.weight import Weigh, Weight
from tests.speech.speaking import blocks_of, in_noise, silence, spoken

PHRASES = (
    "stop", "pause", "go home", "undo that", "bring the cup to the table", "bring the cup", "then go home",
    "yes", "wake up",
)  # fmt: skip
PARTLY = {"bring the cup"}
QUIET_DB = -45.0
WHOLE = {
    "bring the cup to",
    "stop",
    "pause",
    "go home",
    "undo that",
    "bring the cup to the table",
    "yes",
}


@pytest.fixture(scope="module")
def ears() -> Ears:
    return EarMaker().ears(PHRASES)


class Expecting(Ahead):
    """Notes what it is to begin with."""

    def __init__(self, expected: list[bytes]) -> None:
        self._expected = expected

    def begin(self, sound: bytes) -> None:
        self._expected.append(sound)


def weigh(text: str) -> Weight | None:
    if text in PARTLY:
        return Weight.ASKING
    return Weight.CHANGING if text in WHOLE else None


def always(weight: Weight | None) -> Weigh:
    return lambda text: weight


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


def test_the_more_is_missing_the_longer_it_waits_for_more(ears: Ears) -> None:
    pauses = []
    for text in ("undo that", "bring the cup to the table", "bring the cup", "bring the cup to"):
        *_, heard = happen(Hearer(ears, weigh), said(text))
        assert isinstance(heard, Heard)
        pauses.append(heard.pause_s)
    assert pauses == sorted(pauses)
    assert pauses[0] < 0.5  # a short command
    assert pauses[1] < 0.6  # a goal
    assert 0.8 <= pauses[2] < 0.95  # would be asked about: where to?
    assert pauses[3] > 1.0  # nothing ends with "to", whatever it means


def test_a_pause_in_the_middle_of_a_sentence_does_not_cut_it(ears: Ears) -> None:
    first, second = (list(blocks_of(spoken(t))) for t in ("bring the cup", "to the table"))
    while level(first[-1]) < QUIET_DB:
        first.pop()
    while level(second[0]) < QUIET_DB:
        del second[0]
    halves = [*first, *silence(0.6), *second]  # longer than the pause that ends a goal
    heard = [
        h for h in happen(Hearer(ears, weigh), [*silence(0.6), *halves, *silence(2)])
        if isinstance(h, Heard)
    ]  # fmt: skip
    assert [h.spoken.alternatives[0] for h in heard] == ["bring the cup to the table"]


def test_what_is_heard_does_not_depend_on_how_long_was_waited(ears: Ears) -> None:
    found = []
    for weight in (Weight.CHANGING, Weight.ASKING, None):
        *_, heard = happen(Hearer(ears, always(weight)), said("bring the cup to the table"))
        assert isinstance(heard, Heard)
        found.append(heard)
    assert len({h.pause_s for h in found}) == 3
    assert len({h.spoken for h in found}) == 1


def test_a_piece_can_be_heard_again_before_it_has_ended(ears: Ears) -> None:
    expected: list[bytes] = []
    eager = replace(ears, second=Expecting(expected))
    hearer, heard = Hearer(eager, weigh), None
    noisy = blocks_of(in_noise(b"".join(said("go home", 0)), 5))
    for block in [*silence(0.6), *noisy, *silence(2)]:
        for happening in hearer.push(block, True):
            if isinstance(happening, Heard):
                heard = happening
                assert expected[-1] == heard.spoken.audio
    assert heard is not None


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
