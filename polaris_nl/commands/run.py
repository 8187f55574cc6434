"""`run`: carries a program out."""

from __future__ import annotations

import queue
import sys
import threading
from argparse import Namespace
from collections.abc import Callable, Iterable
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

from polaris_nl.automaton.automaton import Automaton
from polaris_nl.automaton.program import Program
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
from polaris_nl.execution.ros.profile import Profile
from polaris_nl.execution.runner import objectives_met
from polaris_nl.execution.state import HumanCommand
from polaris_nl.hands_free.running import command_in as command_in
from polaris_nl.language.understanding import Understanding
from polaris_nl.logs.privacy import privacy_of
from polaris_nl.model.errors import LogError, RunError, UsageError, did_you_mean
from polaris_nl.model.text import capital
from polaris_nl.model.world import World
from polaris_nl.render.glyphs import glyphs_for
from polaris_nl.render.layout import wrapped
from polaris_nl.render.log import event_rows
from polaris_nl.robot_runs import carry_out_with, profile_of
from polaris_nl.run_logs import authored_in
from polaris_nl.runs import RunOrder, resumable
from polaris_nl.session import Session

NONE = "none"


def run(arguments: Namespace) -> int:
    """Runs a program in the simulated world or on a robot; 1 where the run didn't end as it should.

    Nothing moves in the simulated world, so the command itself is the yes there. A robot, simulated
    ones included, wants one of its own.
    """
    profile = profile_of(arguments.robot)
    program, world = opened(arguments)
    people = _people(arguments.people, world)
    with Session(world, program.automaton) as session:
        plan = session.planner.compile(program.automaton)
        order = RunOrder(
            program.automaton,
            plan,
            session.planner,
            people,
            arguments.live,
            arguments.log,
            privacy=privacy_of(arguments.leave_out),
            halt_without_log=arguments.halt_without_log,
            before=_said(arguments.said, arguments.resume, program),
        )
        if arguments.resume is not None:
            point = resumable(arguments.resume, program.automaton, plan, session.planner)
            order = replace(order, resume=point)
        confirmed = profile is None or arguments.yes or agreed(session, profile)
        order = replace(order, before=(*order.before, *session.past))
        listens = arguments.live or (profile is not None and sys.stdin.isatty())
        commands = Keyboard(session.understanding, program.automaton).commands if listens else tuple
        report = carry_out_with(profile)(
            order, confirmed=confirmed, show=shower(arguments.json), commands=commands
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
        if result.outcome != "done":
            again = f"{shown_path(arguments.program)} --resume {shown_path(report.log)}"
            print_text(f"When things are put right, it goes on with: polaris-nl run {again}")
    return 0 if result.outcome == "done" and not report.failure else 1


def agreed(session: Session, profile: Profile) -> bool:
    """Whether a person says yes after hearing what a robot will do.

    Raises:
        RunError: nobody can be asked, or the answer isn't a yes.
    """
    for row in wrapped(session.say("run it").say, width()):
        print(row.text.rstrip(), file=sys.stderr)
    print(f"{capital(profile.title)} will move. Yes or no? ", end="", file=sys.stderr, flush=True)
    answer = sys.stdin.readline()
    if not answer:
        raise RunError("A robot moves only after a yes, and nobody answers; --yes gives it.")
    if session.say(answer.strip()).interpretation.command != "yes":
        raise RunError("Nothing was moved, since the answer wasn't a yes.")
    return True


def _said(session: Path | None, resumed: Path | None, program: Program) -> tuple[Event, ...]:
    """What led to the program, where a log of it is named; a run that goes on takes it from the one before."""
    if session is not None:
        return authored_in(session, program)
    if resumed is None:
        return ()
    with suppress(LogError):  # Nothing was said before it, or the program was changed since.
        return authored_in(resumed, program)
    return ()


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
        self._commands: queue.SimpleQueue[HumanCommand] = queue.SimpleQueue()
        threading.Thread(target=self._read, name="keyboard", daemon=True).start()

    def _read(self) -> None:
        # Understanding takes its time, above all at first, and the run mustn't wait for it.
        self._command("stop")
        for line in sys.stdin:
            command = self._command(line) if line.strip() else None
            if command is not None:
                self._commands.put(command)

    def commands(self) -> Iterable[HumanCommand]:
        """The commands typed since the last call."""
        while not self._commands.empty():
            yield self._commands.get()

    def _command(self, line: str) -> HumanCommand | None:
        command = command_in(line, self._understanding, self._automaton)
        if command is None:
            complain(
                "Say stop, pause, resume, or what has happened, such as: the resident acknowledges."
            )
        return command
