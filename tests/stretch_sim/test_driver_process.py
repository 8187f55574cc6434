"""Each row of the driver's interface, over real ROS 2 between two processes."""

from __future__ import annotations

import json
import math

from polaris_nl.execution.ros.layout import Pose, wrapped
from polaris_nl.execution.ros.stretch_sim.joints import JOINTS
from tests.stretch_sim.client import ABORTED, CANCELED, SUCCEEDED, TOPICS, Client
from tests.stretch_sim.conftest import Start

ONCE = ("/polaris/heard", "/polaris/said", "/polaris/skill_result")


def test_topics_are_published_at_their_rates(sim: Client) -> None:
    for topic in TOPICS:
        if topic not in ONCE:
            sim.fresh(topic)
    for topic in TOPICS:
        sim.all[topic].clear()
    before = json.loads(sim.last["/polaris/sim/truth"].data)["stamp"]
    sim.until(lambda: len(sim.all["/stretch/joint_states"]) > 60, "joint states")
    stamps = [m.header.stamp for m in sim.all["/stretch/joint_states"]]
    first, last = (s.sec + s.nanosec / 1e9 for s in (stamps[0], stamps[-1]))
    assert 20 < (len(stamps) - 1) / (last - first) < 35
    assert first > before - 1
    assert set(JOINTS) <= set(sim.last["/stretch/joint_states"].name)
    assert {"joint_arm_l0", "joint_gripper_finger_left"} <= set(
        sim.last["/stretch/joint_states"].name
    )
    assert sim.last["/mode"].data == "position"
    assert sim.last["/tool"].data == "eoa_wrist_dw3_tool_sg3"
    assert sim.last["/is_homed"].data
    assert not sim.last["/is_runstopped"].data
    assert 12 < sim.last["/battery"].voltage < 14
    base = [t for t in sim.last["/tf"].transforms if t.child_frame_id == "base_link"]
    assert base[0].header.frame_id == "map"
    assert base[0].transform.translation.x == sim.pose().x


def test_the_arm_moves_in_position_mode_and_not_in_navigation_mode(sim: Client) -> None:
    handle = sim.trajectory({"joint_lift": 0.8, "wrist_extension": 0.3})
    # One that comes at once is too soon, and the first goes on.
    assert sim.trajectory({"joint_lift": 0.2}) is None
    status, result = sim.outcome(handle)
    assert (status, result.error_code) == (SUCCEEDED, 0)
    assert math.isclose(sim.joint("joint_lift"), 0.8, abs_tol=0.02)
    assert math.isclose(sim.joint("wrist_extension"), 0.3, abs_tol=0.02)
    for wrong, word in (
        ({"joint_lift": 1.6}, "joint_lift"),
        ({"joint_elbow": 0.1}, "joint_elbow"),
        ({"translate_mobile_base": 0.1, "rotate_mobile_base": 0.1}, "at once"),
    ):
        sim.during(0.25)
        status, result = sim.outcome(sim.trajectory(wrong))
        assert status == ABORTED
        assert result.error_code < 0
        assert word in result.error_string
    assert sim.call("/switch_to_navigation_mode") == (True, "Now in navigation mode.")
    assert sim.mode() == "navigation"
    sim.during(0.25)
    assert sim.trajectory({"joint_lift": 0.4}) is None
    assert math.isclose(sim.joint("joint_lift"), 0.8, abs_tol=0.02)


def test_the_base_moves_by_trajectories_too_and_timed_ones_keep_their_times(sim: Client) -> None:
    before = sim.pose()
    status, _ = sim.outcome(sim.trajectory({"translate_mobile_base": 0.2}))
    assert status == SUCCEEDED
    assert math.isclose(before.distance(sim.pose().x, sim.pose().y), 0.2, abs_tol=0.04)
    sim.during(0.25)
    status, _ = sim.outcome(sim.trajectory({"rotate_mobile_base": 1.0}))
    assert status == SUCCEEDED
    assert math.isclose(wrapped(sim.pose().yaw - before.yaw), 1.0, abs_tol=0.08)
    assert sim.call("/switch_to_trajectory_mode")[0]
    sim.during(0.25)
    lift = sim.joint("joint_lift")
    began = sim.truth()["time"]
    handle = sim.trajectory({"joint_lift": lift}, {"joint_lift": lift + 0.1}, times=(2.0, 8.0))
    status, _ = sim.outcome(handle)
    assert status == SUCCEEDED
    assert sim.truth()["time"] - began >= 8.0
    assert math.isclose(sim.joint("joint_lift"), lift + 0.1, abs_tol=0.02)


def test_velocities_count_in_navigation_mode_until_half_a_second_of_silence(start: Start) -> None:
    _, sim = start("--kinematic", "--people", "none")
    at = sim.pose()
    sim.drive(0.2)
    sim.during(0.3)
    assert sim.pose() == at
    assert sim.call("/switch_to_navigation_mode")[0]
    sim.drive(0.2)
    sim.until(lambda: sim.velocity()[0] > 0.15, "the base moves")
    sim.all["/odom"].clear()
    sim.until(lambda: sim.velocity() == (0.0, 0.0), "the base stops by itself", 2.0)
    moving = [m for m in sim.all["/odom"] if m.twist.twist.linear.x > 0.0]
    stamps = [m.header.stamp.sec + m.header.stamp.nanosec / 1e9 for m in moving]
    # Half a second, and as much as braking takes.
    assert stamps[-1] - stamps[0] < 1.2
    at = sim.pose()
    sim.during(0.2)
    assert sim.pose() == at


