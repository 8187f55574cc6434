"""One goal on its way: actions planned from what is perceived, each done by its primitives."""

from __future__ import annotations

from collections.abc import Callable, Coroutine, Sequence
from functools import partial
from typing import Any

from polaris_nl.execution.backend import Report, ReportKind, SendGoal
from polaris_nl.execution.expectations import needed_places
from polaris_nl.execution.goals import Act, Arrived, Lost, PlanTo, Pursuit
from polaris_nl.execution.ros.driver import Driver, Refused
from polaris_nl.execution.ros.owner import Job, Late, until
from polaris_nl.execution.ros.primitives import Primitives
from polaris_nl.execution.ros.skills import Skills
from polaris_nl.model.domain import Action
from polaris_nl.model.evaluate import effects
from polaris_nl.model.formula import Literal
from polaris_nl.model.state import State
from polaris_nl.model.world import World

EFFECT_S = 2.0
"""How long the effects of an action may take to be perceived before the way goes on without them."""

Send = Callable[[Report], None]
Think = Callable[[Callable[[], Any]], Coroutine[None, None, Any]]


class _Moved(Exception):
    """What the present action needs has gone from its place."""


class Mission:
    """The pursuit of one goal on a robot.

    Args:
        goal: what was asked for.
        world: the world.
        skills: how actions are done.
        plan: the robot-side planner.

    Attributes:
        over: nothing more is reported of it.
    """

    def __init__(self, goal: SendGoal, world: World, skills: Skills, plan: PlanTo) -> None:
        self.goal = goal
        self.over = False
        self._world = world
        self._skills = skills
        self._pursuit = Pursuit(goal, plan, world)
        self._accepted = False
        self._send: Send = lambda report: None

    async def run(
        self,
        primitives: Primitives,
        driver: Driver,
        send: Send,
        seen: Callable[[], State],
        think: Think,
    ) -> None:
        """Pursues the goal to its end, and reports.

        Args:
            primitives: what does things.
            driver: tells when the robot has accepted something.
            send: takes reports.
            seen: what is believed now.
            think: computes something in another thread.
        """
        self._send = send
        driver.accepted = self._accept
        try:
            await self._pursue(primitives, seen, think)
        except Refused as refusal:
            # Refused before anything was accepted is a goal that was never taken.
            self._end("failed" if self._accepted else "rejected", str(refusal))
        except Late as late:
            if self._accepted:
                self._end("failed", str(late))
            self.over = True  # A robot that doesn't answer says nothing, either.

    async def _pursue(
        self, primitives: Primitives, seen: Callable[[], State], think: Think
    ) -> None:
        done: Action | None = None
        while True:
            state = seen()
            found = await think(partial(self._pursuit.next, state))
            if isinstance(found, Lost):
                self._end("failed", found.reason)
                return
            if isinstance(found, Arrived):
                self._accept()
                self._end("succeeded")
                return
            assert isinstance(found, Act)
            if found.before is not None:
                self._reroute(found)
            if found.action == done:
                self._end("succeeded" if len(found.way) == 1 else "failed", _UNSEEN)
                return
            self._check_skill(found.action)
            try:
                achieved = await self._act(found.action, primitives, seen)
            except _Moved:
                done = None
                continue
            done = found.action
            if achieved and len(found.way) == 1:
                # Somebody may have gone on with it since: whether that is well is not for the robot to say.
                self._end("succeeded")
                return

    async def _act(self, action: Action, primitives: Primitives, seen: Callable[[], State]) -> bool:
        """Does an action, primitive by primitive, while what it needs stays where it is.

        Returns:
            Whether its effects were perceived, be it for a moment.
        """
        operator = self._world.domain.operators[action.operator]
        needs = needed_places(action, operator)
        steps = self._skills.steps(action, operator)
        wanted = self._effects(action, seen())
        achieved = False

        def in_place() -> bool:
            nonlocal achieved
            state = seen()
            achieved = achieved or all(map(state.holds, wanted))
            return achieved or all(map(state.holds, needs))

        for primitive in steps:
            await _while(in_place, primitives.do(primitive))
        await _patiently(lambda: in_place() and achieved)
        return achieved

    def _effects(self, action: Action, state: State) -> tuple[Literal, ...]:
        return effects(action, self._world.domain.operators[action.operator], state, self._world)

    def _check_skill(self, action: Action) -> None:
        if action.operator not in self._skills.by_operator:
            raise Refused(f"it has no skill for {action.operator.replace('-', ' ')}")

    def _accept(self) -> None:
        if not self._accepted and not self.over:
            self._accepted = True
            self._send(Report(self.goal.goal, "accepted"))

    def _reroute(self, found: Act) -> None:
        before: Sequence[Action] = found.before or ()
        self._send(Report(self.goal.goal, "replanned", "things changed", tuple(before), found.way))

    def _end(self, kind: ReportKind, reason: str = "") -> None:
        if not self.over:
            self.over = True
            self._send(Report(self.goal.goal, kind, reason))


_UNSEEN = "nothing of it is seen"


async def _while(ok: Callable[[], bool], job: Job) -> None:
    """Does a job as long as something is so.

    Raises:
        _Moved: it isn't so any more; the job is ended.
    """
    try:
        while True:
            try:
                job.send(None)
            except StopIteration:
                return
            if not ok():
                raise _Moved
            await _turn()
    finally:
        job.close()


async def _turn() -> None:
    first = iter((False, True))
    await until(lambda: next(first), 60.0, "a turn")


async def _patiently(ready: Callable[[], bool]) -> None:
    try:
        await until(ready, EFFECT_S, "seeing")
    except Late:
        return  # The next step decides from what is seen then.
