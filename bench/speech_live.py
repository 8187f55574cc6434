"""`python -m bench.speech_live [--utterances N] [--noise DB]`: the hands-free loop at a microphone, in real
time.

The microphone is a sound card made of software: speech is written to it at the pace of the world, comes
out of its microphone, and goes through PulseAudio, ALSA and PortAudio to the loop that `listen` runs. Times
count from the end of the last sound that was written to when the answer is shown, so the card's own delay
(some 100 ms) is in them. With `--noise` a kitchen is heard that far below the speech all the time, and all
is heard again by Whisper, where that is installed.
"""

from __future__ import annotations

import argparse
import os
import queue
import shutil
import statistics
import subprocess
import tempfile
import threading
import time
from collections.abc import Iterator, Sequence
from contextlib import closing, contextmanager
from dataclasses import dataclass, field
from pathlib import Path

from bench.speech_sounds import SENTENCES, SILENCE, Room, spoken
from bench.table import Row, show
from polaris_nl.automaton.automaton import Automaton
from polaris_nl.hands_free.conversation import Conversation, Reply
from polaris_nl.hands_free.listening import Listening
from polaris_nl.hands_free.phrases import spoken_names, spoken_phrases
from polaris_nl.model.world_file import load_world
from polaris_nl.session import Session
from polaris_nl.speech.audio import BLOCK, RATE
from polaris_nl.speech.ears import EarMaker
from polaris_nl.speech.microphone import Microphone
from polaris_nl.speech.modes import State
from tests.speech.sound_card import SoundCard

SAID = (*SENTENCES, "stop")
FEW, MANY = 36, 300
_BLOCK_S = BLOCK / RATE
_PATIENCE_S = 8.0
_BEFORE = 6


@dataclass
class Measured:
    """What came of the utterances: seconds from their ends, and megabytes after each."""

    echoes: list[float] = field(default_factory=list)
    stops: list[float] = field(default_factory=list)
    memory: list[float] = field(default_factory=list)
    lost: list[str] = field(default_factory=list)
    share: float = 0.0


class _Face:
    """Notes when something was shown."""

    def __init__(self) -> None:
        self.shown: queue.SimpleQueue[tuple[float, str]] = queue.SimpleQueue()
        self.listens = threading.Event()

    def shows(self, state: State) -> None:
        self.listens.set()

    def tells(self, text: str) -> None:
        self.shown.put((time.perf_counter(), text))

    def replies(self, reply: Reply) -> None:
        self.shown.put((time.perf_counter(), reply.said.text if reply.text else ""))


class _Mouth:
    """Speaks into the card, at the pace of the world; silence in between."""

    def __init__(self, room: Room | None) -> None:
        self._room = room
        order = [
            "pacat",
            "--device=vmic",
            "--raw",
            "--format=s16le",
            f"--rate={RATE}",
            "--channels=1",
        ]
        self._player = subprocess.Popen(
            [*order, "--latency-msec=20", "--process-time-msec=10"], stdin=subprocess.PIPE
        )
        self._next = time.perf_counter()

    def say(self, blocks: Sequence[bytes]) -> float:
        """Speaks; the time at which the last sound ends."""
        assert self._player.stdin is not None
        for block in blocks:
            time.sleep(max(self._next - time.perf_counter(), 0.0))
            self._next = max(self._next, time.perf_counter() - _BLOCK_S) + _BLOCK_S
            self._player.stdin.write(block if self._room is None else self._room.heard(block))
            self._player.stdin.flush()
        return self._next

    def close(self) -> None:
        """Falls silent for ever."""
        self._player.kill()
        self._player.wait()


