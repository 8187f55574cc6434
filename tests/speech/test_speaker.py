"""Speaking back, with a player that tells what it plays."""

from __future__ import annotations

import queue
import shutil
import threading
from collections.abc import Iterator

import pytest

from polaris_nl.speech.speaker import Speaker
from polaris_nl.speech.voices import EspeakVoice, HibariVoice, Speech, Voice, chime

PATIENCE_S = 20.0


class Letters:
    """A voice whose sound is the text itself."""

    name = "letters"

    def speech(self, text: str) -> Speech:
        return Speech(text.encode(), 16_000)


class Told:
    """A player that tells what it plays, and goes on when it is let."""

    def __init__(self) -> None:
        self.played: queue.Queue[str] = queue.Queue()
        self.let = threading.Semaphore(0)
        self.interrupted: list[bool] = []

    def play(self, speech: Speech, stop: threading.Event) -> None:
        self.played.put(speech.samples.decode())
        while not self.let.acquire(timeout=0.01):
            if stop.is_set():
                self.interrupted.append(True)
                return


@pytest.fixture
def told() -> Told:
    return Told()


@pytest.fixture
def speaker(told: Told) -> Iterator[Speaker]:
    speaker = Speaker(Letters(), told)
    yield speaker
    speaker.close()


def test_one_thing_is_said_after_the_other(speaker: Speaker, told: Told) -> None:
    speaker.say("first", "answer")
    speaker.say("second", "run")
    assert told.played.get(timeout=PATIENCE_S) == "first"
    assert speaker.saying == "first"
    told.let.release(2)
    assert told.played.get(timeout=PATIENCE_S) == "second"
    assert speaker.wait(PATIENCE_S)
    assert speaker.saying == ""


def test_of_what_waits_about_the_same_the_newest_wins(speaker: Speaker, told: Told) -> None:
    speaker.say("going on", "answer")
    assert told.played.get(timeout=PATIENCE_S) == "going on"
    speaker.say("3 actions", "plan")
    speaker.say("reached", "run")
    speaker.say("4 actions", "plan")
    told.let.release(3)
    assert [told.played.get(timeout=PATIENCE_S) for _ in range(2)] == ["reached", "4 actions"]
    assert speaker.wait(PATIENCE_S)
    assert told.played.empty()


def test_an_interruption_silences_what_is_said_and_what_waits(speaker: Speaker, told: Told) -> None:
    speaker.say("long", "answer")
    assert told.played.get(timeout=PATIENCE_S) == "long"
    speaker.say("waiting", "run")
    speaker.interrupt()
    assert speaker.wait(PATIENCE_S)
    assert told.interrupted == [True]
    assert told.played.empty()
    speaker.say("again", "answer")
    assert told.played.get(timeout=PATIENCE_S) == "again"


def test_it_tells_when_it_speaks_and_when_all_is_said(told: Told) -> None:
    changes: queue.Queue[bool] = queue.Queue()
    speaker = Speaker(Letters(), told, changes.put)
    speaker.say("one", "a")
    assert changes.get(timeout=PATIENCE_S)
    told.let.release()
    assert not changes.get(timeout=PATIENCE_S)
    speaker.close()


def test_a_voice_that_fails_leaves_the_queue_going(told: Told) -> None:
    class Hoarse(Letters):
        def speech(self, text: str) -> Speech:
            if text == "bad":
                raise OSError("no sound")
            return super().speech(text)

    speaker = Speaker(Hoarse(), told)
    speaker.say("bad", "a")
    speaker.say("good", "b")
    assert told.played.get(timeout=PATIENCE_S) == "good"
    told.let.release()
    speaker.close()


@pytest.mark.parametrize("kind", [HibariVoice, EspeakVoice])
def test_the_voices_speak(kind: type[HibariVoice] | type[EspeakVoice]) -> None:
    if kind is EspeakVoice and shutil.which("espeak-ng") is None:
        pytest.fail("scripts/install-system test installs espeak-ng, and it isn't here")
    voice: Voice = kind()
    speech = voice.speech("Lunch is ready, at 12 o'clock.")
    assert 1.0 < speech.seconds < 5.0
    assert speech.samples == voice.speech("Lunch is ready, at 12 o'clock.").samples


def test_chimes_are_short_and_quieter_than_words() -> None:
    import array

    for sign in ("listening", "waiting", "asleep"):
        sound = chime(sign)
        assert 0.1 < sound.seconds < 0.3
        assert 0 < max(array.array("h", sound.samples)) < 32767 * 0.11
    assert chime("").samples == b""
