"""The robot's messages, and by which clock they are taken in: real messages, without a network."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import pytest
from builtin_interfaces.msg import Time
from geometry_msgs.msg import TransformStamped
from hypothesis import given
from hypothesis import strategies as st
from sensor_msgs.msg import JointState
from tf2_msgs.msg import TFMessage

from polaris_nl.execution.ros.knowledge import unknown
from polaris_nl.execution.ros.perception import Scene, perceive, remembered
from polaris_nl.execution.ros.profile import profile_for
from polaris_nl.execution.ros.senses import Intake
from polaris_nl.execution.ros.watch import CLOCK_JUMP_S
from polaris_nl.model.formula import parse_literal
from polaris_nl.model.world_file import load_world
from polaris_nl.planning.planner import Planner

APART_S = 1.7e9
"""The robot's clock counts from 1970, a run's from its start."""
TICK_S = 1 / 30
PROFILE = profile_for("stretch-sim")
HALL = parse_literal("(robot-at hall)")
delays = st.lists(st.floats(0.0, 0.9), min_size=1, max_size=40)


@dataclass
class SetClock:
    """Shows the time that it is set to, in seconds."""

    time: float = 0.0

    def now(self) -> float:
        return self.time


@dataclass
class Robot:
    """A robot that stands in the hall and says so, and the intake that hears it."""

    clock: SetClock
    intake: Intake

    def tells(self, at: float, delay: float, ahead: float = 0.0) -> None:
        """Tells its joints and where it stands at a time; it is heard after a delay (s)."""
        self.clock.time = at + delay
        self.intake.take("joint_states", joints(at))
        self.intake.take("tf", standing(at + ahead, *IN_HALL))

    @property
    def age(self) -> float:
        """How old the last word of where it stands is, in seconds."""
        return self.clock.time - self.intake.percepts.base_stamp


IN_HALL = (8.1, 5.1)


def stamp(at: float) -> Time:
    return Time(sec=int(APART_S + at), nanosec=int((APART_S + at) % 1 * 1e9))


def joints(at: float) -> JointState:
    message = JointState(name=["joint_lift"], position=[0.5])
    message.header.stamp = stamp(at)
    return message


def standing(at: float, x: float, y: float) -> TFMessage:
    base = TransformStamped()
    base.header.stamp, base.header.frame_id, base.child_frame_id = stamp(at), "map", "base_link"
    base.transform.translation.x, base.transform.translation.y = x, y
    base.transform.rotation.w = 1.0
    return TFMessage(transforms=[base])


@pytest.fixture
def robot(new_robot: Callable[[], Robot]) -> Robot:
    return new_robot()


@pytest.fixture(scope="module")
def new_robot() -> Callable[[], Robot]:
    world = load_world("care-home")

    def make() -> Robot:
        clock = SetClock()
        return Robot(clock, Intake(PROFILE, world, clock, lambda _: None))

    return make


@pytest.mark.parametrize("late", [0.0, 0.05, 0.4, 0.9])
def test_a_first_message_that_comes_late_makes_nobody_blind(
    robot: Robot, care: Planner, late: float
) -> None:
    scene = Scene.of(care.world, PROFILE.perception, care.mutexes)
    memory = remembered(care.world, 0.0)
    assert HALL not in care.world.initial
    robot.tells(0.0, late)
    for tick in range(1, 200):
        robot.tells(tick * TICK_S, 0.002)
        memory = perceive(memory, robot.intake.percepts, robot.clock.time, scene)
    assert HALL in {b.value for b in memory.beliefs.values()}
    assert HALL not in unknown(memory, robot.intake.percepts, robot.clock.time, scene)
    assert robot.age == pytest.approx(0.0, abs=0.01)


def test_what_is_told_late_is_old(robot: Robot) -> None:
    robot.tells(0.0, 0.002)
    robot.tells(1.0, 0.502)
    assert robot.age == pytest.approx(0.5, abs=1e-3)


def test_what_comes_a_little_faster_than_joints_is_of_now_and_not_of_the_future(
    robot: Robot,
) -> None:
    robot.tells(0.0, 0.05)
    robot.tells(1.0, 0.05, ahead=0.04)
    assert robot.age == 0.0
    robot.tells(2.0, 0.05, ahead=30.0)
    assert robot.age == pytest.approx(-30.0, abs=0.1)


@pytest.mark.parametrize("jump", [-60.0, -1.5, 1.5, 60.0])
def test_a_clock_that_jumps_is_not_followed(robot: Robot, jump: float) -> None:
    for tick in range(60):
        robot.tells(tick * TICK_S, 0.002)
    assert abs(robot.intake.vitals.drift) < 0.01
    for tick in range(60, 120):
        robot.clock.time = tick * TICK_S
        robot.intake.take("joint_states", joints(tick * TICK_S + jump))
        assert robot.intake.vitals.drift == pytest.approx(jump, abs=0.01)


@given(late=delays)
def test_whatever_messages_take_nothing_is_seen_in_the_future_and_no_clock_has_jumped(
    late: list[float], new_robot: Callable[[], Robot]
) -> None:
    robot = new_robot()
    for second, delay in enumerate(late):
        robot.tells(float(second), delay)
        assert robot.age >= 0.0
        assert abs(robot.intake.vitals.drift) <= CLOCK_JUMP_S
    # It looks no older than it is, and by the fastest message so far just as old.
    assert robot.age == pytest.approx(late[-1] - min(late), abs=1e-3)
