"""The watchdog: from what the robot says of itself to its health, and whether it moves. Pure."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from polaris_nl.execution.backend import READY, Health
from polaris_nl.execution.ros.profile import Safety

CLOCK_JUMP_S = 1.0
"""A robot whose time stamps move by more than this against our clock has a clock that jumped."""
TWO_SPEAK = (
    "two programs answer for the robot at once; end one of them (one that was killed counts for up to "
    "20 seconds more)"
)
BUSY_MODES = ("homing", "stowing", "calibration")
STOPPED_MODE = "runstopped"


@dataclass(frozen=True, slots=True)
class Vitals:
    """The latest of what a robot says of itself. Times are those of the run's clock, in seconds.

    Attributes:
        heartbeat: when joint states last came; None before the first.
        moved: the base's speeds (m/s, rad/s) and when odometry told them.
        homed, runstopped, mode, voltage: as last told; None or "" before that.
        drift: by how much the robot's time stamps moved against our clock since the start, in seconds.
        speakers: how many servers answer on each name that only one should answer on.
    """

    heartbeat: float | None = None
    moved: tuple[float, float, float] | None = None
    homed: bool | None = None
    runstopped: bool | None = None
    mode: str = ""
    voltage: float | None = None
    drift: float = 0.0
    speakers: Mapping[str, int] = field(default_factory=dict)

    @property
    def told(self) -> bool:
        """Whether the robot has said by now what would keep it from moving."""
        return self.homed is not None and self.runstopped is not None and self.mode != ""


def health_of(vitals: Vitals, now: float, limits: Safety) -> Health:
    """How a robot is. The gravest problem comes first; a silent robot's old words count for nothing."""
    if vitals.heartbeat is None or now - vitals.heartbeat > limits.heartbeat_s:
        return Health("silent")
    if vitals.runstopped or vitals.mode == STOPPED_MODE:
        return Health("runstopped")
    if vitals.homed is False:
        return Health("unhomed")
    if abs(vitals.drift) > CLOCK_JUMP_S:
        return Health("clock")
    if any(count > 1 for count in vitals.speakers.values()):
        return Health("duplicate", TWO_SPEAK)
    if vitals.voltage is not None and vitals.voltage < limits.battery_v:
        return Health("battery")
    if vitals.mode in BUSY_MODES:
        text = f"the robot is in {vitals.mode} mode and takes no commands; wait until it is done"
        return Health("mode", text)
    return READY


def moving(vitals: Vitals, now: float, limits: Safety) -> bool | None:
    """Whether the base moves, by odometry; None where odometry is silent."""
    if vitals.moved is None or now - vitals.moved[2] > limits.heartbeat_s:
        return None
    linear, angular, _ = vitals.moved
    return abs(linear) > limits.moving_m_s or abs(angular) > limits.moving_rad_s
