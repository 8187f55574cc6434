"""The robot's topics, services and actions. Everything here runs in the owner's thread."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from typing import Any

from polaris_nl.execution.ros.middleware import has_interface, interface
from polaris_nl.execution.ros.owner import until, within
from polaris_nl.execution.ros.profile import Profile


class Refused(Exception):
    """The robot refused or failed something; the text is a clause for after "because"."""


class Driver:
    """What is said to a robot, and what it says.

    Args:
        profile: its names.
        hear: is given each message with the name of its topic in the profile.
        record: is given each message that goes either way, with its topic and type, for the log.

    Attributes:
        open_goals: the action goals that haven't ended yet, as far as the robot told.
        actions: clients of the actions whose message types are installed.
        accepted: is called when the robot has accepted to do something.
    """

    def __init__(
        self,
        profile: Profile,
        hear: Callable[[str, Any], None],
        record: Callable[[str, str, Any], None] = lambda topic, kind, message: None,
    ) -> None:
        self.profile = profile
        self._hear = hear
        self._record = record
        self._node: Any = None
        self._publishers: dict[str, Any] = {}
        self._kinds: dict[str, str] = {}
        self._clients: dict[str, Any] = {}
        self.actions: dict[str, Any] = {}
        self.open_goals: list[Any] = []
        self.accepted: Callable[[], None] = lambda: None

    def set_up(self, node: Any) -> None:
        """Makes the subscriptions, publishers and clients."""
        self._node = node
        for name, kind in _HEARD.items():
            if has_interface(kind.split("/")[0]):
                self._subscribe(name, kind)
        for name, kind in _SAID.items():
            topic = self.profile.topics[name]
            self._publishers[name] = node.create_publisher(interface(kind), topic, 1)
            self._kinds[name] = kind
        for name, service in self.profile.services.items():
            kind = "std_srvs/srv/SetBool" if name == "runstop" else "std_srvs/srv/Trigger"
            self._clients[name] = node.create_client(interface(kind), service)
        for means in {m for m in self.profile.primitives.values() if m.startswith("/")}:
            self._clients[means] = node.create_client(interface("std_srvs/srv/Trigger"), means)
        for name, kind in _DONE.items():
            if has_interface(kind.split("/")[0]):
                action_client = __import__("rclpy.action", fromlist=["ActionClient"]).ActionClient
                server = self.profile.actions[name]
                self.actions[name] = action_client(node, interface(kind), server)

    def _subscribe(self, name: str, kind: str) -> None:
        topic = self.profile.topics[name]

        def take(message: Any) -> None:
            self._record(topic, kind, message)
            self._hear(name, message)

        self._node.create_subscription(interface(kind), topic, take, _quality(name))

    # Topics

    def publish(self, name: str, message: Any) -> None:
        """Sends a message."""
        self._record(self.profile.topics[name], self._kinds[name], message)
        self._publishers[name].publish(message)

    def tell(self, name: str, value: Mapping[str, Any]) -> None:
        """Sends JSON as a text message."""
        self.publish(name, interface("std_msgs/msg/String")(data=json.dumps(value)))

    def velocity(self, linear: float, angular: float) -> None:
        """Commands a velocity of the base, within the profile's limits (m/s, rad/s)."""
        most = self.profile.base
        twist = interface("geometry_msgs/msg/Twist")()
        twist.linear.x = max(-most.linear, min(most.linear, float(linear)))
        twist.angular.z = max(-most.angular, min(most.angular, float(angular)))
        self.publish("cmd_vel", twist)

    def listeners(self, name: str) -> int:
        """How many subscribe to one of our topics."""
        return int(self._publishers[name].get_subscription_count())

    def speakers(self) -> dict[str, int]:
        """How many servers answer on each name that only one should answer on."""
        found = {
            name: int(self._node.count_services(name)) for name in self.profile.services.values()
        }
        for name in self.actions:
            server = self.profile.actions[name]
            found[server] = int(self._node.count_services(f"{server}/_action/send_goal"))
        return found

    # Services

    def offers(self, name: str) -> bool:
        """Whether a service or an action is there now."""
        if name in self.actions:
            return bool(self.actions[name].server_is_ready())
        client = self._clients.get(name)
        return client is not None and bool(client.service_is_ready())

    async def call(self, name: str, seconds: float, flag: bool | None = None) -> Any:
        """Calls a service (Trigger, or SetBool with a flag) and returns its answer.

        Raises:
            Late: the service isn't there, or doesn't answer.
        """
        client = self._clients[name]
        what = self.profile.services.get(name, name).lstrip("/").replace("_", " ")
        await until(client.service_is_ready, seconds, what)
        request = client.srv_type.Request()
        if flag is not None:
            request.data = flag
        return await within(client.call_async(request), seconds, what)

    def call_now(self, name: str, flag: bool | None = None) -> None:
        """Calls a service without waiting for its answer; nothing if it isn't there."""
        client = self._clients[name]
        if client.service_is_ready():
            request = client.srv_type.Request()
            if flag is not None:
                request.data = flag
            client.call_async(request)

    # Actions

    async def pursue(self, name: str, goal: Any, seconds: float, what: str) -> Any:
        """Sends an action goal and waits for its result; a goal left behind is cancelled.

        Raises:
            Refused: it is rejected, aborted or cancelled.
            Late: there is no answer in time.
        """
        times = self.profile.times
        client = self.actions[name]
        await until(client.server_is_ready, times.service, what)
        await self._last_goal_ended(what)
        handle = await self._sent(client, goal, what)
        if not handle.accepted:
            raise Refused(f"it refuses {what} just now")
        self.accepted()
        self.open_goals.append(handle)
        future = handle.get_result_async()
        future.add_done_callback(lambda _: self._ended(handle))
        try:
            # Not `within`: the result is still wanted after a cancel, to know that it has ended.
            await until(future.done, seconds, what)
        except BaseException:
            handle.cancel_goal_async()
            raise
        answer = future.result()
        status = interface("action_msgs/msg/GoalStatus")
        if answer.status != status.STATUS_SUCCEEDED:
            told = str(getattr(answer.result, "error_string", "")).strip().rstrip(".")
            raise Refused(told or f"it gave up {what}")
        return answer.result

    async def _sent(self, client: Any, goal: Any, what: str) -> Any:
        """Sends a goal and waits for the robot's answer; one that comes too late for us is cancelled."""
        future = client.send_goal_async(goal)
        try:
            await until(future.done, self.profile.times.accept, what)
        except BaseException:
            future.add_done_callback(_disown)
            raise
        return future.result()

    def cancel_all(self) -> None:
        """Asks the robot to give up every goal that hasn't ended."""
        for handle in self.open_goals:
            handle.cancel_goal_async()

    async def _last_goal_ended(self, what: str) -> None:
        """A robot that is slow to give a goal up isn't given the next one yet."""
        await until(
            lambda: not self.open_goals, self.profile.times.cancel, f"giving up before {what}"
        )

    def _ended(self, handle: Any) -> None:
        if handle in self.open_goals:
            self.open_goals.remove(handle)


