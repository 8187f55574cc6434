"""A real microphone path: PortAudio, ALSA and PulseAudio, with a sound card made of software."""

from __future__ import annotations

import itertools
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from types import SimpleNamespace

import pytest

from polaris_nl.model.errors import SpeechError
from polaris_nl.speech import microphone
from polaris_nl.speech.activity import SileroActivity
from polaris_nl.speech.audio import level
from polaris_nl.speech.ears import EarMaker
from polaris_nl.speech.microphone import Microphone, microphones
from polaris_nl.speech.microphone_process import FRAME, frames, unpacked
from polaris_nl.speech.recogniser import pieces
from polaris_nl.speech.trouble import Trouble
from tests.speech.sound_card import SoundCard, sound_card
from tests.speech.speaking import SILENCE, spoken


@pytest.fixture
def card(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[SoundCard]:
    card = sound_card(tmp_path, monkeypatch)
    card.plug_in()
    yield card
    card.unplug()


def until_quiet(sound: Iterator[bytes | Trouble], quiet_s: float = 2.0) -> Iterator[bytes]:
    """Blocks from the first loud one until it has been quiet for some seconds."""
    quiet, heard = 0, False
    while not heard or quiet < quiet_s * 10:
        block = next(sound)
        assert isinstance(block, bytes), block
        loud = level(block) > -50
        heard, quiet = heard or loud, 0 if loud else quiet + 1
        yield block


def test_what_is_said_into_the_microphone_is_heard(card: SoundCard) -> None:
    ears = EarMaker().ears(["bring the cup to the table", "go home"])
    sound = Microphone("pulse").sound()
    assert isinstance(next(sound), bytes)  # it is open
    player = threading.Thread(
        target=card.play, args=(SILENCE * 8 + spoken("go home") + SILENCE * 20,)
    )
    player.start()
    (heard,) = pieces(until_quiet(sound), SileroActivity(), ears.phrased, ears.free)
    player.join()
    sound.close()
    assert heard.alternatives[0] == "go home"


def test_the_microphones_are_those_that_are_plugged_in_now(card: SoundCard) -> None:
    card.unplug()
    assert "pulse" not in microphones()
    card.plug_in()
    assert "pulse" in microphones()


def test_an_unplugged_microphone_is_said_at_once_and_comes_back(card: SoundCard) -> None:
    plugged = threading.Event()

    def wait(seconds: float) -> None:
        if not plugged.is_set():
            plugged.set()
            card.plug_in()

    sound = Microphone("pulse", wait).sound()
    assert isinstance(next(sound), bytes)
    card.unplug()
    found: list[bytes | Trouble] = []
    while not found or not isinstance(found[-1], Trouble):
        found.append(next(sound))
    assert found[-1] == Trouble(
        "The microphone pulse gives no sound any more. Plug it in again; I wait."
    )
    assert next(sound) == Trouble("The microphone pulse is back.", over=True)
    assert isinstance(next(sound), bytes)
    sound.close()


def test_a_microphone_that_isn_t_there_is_named_with_those_that_are() -> None:
    with pytest.raises(
        SpeechError, match=r"The microphone nowhere can't be used. Microphones here: .*FILE"
    ):
        next(Microphone("nowhere").sound())


class Hasty:
    """A sound library whose device gives three blocks at once, and had to drop sound before the second."""

    class RawInputStream:
        def __init__(self, callback: Callable[..., None], **_: object) -> None:
            self._callback = callback

        def start(self) -> None:
            for number in range(3):
                status = SimpleNamespace(input_overflow=number == 1)
                self._callback(bytes([number]), 1, None, status)


def test_lost_sound_is_told_with_the_block_after_it() -> None:
    found = [unpacked(frame) for frame in itertools.islice(frames(Hasty, None), 3)]
    assert found == [(b"\0", False), (b"\1", True), (b"\2", False)]


def test_lost_sound_is_said(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    recorder = tmp_path / "recorder"
    recorder.write_text(
        f"#!/bin/sh\nhead -c {FRAME} /dev/zero; printf '\\001'; head -c {FRAME - 1} /dev/zero; exec cat\n"
    )
    recorder.chmod(0o755)
    monkeypatch.setattr(microphone.sys, "executable", str(recorder))
    sound = Microphone("busy").sound()
    lost = Trouble("Some sound was lost: this machine is too busy. Say it again.", over=True)
    assert list(itertools.islice(sound, 3)) == [bytes(FRAME - 1), lost, bytes(FRAME - 1)]
    sound.close()
