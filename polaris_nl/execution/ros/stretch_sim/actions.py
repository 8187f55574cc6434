"""The two actions: follow_joint_trajectory and navigate_to_pose."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from builtin_interfaces.msg import Duration
from control_msgs.action import FollowJointTrajectory
from nav2_msgs.action import NavigateToPose
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.node import Node
from rclpy.task import Future

from polaris_nl.execution.ros.layout import Pose
from polaris_nl.execution.ros.stretch_sim import messages
from polaris_nl.execution.ros.stretch_sim.navigation import Navigation
from polaris_nl.execution.ros.stretch_sim.simulator import Simulator
from polaris_nl.execution.ros.stretch_sim.trajectory import Trajectory, Waypoint

FEEDBACK_S = 0.2


@dataclass(slots=True)
class _Wait:
    ready: Callable[[], bool]
    future: Future


@dataclass(slots=True)
class _Goal:
    """A goal under way; a cancel may be heeded late, or not at all."""

    handle: Any
    task: Navigation | Trajectory
    of: str
    heeds_at: float | None = None


class Actions:
    """The action servers.

    Args:
        node: whose they are.
        simulator: what carries goals out.
    """

    def __init__(self, node: Node, simulator: Simulator) -> None:
        self._node = node
        self._simulator = simulator
        self._waits: list[_Wait] = []
        self._goals: list[_Goal] = []
        self._feedback_at = 0.0
        self._servers = (
            ActionServer(
                node,
                FollowJointTrajectory,
                "/stretch_controller/follow_joint_trajectory",
                self._follow,
                goal_callback=self._admit_trajectory,
                cancel_callback=lambda handle: CancelResponse.ACCEPT,
            ),
            ActionServer(
                node,
                NavigateToPose,
                "/navigate_to_pose",
                self._navigate,
                goal_callback=self._admit_navigation,
                cancel_callback=lambda handle: CancelResponse.ACCEPT,
            ),
        )

    async def until(self, ready: Callable[[], bool]) -> None:
        """Waits in a callback until something is so."""
        future = Future()
        self._waits.append(_Wait(ready, future))
        await future

    def step(self, now: float) -> None:
        """Heeds cancels, sends feedback and wakes what waits."""
        for goal in self._goals:
            self._heed(goal, now)
        if now - self._feedback_at >= FEEDBACK_S:
            self._feedback_at = now
            for goal in self._goals:
                self._feed(goal, now)
        for wait in [w for w in self._waits if w.ready()]:
            self._waits.remove(wait)
            wait.future.set_result(None)

    # Admission

    def _admit_navigation(self, request: Any) -> GoalResponse:
        rejected = self._simulator.refuses_navigation()
        return GoalResponse.REJECT if rejected else GoalResponse.ACCEPT

    def _admit_trajectory(self, request: Any) -> GoalResponse:
        reason = self._simulator.driver.refuses(self._node.get_clock().now().nanoseconds / 1e9)
        if reason:
            self._node.get_logger().warning(f"a trajectory is rejected: {reason}")
        return GoalResponse.REJECT if reason else GoalResponse.ACCEPT

    # Execution

    async def _navigate(self, handle: Any) -> Any:
        given = handle.request.pose.pose
        goal = Pose(given.position.x, given.position.y, messages.yaw_of(given.orientation))
        task = self._simulator.navigate(goal)
        await self._end(_Goal(handle, task, "navigate"))
        return NavigateToPose.Result()

    async def _follow(self, handle: Any) -> Any:
        given = handle.request.trajectory
        points = [
            Waypoint(tuple(p.positions), p.time_from_start.sec + p.time_from_start.nanosec / 1e9)
            for p in given.points
        ]
        task = self._simulator.driver.follow(list(given.joint_names), points)
        await self._end(_Goal(handle, task, "trajectory"))
        result = FollowJointTrajectory.Result()
        if task.state == "aborted":
            codes = FollowJointTrajectory.Result
            result.error_code = (
                codes.INVALID_GOAL if task.invalid else codes.GOAL_TOLERANCE_VIOLATED
            )
            result.error_string = task.reason
        return result

    async def _end(self, goal: _Goal) -> None:
        self._goals.append(goal)
        await self.until(lambda: goal.task.state != "active")
        self._goals.remove(goal)
        if goal.task.reason:
            self._node.get_logger().warning(f"{goal.of}: {goal.task.reason}")
        if goal.task.state == "succeeded":
            goal.handle.succeed()
        elif goal.task.state == "canceled":
            goal.handle.canceled()
        else:
            goal.handle.abort()

    # While it goes on

    def _heed(self, goal: _Goal, now: float) -> None:
        if not goal.handle.is_cancel_requested or goal.task.state != "active":
            return
        if goal.heeds_at is None:
            mishaps = self._simulator.mishaps
            slow = mishaps.take("slow-cancel", goal.of)
            goal.heeds_at = now + slow.seconds if slow else now
            if mishaps.take("ignore-cancel", goal.of):
                goal.heeds_at = math.inf
        if now < goal.heeds_at:
            return
        if isinstance(goal.task, Navigation):
            self._simulator.cancel_navigation(goal.task)
        else:
            goal.task.cancel(self._simulator.body)

    def _feed(self, goal: _Goal, now: float) -> None:
        pose, stamp = self._simulator.body.pose, self._simulator.stamp(now)
        if isinstance(goal.task, Navigation):
            feedback = NavigateToPose.Feedback()
            feedback.current_pose = messages.pose_stamped(pose, stamp)
            feedback.distance_remaining = float(goal.task.remaining(pose))
            feedback.navigation_time = _duration(goal.task.elapsed)
        else:
            feedback = FollowJointTrajectory.Feedback()
            feedback.header.stamp = messages.time_of(stamp)
            feedback.joint_names = list(self._simulator.body.joints)
            feedback.actual.positions = [float(p) for p in self._simulator.body.joints.values()]
        goal.handle.publish_feedback(feedback)


def _duration(seconds: float) -> Duration:
    return Duration(sec=int(seconds), nanosec=int(seconds % 1 * 1e9))
