"""The driver's core: modes, services, streams of commands and trajectories, as stretch_driver has them.

Pure: it is given times and a body. Motions take place in the body's time, the silence after which a velocity
is withdrawn in the clock's, since whoever publishes velocities goes by that.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from polaris_nl.execution.ros.stretch_sim.body import Body
from polaris_nl.execution.ros.stretch_sim.faults import Mishaps
from polaris_nl.execution.ros.stretch_sim.joints import HOME, JOINTS, STOWED
from polaris_nl.execution.ros.stretch_sim.trajectory import BaseMove, Trajectory, Waypoint, checked

Mode = str
POSITION, NAVIGATION, TRAJECTORY = "position", "navigation", "trajectory"
HOMING, STOWING, RUNSTOPPED = "homing", "stowing", "runstopped"

SILENCE_S = 0.5
"""A velocity that isn't repeated for so long is withdrawn."""
GOAL_GAP_S = 0.2
"""A trajectory that comes so soon after the last one is rejected."""
HOMING_S = 8.0
STOW_TIMEOUT_S = 12.0
FULL_V = 13.2
EMPTY_V = 10.5


@dataclass(frozen=True, slots=True)
class Answer:
    """What a service answers."""

    success: bool
    message: str


class Driver:
    """The driver of one robot.

    Args:
        body: what it moves.
        mishaps: what goes wrong.
        now: the clock's time, in seconds.
        homed: whether the robot knows where its joints are.
    """

    def __init__(self, body: Body, mishaps: Mishaps, now: float, homed: bool = True) -> None:
        self.body = body
        self.mode: Mode = POSITION
        self.homed = homed
        self.streaming = False
        self.collision_avoidance = True
        self.voltage = FULL_V
        self.trajectory: Trajectory | None = None
        self._mishaps = mishaps
        self._now = now
        self._before: Mode = POSITION
        self._velocity_at = -SILENCE_S
        self._goal_at = now - GOAL_GAP_S
        self._busy_s = 0.0
        self._base: BaseMove | None = None

    @property
    def runstopped(self) -> bool:
        """Whether the run-stop is pressed."""
        return self.mode == RUNSTOPPED

    @property
    def busy(self) -> bool:
        """Whether the robot homes or stows itself."""
        return self.mode in (HOMING, STOWING)

    # Services

    def switch(self, mode: Mode) -> Answer:
        """Changes the mode."""
        if self.runstopped or self.busy:
            return Answer(False, f"Cannot switch to {mode} mode while {self.mode}.")
        if mode != self.mode:
            self.body.drive(0.0, 0.0)
        self.mode = mode
        return Answer(True, f"Now in {mode} mode.")

    def home(self) -> Answer:
        """Starts homing; `busy` until it is done."""
        if self.runstopped or self.busy:
            return Answer(False, f"Cannot home while {self.mode}.")
        self._begin(HOMING, HOME)
        return Answer(True, "Homed.")

    def stow(self) -> Answer:
        """Starts stowing. Like the real driver, it says that it succeeded even where it refused."""
        if self.runstopped or self.busy or not self.homed:
            return Answer(True, "Stow was not done.")
        self._begin(STOWING, STOWED)
        return Answer(True, "Stowed.")

    def stop(self) -> Answer:
        """Stops all motion now. Goals stay active, as the real driver's do."""
        self.body.hold()
        self._velocity_at = self._now - SILENCE_S
        self._base = None
        if self.trajectory is not None:
            self.trajectory.held = True
        return Answer(True, "Stopped the robot.")

    def runstop(self, pressed: bool) -> Answer:
        """Presses or releases the run-stop."""
        if pressed and not self.runstopped:
            self._before = POSITION if self.busy else self.mode
            self.mode = RUNSTOPPED
            self.body.hold()
            self._base = None
            if self.trajectory is not None:
                self.trajectory.abort("the run-stop is pressed")
        elif not pressed and self.runstopped:
            self.mode = self._before
        return Answer(True, f"is_runstopped: {self.runstopped}")

    def stream(self, active: bool) -> Answer:
        """Turns streaming of positions on or off."""
        self.streaming = active
        return Answer(True, f"Streaming position is {'on' if active else 'off'}.")

    def avoid_collisions(self, active: bool) -> Answer:
        """Turns avoidance of self-collision on or off; the simulated arm can't collide with itself anyway."""
        self.collision_avoidance = active
        return Answer(True, f"is_self_collision_avoidance_active: {active}")

    # Streams

    def velocity(self, linear: float, angular: float) -> bool:
        """A velocity for the base; False where it isn't heeded."""
        if self.mode != NAVIGATION or not self.homed:
            return False
        self._velocity_at = self._now
        self.body.drive(linear, angular)
        return True

    def pose(self, values: Sequence[float]) -> bool:
        """Ten positions: the joints', and how far the base is to move or turn; False if they aren't heeded."""
        if not (self.streaming and self.mode == POSITION and self.homed):
            return False
        if len(values) != len(JOINTS) + 2 or (values[-2] and values[-1]):
            return False
        for name, value in zip(JOINTS, values, strict=False):
            self.body.aim(name, value)
        if values[-2] or values[-1]:
            self._base = BaseMove(self.body.pose, values[-2], values[-1])
        return True

    # Trajectories

    def refuses(self, now: float) -> str:
        """Why a trajectory would be rejected now, or ""."""
        if self._mishaps.take("reject", "trajectory"):
            return "a fault was asked for"
        if self.runstopped:
            return "the run-stop is pressed"
        if not self.homed:
            return "the robot isn't homed"
        if self.mode not in (POSITION, TRAJECTORY):
            return f"the robot is in {self.mode} mode"
        if now - self._goal_at < GOAL_GAP_S:
            return "it comes too soon after the last one"
        self._goal_at = now
        return ""

    def follow(self, names: Sequence[str], points: Sequence[Waypoint]) -> Trajectory:
        """Begins an accepted trajectory; the one before it is aborted."""
        if self.trajectory is not None:
            self.trajectory.abort("a newer goal came")
        steps, problem = checked(names, points, timed=self.mode == TRAJECTORY)
        self.trajectory = trajectory = Trajectory(steps, timed=self.mode == TRAJECTORY)
        if problem:
            trajectory.abort(problem, invalid=True)
        elif self._mishaps.take("lie", "trajectory"):
            trajectory.succeed()
        elif self._mishaps.take("fail", "trajectory"):
            trajectory.abort("a fault was asked for")
        elif self._mishaps.take("never", "trajectory"):
            trajectory.endless = True
        return trajectory

    # Time

    def step(self, now: float, seconds: float) -> None:
        """Lets time pass: `seconds` of the body's (which is stepped elsewhere), up to `now` of the clock's."""
        self._now = now
        self.voltage = max(self.voltage - seconds * 1e-5, EMPTY_V - 1)
        if self.mode == NAVIGATION and now - self._velocity_at > SILENCE_S:
            self.body.drive(0.0, 0.0)
        if self.busy:
            self._finish_if_there(seconds)
        if self.trajectory is not None:
            self.trajectory.step(self.body, seconds)
            if self.trajectory.state != "active":
                self.trajectory = None
        if self._base is not None and not self.runstopped:
            self._base = self._base.step(self.body)

    def _begin(self, mode: Mode, targets: Mapping[str, float]) -> None:
        self._before, self.mode = self.mode, mode
        self.body.drive(0.0, 0.0)
        self._busy_s = 0.0
        if mode == HOMING:
            self.homed = False
        for name, target in targets.items():
            self.body.aim(name, target)

    def _finish_if_there(self, seconds: float) -> None:
        self._busy_s += seconds
        targets = HOME if self.mode == HOMING else STOWED
        there = all(abs(self.body.joints[n] - t) < 0.02 for n, t in targets.items())
        least = HOMING_S if self.mode == HOMING else 0.0
        if (there and self._busy_s >= least) or self._busy_s >= least + STOW_TIMEOUT_S:
            self.homed = self.homed or self.mode == HOMING
            # After homing the driver is in position mode, after stowing in the mode before.
            self.mode = POSITION if self.mode == HOMING else self._before
