"""A client of the simulated driver, as a robot's user would write one; every wait has a deadline."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Sequence
from typing import Any

import rclpy
from builtin_interfaces.msg import Duration
from control_msgs.action import FollowJointTrajectory
from geometry_msgs.msg import Twist
from nav2_msgs.action import NavigateToPose
from nav_msgs.msg import Odometry
from rclpy.action import ActionClient
from rclpy.executors import SingleThreadedExecutor
from rclpy.qos import QoSProfile
from sensor_msgs.msg import BatteryState, JointState
from std_msgs.msg import Bool, Float64MultiArray, String
from std_srvs.srv import SetBool, Trigger
from tf2_msgs.msg import TFMessage
from trajectory_msgs.msg import JointTrajectoryPoint
from visualization_msgs.msg import MarkerArray

from polaris_nl.execution.ros.layout import Layout, Pose
from polaris_nl.execution.ros.stretch_sim import messages
from polaris_nl.model.world_file import load_world

TOPICS = {
    "/stretch/joint_states": JointState,
    "/odom": Odometry,
    "/battery": BatteryState,
    "/mode": String,
    "/tool": String,
    "/is_homed": Bool,
    "/is_runstopped": Bool,
    "/is_streaming_position": Bool,
    "/aruco/marker_array": MarkerArray,
    "/tf": TFMessage,
    "/polaris/perceived": String,
    "/polaris/heard": String,
    "/polaris/said": String,
    "/polaris/skill_result": String,
    "/polaris/sim/truth": String,
}
SUCCEEDED, CANCELED, ABORTED = 4, 5, 6


class Client:
    """Talks to the simulator of a world."""

    def __init__(self, world: str) -> None:
        rclpy.init()
        self.node = rclpy.create_node("tester")
        self._executor = SingleThreadedExecutor()
        self._executor.add_node(self.node)
        self.last: dict[str, Any] = {}
        self.all: dict[str, list[Any]] = {name: [] for name in TOPICS}
        for name, kind in TOPICS.items():
            self.node.create_subscription(kind, name, self._keep(name), QoSProfile(depth=20))
        self._velocity = self.node.create_publisher(Twist, "/stretch/cmd_vel", 1)
        self._pose = self.node.create_publisher(Float64MultiArray, "/joint_pose_cmd", 1)
        self._texts = {
            name: self.node.create_publisher(String, name, 20)
            for name in ("/polaris/skill", "/polaris/say", "/polaris/sim/fault")
        }
        self._arm = ActionClient(
            self.node, FollowJointTrajectory, "/stretch_controller/follow_joint_trajectory"
        )
        self._nav = ActionClient(self.node, NavigateToPose, "/navigate_to_pose")
        self._services: dict[str, Any] = {}
        self._skills = 0
        self.layout = Layout.of(load_world(world))
        senders = (self._velocity, self._pose, *self._texts.values())
        self.until(
            lambda: (
                "/polaris/sim/truth" in self.last
                and "/stretch/joint_states" in self.last
                and self._arm.server_is_ready()
                and self._nav.server_is_ready()
                and all(sender.get_subscription_count() for sender in senders)
            ),
            "the driver",
        )

    def close(self) -> None:
        self._executor.shutdown()
        self.node.destroy_node()
        rclpy.shutdown()

    def _keep(self, name: str) -> Callable[[Any], None]:
        def keep(message: Any) -> None:
            self.last[name] = message
            self.all[name].append(message)

        return keep

    # Waiting

    def until(self, ready: Callable[[], Any], what: str, seconds: float = 20.0) -> Any:
        """Spins until something is so, and returns it."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            found = ready()
            if found:
                return found
            self._executor.spin_once(timeout_sec=0.05)
        raise AssertionError(f"not within {seconds:g} s: {what}")

    def during(self, seconds: float) -> None:
        """Spins for a while, to see that nothing happens."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            self._executor.spin_once(timeout_sec=0.02)

    def fresh(self, topic: str) -> Any:
        """The next message."""
        self.last.pop(topic, None)
        return self.until(lambda: self.last.get(topic), topic)

    # Reading

    def truth(self) -> dict[str, Any]:
        return dict(json.loads(self.fresh("/polaris/sim/truth").data))

    def facts(self) -> set[str]:
        return set(self.truth()["facts"])

    def perceived(self) -> set[str]:
        given = json.loads(self.fresh("/polaris/perceived").data)
        return {fact["literal"] for fact in given["facts"]}

    def seen(self) -> dict[str, tuple[float, float, float]]:
        markers = self.fresh("/aruco/marker_array").markers
        return {m.text: (m.pose.position.x, m.pose.position.y, m.pose.position.z) for m in markers}

    def joint(self, name: str) -> float:
        state = self.fresh("/stretch/joint_states")
        return float(dict(zip(state.name, state.position, strict=True))[name])

    def pose(self) -> Pose:
        at = self.fresh("/odom").pose.pose
        return Pose(at.position.x, at.position.y, messages.yaw_of(at.orientation))

    def velocity(self) -> tuple[float, float]:
        twist = self.fresh("/odom").twist.twist
        return twist.linear.x, twist.angular.z

    def mode(self) -> str:
        return str(self.fresh("/mode").data)

    # Commanding

    def call(self, name: str, data: bool | None = None, seconds: float = 20.0) -> tuple[bool, str]:
        """Calls a Trigger, or a SetBool where there is a value."""
        kind = Trigger if data is None else SetBool
        service = self._services.get(name) or self.node.create_client(kind, name)
        self._services[name] = service
        self.until(service.service_is_ready, name)
        request = kind.Request() if data is None else kind.Request(data=data)
        future = service.call_async(request)
        self.until(future.done, name, seconds)
        return future.result().success, future.result().message

    def drive(self, linear: float, angular: float = 0.0) -> None:
        twist = Twist()
        twist.linear.x, twist.angular.z = linear, angular
        self._velocity.publish(twist)

    def stream(self, values: Sequence[float]) -> None:
        self._pose.publish(Float64MultiArray(data=list(values)))

    def fault(self, kind: str, **given: Any) -> None:
        """Lets something go wrong, and waits until it is so."""
        before = self.truth()["faults"]
        self._texts["/polaris/sim/fault"].publish(messages.text({"fault": kind, **given}))
        self.until(lambda: self.truth()["faults"] > before, f"the fault {kind}")

    def say(self, person: str, message: str, text: str) -> None:
        given = {"person": person, "message": message, "text": text}
        self._texts["/polaris/say"].publish(messages.text(given))

    def skill(self, skill: str, thing: str = "", at: str = "") -> tuple[bool, str]:
        """Asks for a skill and waits for the reply."""
        self._skills += 1
        name = f"s{self._skills}"
        given = {"id": name, "skill": skill, "object": thing, "at": at}
        self._texts["/polaris/skill"].publish(messages.text(given))

        def reply() -> Any:
            told = (json.loads(m.data) for m in self.all["/polaris/skill_result"])
            return next((t for t in told if t["id"] == name), None)

        answer = self.until(reply, f"the reply to {skill} {thing}")
        return answer["ok"], answer["reason"]

    def send(self, client: ActionClient, goal: Any) -> Any:
        """Sends a goal; the handle, or None where it is rejected."""
        future = client.send_goal_async(goal)
        self.until(future.done, "the answer to a goal")
        handle = future.result()
        return handle if handle.accepted else None

    def outcome(self, handle: Any, seconds: float = 40.0) -> tuple[int, Any]:
        """The status and result of a goal."""
        future = handle.get_result_async()
        self.until(future.done, "the result of a goal", seconds)
        return future.result().status, future.result().result

    def trajectory(self, *points: dict[str, float], times: Sequence[float] = ()) -> Any:
        goal = FollowJointTrajectory.Goal()
        goal.trajectory.joint_names = list(points[0]) if points else []
        for number, point in enumerate(points):
            one = JointTrajectoryPoint(positions=[float(v) for v in point.values()])
            if times:
                one.time_from_start = Duration(
                    sec=int(times[number]), nanosec=int(times[number] % 1 * 1e9)
                )
            goal.trajectory.points.append(one)
        return self.send(self._arm, goal)

    def go(self, pose: Pose) -> Any:
        goal = NavigateToPose.Goal()
        goal.pose = messages.pose_stamped(pose, time.time())
        return self.send(self._nav, goal)

    # Longer stories

    def beside(self, place: str) -> Pose:
        """Where a robot stands to reach a surface or container."""
        at = self.layout.places[place]
        found = self.layout.beside(at.x, at.y, self.layout.regions[place], 0.75)
        assert found is not None
        return found

    def drive_to(self, pose: Pose) -> None:
        assert self.call("/switch_to_navigation_mode")[0]
        status, _ = self.outcome(self.go(pose))
        assert status == SUCCEEDED

    def reach(self, extension: float = 0.35, lift: float = 0.85) -> None:
        assert self.call("/switch_to_position_mode")[0]
        self.during(0.2)  # The driver rejects what comes sooner after the last one.
        handle = self.trajectory({"joint_lift": lift, "wrist_extension": extension})
        assert self.outcome(handle)[0] == SUCCEEDED

    def at(self, place: str) -> None:
        """Drives beside a place and reaches out to it."""
        self.drive_to(self.beside(place))
        self.reach()

    def retract(self) -> None:
        self.reach(0.0, 0.6)
