"""`run`: carries a program out."""

from __future__ import annotations

import queue
import sys
import threading
from argparse import Namespace
from collections.abc import Callable, Iterable

from polaris_nl.automaton.automaton import Automaton
from polaris_nl.commands.common import (
    complain,
    opened,
    print_json,
    print_rows,
    print_text,
    shown_path,
    width,
)
from polaris_nl.execution.events import Event, GoalConfirmed
from polaris_nl.execution.runner import objectives_met
from polaris_nl.execution.state import HumanCommand
from polaris_nl.hands_free.running import command_in as command_in
from polaris_nl.language.understanding import Understanding
from polaris_nl.model.errors import RunError, UsageError, did_you_mean
from polaris_nl.model.world import World
from polaris_nl.render.glyphs import glyphs_for
from polaris_nl.render.log import event_rows
from polaris_nl.runs import RunOrder, run_simulated
from polaris_nl.session import Session

NONE = "none"


def run(arguments: Namespace) -> int:
    """Runs a program in the simulated world; 1 where the run didn't end as it should.

    Nothing real moves there, so the command itself is the yes.
    """
    if arguments.robot != "world":
        raise RunError(
            f"The robot {arguments.robot} isn't there yet; use --robot world, the simulated world."
        )
    program, world = opened(arguments)
    people = _people(arguments.people, world)
    with Session(world, program.automaton) as session:
        plan = session.planner.compile(program.automaton)
        order = RunOrder(
            program.automaton, plan, session.planner, people, arguments.live, arguments.log
        )
        commands = (
            Keyboard(session.understanding, program.automaton).commands if arguments.live else tuple
        )
        report = run_simulated(
            order, confirmed=True, show=shower(arguments.json), commands=commands
        )
    result = report.result
    met = objectives_met(world, result.beliefs)
    if report.failure:
        complain(report.failure)
    if arguments.json:
        print_json(
            {
                "outcome": result.outcome,
                "reason": result.reason,
                "checkpoints": list(result.checkpoints),
                "seconds": round(result.seconds, 1),
                "objectives": [{"name": o.name, "met": ok} for o, ok in met],
                "log": str(report.log),
            }
        )
    else:
        done = [o.name for o, ok in met if ok]
        if met:
            print_text(f"Objectives: {len(done)} of {len(met)} ({', '.join(done) or 'none'}).")
        print_text(f"The log can be read with: polaris-nl review {shown_path(report.log)}")
    return 0 if result.outcome == "done" and not report.failure else 1


def shower(silent: bool = False) -> Callable[[Event], None]:
    """Prints what happens in a run, with the seconds since its first event."""
    first: list[float] = []

    def show(event: Event) -> None:
        first.append(event.time)
        if (
            event.text
            and event.severity != "debug"
            and not isinstance(event, GoalConfirmed)
            and not silent
        ):
            print_rows(
                event_rows(event.time - first[0], event.severity, event.text, glyphs_for(), width())
            )

    return show


def _people(named: list[str] | None, world: World) -> tuple[str, ...] | None:
    if named is None:
        return None
    known = [a.name for a in world.scenario.human_actions]
    for name in named:
        if name != NONE and name not in known:
            hint = did_you_mean(name, known) or " The world file lists none."
            raise UsageError(f"Nobody in {world.name} can do {name!r}.{hint}")
    return tuple(name for name in named if name != NONE)


class Keyboard:
    """What is typed during a run: stop, pause, resume, or a fact that has come true."""

    def __init__(self, understanding: Understanding, automaton: Automaton) -> None:
        self._understanding = understanding
        self._automaton = automaton
        self._lines: queue.SimpleQueue[str] = queue.SimpleQueue()
        threading.Thread(target=self._read, name="keyboard", daemon=True).start()

    def _read(self) -> None:
        for line in sys.stdin:
            self._lines.put(line)

    def commands(self) -> Iterable[HumanCommand]:
        """The commands typed since the last call."""
        while not self._lines.empty():
            command = self._command(self._lines.get())
            if command is not None:
                yield command

    def _command(self, line: str) -> HumanCommand | None:
        command = command_in(line, self._understanding, self._automaton)
        if command is None:
            complain(
                "Say stop, pause, resume, or what has happened, such as: the resident acknowledges."
            )
        return command
