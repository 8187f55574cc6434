"""A Stretch as the executor sees it: goals in, observations and reports out.

Two threads touch it. The run's thread calls the methods of the `Robot` protocol, which only hand
things over and read frozen values. The owner's thread makes every rclpy call, takes messages in,
watches over the robot's health some hundred times a second, and withdraws all motion at once when
something is wrong, without waiting for the run.
"""

from __future__ import annotations

import contextlib
import queue
from collections.abc import Callable, Coroutine, Iterable, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Any

from polaris_nl.execution.backend import (
    CancelGoal,
    Command,
    Health,
    Observation,
    Report,
    RunStop,
    SendGoal,
    StopRobot,
    ZeroVelocity,
)
from polaris_nl.execution.clock import Clock
from polaris_nl.execution.goals import PlanTo
from polaris_nl.execution.ros.driver import Driver
from polaris_nl.execution.ros.knowledge import facts, sightings, unknown
from polaris_nl.execution.ros.middleware import stay_on_this_machine
from polaris_nl.execution.ros.mission import Mission
from polaris_nl.execution.ros.owner import Late, Owner, until
from polaris_nl.execution.ros.perception import Scene, perceive, remembered
from polaris_nl.execution.ros.primitives import NAVIGATION, Primitives
from polaris_nl.execution.ros.profile import Profile
from polaris_nl.execution.ros.senses import Intake
from polaris_nl.execution.ros.skills import skills_for
from polaris_nl.execution.ros.watch import health_of, moving
from polaris_nl.model.domain import Action
from polaris_nl.model.errors import RunError
from polaris_nl.model.formula import Literal
from polaris_nl.model.state import Mutexes, State
from polaris_nl.model.text import capital
from polaris_nl.model.world import World

TOLD_S = 2.0
"""How long a robot that answers is given to say whether it may move."""
LOOK_S = 0.05
"""How often percepts become beliefs."""
STILL_S = 0.05
"""How often a velocity of zero is sent while the base is held still."""
SPEAKERS_S = 0.5
"""How often it is looked whether two programs speak for the robot."""

Record = Callable[[str, str, Any], None]


