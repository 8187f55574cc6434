"""Plans the rest of a segment anew for the executor, which itself never waits for a planner."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Protocol

from polaris_nl.execution.goals import PlanTo
from polaris_nl.execution.state import PlanAnswer, PlanRequest
from polaris_nl.model.domain import Action

Able = Callable[[tuple[Action, ...]], bool]
"""Whether the robot has a skill for each of some actions."""


class Replanner(Protocol):
    """Takes requests and gives answers, each once."""

    def ask(self, request: PlanRequest, budget_s: float, able: Able) -> None:
        """Begins to plan; an older request is forgotten."""
        ...

    def answers(self) -> tuple[PlanAnswer, ...]:
        """The answers that have come since the last call."""
        ...

    def close(self) -> None:
        """Waits for what is being planned, which its budget limits, and ends."""
        ...


class NoReplanner:
    """Finds no other way: every deviation is for people to put right."""

    def ask(self, request: PlanRequest, budget_s: float, able: Able) -> None:
        """Passes over the request."""

    def answers(self) -> tuple[PlanAnswer, ...]:
        """None ever come."""
        return ()

    def close(self) -> None:
        """There is nothing to end."""


class InlineReplanner:
    """Plans at once, in the caller's thread: for virtual time, in which planning takes none.

    Args:
        plan: the planner.
    """

    def __init__(self, plan: PlanTo) -> None:
        self._plan = plan
        self._answers: list[PlanAnswer] = []

    def ask(self, request: PlanRequest, budget_s: float, able: Able) -> None:
        """Plans; the answer is there with the next call of `answers`."""
        self._answers = [_answer(self._plan, request, budget_s, able)]

    def answers(self) -> tuple[PlanAnswer, ...]:
        """The answer, once."""
        answers, self._answers = self._answers, []
        return tuple(answers)

    def close(self) -> None:
        """There is nothing to end."""


class ThreadedReplanner:
    """Plans in a thread of its own, for runs in real time.

    Args:
        plan: the planner.
    """

    def __init__(self, plan: PlanTo) -> None:
        self._plan = plan
        self._pool = ThreadPoolExecutor(1, thread_name_prefix="replanning")
        self._asked: Future[PlanAnswer] | None = None

    def ask(self, request: PlanRequest, budget_s: float, able: Able) -> None:
        """Begins to plan."""
        if self._asked is not None:
            self._asked.cancel()
        self._asked = self._pool.submit(_answer, self._plan, request, budget_s, able)

    def answers(self) -> tuple[PlanAnswer, ...]:
        """The answer once it is there.

        Raises:
            Exception: whatever the planner raised.
        """
        if self._asked is None or not self._asked.done():
            return ()
        asked, self._asked = self._asked, None
        return (asked.result(),)

    def close(self) -> None:
        """Waits for the thread."""
        self._pool.shutdown(cancel_futures=True)


def _answer(plan: PlanTo, request: PlanRequest, budget_s: float, able: Able) -> PlanAnswer:
    result = plan(request.state, request.goals, budget_s)
    if result.status != "solved" or not able(result.actions):
        return PlanAnswer(request.number, None)
    return PlanAnswer(request.number, result.actions)
