"""What to do about what was heard, and what to say to it: the policy of a conversation without a screen.

Questions are answered at once; edits are applied and echoed; a run needs a yes after the echo of
what will happen. What isn't understood twice is offered as numbered choices.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Literal as OneOf

from polaris_nl.execution.events import Event, Said
from polaris_nl.execution.events import Heard as HeardEvent
from polaris_nl.execution.state import HumanCommand
from polaris_nl.hands_free.choices import NO, YES, Choices, choices_among
from polaris_nl.hands_free.phrases import spoken_names
from polaris_nl.hands_free.running import Running, told
from polaris_nl.model.text import capital
from polaris_nl.session import Session
from polaris_nl.snapshot import Answer
from polaris_nl.speech.hearing import Utterance

ANSWERS = 3
"""Readings that may answer an offered choice: the likeliest ones."""
FAILURES = 2
"""After so many failures in a row, choices are offered."""
MEANT, MEANT_WHEN_CALLED = 0.15, 0.6
"""Speech that isn't understood, but that both decodings hear so alike, was meant for the robot: it gets an
answer. Without a call much speech isn't, so there they have to be all but the same, and to name something."""


@dataclass(frozen=True)
class Reply:
    """What came of an utterance.

    Attributes:
        said: what was heard.
        text: what to answer, or "" for nothing.
        answer: the session's answer, where it was asked.
        ends: the conversation is over.
        starts: a run may start: the user has said yes.
    """

    said: Utterance
    text: str = ""
    answer: Answer | None = None
    ends: bool = False
    starts: bool = False


class Conversation:
    """One user's conversation about one program.

    Args:
        session: what is changed and asked.
        sink: is given what is said, as events.
        aloud: what it says is spoken.
        robot: what a run moves, such as "the simulated Stretch"; "" where nothing does.
        now: the time in seconds since the epoch.
    """

    def __init__(
        self,
        session: Session,
        sink: Callable[[Event], None] = lambda event: None,
        aloud: bool = False,
        robot: str = "",
        now: Callable[[], float] = time.time,
    ) -> None:
        self.session = session
        self.running: Running | None = None
        self._sink = sink
        self._aloud = aloud
        self._robot = robot
        self.now = now
        self._failures = 0
        self._choices: Choices | None = None
        self._names = spoken_names(session.understanding)

    @property
    def _runs(self) -> Running | None:
        return self.running if self.running is not None and self.running.going_on else None

    def note(self, heard: HeardEvent) -> None:
        """Logs what was heard where nothing else follows from it."""
        self._sink(heard)

    def quick(self, command: str) -> str:
        """Stops or pauses at once, whatever else goes on; what to say to it."""
        runs = self._runs
        if runs is not None:
            kind: OneOf["stop", "pause"] = "stop" if command == "stop" else "pause"
            heard = HeardEvent(time=self.now(), utterance=command, source="voice")
            runs.command(HumanCommand(kind, source="voice", said=heard))
        return "Stopped." if command == "stop" else "Paused."

    def take(
        self, said: Utterance, heard: HeardEvent, called: bool, near: Callable[[], Sequence[str]]
    ) -> Reply:
        """Does what an utterance asks for.

        Args:
            said: what was heard.
            heard: the same for the log.
            called: attention was called (a key, the wake word), so that it was meant for the robot.
            near: finds what else may have been said.
        """
        if self._choices is not None:
            others = () if said.accepted else said.alternatives[:ANSWERS]
            answers = [self._answer(text) for text in (said.text, *others)]
            chosen = next(filter(lambda c: c is not None, map(self._choices.chosen, answers)), None)
            if chosen is not None:
                self._choices = None
                self._failures = 0
                if not chosen:
                    self._sink(heard)
                    return self._reply(said, "All right. Say it in other words.")
                return self._act(said, chosen, heard)
            if answers[0] == YES:
                # It must not be taken for a yes to a run that was asked about before.
                self._sink(heard)
                return self._reply(said, self._choices.ask_again)
        if said.accepted:
            self._failures, self._choices = 0, None
            return self._act(said, said.text, heard)
        if said.doubts:
            return self._offered(said, heard, Choices(said.doubts))
        if not self._was_meant(said, called):
            self._sink(heard)
            return Reply(said)  # Not meant for the robot: it doesn't butt in.
        return self._failed(said, heard, near)

    def _answer(self, text: str) -> str:
        """Words as an answer to choices: any way to agree is a yes, any way not to a no."""
        command = self.session.understood(text).command
        return {"yes": YES, "no": NO}.get(command or "", text)

    def _was_meant(self, said: Utterance, called: bool) -> bool:
        """Whether speech that isn't understood was meant for the robot all the same, and wants an answer."""
        if called:
            return bool(said.text) and said.different <= MEANT_WHEN_CALLED
        names_something = any(f" {name} " in f" {said.text} " for name in self._names)
        return names_something and said.different <= MEANT

    def _act(self, said: Utterance, text: str, heard: HeardEvent) -> Reply:
        runs = self._runs
        if runs is not None:
            command = told(text, self.session, heard)
            if command is not None:
                self._sink(heard)
                runs.command(command)
                return self._reply(said, _RUN_ANSWERS.get(command.kind, "All right."))
        answer = self.session.say(text, source="voice", heard=heard)
        words = answer.say
        if self._robot and self.session.awaits_yes:
            words = f"{capital(self._robot)} will move. {words}"
        self._tell(words)
        return Reply(
            said,
            words,
            answer,
            ends=answer.interpretation.command == "quit",
            starts=answer.confirmed,
        )

    def _failed(
        self, said: Utterance, heard: HeardEvent, near: Callable[[], Sequence[str]]
    ) -> Reply:
        self._failures += 1
        choices = None
        meant = self.session.understood(said.text)
        if meant.edits or meant.command is not None:
            # It makes sense, but too little speaks for it: it is asked about, and not done.
            choices = choices_among((said.text,), ())
        elif self._failures >= FAILURES:
            choices = choices_among(near(), ("help", "read me the program"))
        if choices is not None:
            return self._offered(said, heard, choices)
        answer = self.session.say(said.text, source="voice", heard=heard)
        self._tell(answer.say)
        return Reply(said, answer.say, answer)

    def _offered(self, said: Utterance, heard: HeardEvent, choices: Choices) -> Reply:
        """Asks which of some sentences was meant."""
        self._choices = choices
        self._sink(heard)
        return self._reply(said, choices.say)

    def _reply(self, said: Utterance, text: str) -> Reply:
        self._tell(text)
        return Reply(said, text)

    def _tell(self, text: str) -> None:
        if text and self._aloud:
            self._sink(Said(time=self.now(), text=text, aloud=True))


_RUN_ANSWERS = {"stop": "Stopped.", "pause": "Paused.", "resume": "Going on."}