class StretchRobot:
    """A robot over ROS 2. Making it moves nothing; it listens until it is ready.

    Args:
        profile: what kind of robot.
        world: the world at the start.
        plan: the robot-side planner.
        mutexes: what excludes what.
        clock: the run's clock.
        state: what is believed at the start, where it isn't the world's; a run that is resumed has one.
        record: is given every message that goes either way: topic, type, message.
        closed: is called when the link is closed and nothing more will be recorded.

    Raises:
        RunError: rclpy is missing, or the robot doesn't answer.
    """

    def __init__(
        self,
        profile: Profile,
        world: World,
        plan: PlanTo,
        mutexes: Mutexes,
        clock: Clock,
        *,
        state: State | None = None,
        record: Record = lambda topic, kind, message: None,
        closed: Callable[[], None] = lambda: None,
    ) -> None:
        self.name = profile.name
        self._profile = profile
        self._world = world
        self._plan = plan
        self._clock = clock
        self._skills = skills_for(world.domain)
        self._scene = Scene.of(world, profile.perception, mutexes)
        self._memory = remembered(world, clock.now(), state)
        self._closed = closed
        self._senses = Intake(profile, world, clock, self._believed)
        self._driver = Driver(profile, self._senses.take, record)
        self._primitives = Primitives(self._driver, self._senses)
        self._reports: queue.SimpleQueue[Report] = queue.SimpleQueue()
        self._mission: Mission | None = None
        self._job: Future[None] | None = None
        self._health = Health("silent")
        self._state = facts(self._memory)
        self._still = False
        self._looked = self._stilled = self._counted = 0.0
        self._planner = ThreadPoolExecutor(max_workers=1, thread_name_prefix="robot-planning")
        if profile.simulated:
            stay_on_this_machine()
        try:
            self._owner = Owner("polaris_nl", self._driver.set_up, self._watch, self._withdraw)
        except BaseException:
            self._planner.shutdown()
            closed()
            raise
        try:
            self._owner.do(self._ready(), profile.times.ready + 1.0)
        except BaseException:
            self.close()
            raise

    # The robot protocol

    def missing(self, actions: Iterable[Action]) -> tuple[str, ...]:
        """The operators among some actions that it has no skill for."""
        return self._skills.missing((a.operator for a in actions), self._profile)

    def advance(self, now: float) -> None:
        """Nothing: real time passes by itself."""

    def command(self, command: Command) -> None:
        """Hands a command to the owner's thread."""
        if isinstance(command, SendGoal):
            self._owner.start(self._begin(command))
        elif isinstance(command, CancelGoal):
            self._owner.start(self._cancel(command.goal))
        elif isinstance(command, ZeroVelocity):
            self._owner.start(self._stand_still())
        elif isinstance(command, StopRobot):
            self._owner.start(self._stop("stop", None))
        elif isinstance(command, RunStop):
            self._owner.start(self._stop("runstop", True))

    def observe(self) -> Observation:
        """What is perceived now."""
        now, memory, percepts = self._clock.now(), self._memory, self._senses.percepts
        return Observation(
            facts(memory),
            unknown(memory, percepts, now, self._scene),
            seen=sightings(memory),
            health=self._health_now(now),
            moving=moving(self._senses.vitals, now, self._profile.safety),
        )

    def reports(self) -> Sequence[Report]:
        """The reports since the last call."""
        found = []
        while not self._reports.empty():
            found.append(self._reports.get())
        return found

    def close(self) -> None:
        """Lets the robot go; it stands still."""
        if self._owner.alive:
            # A link that is broken can't be asked for more; the driver stops by itself.
            with contextlib.suppress(RunError):
                self._owner.do(self._let_go(), 2.0)
        self._owner.close()
        self._planner.shutdown(wait=True, cancel_futures=True)
        self._closed()

    # The owner's thread

    def _watch(self) -> None:
        """Every turn: health, reflex, beliefs, standing still."""
        now = self._clock.now()
        if now - self._counted >= SPEAKERS_S:
            self._counted = now
            self._senses.count(self._driver.speakers())
        before, self._health = self._health, self._health_now(now)
        if before.ready and not self._health.ready:
            self._withdraw()
        if now - self._looked >= LOOK_S:
            self._looked = now
            self._memory = perceive(self._memory, self._senses.percepts, now, self._scene)
            self._state = facts(self._memory)
        heeded = self._senses.mode in ("", NAVIGATION)
        if self._still and heeded and now - self._stilled >= STILL_S:
            self._stilled = now
            self._driver.velocity(0.0, 0.0)

    def _health_now(self, now: float) -> Health:
        if not self._owner_alive():
            why = f" ({self._owner.failure})" if self._owner.failure else ""
            return Health("fault", f"the link to the robot broke{why}; start the run again")
        return health_of(self._senses.vitals, now, self._profile.safety)

    def _owner_alive(self) -> bool:
        owner = getattr(self, "_owner", None)
        return owner is None or owner.alive

    def _withdraw(self) -> None:
        """The reflex: whatever moves is called off, at once."""
        self._end_mission("cancelled", self._health.words)
        self._driver.cancel_all()
        self._driver.velocity(0.0, 0.0)
        self._still = True
        self._driver.call_now("stop")

    async def _ready(self) -> None:
        seconds, vitals = self._profile.times.ready, self._senses
        try:
            await until(lambda: vitals.vitals.heartbeat is not None, seconds, "answering")
            await until(
                lambda: vitals.percepts.base is not None and vitals.vitals.moved is not None,
                seconds,
                "telling where it is",
            )
        except Exception as error:
            way = (
                f"start it with: polaris-nl stretch-sim --world {self._world.name}"
                if self._profile.simulated
                else "see that its driver runs, and that this machine is in the same ROS domain"
            )
            raise RunError(f"{capital(self._profile.title)} doesn't answer; {way}") from error
        with contextlib.suppress(Late):
            # A run must not begin before the robot has had time to say that it isn't homed or can't move; a
            # driver that never speaks of it is believed.
            await until(lambda: vitals.vitals.told, TOLD_S, "telling how it is")

    async def _begin(self, goal: SendGoal) -> None:
        self._end_mission("cancelled", "another goal came")
        if not self._health.ready:
            self._reports.put(Report(goal.goal, "rejected", self._health.words))
            return
        self._still = False
        mission = Mission(goal, self._world, self._skills, self._plan)
        self._mission = mission
        job = mission.run(
            self._primitives, self._driver, self._reports.put, self._seen, self._think
        )
        self._job = self._owner.start(job)

    async def _cancel(self, goal: int) -> None:
        if self._mission is not None and self._mission.goal.goal == goal:
            self._end_mission("cancelled", "")
        self._driver.cancel_all()

    async def _stand_still(self) -> None:
        self._end_mission("cancelled", "")
        self._still = True
        self._driver.velocity(0.0, 0.0)

    async def _stop(self, service: str, flag: bool | None) -> None:
        self._end_mission("cancelled", "")
        self._driver.cancel_all()
        self._driver.velocity(0.0, 0.0)
        self._driver.call_now(service, flag)

    async def _let_go(self) -> None:
        """Ends what is under way and waits, for a moment, until the robot has given it up."""
        busy = self._mission is not None and not self._mission.over
        self._end_mission("cancelled", "")
        if busy or self._driver.open_goals:
            self._driver.cancel_all()
            self._driver.velocity(0.0, 0.0)
            try:
                await until(lambda: not self._driver.open_goals, 1.0, "giving up")
            except Exception:
                return

    def _end_mission(self, kind: str, reason: str) -> None:
        if self._job is not None:
            self._job.cancel()
            self._job = None
        mission, self._mission = self._mission, None
        if mission is not None and not mission.over:
            mission.over = True
            self._reports.put(Report(mission.goal.goal, "cancelled", reason))

    def _seen(self) -> State:
        return self._state

    def _think(self, work: Callable[[], Any]) -> Coroutine[None, None, Any]:
        """Has something computed in the planning thread, so that this one goes on watching."""

        async def thought() -> Any:
            future = self._planner.submit(work)
            await until(future.done, 30.0, "planning")
            return future.result()

        return thought()

    def _believed(self, variable: Literal) -> Literal | None:
        belief = self._memory.beliefs.get(variable)
        return belief.value if belief is not None else None
