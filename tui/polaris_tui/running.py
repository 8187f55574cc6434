"""A run in the simulated world or on a robot, in a thread of its own."""

from __future__ import annotations

import queue
import threading
from collections.abc import Callable, Iterable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

from textual.message import Message

from polaris_nl.execution.events import Event
from polaris_nl.execution.ros.profile import Profile
from polaris_nl.execution.state import HumanCommand
from polaris_nl.model.errors import PolarisError
from polaris_nl.planning.result import BranchingPlan
from polaris_nl.session import Session
from polaris_nl.snapshot import Snapshot
from polaris_tui.messages import Happened, RunOver
from polaris_tui.transcript import Entry

if TYPE_CHECKING:
    from polaris_nl.runs import CarryOut, RunReport

END_S = 5.0
"""How long a run in the simulated world may take to stop."""
ROBOT_END_S = 30.0
"""The same on a robot: longer than one may take to answer, or to stand still."""


class Run(Protocol):
    """A run that goes on, wherever it was begun.

    Attributes:
        snapshot: the program that is carried out, with its plan.
        plan: that plan.
        ours: it was begun here, so that it ends with this program; the others go on without it.
    """

    snapshot: Snapshot
    plan: BranchingPlan
    ours: bool

    @property
    def active(self) -> bool:
        """Whether it goes on."""
        ...

    def command(self, command: HumanCommand) -> None:
        """Commands it, at once."""
        ...

    def wait(self, seconds: float | None) -> None:
        """Waits for its end."""
        ...

    def end(self) -> None:
        """Has nothing to do with it any more: stops it where it is ours, and waits for that."""
        ...


Current = Callable[[], Run | None]
"""Tells which run goes on."""


class Running:
    """One run, after its yes.

    Args:
        session: whose world and planner it uses.
        snapshot: the program that was read out, and the plan for it.
        plan: that plan.
        tell: is given messages; called in the run's thread.
        live: in real time; otherwise as fast as the machine can. A robot takes its time anyway.
        log: where the log is written; a new one in the log folder by default.
        before: what led to the program, for the log.
        profile: the robot that is to move; None for the simulated world, where nothing does.
    """

    ours = True

    def __init__(
        self,
        session: Session,
        snapshot: Snapshot,
        plan: BranchingPlan,
        tell: Callable[[Message], object],
        live: bool = True,
        log: Path | None = None,
        before: tuple[Event, ...] = (),
        profile: Profile | None = None,
    ) -> None:
        self.snapshot = snapshot
        self.plan = plan
        self._session = session
        self.tell = tell
        self._live = live
        self._log = log
        self._before = before
        self._profile = profile
        self._commands: queue.SimpleQueue[HumanCommand] = queue.SimpleQueue()
        self._thread = threading.Thread(target=self._run, name="run", daemon=True)

    def start(self) -> None:
        """Starts it."""
        self._thread.start()

    @property
    def active(self) -> bool:
        """Whether it goes on."""
        return self._thread.is_alive()

    def command(self, command: HumanCommand) -> None:
        """Commands the run; it listens many times a second."""
        self._commands.put(command)

    @property
    def robot(self) -> str:
        """What it moves, for sentences; "" in the simulated world."""
        return self._profile.title if self._profile is not None else ""

    def wait(self, seconds: float | None) -> None:
        """Waits for its end; for ever where no time is given."""
        self._thread.join(seconds)

    def end(self) -> None:
        """Stops it and waits for that, as long as it may take: a robot is let go of before its program ends."""
        self.command(HumanCommand("stop"))
        self.wait(END_S if self._profile is None else ROBOT_END_S)

    def _taken(self) -> Iterable[HumanCommand]:
        while not self._commands.empty():
            yield self._commands.get()

    def _run(self) -> None:
        try:
            report = self._carried_out()
        except PolarisError as error:
            self.tell(RunOver(Entry(str(error), "! ", "bad")))
        except Exception as error:
            text = f"The run went wrong and was stopped ({type(error).__name__}: {error})."
            self.tell(RunOver(Entry(text, "! ", "bad")))
        else:
            self.tell(RunOver(*self._afterwards(report)))

    def _carried_out(self) -> RunReport:
        from polaris_nl.runs import RunOrder

        order = RunOrder(
            self.snapshot.automaton,
            self.plan,
            self._session.planner,
            live=self._live,
            log=self._log,
            before=self._before,
        )
        carry_out = self._carry_out()
        return carry_out(order, confirmed=True, show=self._show, commands=self._taken)

    def _carry_out(self) -> CarryOut:
        """Who runs it; what a robot takes is loaded only where one moves."""
        if self._profile is None:
            from polaris_nl.runs import run_simulated

            return run_simulated
        from polaris_nl.robot_runs import run_on_robot

        return partial(run_on_robot, self._profile)

    def _show(self, event: Event) -> None:
        self.tell(Happened(event))

    def _afterwards(self, report: RunReport) -> Iterable[Entry]:
        from polaris_nl.commands.common import shown_path
        from polaris_nl.execution.runner import objectives_met

        met = objectives_met(self._session.world, report.result.beliefs)
        done = [objective.name for objective, holds in met if holds]
        if met:
            yield Entry(f"Objectives: {len(done)} of {len(met)} ({', '.join(done) or 'none'}).")
        yield Entry(f"Read the run back with: polaris-nl review {shown_path(report.log)}")
        if report.failure:
            yield Entry(report.failure, "! ", "bad")
