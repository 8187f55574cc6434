"""Lets other terminals see and command a run of this one."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from textual.message import Message

from polaris_nl.automaton.program import program_json
from polaris_nl.planning.plan_json import plan_json
from polaris_nl.session import Session
from polaris_tui.remote import RunServer
from polaris_tui.running import Running

Tell = Callable[[Message], object]


def served(run: Running, session: Session, folder: Path, tell: Tell) -> tuple[Tell, str]:
    """Serves a run that is about to start.

    Args:
        run: the run.
        session: its world.
        folder: where it is to listen.
        tell: whom it tells what happens.

    Returns:
        Whom it is to tell from now on, and why nobody else can be told, or "".
    """
    hello = {
        "world": session.world.name,
        "robot": run.robot,
        "program": program_json(session.program_of(run.snapshot.automaton)),
        "plan": plan_json(run.plan, run.snapshot.automaton),
    }
    try:
        server = RunServer(hello, run.command, folder)
    except OSError as error:
        return tell, f"No other terminal will be able to stop this run ({error})."

    def both(message: Message) -> None:
        tell(message)
        server.tell(message)

    return both, ""