def _disown(future: Any) -> None:
    if not future.cancelled() and future.exception() is None and future.result().accepted:
        future.result().cancel_goal_async()


def _quality(name: str) -> Any:
    """How a topic is subscribed to: reliably; frames that never change are sent to late comers, too."""
    depth = _DEPTHS.get(name, 1)
    if name != "tf_static":
        return depth
    qos = __import__("rclpy.qos", fromlist=["QoSProfile"])
    return qos.QoSProfile(depth=depth, durability=qos.DurabilityPolicy.TRANSIENT_LOCAL)


_DEPTHS = {"tf_static": 50, "heard": 20, "said": 20, "skill_result": 20, "tf": 50}
_HEARD = {
    "joint_states": "sensor_msgs/msg/JointState",
    "odom": "nav_msgs/msg/Odometry",
    "battery": "sensor_msgs/msg/BatteryState",
    "mode": "std_msgs/msg/String",
    "is_homed": "std_msgs/msg/Bool",
    "is_runstopped": "std_msgs/msg/Bool",
    "is_streaming_position": "std_msgs/msg/Bool",
    "tf": "tf2_msgs/msg/TFMessage",
    "tf_static": "tf2_msgs/msg/TFMessage",
    "markers": "visualization_msgs/msg/MarkerArray",
    "perceived": "std_msgs/msg/String",
    "heard": "std_msgs/msg/String",
    "said": "std_msgs/msg/String",
    "skill_result": "std_msgs/msg/String",
}
_SAID = {
    "cmd_vel": "geometry_msgs/msg/Twist",
    "joint_pose_cmd": "std_msgs/msg/Float64MultiArray",
    "say": "std_msgs/msg/String",
    "skill": "std_msgs/msg/String",
}
_DONE = {
    "trajectory": "control_msgs/action/FollowJointTrajectory",
    "navigate": "nav2_msgs/action/NavigateToPose",
}
