"""A run that goes on while its user speaks."""

from __future__ import annotations

import queue
import threading
import time
from collections.abc import Callable, Iterable

from polaris_nl.automaton.automaton import Automaton
from polaris_nl.execution.events import Event, Heard
from polaris_nl.execution.state import HumanCommand
from polaris_nl.language.understanding import Understanding
from polaris_nl.model.errors import PolarisError
from polaris_nl.runs import CarryOut, RunOrder, RunReport
from polaris_nl.session import Session


class Running:
    """Carries one program out in a thread of its own.

    Args:
        order: what is to be run.
        carry_out: runs it, in the simulated world or on a robot.
        show: is given every event.
        over: is told how it ended: the report, or what went wrong in one sentence.
    """

    def __init__(
        self,
        order: RunOrder,
        carry_out: CarryOut,
        show: Callable[[Event], None],
        over: Callable[[RunReport | str], None],
    ) -> None:
        self._order = order
        self._carry_out = carry_out
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
            how: RunReport | str = self._carry_out(
                self._order, confirmed=True, show=self._show, commands=self._given
            )
        except PolarisError as error:
            how = str(error)
        self._over(how)

    def _given(self) -> Iterable[HumanCommand]:
        while not self._commands.empty():
            yield self._commands.get()


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