def rows(count: int = FEW, noise_db: float | None = None) -> Iterator[Row]:
    """The rows about the microphone; none where PulseAudio isn't installed.

    Args:
        count: how many utterances.
        noise_db: how far the noise of a kitchen is below their active level; None for no noise.
    """
    if shutil.which("pulseaudio") is None:
        return
    found = measured(count, noise_db)
    own, third = [s * 1000 for s in found.echoes], max(len(found.echoes) // 3, 1)
    drift = statistics.median(own[-third:]) - statistics.median(own[:third])
    lost = f"; not answered: {', '.join(found.lost)}" if found.lost else ""
    yield Row(
        "microphone: end of speech -> echo", "p95 <= 800", own,
        note=f"{count} utterances in a row; the last third {drift:+.0f} ms later than the first{lost}",
    )  # fmt: skip
    yield Row(
        'microphone: end of "stop" -> acted on', "p95 <= 400", [s * 1000 for s in found.stops]
    )
    half = len(found.memory) // 2
    yield Row(
        "microphone: memory, growth over the second half", "0",
        [found.memory[-1] - found.memory[half]], unit="MB",
        note=f"resident {found.memory[-1]:.0f} MB; the loop took {found.share:.2f} of one core",
    )  # fmt: skip


def measured(count: int, noise_db: float | None = None) -> Measured:
    """Says so many utterances, one after the other, each after the answer to the one before."""
    sounds = {text: spoken(text) for text in SAID}
    room = Room.kitchen([*sounds.values()], noise_db) if noise_db is not None else None
    found, face = Measured(), _Face()
    with Session(load_world("care-home")) as session, _card():
        session.warm_up()
        understanding = session.understanding
        ears = EarMaker().ears(spoken_phrases(understanding), spoken_names(understanding))
        listening = Listening(Microphone("pulse"), ears, Conversation(session), face)
        loop = threading.Thread(target=listening.run, name="listening", daemon=True)
        loop.start()
        assert face.listens.wait(_PATIENCE_S), "the microphone doesn't open"
        started, used = time.perf_counter(), time.process_time()
        for number in range(count):
            text = SAID[number % len(SAID)]
            if number % len(SAID) == 0:
                session.begin_again(Automaton())
            _utter(text, sounds[text], room, face, found)
        found.share = (time.process_time() - used) / (time.perf_counter() - started)
        listening.stop()
        loop.join(_PATIENCE_S)
    return found


def _utter(
    text: str, sound: Sequence[bytes], room: Room | None, face: _Face, found: Measured
) -> None:
    # A new player each time: what one holds back grows with each pause that is made.
    with closing(_Mouth(room)) as mouth:
        mouth.say([SILENCE] * _BEFORE)
        while not face.shown.empty():
            face.shown.get()
        ended = mouth.say(sound)
        while face.shown.empty() and time.perf_counter() < ended + _PATIENCE_S:
            mouth.say([SILENCE])
    if face.shown.empty():
        found.lost.append(text)
    else:
        at, _ = face.shown.get()
        (found.stops if text == "stop" else found.echoes).append(at - ended)
    found.memory.append(_resident())


@contextmanager
def _card() -> Iterator[None]:
    with tempfile.TemporaryDirectory() as folder:
        runtime = Path(folder) / "run"
        runtime.mkdir(mode=0o700)
        before = dict(os.environ)
        os.environ.pop("PULSE_SERVER", None)
        os.environ |= {"XDG_RUNTIME_DIR": str(runtime), "XDG_CONFIG_HOME": folder}
        card = SoundCard(Path(folder))
        card.plug_in()
        try:
            yield
        finally:
            card.unplug()
            os.environ.clear()
            os.environ.update(before)


def _resident() -> float:
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 2**20


def main() -> None:
    """Measures and prints."""
    parser = argparse.ArgumentParser(description="The hands-free loop at a microphone.")
    parser.add_argument("--utterances", type=int, default=MANY, help="how many, in a row")
    parser.add_argument("--noise", type=float, metavar="DB", help="a kitchen, that far below it")
    given = parser.parse_args()
    show(rows(given.utterances, given.noise))


if __name__ == "__main__":
    main()
