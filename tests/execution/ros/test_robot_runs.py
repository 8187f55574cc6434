"""A robot and its link: what is refused, what is said, and robots that have less."""

from __future__ import annotations

import importlib.util
import io
import math
import os
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from polaris_nl.automaton.program import Program, write_program
from polaris_nl.cli import main
from polaris_nl.execution.backend import Report, SendGoal
from polaris_nl.execution.clock import RealClock, VirtualClock
from polaris_nl.execution.ros import middleware
from polaris_nl.execution.ros.owner import Late, Owner, until
from polaris_nl.execution.ros.profile import Profile, profile_for
from polaris_nl.execution.ros.recording import Definition, Recorder, definition_of
from polaris_nl.execution.ros.robot import StretchRobot
from polaris_nl.model.domain import Action
from polaris_nl.model.errors import RunError
from polaris_nl.planning.planner import Planner
from polaris_nl.robot_runs import run_on_robot
from polaris_nl.runs import RunOrder
from tests.execution.ros.processes import Onlooker, Process, new_domain
from tests.execution.ros.ros_harness import MOCK
from tests.execution.story import Case, literals

SIM = profile_for("stretch-sim")


@pytest.fixture(autouse=True)
def domain(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROS_DOMAIN_ID", new_domain())
    monkeypatch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")


@pytest.fixture
def onlooker() -> Iterator[Callable[..., Onlooker]]:
    """Starts a mock driver, and looks on at it."""
    open_: list[Process | Onlooker] = []

    def start(*options: str) -> Onlooker:
        driver = Process(MOCK, "care-home", "none", *options)
        open_.append(driver)
        driver.wait_for("ready")
        found = Onlooker(RealClock())
        open_.append(found)
        found.ready()
        return found

    yield start
    for thing in reversed(open_):
        thing.close()


def linked(planner: Planner, onlooker: Onlooker, profile: Profile = SIM) -> StretchRobot:
    robot = StretchRobot(profile, planner.world, planner.segment, planner.mutexes, onlooker.clock)
    onlooker.wait(lambda: robot.observe().health.ready)
    return robot


def ends(robot: StretchRobot, goal: SendGoal, seconds: float = 60.0) -> list[Report]:
    """Sends a goal, and collects its reports until the last one."""
    robot.command(goal)
    found: list[Report] = []
    end = time.monotonic() + seconds
    while not found or found[-1].kind in ("accepted", "replanned"):
        assert time.monotonic() < end, found
        found += robot.reports()
        time.sleep(0.01)
    return found


def goal(number: int, action: Sequence[str], *effects: str) -> SendGoal:
    operator, *names = action
    return SendGoal(number, Action(operator, tuple(names)), literals(*effects))


# Refused, and said


def test_nothing_is_even_linked_without_a_yes(serve: Case, tmp_path: Path) -> None:
    order = RunOrder(serve.automaton, serve.plan, serve.planner, log=tmp_path / "x.mcap")
    with pytest.raises(RunError, match="only after a clear yes"):
        run_on_robot(SIM, order, confirmed=False)
    assert not (tmp_path / "x.mcap").exists()


@pytest.fixture
def program(serve: Case, tmp_path: Path) -> Path:
    path = tmp_path / "serve.polaris.json"
    write_program(Program(serve.automaton, "caregiving", "care-home"), path)
    return path


@pytest.mark.parametrize(
    ("answer", "says"),
    [("no\n", "wasn't a yes"), ("perhaps\n", "wasn't a yes"), ("", "--yes gives it")],
)
def test_the_command_asks_and_takes_nothing_but_a_yes(
    program: Path,
    answer: str,
    says: str,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setattr("sys.stdin", io.StringIO(answer))
    assert main(["run", str(program), "--robot", "stretch-sim"]) == 1
    told = capsys.readouterr()
    assert "The simulated Stretch will move. Yes or no?" in told.err
    assert "tray" in told.err
    assert says in told.err
    assert told.out == ""


def test_an_unknown_robot_is_named(program: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", str(program), "--robot", "strech", "--yes"]) == 1
    assert "no robot called strech. Did you mean stretch" in capsys.readouterr().err


def test_a_robot_that_is_not_there_is_told_with_a_way_out(care: Planner) -> None:
    times = replace(SIM.times, ready=0.5)
    with pytest.raises(RunError, match=r"start it with: polaris-nl stretch-sim --world care-home"):
        StretchRobot(replace(SIM, times=times), care.world, care.segment, care.mutexes, RealClock())


def test_missing_ros_is_told_with_what_brings_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    with pytest.raises(RunError, match=r"missing here. pip install .polaris-nl\[ros\]"):
        middleware.installation({})
    with pytest.raises(RunError, match="humble is set up here, but not for this Python"):
        middleware.installation({"ROS_DISTRO": "humble"})


def test_a_missing_message_package_is_told_with_what_brings_it() -> None:
    with pytest.raises(RunError, match=r"tail_msgs/msg/Wag is missing here\. Install it"):
        middleware.interface("tail_msgs/msg/Wag")
    with pytest.raises(RunError, match=r"Nothing is missing here\. Build it"):
        middleware.interface("control_msgs/action/Nothing")


def test_a_sourced_installation_is_told_from_wheels(tmp_path: Path) -> None:
    place = middleware.installation({}).place
    assert not middleware.installation({"AMENT_PREFIX_PATH": str(tmp_path)}).sourced
    found = middleware.installation({"AMENT_PREFIX_PATH": str(place), "ROS_DISTRO": "jazzy"})
    assert found.sourced
    assert "the installation jazzy" in found.words


def test_what_is_simulated_stays_on_this_machine_unless_told(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.delenv("ROS_AUTOMATIC_DISCOVERY_RANGE")
    monkeypatch.delenv("ROS_LOCALHOST_ONLY", raising=False)
    middleware.stay_on_this_machine()
    assert os.environ["ROS_AUTOMATIC_DISCOVERY_RANGE"] == "LOCALHOST"
    monkeypatch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "SUBNET")
    middleware.stay_on_this_machine()
    assert os.environ["ROS_AUTOMATIC_DISCOVERY_RANGE"] == "SUBNET"


# Robots that have less, and limits


def test_without_actions_it_drives_by_velocity_and_reaches_by_joint_positions(
    care: Planner, onlooker: Callable[..., Onlooker]
) -> None:
    driver = onlooker("--plain")
    robot = linked(care, driver)
    try:
        effects = ("(robot-at hall)", "(not (robot-at home))")
        reports = ends(robot, goal(1, ("move", "home", "hall"), *effects))
        assert [r.kind for r in reports] == ["accepted", "succeeded"]

        def speeds() -> list[list[float]]:
            return [value for _, what, value in driver.asked if what == "velocity"]

        most = SIM.base
        driver.wait(
            lambda: speeds()[-1] == [0.0, 0.0]
        )  # What it was asked last may come after the report.
        assert max(abs(linear) for linear, _ in speeds()) <= most.linear + 1e-9
        assert max(abs(angular) for _, angular in speeds()) <= most.angular + 1e-9
    finally:
        robot.close()


def test_a_position_beyond_the_limits_is_never_sent(
    care: Planner, onlooker: Callable[..., Onlooker]
) -> None:
    driver = onlooker()
    low = {**SIM.joints, "joint_lift": (0.0, 0.3)}
    robot = linked(care, driver, replace(SIM, joints=low))  # Stowing wants more than that.
    try:
        reports = ends(robot, goal(1, ("move", "home", "hall"), "(robot-at hall)"))
        assert [r.kind for r in reports] == ["rejected"]
        assert "beyond the limits of joint_lift" in reports[0].reason
        assert not [what for _, what, _ in driver.asked if what in ("goal", "velocity", "pose")]
    finally:
        robot.close()


def test_a_robot_that_is_not_homed_is_sent_nothing(
    care: Planner, onlooker: Callable[..., Onlooker]
) -> None:
    driver = onlooker()
    driver.fault({"kind": "unhomed"})
    robot = StretchRobot(SIM, care.world, care.segment, care.mutexes, driver.clock)
    try:
        driver.wait(lambda: robot.observe().health.kind == "unhomed")
        reports = ends(robot, goal(1, ("move", "home", "hall"), "(robot-at hall)"))
        assert [r.kind for r in reports] == ["rejected"]
        assert "home it first" in reports[0].reason
        assert not [what for _, what, _ in driver.asked if what == "goal"]
    finally:
        robot.close()


# The owner's thread


def test_a_wait_ends_at_its_deadline_and_a_job_can_be_ended() -> None:
    owner = Owner("owner_test", lambda node: None)
    ended: list[str] = []

    async def endless() -> None:
        try:
            await until(lambda: False, 60.0, "the end")
        finally:
            ended.append("cleaned up")

    async def short() -> None:
        await until(lambda: False, 0.05, "the answer")

    try:
        with pytest.raises(Late, match=r"the answer took more than 0\.05 seconds"):
            owner.do(short(), 5.0)
        job = owner.start(endless())
        with pytest.raises(Late):
            owner.do(short(), 5.0)
        job.cancel()
        with pytest.raises(Late):
            owner.do(short(), 5.0)
        assert ended == ["cleaned up"]
    finally:
        owner.close()
    assert not owner.alive


def test_a_fault_in_the_thread_says_its_last_words_and_is_noticed() -> None:
    last: list[str] = []
    looks = iter(range(5))
    owner = Owner(
        "owner_test", lambda node: None, lambda: next(looks) and None, lambda: last.append("stop")
    )
    end = time.monotonic() + 10.0
    while owner.alive:
        assert time.monotonic() < end
        time.sleep(0.01)
    assert last == ["stop"]
    owner.close()


# The log


def test_messages_are_thinned_out_by_topic_and_ours_are_kept_under_another_name() -> None:
    text = middleware.interface("std_msgs/msg/String")
    kept: list[tuple[str, Definition, float, bytes]] = []
    clock = VirtualClock(100.0)
    recorder = Recorder(lambda *message: kept.append(message), SIM, clock)
    for _ in range(60):
        recorder("/mode", "std_msgs/msg/String", text(data="navigation"))
        recorder("/polaris/said", "std_msgs/msg/String", text(data="{}"))
        clock.sleep(1 / 30)
    recorder.close()
    assert recorder.failure == ""
    topics = [topic for topic, *_ in kept]
    assert topics.count("/mode") == math.ceil(2 / 0.9)
    assert topics.count("/polaris/ros/said") == 60
    assert kept[0][1].name == "std_msgs/msg/String"
    assert b"navigation" in kept[0][3]


def test_definitions_have_all_types_that_are_in_them() -> None:
    found = definition_of("nav_msgs/msg/Odometry")
    for name in ("std_msgs/Header", "builtin_interfaces/Time", "geometry_msgs/Quaternion"):
        assert f"MSG: {name}\n" in found.text


def test_a_log_that_fails_is_told_and_nothing_else_breaks() -> None:
    def broken(*message: Any) -> None:
        raise OSError("no space")

    recorder = Recorder(broken, SIM, VirtualClock(0.0))
    text = middleware.interface("std_msgs/msg/String")
    recorder("/polaris/said", "std_msgs/msg/String", text(data="{}"))
    recorder("/polaris/said", "std_msgs/msg/String", text(data="{}"))
    recorder.close()
    assert "no space" in recorder.failure
