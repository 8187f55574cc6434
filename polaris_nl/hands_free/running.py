"""A run that goes on while its user speaks."""

from __future__ import annotations

import queue
import threading
import time
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING

from polaris_nl.automaton.automaton import Automaton
from polaris_nl.execution.events import (
    CheckpointReached,
    Deviated,
    Event,
    Halted,
    Heard,
    RunEnded,
    Waiting,
)
from polaris_nl.execution.state import HumanCommand
from polaris_nl.language.understanding import Understanding
from polaris_nl.logs.privacy import KEEP_ALL, Privacy
from polaris_nl.model.errors import PolarisError
from polaris_nl.runs import RunOrder, RunReport, run_simulated
from polaris_nl.session import Session

if TYPE_CHECKING:
    from polaris_nl.hands_free.conversation import Conversation, Reply


class Running:
    """Carries one program out in a thread of its own.

    Args:
        order: what is to be run.
        show: is given every event.
        over: is told how it ended: the report, or what went wrong in one sentence.
    """

    def __init__(
        self,
        order: RunOrder,
        show: Callable[[Event], None],
        over: Callable[[RunReport | str], None],
    ) -> None:
        self._order = order
        self._show = show
        self._over = over
        self._commands: queue.SimpleQueue[HumanCommand] = queue.SimpleQueue()
        self._thread = threading.Thread(target=self._work, name="running", daemon=True)
        self._thread.start()

    @property
    def going_on(self) -> bool:
        """Whether it isn't over yet."""
        return self._thread.is_alive()

    def command(self, command: HumanCommand) -> None:
        """Stops, pauses, resumes, or tells what has happened; at once."""
        self._commands.put(command)

    def join(self, seconds: float) -> bool:
        """Waits for its end; False if it takes longer."""
        self._thread.join(seconds)
        return not self._thread.is_alive()

    def _work(self) -> None:
        try:
            self._over(
                run_simulated(self._order, confirmed=True, show=self._show, commands=self._given)
            )
        except PolarisError as error:
            self._over(str(error))

    def _given(self) -> Iterable[HumanCommand]:
        while not self._commands.empty():
            yield self._commands.get()


class Runs:
    """Starts runs when the user has said yes, and tells what they do.

    Args:
        conversation: its program is run; its words command the run.
        sink: is given the run's events, too.
        tell: says a sentence.
        log: the conversation's log, beside which each run gets one of its own; None for the log folder.
        privacy: what the logs of runs leave out.
    """

    def __init__(
        self,
        conversation: Conversation,
        sink: Callable[[Event], None],
        tell: Callable[[str], None],
        log: Path | None = None,
        privacy: Privacy = KEEP_ALL,
    ) -> None:
        self._log = log
        self._privacy = privacy
        self._conversation = conversation
        self._sink = sink
        self._tell = tell

    def start(self, reply: Reply) -> None:
        """Runs the program that the user has said yes to, in the simulated world and in real time."""
        answer, session = reply.answer, self._conversation.session
        assert answer is not None, "a run follows from an answer"
        automaton, plan = answer.snapshot.automaton, answer.snapshot.plan
        assert plan is not None, "nobody says yes to a program without a plan"
        order = RunOrder(
            automaton, plan, session.planner, live=True, log=self._path(), before=session.past,
            privacy=self._privacy,
        )  # fmt: skip
        self._conversation.running = Running(order, self._show, self._over)

    def _path(self) -> Path | None:
        if self._log is None:
            return None
        number = 1
        while (path := self._log.with_name(f"{self._log.stem}-run-{number}.mcap")).exists():
            number += 1
        return path

    def close(self, seconds: float = 5.0) -> None:
        """Stops a run that goes on."""
        running = self._conversation.running
        if running is not None and running.going_on:
            running.command(HumanCommand("stop"))
            running.join(seconds)

    def _show(self, event: Event) -> None:
        self._sink(event)
        if isinstance(event, _TOLD) and event.text:
            self._tell(event.text)

    def _over(self, how: RunReport | str) -> None:
        if isinstance(how, str):
            self._tell(how)
        elif how.failure:
            self._tell(how.failure)


_TOLD = (CheckpointReached, Waiting, Deviated, Halted, RunEnded)
"""What a user without a screen wants to know of a run."""


def told(text: str, session: Session, heard: Heard) -> HumanCommand | None:
    """What words during a run tell it: pause, resume, stop, or a fact that has come true; or None."""
    found = command_in(text, session.understanding, session.snapshot.automaton)
    return HumanCommand(found.kind, found.literals, "voice", heard) if found else None


def command_in(
    line: str, understanding: Understanding, automaton: Automaton
) -> HumanCommand | None:
    """What words during a run command: stop, pause, resume, or a fact that has come true.

    Args:
        line: what was said or typed.
        understanding: the language side.
        automaton: the program that runs; what it is about is what facts are about.
    """
    said = Heard(time=time.time(), utterance=line.strip())
    meant, _ = understanding.interpret(line, automaton)
    if meant.command in ("stop", "quit"):
        return HumanCommand("stop", said=said)
    if meant.command == "pause":
        return HumanCommand("pause", said=said)
    if meant.command == "resume":
        return HumanCommand("resume", said=said)
    # Facts are read as conditionals are: then "she acknowledges" means what the program waits for.
    asked, _ = understanding.interpret(f"what will you do if {line}", automaton)
    when = asked.query.when if asked.query is not None else ()
    return HumanCommand("happened", when, said=said) if when else None
