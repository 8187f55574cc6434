"""The simulation as a whole: body, driver, navigation, skills, speech and people, advanced together.

Pure but for the body: it is given the clock's time and makes what happens of it. `time` is the simulation's
own, which runs `speed` times as fast.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field

from polaris_nl.execution.ros.layout import Layout, Pose
from polaris_nl.execution.ros.stretch_sim import skills
from polaris_nl.execution.ros.stretch_sim.body import Body, KinematicBody
from polaris_nl.execution.ros.stretch_sim.driver import Driver
from polaris_nl.execution.ros.stretch_sim.faults import GOAL_FAULTS, Fault, Mishaps
from polaris_nl.execution.ros.stretch_sim.floor import Floor, floor_of
from polaris_nl.execution.ros.stretch_sim.navigation import Navigation, begin
from polaris_nl.execution.ros.stretch_sim.people import Deed, People
from polaris_nl.execution.ros.stretch_sim.perception import Cameras, Settings
from polaris_nl.execution.ros.stretch_sim.scene import Scene, start_pose
from polaris_nl.execution.ros.stretch_sim.skills import Reply, Request
from polaris_nl.execution.ros.stretch_sim.speech import Saying, Speech
from polaris_nl.model.world import World
from polaris_nl.planning.mutexes import find_mutexes

STEP_S = 0.02
LAG_S = 0.5
"""If the machine falls behind by more than this, simulated time is dropped instead."""
CATCH_UP_S = 0.05
"""The most that is caught up with at a time, so that the driver's topics don't fall silent over it."""
MakeBody = Callable[[World, Layout, Floor, Pose], Body]
"""Makes a body in a world, with its start."""


@dataclass(frozen=True, slots=True)
class Options:
    """How to simulate.

    Attributes:
        people: the human actions that people prefer; None for the world's order, empty for none.
        speed: simulated seconds a second.
        noise_m, dropout: of the cameras.
        homed: whether the robot is homed at the start.
    """

    people: tuple[str, ...] | None = None
    seed: int = 0
    speed: float = 1.0
    noise_m: float = 0.0
    dropout: float = 0.0
    homed: bool = True


@dataclass(slots=True)
class _Task:
    """A skill under way."""

    request: Request
    until: float
    done: Callable[[Reply], None]
    lies: bool = False


@dataclass(slots=True)
class Happened:
    """What was done and said since it was last asked."""

    deeds: list[Deed] = field(default_factory=list)
    said: list[Saying] = field(default_factory=list)


class Simulator:
    """One robot in one world.

    Args:
        world: the world.
        now: the clock's time, in seconds.
        options: how.
        make_body: makes the body from the world, its start and its floor; without forces by default.

    Raises:
        RunError: the world doesn't say where things are.
    """

    def __init__(
        self,
        world: World,
        now: float,
        options: Options | None = None,
        make_body: MakeBody | None = None,
    ) -> None:
        options = options or Options()
        self.layout = Layout.of(world)
        start = start_pose(world, self.layout)
        self.floor = floor_of(self.layout, world.map)
        self.body: Body = (
            make_body(world, self.layout, self.floor, start)
            if make_body is not None
            else KinematicBody(start, self.floor.fits)
        )
        mutexes = find_mutexes(world)
        self.world = world
        self.mishaps = Mishaps()
        self.driver = Driver(self.body, self.mishaps, now, options.homed)
        self.scene = Scene(world, mutexes, self.layout, self.floor, self.body)
        self.cameras = Cameras(self.scene, Settings(options.noise_m, options.dropout, options.seed))
        self.time = 0.0
        self.struck = 0
        self.navigation: Navigation | None = None
        self._people = People(self.scene, options.people, mutexes, options.seed)
        self._speed = options.speed
        self._most = max(3, math.ceil(CATCH_UP_S * options.speed / STEP_S))
        self._now: float | None = None
        self._owed = 0.0
        self._wall = self._simulated = 0.0
        self._task: _Task | None = None
        self._speech = Speech(self.scene, self.mishaps)
        self._happened = Happened()

    # Time

    def step(self, now: float) -> Happened:
        """Lets time pass until `now` on the clock, and tells what people did and what was said."""
        passed = 0.0 if self._now is None else max(now - self._now, 0.0)
        self._now = now
        self._wall += passed
        self._owed = min(self._owed + passed * self._speed, LAG_S * self._speed)
        for _ in range(self._most):
            if self._owed < STEP_S:
                break
            self._owed -= STEP_S
            self._advance(now)
        happened, self._happened = self._happened, Happened()
        return happened

    def stamp(self, now: float) -> float:
        """What messages that are sent now are stamped with."""
        return now + self.mishaps.clock_s

    @property
    def real_time_factor(self) -> float:
        """Simulated seconds a second, so far."""
        return self._simulated / self._wall if self._wall > 0 else 0.0

    @property
    def wall(self) -> float:
        """The clock's seconds since the start."""
        return self._wall

    def _advance(self, now: float) -> None:
        self.time += STEP_S
        self._simulated += STEP_S
        self.driver.step(now, STEP_S)
        if self.navigation is not None:
            self.navigation.step(self.body.pose, STEP_S, self.driver.velocity)
            if self.navigation.state != "active":
                self.navigation = None
        self.body.step(STEP_S)
        self.scene.step(STEP_S)
        self._work()
        self._happened.said += self._speech.step(self.time)
        self._happened.deeds += self._people.step(self.time)

    # Goals

    def refuses_navigation(self) -> bool:
        """Whether a fault makes the next navigation goal be rejected."""
        return self.mishaps.take("reject", "navigate") is not None

    def navigate(self, goal: Pose) -> Navigation:
        """Begins an accepted navigation goal; the one before it is aborted."""
        if self.navigation is not None:
            self.navigation.abort("a newer goal came")
        if self.mishaps.take("lie", "navigate"):
            return Navigation(goal, state="succeeded")
        navigation = begin(self.floor, self.body.pose, goal)
        if self.mishaps.take("fail", "navigate"):
            navigation.abort("a fault was asked for")
        navigation.endless = self.mishaps.take("never", "navigate") is not None
        if navigation.state == "active":
            self.navigation = navigation
        return navigation

    def cancel_navigation(self, navigation: Navigation) -> None:
        """Ends a navigation goal at the client's wish; the base stops."""
        if navigation.state == "active":
            navigation.state = "canceled"
            self.body.drive(0.0, 0.0)
            self.navigation = None

    def perform(self, request: Request, done: Callable[[Reply], None], of: str = "skill") -> None:
        """Begins a skill, or refuses it; `done` gets the reply, now or later.

        Args:
            request: what to do.
            done: is given the reply.
            of: the kind of goal that faults know it by: `skill` or `trigger`.
        """
        if self.mishaps.take("never", of):
            return
        lies = self.mishaps.take("lie", of) is not None
        reason = "" if lies else self._refusal(request, of)
        if reason:
            done(Reply(request.id, False, reason))
        else:
            self._task = _Task(request, self.time + skills.SKILL_S, done, lies)

    def say(self, saying: Saying) -> None:
        """Begins to say something."""
        self._speech.say(saying, self.time)

    def strike(self, fault: Fault) -> None:
        """Makes something go wrong.

        Raises:
            UsageError: it names something that isn't there.
        """
        self.struck += 1
        if fault.kind in GOAL_FAULTS:
            self.mishaps.add(fault)
        elif not self.mishaps.strike(fault, self._now or 0.0):
            self._strike(fault)

    # What takes its time

    def _refusal(self, request: Request, of: str) -> str:
        if self.mishaps.take("reject", of):
            return "a fault was asked for"
        return self._unable() or (
            "another skill is under way" if self._task else skills.problem(request, self.scene)
        )

    def _unable(self) -> str:
        if self.driver.runstopped:
            return "the run-stop is pressed"
        if not self.driver.homed or self.driver.busy:
            return "the robot isn't homed, or is busy with itself"
        return ""

    def _work(self) -> None:
        task = self._task
        if task is None:
            return
        reason = self._unable()
        if not reason and self.time < task.until:
            return
        self._task = None
        if not reason and not task.lies:
            of = "trigger" if task.request.id == "demo" else "skill"
            slipped = self.mishaps.take("fail", of) is not None
            # What was possible when it began may not be possible any more.
            reason = "it slipped" if slipped else skills.problem(task.request, self.scene)
            if not reason:
                skills.effect(task.request, self.scene)
        task.done(Reply(task.request.id, not reason, reason))

    def _strike(self, fault: Fault) -> None:
        match fault.kind:
            case "event":
                self.scene.make_true(fault.literals)
            case "move":
                self.scene.move(fault.object, fault.to)
            case "add":
                self.scene.add(fault.object, fault.to)
            case "remove":
                self.scene.remove(fault.object)
            case "unhomed" | "homed":
                self.driver.homed = fault.kind == "homed"
            case "battery":
                self.driver.voltage = fault.value
            case "runstop":
                self.driver.runstop(bool(fault.value))