def stands_at(pose: Pose, other: Pose) -> bool:
    """Whether two poses are the same but for the last digits, which turning frames into others rounds."""
    return pose.distance(other.x, other.y) < 1e-9 and abs(wrapped(pose.yaw - other.yaw)) < 1e-9


def test_navigation_arrives_is_cancelled_and_gives_way_to_newer_goals(sim: Client) -> None:
    assert sim.call("/switch_to_navigation_mode")[0]
    goal = sim.beside("worktop")
    status, _ = sim.outcome(sim.go(goal))
    at = sim.pose()
    assert status == SUCCEEDED
    assert at.distance(goal.x, goal.y) < 0.25
    assert abs(wrapped(at.yaw - goal.yaw)) < 0.25
    assert sim.truth()["region"] == "kitchen"
    handle = sim.go(sim.beside("desk"))
    sim.until(lambda: sim.velocity()[0] > 0.1, "the base moves")
    cancel = handle.cancel_goal_async()
    assert sim.outcome(handle)[0] == CANCELED
    assert cancel.result() is None or cancel.result().goals_canceling
    sim.until(lambda: sim.velocity() == (0.0, 0.0), "the base stops")
    at = sim.pose()
    sim.during(0.3)
    assert stands_at(sim.pose(), at)
    first = sim.go(sim.beside("desk"))
    second = sim.go(sim.beside("worktop"))
    assert sim.outcome(first)[0] == ABORTED
    assert sim.outcome(second)[0] == SUCCEEDED
    # Into a wall there is no way, and out of navigation mode nothing moves.
    assert sim.outcome(sim.go(Pose(-5.0, -5.0)))[0] == ABORTED
    assert sim.call("/switch_to_position_mode")[0]
    at = sim.pose()
    assert sim.outcome(sim.go(sim.beside("desk")))[0] == ABORTED
    assert stands_at(sim.pose(), at)


def test_the_run_stop_ends_all_motion_until_it_is_released(start: Start) -> None:
    _, sim = start("--kinematic", "--people", "none")
    handle = sim.trajectory({"joint_lift": 1.0})
    sim.until(lambda: sim.joint("joint_lift") > 0.62, "the lift moves")
    assert sim.call("/runstop", True) == (True, "is_runstopped: True")
    lift = sim.joint("joint_lift")
    assert sim.mode() == "runstopped"
    assert sim.fresh("/is_runstopped").data
    assert sim.outcome(handle)[0] == ABORTED
    assert not sim.call("/switch_to_navigation_mode")[0]
    assert sim.trajectory({"joint_lift": 0.2}) is None
    sim.drive(0.2)
    sim.during(0.3)
    assert sim.velocity() == (0.0, 0.0)
    assert sim.joint("joint_lift") == lift
    assert sim.call("/runstop", False) == (True, "is_runstopped: False")
    assert sim.mode() == "position"
    assert sim.call("/switch_to_navigation_mode")[0]
    handle = sim.go(sim.beside("worktop"))
    sim.until(lambda: max(map(abs, sim.velocity())) > 0.1, "the base moves")
    sim.call("/runstop", True)
    assert sim.velocity() == (0.0, 0.0)


def test_stopping_ends_motion_but_not_goals(start: Start) -> None:
    _, sim = start("--kinematic", "--people", "none", "--speed", "2")
    handle = sim.trajectory({"joint_lift": 1.0})
    sim.until(lambda: sim.joint("joint_lift") > 0.61, "the lift moves")
    assert sim.call("/stop_the_robot")[0]
    lift = sim.joint("joint_lift")
    sim.during(0.2)
    assert sim.joint("joint_lift") == lift
    # The goal stays active until its point's time is over.
    status, result = sim.outcome(handle)
    assert status == ABORTED
    assert "10 seconds" in result.error_string
    assert sim.joint("joint_lift") == lift


def test_homing_and_stowing(sim: Client) -> None:
    sim.fault("unhomed")
    assert not sim.fresh("/is_homed").data
    assert sim.trajectory({"joint_lift": 0.9}) is None
    # As the real driver: it says yes to stowing and doesn't do it.
    lift = sim.joint("joint_lift")
    assert sim.call("/stow_the_robot")[0]
    assert sim.joint("joint_lift") == lift
    assert sim.call("/home_the_robot") == (True, "Homed.")
    assert {"homing"} <= {m.data for m in sim.all["/mode"]}
    assert sim.fresh("/is_homed").data
    assert sim.mode() == "position"
    assert sim.call("/switch_to_navigation_mode")[0]
    assert sim.call("/stow_the_robot") == (True, "Stowed.")
    assert {"stowing"} <= {m.data for m in sim.all["/mode"]}
    assert sim.mode() == "navigation"
    assert math.isclose(sim.joint("joint_lift"), 0.3, abs_tol=0.02)


def test_streamed_positions_count_once_streaming_is_on(sim: Client) -> None:
    values = [0.2, 0.9, 1.0, -0.3, 0.0, 0.4, -0.2, 0.1, 0.0, 0.0]
    sim.stream(values)
    sim.during(0.3)
    assert math.isclose(sim.joint("joint_lift"), 0.6, abs_tol=0.01)
    assert sim.call("/activate_streaming_position")[0]
    sim.until(lambda: sim.fresh("/is_streaming_position").data, "streaming is on")
    sim.stream(values)
    for name, value in zip(JOINTS, values, strict=False):
        sim.until(lambda n=name, v=value: abs(sim.joint(n) - v) < 0.01, name)
    before = sim.pose()
    sim.stream([*values[:8], 0.15, 0.0])
    sim.until(lambda: before.distance(sim.pose().x, sim.pose().y) > 0.12, "the base moves")
    assert sim.call("/deactivate_streaming_position")[0]
    assert sim.call("/self_collision_avoidance", False)[0]
