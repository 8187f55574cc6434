"""The ROS 2 node: the driver's topics, services and actions around a simulator."""

from __future__ import annotations

import json
import time
from typing import TYPE_CHECKING, Any

from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.node import Node
from rclpy.qos import QoSProfile
from sensor_msgs.msg import BatteryState, JointState
from std_msgs.msg import Bool, Float64MultiArray, String
from std_srvs.srv import SetBool, Trigger
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import MarkerArray

from polaris_nl.execution.ros.stretch_sim import messages, skills
from polaris_nl.execution.ros.stretch_sim.actions import Actions
from polaris_nl.execution.ros.stretch_sim.driver import NAVIGATION, POSITION, TRAJECTORY, Answer
from polaris_nl.execution.ros.stretch_sim.faults import parse_fault
from polaris_nl.execution.ros.stretch_sim.joints import published
from polaris_nl.execution.ros.stretch_sim.simulator import Simulator
from polaris_nl.execution.ros.stretch_sim.skills import Reply, Request
from polaris_nl.execution.ros.stretch_sim.snapshot import snapshot
from polaris_nl.execution.ros.stretch_sim.speech import Saying
from polaris_nl.model.errors import PolarisError

if TYPE_CHECKING:
    from polaris_nl.execution.ros.stretch_sim.film import Film

LOOP_S = 0.01
PUBLISH_S = 1 / 30
SENSE_S = 0.1
WORDS_S = 8.0
"""How long a film shows what was said or done, in simulated seconds."""
TOOL = "eoa_wrist_dw3_tool_sg3"
_SENDING = {
    "joints": (JointState, "/stretch/joint_states"),
    "odom": (Odometry, "/odom"),
    "battery": (BatteryState, "/battery"),
    "mode": (String, "/mode"),
    "tool": (String, "/tool"),
    "homed": (Bool, "/is_homed"),
    "runstopped": (Bool, "/is_runstopped"),
    "streaming": (Bool, "/is_streaming_position"),
    "markers": (MarkerArray, "/aruco/marker_array"),
    "tf": (TFMessage, "/tf"),
    "perceived": (String, "/polaris/perceived"),
    "heard": (String, "/polaris/heard"),
    "said": (String, "/polaris/said"),
    "skill": (String, "/polaris/skill_result"),
    "truth": (String, "/polaris/sim/truth"),
}


