"""Speech before the screen: heard by the real recogniser, carried out as if it was typed."""

from __future__ import annotations

import queue
import sys
import threading
from collections.abc import Iterator
from functools import partial
from pathlib import Path

import pytest

from polaris_nl.logs.reader import read_log
from polaris_nl.model.errors import SpeechError
from polaris_nl.speech.sources import Recording
from polaris_nl.speech.trouble import Trouble
from polaris_tui.talking import Talking
from tests.speech.speaking import SILENCE, blocks_of, silence, spoken
from tests.tui.conftest import Play, Stage
from tests.tui.ssh import ROOT, Tmux

LUNCH = ROOT / "domains" / "caregiving" / "recordings" / "lunch.flac"


class Mouth:
    """A live microphone: sound comes as somebody speaks, and silence without end between."""

    name = "the test's mouth"
    live = True

    def __init__(self) -> None:
        self._said: queue.SimpleQueue[bytes] = queue.SimpleQueue()
        self.closed = threading.Event()

    def say(self, sentence: str) -> None:
        for block in (*blocks_of(spoken(sentence)), *silence(1.5)):
            self._said.put(block)

    @property
    def silent(self) -> bool:
        """Whether all that was said has been taken."""
        return self._said.empty()

    def sound(self) -> Iterator[bytes | Trouble]:
        try:
            while True:
                try:
                    yield self._said.get(timeout=0.02)
                except queue.Empty:
                    yield SILENCE
        finally:
            self.closed.set()


def test_a_program_is_spoken_and_its_run_stopped(
    play: Play, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    mouth = Mouth()
    for sentence in ("go to the kitchen", "run it", "yes", "stop", "go to the hall", "go to sleep"):
        spoken(sentence)  # Made before the key is pressed, since the window for it is short.

    async def script(stage: Stage) -> None:
        await stage.press("ctrl+g")
        await stage.see("(listening)")
        mouth.say("go to the kitchen")
        await stage.see("> heard: go to the kitchen", "Go to the kitchen. The plan takes")
        mouth.say("run it")
        await stage.see("> heard: run it", "Shall I start? Say yes or no.")
        mouth.say("yes")
        await stage.see("> heard: yes", "> running")
        mouth.say("stop")
        await stage.see("> heard: stop", "You stopped the run.")
        # After a while, what is said is not meant for the robot until the key is pressed again.
        monkeypatch.setattr("polaris_nl.speech.modes.WINDOW_S", 0.1)
        await stage.press("ctrl+@")
        await stage.see("ctrl+space to talk")
        mouth.say("go to the hall")
        monkeypatch.setattr("polaris_nl.speech.modes.WINDOW_S", 8.0)
        await stage.until(lambda: mouth.silent)
        await stage.press("ctrl+@")
        await stage.see("(listening)")
        mouth.say("go to sleep")
        await stage.see("(asleep)", "Asleep. Say")
        assert "heard: go to the hall" not in stage.pane("answers")

    play(script, size=(100, 40), live=True, talk=partial(Talking, mouth, "talk"))
    assert mouth.closed.is_set()
    (path,) = (tmp_path / "logs").glob("*.mcap")
    events = read_log(path).events
    assert [e.source for e in events if e.topic == "/polaris/heard"] == ["voice"] * 3
    stops = [e for e in events if e.topic == "/polaris/command" and e.command == "stop"]
    assert stops[0].source == "voice"


def test_a_recording_is_heard_at_the_key(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path / "config"))
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    terminal = Tmux(tmp_path)
    try:
        terminal.open("tui", "--world", "care-home", "--mic", str(LUNCH))
        terminal.see("empty program")
        terminal.keys("C-Space")
        terminal.see("heard: ", "ok, 14 actions", "once lunch is dismissed")
        terminal.keys("C-q")
        assert "LOG (" not in terminal.see("code 0")
    finally:
        terminal("kill-server")


def test_what_is_missing_is_said(
    play: Play, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    async def script(stage: Stage) -> None:
        await stage.press("ctrl+g")
        await stage.see("(no microphone)", wanted)
        await stage.say("open the fridge")
        await stage.see("ok, 3 actions", "(no microphone)")

    wanted = "nothing.wav"
    play(script, talk=partial(Talking, Recording(tmp_path / "nothing.wav"), "talk"))
    monkeypatch.setitem(sys.modules, "vosk", None)
    wanted = "polaris-nl[voice]"
    play(script, talk=partial(Talking, Mouth(), "talk"))


def test_a_microphone_that_is_lost_is_told(play: Play) -> None:
    class Unplugged(Mouth):
        def sound(self) -> Iterator[bytes | Trouble]:
            yield SILENCE
            yield Trouble("The microphone gives no sound any more. Plug it in again; I wait.")
            raise SpeechError("It never came back.")

    async def script(stage: Stage) -> None:
        await stage.press("ctrl+g")
        await stage.see("Plug it in again", "It never came back.", "(no microphone)")

    play(script, talk=partial(Talking, Unplugged(), "talk"))


def test_without_speech_the_key_says_what_there_is(play: Play) -> None:
    async def script(stage: Stage) -> None:
        await stage.press("ctrl+g")
        await stage.see("polaris-nl listen takes speech")
        assert stage.app.talking is None

    play(script)
