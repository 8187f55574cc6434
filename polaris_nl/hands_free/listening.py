"""The hands-free loop: sound in, words and chimes out. "Stop" and "pause" act whatever else goes on.

The loop never waits for an answer: what is said goes to a thread that takes one utterance after the
other, so that "stop" is heard while a plan is made or a sentence is spoken.
"""

from __future__ import annotations

import queue
import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Protocol

from polaris_nl.execution.events import Heard as HeardEvent
from polaris_nl.hands_free.conversation import Conversation, Reply
from polaris_nl.hands_free.phrases import SLEEP, WAKE
from polaris_nl.hands_free.weight import Sense, weigher
from polaris_nl.speech.ears import Ears
from polaris_nl.speech.hearer import Heard, Hearer, Quick, Started
from polaris_nl.speech.hearing import Utterance, near
from polaris_nl.speech.modes import Attention, Cue, Happening, State, cue
from polaris_nl.speech.recogniser import Spoken
from polaris_nl.speech.sources import Source
from polaris_nl.speech.speaker import Speaker
from polaris_nl.speech.trouble import Trouble
from polaris_nl.speech.voices import chime
from polaris_nl.speech.wake import WakeWord

_PATIENCE_S = 30.0


class Face(Protocol):
    """What shows a conversation: the command's output, or a test."""

    def shows(self, state: State) -> None:
        """Whether it listens now."""
        ...

    def tells(self, text: str) -> None:
        """A sentence about the microphone or the mode."""
        ...

    def replies(self, reply: Reply) -> None:
        """What was heard, and what came of it."""
        ...