class StretchNode(Node):  # type: ignore[misc] # rclpy may be missing
    """The simulated driver.

    Args:
        simulator: what it drives.
        film: what draws it, or None.
    """

    def __init__(self, simulator: Simulator, film: Film | None = None) -> None:
        super().__init__("stretch_driver")
        self.simulator = simulator
        self._driver = simulator.driver
        # A service that waits must not keep everything else waiting.
        self._lasting_group = ReentrantCallbackGroup()
        # Depth 1, reliable, as the driver has them; what is said once isn't lost for that.
        once = ("heard", "said", "skill")
        self._out = {
            key: self.create_publisher(kind, name, QoSProfile(depth=20 if key in once else 1))
            for key, (kind, name) in _SENDING.items()
        }
        self._listen()
        self._serve()
        self._actions = Actions(self, simulator)
        self._frozen_stamp: float | None = None
        self._film = film
        self._last_words = ""
        self._words_at = 0.0
        self.create_timer(LOOP_S, self._loop)
        self.create_timer(PUBLISH_S, self._publish)
        self.create_timer(SENSE_S, self._sense)

    # Time

    def _loop(self) -> None:
        happened = self.simulator.step(time.time())
        self._actions.step(time.time())
        stamp = self.simulator.stamp(time.time())
        for saying in happened.said:
            said = {"person": saying.person, "message": saying.message, "text": saying.text}
            self._note(f"robot: {saying.text}")
            self._out["said"].publish(messages.text({**said, "heard": True, "stamp": stamp}))
        for deed in happened.deeds:
            self._note(f"a person: {deed.action.name}")
            self.get_logger().info(f"a person does this: {deed.action.name}")
            if not self.simulator.cameras.hears(deed.speaker):
                continue
            for literal in deed.spoken:
                heard = {"literal": str(literal), "person": deed.speaker, "stamp": stamp}
                self._out["heard"].publish(messages.text(heard))

    def _note(self, words: str) -> None:
        self._last_words, self._words_at = words, self.simulator.time

    def _publish(self) -> None:
        now = time.time()
        if now < self.simulator.mishaps.silent_until:
            return
        stamp = self._stamp(now)
        body, driver, out = self.simulator.body, self._driver, self._out
        out["joints"].publish(messages.joint_state(published(body.joints), stamp))
        out["odom"].publish(messages.odometry(body.pose, body.velocity, stamp))
        out["battery"].publish(messages.battery(driver.voltage, stamp))
        out["mode"].publish(String(data=driver.mode))
        out["tool"].publish(String(data=TOOL))
        out["homed"].publish(Bool(data=driver.homed))
        out["runstopped"].publish(Bool(data=driver.runstopped))
        out["streaming"].publish(Bool(data=driver.streaming))
        out["tf"].publish(messages.transforms(body.pose, (), stamp))

    def _sense(self) -> None:
        now = time.time()
        if self._film is not None:
            recent = self.simulator.time - self._words_at < WORDS_S
            moment = snapshot(self.simulator, self._last_words if recent else "")
            self._film.show(self.simulator.wall, moment)
        self._publish_truth(now)
        mishaps = self.simulator.mishaps
        if now < max(mishaps.blind_until, mishaps.silent_until):
            return
        stamp = self._stamp(now)
        cameras = self.simulator.cameras
        seen = cameras.markers()
        self._out["markers"].publish(messages.marker_array(seen, stamp))
        self._out["tf"].publish(messages.transforms(self.simulator.body.pose, seen, stamp))
        facts = [{"literal": str(f), "stamp": stamp} for f in cameras.facts()]
        self._out["perceived"].publish(messages.text({"stamp": stamp, "facts": facts}))

    def _publish_truth(self, now: float) -> None:
        """What is really so, for tests and for whoever watches; a robot has no such topic."""
        simulator = self.simulator
        pose = simulator.body.pose
        truth = {
            "stamp": now,
            "time": round(simulator.time, 3),
            "pose": [round(v, 4) for v in (pose.x, pose.y, pose.yaw)],
            "region": simulator.scene.region,
            "faults": simulator.struck,
            "physics": simulator.body.physical,
            "real_time_factor": round(simulator.real_time_factor, 3),
            "facts": sorted(map(str, simulator.scene.state.facts)),
        }
        self._out["truth"].publish(messages.text(truth))

    def _stamp(self, now: float) -> float:
        stamp = self.simulator.stamp(now)
        if now >= self.simulator.mishaps.stale_until:
            self._frozen_stamp = None
            return stamp
        if self._frozen_stamp is None:
            self._frozen_stamp = stamp
        return self._frozen_stamp

    # Topics

    def _listen(self) -> None:
        one, many = QoSProfile(depth=1), QoSProfile(depth=20)
        self.create_subscription(Twist, "/stretch/cmd_vel", self._velocity, one)
        self.create_subscription(Float64MultiArray, "/joint_pose_cmd", self._pose, one)
        self.create_subscription(String, "/polaris/skill", self._skill, many)
        self.create_subscription(String, "/polaris/say", self._say, many)
        self.create_subscription(String, "/polaris/sim/fault", self._fault, many)

    def _velocity(self, message: Twist) -> None:
        self._driver.velocity(message.linear.x, message.angular.z)

    def _pose(self, message: Float64MultiArray) -> None:
        self._driver.pose(list(message.data))

    def _skill(self, message: String) -> None:
        given = self._json(message)
        names = {key: str(given.get(key) or "") for key in ("id", "skill", "object", "at")}

        def done(reply: Reply) -> None:
            answer = {"id": reply.id, "ok": reply.ok, "reason": reply.reason}
            self._out["skill"].publish(messages.text(answer))

        if given:
            self.simulator.perform(Request(**names), done)

    def _say(self, message: String) -> None:
        given = self._json(message)
        if given:
            words = (str(given.get(key) or "") for key in ("person", "message", "text"))
            self.simulator.say(Saying(*words))

    def _fault(self, message: String) -> None:
        try:
            self.simulator.strike(parse_fault(message.data))
        except PolarisError as error:
            self.get_logger().error(str(error))

    def _json(self, message: String) -> dict[str, Any]:
        try:
            given = json.loads(message.data)
        except ValueError:
            given = None
        if not isinstance(given, dict):
            self.get_logger().error(f"This isn't a JSON object: {message.data[:80]}")
            return {}
        return given

    # Services

    def _serve(self) -> None:
        driver = self._driver
        for mode in (POSITION, NAVIGATION, TRAJECTORY):
            self._trigger(f"/switch_to_{mode}_mode", lambda mode=mode: driver.switch(mode))
        self._trigger("/stop_the_robot", driver.stop)
        self._trigger("/activate_streaming_position", lambda: driver.stream(True))
        self._trigger("/deactivate_streaming_position", lambda: driver.stream(False))
        self._switch("/runstop", driver.runstop)
        self._switch("/self_collision_avoidance", driver.avoid_collisions)
        self._lasting("/home_the_robot", driver.home)
        self._lasting("/stow_the_robot", driver.stow)
        find = skills
        self._demo("/grasp_object/trigger_grasp_object", find.nearest_object, "nothing in reach")
        # As the real one: it says that it succeeded even where it found nobody.
        self._demo(
            "/handover_object/trigger_handover_object", find.nearest_person, "nobody in reach", True
        )
        for way in ("up", "down"):
            self._demo(
                f"/open_drawer/trigger_open_drawer_{way}", find.nearest_container, "nothing to open"
            )

    def _trigger(self, name: str, act: Any) -> None:
        def serve(request: Any, response: Any) -> Any:
            return _answered(response, act())

        self.create_service(Trigger, name, serve)

    def _switch(self, name: str, act: Any) -> None:
        def serve(request: Any, response: Any) -> Any:
            return _answered(response, act(request.data))

        self.create_service(SetBool, name, serve)

    def _lasting(self, name: str, act: Any) -> None:
        async def serve(request: Any, response: Any) -> Any:
            answer = act()
            if self._driver.busy:
                await self._actions.until(lambda: not self._driver.busy)
                if self._driver.runstopped:
                    answer = Answer(False, "The run-stop was pressed.")
            return _answered(response, answer)

        self.create_service(Trigger, name, serve, callback_group=self._lasting_group)

    def _demo(self, name: str, find: Any, nothing: str, regardless: bool = False) -> None:
        async def serve(request: Any, response: Any) -> Any:
            wanted = find(self.simulator.scene)
            if wanted is None:
                return _answered(response, Answer(regardless, nothing))
            replies: list[Reply] = []
            self.simulator.perform(wanted, replies.append, "trigger")
            await self._actions.until(lambda: bool(replies))
            return _answered(response, Answer(replies[0].ok or regardless, replies[0].reason))

        self.create_service(Trigger, name, serve, callback_group=self._lasting_group)


def _answered(response: Any, answer: Answer) -> Any:
    response.success, response.message = answer.success, answer.message
    return response
