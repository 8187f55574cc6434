"""A whole conversation for tests: somebody speaks, the program hears, does and answers."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from pathlib import Path

from polaris_nl.automaton.program import program_json
from polaris_nl.execution.events import Event
from polaris_nl.execution.ros.profile import Profile
from polaris_nl.hands_free.conversation import Conversation, Reply
from polaris_nl.hands_free.listening import Listening
from polaris_nl.hands_free.phrases import spoken_names, spoken_phrases
from polaris_nl.hands_free.recording import AudioKeeper
from polaris_nl.hands_free.runs import Runs
from polaris_nl.logs.writer import LogWriter, attachments_of
from polaris_nl.model.world_file import load_world
from polaris_nl.robot_runs import carry_out_with
from polaris_nl.session import Session
from polaris_nl.speech.ears import EarMaker, Ears
from polaris_nl.speech.modes import Attention, State
from polaris_nl.speech.sources import Source
from polaris_nl.speech.speaker import Speaker
from polaris_nl.speech.voices import Speech


class Collected:
    """A face that keeps what it is shown."""

    def __init__(self) -> None:
        self.states: list[State] = []
        self.told: list[str] = []
        self.heard: list[Reply] = []

    def shows(self, state: State) -> None:
        self.states.append(state)

    def tells(self, text: str) -> None:
        self.told.append(text)

    def replies(self, reply: Reply) -> None:
        self.heard.append(reply)

    @property
    def texts(self) -> list[str]:
        return [reply.text for reply in self.heard]


class Silent:
    """A voice and a player that take no time, or for ever; what was said is kept."""

    name = "silent"

    def __init__(self) -> None:
        self.said: list[str] = []
        self.endless = False
        self.interrupted = 0

    def speech(self, text: str) -> Speech:
        return Speech(text.encode(), 16_000)

    def play(self, speech: Speech, stop: threading.Event) -> None:
        if speech.rate == 16_000:
            self.said.append(speech.samples.decode())
            if self.endless and stop.wait(60):
                self.interrupted += 1


class Talk:
    """Holds a conversation.

    Args:
        world: a shipped world.
        maker: loaded models.
        log: keeps the conversation there, with its sound.
        robot: what runs move; nothing but the simulated world if None.
    """

    def __init__(
        self,
        world: str,
        maker: EarMaker,
        log: Path | None = None,
        robot: Profile | None = None,
    ) -> None:
        self.session = Session(load_world(world))
        self.face = Collected()
        self.events: list[Event] = []
        self.voice = Silent()
        self.speaker = Speaker(self.voice, self.voice)
        world_ = self.session.world
        attachments = attachments_of(
            program_json(self.session.program), world_.domain.source, world_.source
        )
        self.log = LogWriter(log, attachments) if log is not None else None
        self.ears: Ears = maker.ears(
            spoken_phrases(self.session.understanding), spoken_names(self.session.understanding)
        )
        if self.log is not None:
            write = self.log.write
            self.session.report_to(lambda event: (write(event), None)[1])
        self.conversation = Conversation(
            self.session, self._sink, aloud=True, robot=robot.title if robot is not None else ""
        )
        self.runs = Runs(self.conversation, self._sink, self._tell, log, carry_out_with(robot))
        self.listening: Listening | None = None

    def _sink(self, event: Event) -> None:
        self.events.append(event)
        if self.log is not None:
            self.log.write(event)

    def _tell(self, text: str) -> None:
        self.face.tells(text)
        self.speaker.say(text, "run")

    def hold(
        self,
        source: Source,
        attention: Attention = Attention(),  # noqa: B008 - a frozen value
        now: Callable[[], float] | None = None,
        **more: object,
    ) -> Collected:
        """Listens to the end of the source."""
        self.listening = Listening(
            source, self.ears, self.conversation, self.face, attention, self.speaker,
            keep=AudioKeeper(self.log).keep if self.log is not None else None,
            started=self.runs.start,
            **more,
        )  # fmt: skip
        if now is not None:
            self.listening.now = now
        self.speaker.changed = self.listening.spoke
        self.listening.run()
        return self.face

    def close(self) -> None:
        self.runs.close()
        self.speaker.close()
        self.session.wait()
        self.session.close()
        if self.log is not None:
            self.log.close()

    def __enter__(self) -> Talk:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


class Counted:
    """A source whose blocks are a clock: 0.1 s each."""

    def __init__(self, source: Source) -> None:
        self.name, self.live, self._source = source.name, source.live, source
        self.seconds = 0.0

    def sound(self) -> Iterator[object]:
        for block in self._source.sound():
            self.seconds += 0.1
            yield block

    def now(self) -> float:
        return self.seconds