@dataclass
class Listening:
    """Brings a source, ears, a conversation and a voice together.

    Attributes:
        source: where sound comes from.
        ears: decoders and detector.
        conversation: what to do about what is heard.
        face: what shows it.
        attention: when speech is meant for the robot.
        speaker: says answers aloud, or None.
        wake_word: hears its name, in the mode `wake`.
        keep: keeps the sound of a piece of speech and returns its name, where it is asked for.
        started: is told when the user has said yes to a run.
        now: the time in seconds.
    """

    source: Source
    ears: Ears
    conversation: Conversation
    face: Face
    attention: Attention = field(default_factory=Attention)
    speaker: Speaker | None = None
    wake_word: WakeWord | None = None
    keep: Callable[[bytes], str] | None = None
    started: Callable[[Reply], None] = lambda reply: None
    now: Callable[[], float] = time.monotonic

    def __post_init__(self) -> None:
        self._happened: queue.SimpleQueue[Happening] = queue.SimpleQueue()
        self._asked: queue.Queue[Callable[[], None] | None] = queue.Queue()
        self._over = threading.Event()
        self._shown: State | None = None
        self._weigh = weigher(self.conversation.session)
        self._hearer = Hearer(self.ears, self._weigh)

    def key(self) -> None:
        """The push-to-talk key was pressed; from any thread."""
        self._happened.put("key")

    def spoke(self, speaking: bool) -> None:
        """The program's own voice starts or ends; from any thread."""
        self._happened.put("speaks" if speaking else "silent")

    def stop(self) -> None:
        """Ends the loop after the next block; from any thread."""
        self._over.set()

    def run(self) -> None:
        """Listens until the sound or the conversation ends.

        Raises:
            SpeechError: the source can't be used.
        """
        worker = threading.Thread(target=self._work, name="answering", daemon=True)
        worker.start()
        try:
            for sound in self.source.sound():
                if isinstance(sound, Trouble):
                    self.face.tells(sound.text)
                    self._say(sound.text, "trouble")
                else:
                    self._block(sound)
                if self._over.is_set():
                    break
            self._take(self._hearer.end())
        finally:
            self._asked.put(None)
            worker.join()

    def _block(self, block: bytes) -> None:
        now = self.now()
        while not self._happened.empty():
            self._change(self._happened.get(), now)
        self.attention = self.attention.at(now)
        if self.wake_word is not None and self.wake_word.heard(block):
            self._change("wake-word", now)
        self._show()
        self._take(self._hearer.push(block, self.attention.hears(now) or self.attention.asleep))

    def _change(self, happening: Happening, now: float) -> None:
        if happening in ("key", "wake-word"):
            self._hearer.call()
            if self.speaker is not None:
                self.speaker.interrupt()
        self.attention = self.attention.after(happening, now)

    def _show(self) -> None:
        state = self.attention.state(self.now())
        if state == self._shown:
            return
        sign: Cue = cue(self._shown, state) if self._shown is not None else ""
        self._shown = state
        self.face.shows(state)
        if self.speaker is not None and sign:
            self.speaker.play(chime(sign))

    def _take(self, happenings: Iterator[Started | Quick | Heard]) -> None:
        for happening in happenings:
            if isinstance(happening, Quick):
                self._quick(happening.command)
            elif isinstance(happening, Heard):
                self._heard(happening)
            elif self.speaker is not None and self.attention.hears(self.now()):
                self.speaker.interrupt()  # Somebody speaks, and is meant to be heard: fall silent.

    def _quick(self, command: str) -> None:
        if self.speaker is not None:
            if command in self.speaker.saying.lower():
                return  # It heard itself.
            self.speaker.interrupt()
        text = self.conversation.quick(command)
        self.face.tells(text)

    def _heard(self, heard: Heard) -> None:
        called = self.attention.mode != "always"
        self._asked.put(lambda: self._answer(heard, called))
        if not self.source.live:
            # A recording is answered sentence by sentence, as if its speaker waited for the answers.
            done = threading.Event()
            self._asked.put(done.set)
            done.wait(_PATIENCE_S)

    def _work(self) -> None:
        while (work := self._asked.get()) is not None:
            work()

    def _answer(self, heard: Heard, called: bool) -> None:
        """In the answering thread: takes what was heard, and says what came of it."""
        spoken = heard.spoken
        if heard.quick and spoken.alternatives[0].split()[0] == heard.quick:
            self._log(_certain(heard.quick, spoken), heard)
            return
        if self._is_mode(heard):
            return
        started = time.perf_counter()
        sense = Sense(self.conversation.session)
        said = self.ears.said([spoken], sense.weigh, sense.means)
        event = self._event(said, heard, time.perf_counter() - started + heard.decoding_s)
        reply = self.conversation.take(
            said, event, called, lambda: near([spoken], self._weigh, self.ears.ways)
        )
        if said.accepted:
            self._happened.put("said")
        self.face.replies(reply)
        self._say(reply.text, "answer")
        if reply.starts:
            self.started(reply)
        if reply.ends:
            self._over.set()

    def _is_mode(self, heard: Heard) -> bool:
        """Whether what was heard is about listening itself; asleep, all else is passed over unread."""
        texts = heard.spoken.alternatives[:3]
        if self.attention.asleep:
            if WAKE in texts and heard.spoken.free in (WAKE, ""):
                self._happened.put("wake")
                self._log(_certain(WAKE, heard.spoken), heard)
                self._say("I'm listening.", "mode")
            return True
        if SLEEP in texts:
            self._happened.put("sleep")
            self._log(_certain(SLEEP, heard.spoken), heard)
            self.face.tells(
                f'Asleep. Say "{WAKE}" when you need me; "stop" and "pause" still work.'
            )
            return True
        return False

    def _log(self, said: Utterance, heard: Heard) -> None:
        self.conversation.note(self._event(said, heard, heard.decoding_s))

    def _event(self, said: Utterance, heard: Heard, seconds: float) -> HeardEvent:
        return HeardEvent(
            time=self.conversation.now(),
            utterance=said.text,
            source="voice",
            alternatives=list(said.alternatives[:10]),
            audio_s=round(said.audio_s, 2),
            ms=round(seconds * 1000, 1),
            free=said.free,
            again=said.again,
            repaired=said.repaired,
            decision=said.why_not or "accepted",
            audio=self.keep(heard.spoken.audio) if self.keep is not None else "",
            pause_s=round(heard.pause_s, 2),
        )

    def _say(self, text: str, about: str) -> None:
        if self.speaker is not None and text:
            self.speaker.say(text, about)


def _certain(text: str, spoken: Spoken) -> Utterance:
    return Utterance(text, True, spoken.alternatives, spoken.seconds, spoken.free)
