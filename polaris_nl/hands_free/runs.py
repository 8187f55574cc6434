"""What hands-free users hear of runs: they start when the user has said yes, and tell what they do."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from polaris_nl.execution.events import (
    CheckpointReached,
    Deviated,
    Event,
    Halted,
    RunEnded,
    Waiting,
)
from polaris_nl.execution.state import HumanCommand
from polaris_nl.hands_free.conversation import Conversation, Reply
from polaris_nl.hands_free.running import Running
from polaris_nl.logs.privacy import KEEP_ALL, Privacy
from polaris_nl.runs import CarryOut, RunOrder, RunReport, run_simulated


class Runs:
    """Starts runs when the user has said yes, and tells what they do.

    Args:
        conversation: its program is run; its words command the run.
        sink: is given the run's events, too.
        tell: says a sentence.
        log: the conversation's log, beside which each run gets one of its own; None for the log folder.
        carry_out: runs a program: in the simulated world, or on a robot.
        privacy: what the logs of runs leave out.
    """

    def __init__(
        self,
        conversation: Conversation,
        sink: Callable[[Event], None],
        tell: Callable[[str], None],
        log: Path | None = None,
        carry_out: CarryOut = run_simulated,
        privacy: Privacy = KEEP_ALL,
    ) -> None:
        self._log = log
        self._privacy = privacy
        self._carry_out = carry_out
        self._conversation = conversation
        self._sink = sink
        self._tell = tell

    def start(self, reply: Reply) -> None:
        """Runs the program that the user has said yes to, in real time."""
        answer, session = reply.answer, self._conversation.session
        assert answer is not None, "a run follows from an answer"
        if session.running:
            self._tell(_RUNS_ALREADY)
            return
        automaton, plan = answer.snapshot.automaton, answer.snapshot.plan
        assert plan is not None, "nobody says yes to a program without a plan"
        order = RunOrder(
            automaton, plan, session.planner, live=True, log=self._path(), before=session.past,
            privacy=self._privacy,
        )  # fmt: skip
        session.running = True
        self._conversation.running = Running(order, self._carry_out, self._show, self._over)

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
        if isinstance(event, CheckpointReached):
            self._reached(event.checkpoint)
        elif isinstance(event, _TOLD) and event.text:
            self._tell(event.text)

    def _reached(self, checkpoint: str) -> None:
        """Says what has been done: names of checkpoints are for the eye."""
        session = self._conversation.session
        found = session.snapshot.automaton.checkpoints.get(checkpoint)
        if found is not None and found.goals:
            self._tell(f"Done: {session.wording.goals(found.goals)}.")

    def _over(self, how: RunReport | str) -> None:
        self._conversation.session.running = False
        if isinstance(how, str):
            self._tell(how)
        elif how.failure:
            self._tell(how.failure)


_TOLD = (Waiting, Deviated, Halted, RunEnded)
"""What a user without a screen wants to know of a run."""
_RUNS_ALREADY = 'A program is running already. Say "stop" first, then "run it" again.'
