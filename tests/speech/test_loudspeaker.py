"""A real loudspeaker path: what is played into the sound card is recorded from it."""

from __future__ import annotations

import array
import math
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

from polaris_nl.speech.audio import RATE, level
from polaris_nl.speech.microphone import Microphone
from polaris_nl.speech.speaker import SoundPlayer
from polaris_nl.speech.voices import Speech
from tests.speech.sound_card import SoundCard, sound_card

LOUD = -30.0
PATIENCE_S = 20.0


@pytest.fixture
def card(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[SoundCard]:
    card = sound_card(tmp_path, monkeypatch)
    card.plug_in()
    import sounddevice  # Only now: without PortAudio the card above has said what to install.

    sounddevice._terminate()  # PortAudio looks for devices once, when it starts.
    sounddevice._initialize()
    yield card
    card.unplug()


def tone(seconds: float) -> Speech:
    wave = (int(8000 * math.sin(at / 8)) for at in range(int(RATE * seconds)))
    return Speech(array.array("h", wave).tobytes(), RATE)


def loudness(sound: Iterator[object]) -> float:
    block = next(sound)
    assert isinstance(block, bytes)
    return level(block)


def test_what_is_said_comes_out_of_the_loudspeaker_until_it_is_interrupted(card: SoundCard) -> None:
    stop = threading.Event()
    sound = Microphone("pulse").sound()
    playing = threading.Thread(target=SoundPlayer().play, args=(tone(60), stop))
    playing.start()
    while loudness(sound) < LOUD:
        assert playing.is_alive()
    stop.set()
    playing.join(PATIENCE_S)
    while loudness(sound) > LOUD:
        pass
    sound.close()


def test_a_loudspeaker_that_is_unplugged_ends_what_is_said(card: SoundCard) -> None:
    sound = Microphone("pulse").sound()
    playing = threading.Thread(target=SoundPlayer().play, args=(tone(60), threading.Event()))
    playing.start()
    while loudness(sound) < LOUD:
        assert playing.is_alive()
    card.unplug()
    playing.join(PATIENCE_S)
    assert not playing.is_alive()
    sound.close()
