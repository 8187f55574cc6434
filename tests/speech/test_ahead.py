"""Beginning to hear again before it is asked for."""

from __future__ import annotations

import threading
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import pytest

from polaris_nl.model.errors import SpeechError
from polaris_nl.speech.ahead import Ahead

PATIENCE_S = 10.0


@dataclass
class Heard:
    """An opinion that says what it is of."""

    sound: bytes
    begun: threading.Event
    go_on: threading.Event

    @property
    def texts(self) -> Sequence[str]:
        self.begun.set()
        assert self.go_on.wait(PATIENCE_S)
        return [self.sound.decode()]

    def likelihoods(self, texts: Sequence[str]) -> Sequence[float]:
        return [0.0] * len(texts)


@dataclass
class Slow:
    """A recogniser whose opinions take until they may go on."""

    asked: list[bytes] = field(default_factory=list)
    begun: threading.Event = field(default_factory=threading.Event)
    go_on: threading.Event = field(default_factory=threading.Event)

    def opinion(self, sound: bytes) -> Heard:
        if sound == b"broken":
            raise SpeechError("broken")
        self.asked.append(sound)
        return Heard(sound, self.begun, self.go_on)


@pytest.fixture
def slow() -> Iterator[Slow]:
    recogniser = Slow()
    yield recogniser
    recogniser.go_on.set()


def test_what_was_begun_is_not_heard_twice(slow: Slow) -> None:
    ahead = Ahead(slow)
    ahead.begin(b"go home")
    assert slow.begun.wait(PATIENCE_S)  # Nobody has asked yet.
    slow.go_on.set()
    assert ahead.opinion(b"go home").texts == ["go home"]
    assert slow.asked == [b"go home"]


def test_what_went_on_is_heard_as_a_whole(slow: Slow) -> None:
    slow.go_on.set()
    ahead = Ahead(slow)
    ahead.begin(b"go")
    assert ahead.opinion(b"go home").texts == ["go home"]


def test_only_the_latest_waits_for_its_turn(slow: Slow) -> None:
    ahead = Ahead(slow)
    for sound in (b"go", b"go to", b"go to the kitchen"):
        ahead.begin(sound)
        assert slow.begun.wait(PATIENCE_S)
    slow.go_on.set()
    assert ahead.opinion(b"go to the kitchen").texts == ["go to the kitchen"]
    assert slow.asked == [b"go", b"go to the kitchen"]


def test_the_same_piece_may_be_asked_about_again(slow: Slow) -> None:
    slow.go_on.set()
    ahead = Ahead(slow)
    ahead.begin(b"go home")
    assert [*ahead.opinion(b"go home").texts] == [*ahead.opinion(b"go home").texts]


def test_what_goes_wrong_is_told_whoever_asks(slow: Slow) -> None:
    ahead = Ahead(slow)
    ahead.begin(b"broken")
    with pytest.raises(SpeechError, match="broken"):
        ahead.opinion(b"broken")
