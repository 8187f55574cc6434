"""A small mock of the robot's driver, in a process of its own: real messages, no physics, bad manners.

    python -m tests.execution.ros.mock_driver WORLD [people's preferences, or none] [--plain]

It answers on the driver's topics, services and actions. The base glides straight to where it is sent,
joints jump, skills do at once what they say, and people act as the world file says. `/mock/fault`
(JSON: a fault's fields) makes it reject, fail, lie, never end, ignore cancelling, go blind, and worse;
killing and freezing it is done with signals. With --plain it has no actions, and goes by velocities
and joint positions. `/mock/log` tells what was asked of it, and when.
"""

from __future__ import annotations

import json
import math
import sys
import threading
import time
from typing import Any

import rclpy
from control_msgs.action import FollowJointTrajectory
from geometry_msgs.msg import TransformStamped, Twist
from nav2_msgs.action import NavigateToPose
from nav_msgs.msg import Odometry
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.node import Node
from sensor_msgs.msg import BatteryState, JointState
from std_msgs.msg import Bool, Float64MultiArray, String
from std_srvs.srv import SetBool, Trigger
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import Marker, MarkerArray

from polaris_nl.execution.ros.layout import Layout, wrapped
from polaris_nl.execution.ros.stretch_sim.people import willing
from polaris_nl.model.formula import Literal, parse_literal
from polaris_nl.model.state import State
from polaris_nl.model.world_file import load_world
from polaris_nl.planning.planner import Planner

RATE_S = 1 / 30
PLAIN = "--plain"
SPEED = 6.0
"""Metres a second: tests needn't watch it drive."""
HASTE = 4.0
"""How many times as fast as it is told it drives by velocity, for the same reason."""
SILENCE_S = 0.5
"""A velocity that isn't repeated for so long is withdrawn."""
PEOPLE_S = 1.5
"""How long people take to act."""


class MockDriver(Node):
    """The node."""

    def __init__(self, world_name: str, people: tuple[str, ...] | None, plain: bool) -> None:
        super().__init__("mock_driver")
        self.world = load_world(world_name)
        mutexes = Planner(self.world).mutexes
        self.people = list(willing(self.world, people, mutexes))
        self.people_at: dict[str, float] = {}
        self.wavering: list[Literal] = []
        self.stop_at, self.loose = 0.0, False
        self.ticks, self.ticked_at = 0, time.time()
        self.layout = Layout.of(self.world)
        self.state: State = self.world.initial
        start = next(f.args[0] for f in self.state.facts if f.predicate == "robot-at")
        middle = self.layout.standing(start)
        assert middle is not None
        self.x, self.y, self.yaw = middle.x, middle.y, 0.0
        self.velocity, self.told_at = (0.0, 0.0), 0.0
        self.target: tuple[float, float, float] | None = None
        self.joints = {"joint_lift": 0.55, "wrist_extension": 0.0, "joint_wrist_yaw": 0.0}
        self.mode, self.homed, self.stopped, self.volts = "position", True, False, 12.5
        self.faults: dict[str, int] = {}
        self.until: dict[str, float] = {}
        self.jump = self.slow_s = 0.0
        self.muted = self.streaming = False
        group = ReentrantCallbackGroup()
        make = self.create_publisher
        self.out: dict[str, Any] = {
            "joints": make(JointState, "/stretch/joint_states", 1),
            "odom": make(Odometry, "/odom", 1),
            "battery": make(BatteryState, "/battery", 1),
            "mode": make(String, "/mode", 1),
            "homed": make(Bool, "/is_homed", 1),
            "stopped": make(Bool, "/is_runstopped", 1),
            "tf": make(TFMessage, "/tf", 10),
            "markers": make(MarkerArray, "/aruco/marker_array", 1),
            "perceived": make(String, "/polaris/perceived", 1),
            "heard": make(String, "/polaris/heard", 10),
            "said": make(String, "/polaris/said", 10),
            "skill": make(String, "/polaris/skill_result", 10),
            "log": make(String, "/mock/log", 50),
        }
        hear = self.create_subscription
        hear(Twist, "/stretch/cmd_vel", self.on_velocity, 1, callback_group=group)
        hear(String, "/mock/fault", self.on_fault, 10, callback_group=group)
        hear(String, "/polaris/say", self.on_say, 10, callback_group=group)
        hear(String, "/polaris/skill", self.on_skill, 10, callback_group=group)
        for mode in ("position", "navigation"):
            name = f"/switch_to_{mode}_mode"
            self.create_service(Trigger, name, self.switcher(mode), callback_group=group)
        self.create_service(Trigger, "/stop_the_robot", self.on_stop, callback_group=group)
        self.create_service(SetBool, "/runstop", self.on_runstop, callback_group=group)
        if plain:
            hear(Float64MultiArray, "/joint_pose_cmd", self.on_pose, 1, callback_group=group)
            name = "/activate_streaming_position"
            self.create_service(Trigger, name, self.on_streaming, callback_group=group)
        for kind, name, work in (
            ()
            if plain
            else (
                (NavigateToPose, "/navigate_to_pose", self.navigate),
                (FollowJointTrajectory, "/stretch_controller/follow_joint_trajectory", self.reach),
            )
        ):
            ActionServer(
                self, kind, name, work, callback_group=group,
                goal_callback=self.on_goal, cancel_callback=self.on_cancel,
            )  # fmt: skip

    # Time

    def beat(self) -> None:
        """Ticks for ever, in a thread of its own: among many messages the executor is late by half a second."""
        due = time.monotonic()
        while rclpy.ok():
            try:
                self.tick()
            except rclpy_implementation.RCLError:
                if rclpy.ok():
                    raise  # Otherwise it was shut down meanwhile.
            due = max(due + RATE_S, time.monotonic())
            time.sleep(max(due - time.monotonic(), 0.0))

    def tick(self) -> None:
        now = time.time()
        if now - self.told_at > SILENCE_S:
            self.velocity = (0.0, 0.0)
        if self.stopped and 0 < self.until.get("stopped", 0.0) < now:
            self.stopped = False
        self.ticks += 1
        if now - self.ticked_at > SILENCE_S:
            self.target = None  # It was frozen: no velocity has come for too long.
        self.ticked_at = now
        self.act(now)
        if 0 < self.stop_at <= now:
            self.stop_at, self.target, self.velocity = 0.0, None, (0.0, 0.0)
        moved = self.move()
        stamp = self.stamp(now)
        odom = Odometry()
        odom.header.stamp, odom.header.frame_id = stamp, "odom"
        odom.twist.twist.linear.x, odom.twist.twist.angular.z = moved
        self.send("odom", odom)
        joints = JointState(name=list(self.joints), position=list(self.joints.values()))
        joints.header.stamp = stamp
        self.send("joints", joints)
        self.send("battery", BatteryState(voltage=self.volts))
        self.send("mode", String(data="runstopped" if self.stopped else self.mode))
        self.send("homed", Bool(data=self.homed))
        self.send("stopped", Bool(data=self.stopped))
        base = TransformStamped()
        base.header.stamp, base.header.frame_id, base.child_frame_id = stamp, "map", "base_link"
        base.transform.translation.x, base.transform.translation.y = self.x, self.y
        base.transform.rotation.z, base.transform.rotation.w = half(self.yaw)
        self.send("tf", TFMessage(transforms=[base]))
        if not self.lasts("blind"):
            self.show(self.stamp(now - 30.0) if self.lasts("stale") else stamp, now)

    def move(self) -> tuple[float, float]:
        """One tick of the base; returns its speeds as odometry tells them."""
        if self.stopped:
            return 0.0, 0.0
        if self.loose:
            return 0.2, 0.0
        if self.target is not None and self.mode == "navigation":
            x, y, _ = self.target
            distance, step = math.dist((x, y), (self.x, self.y)), SPEED * RATE_S
            if distance <= step:
                self.x, self.y, self.yaw = self.target
                return 0.0, 0.0
            self.x += (x - self.x) / distance * step
            self.y += (y - self.y) / distance * step
            return SPEED, 0.0
        linear, angular = self.velocity if self.mode == "navigation" else (0.0, 0.0)
        self.yaw = wrapped(self.yaw + angular * RATE_S)
        self.x += linear * HASTE * math.cos(self.yaw) * RATE_S
        self.y += linear * HASTE * math.sin(self.yaw) * RATE_S
        return linear, angular

    def show(self, stamp: Any, now: float) -> None:
        """What is in sight: everything that isn't behind a door, as if there were cameras in all rooms."""
        markers = []
        for entity in self.world.entities.values():
            at = self.where(entity.name)
            if at is None:
                continue
            marker = Marker(ns=entity.type, text=entity.name, id=len(markers))
            marker.header.stamp, marker.header.frame_id = stamp, "map"
            marker.pose.position.x, marker.pose.position.y = at
            marker.pose.position.z = 0.8
            markers.append(marker)
        self.send("markers", MarkerArray(markers=markers))
        seconds = stamp.sec + stamp.nanosec * 1e-9
        told = ("open", "is-full", "is-clean", "has", "holding", "acknowledged", "dismissed")
        shown = [f for f in self.state.facts if f.predicate in told]
        if self.lasts("flicker"):
            shown += [x if self.ticks // 3 % 2 else x.negation for x in self.wavering]
        elif self.lasts("contradict"):
            shown += self.wavering
        elif self.lasts("blink"):
            shown += self.wavering
            self.until["blink"] = 0.0
        facts = [{"literal": str(f), "stamp": seconds} for f in shown]
        self.send("perceived", String(data=json.dumps({"stamp": seconds, "facts": facts})))

    def where(self, name: str) -> tuple[float, float] | None:
        """Where an entity is; None for what nobody can see."""
        if name in self.layout.places:
            return self.layout.places[name].x, self.layout.places[name].y
        for fact in self.state.facts:
            if fact.predicate == "person-in" and fact.args[0] == name:
                place = self.layout.standing(fact.args[1])
                return (place.x, place.y) if place else None
            if fact.predicate == "holding" and fact.args[0] == name:
                return self.x, self.y
            if fact.predicate in ("at", "in") and fact.args[0] == name:
                if fact.predicate == "in" and Literal("open", fact.args[1:]) not in self.state:
                    return None
                return self.where(fact.args[1])
        return None

    # What it is told

    def act(self, now: float) -> None:
        """People do what they are willing to, some time after they can."""
        for action in list(self.people):
            if not all(map(self.state.holds, action.when)):
                self.people_at.pop(action.name, None)
            elif now >= self.people_at.setdefault(action.name, now + PEOPLE_S):
                self.people.remove(action)
                for literal in action.effect:
                    self.make(literal)
                    if literal.predicate in ("acknowledged", "dismissed"):
                        self.send("heard", String(data=json.dumps({"literal": str(literal)})))

    def stop(self) -> None:
        """Somebody wants it to stand still."""
        if self.lasts("runaway"):
            self.loose = True
        elif self.lasts("slow-stop"):
            self.stop_at = self.stop_at or time.time() + self.slow_s
        else:
            self.target, self.velocity = None, (0.0, 0.0)

    def on_velocity(self, twist: Twist) -> None:
        speeds = (twist.linear.x, twist.angular.z)
        self.note("velocity", speeds)
        if speeds == (0.0, 0.0):
            self.stop()
        else:
            self.velocity, self.told_at = speeds, time.time()

    def on_fault(self, message: String) -> None:
        fault = json.loads(message.data)
        kind, seconds = fault["kind"], fault.get("seconds") or 1e6
        literals = [parse_literal(text) for text in fault.get("literals", ())]
        if kind == "event":
            for literal in literals:
                self.make(literal)
        elif kind == "say":
            for literal in literals:
                self.send("heard", String(data=json.dumps({"literal": str(literal)})))
        elif kind == "runstopped":
            self.stopped, self.target = True, None
            self.until["stopped"] = time.time() + seconds
        elif kind == "unhomed":
            self.homed = False
        elif kind == "battery":
            self.volts = 9.0
        elif kind == "mode":
            self.mode = "homing"
        elif kind == "clock":
            self.jump = 60.0
        elif kind == "duplicate":
            self.second = rclpy.create_node("second_driver")
            self.second.create_service(Trigger, "/stop_the_robot", self.on_stop)
        elif kind in LASTING:
            self.slow_s = seconds
            self.wavering = literals
            self.until[kind] = time.time() + (1e6 if kind in ("slow-stop", "blink") else seconds)
        else:
            self.faults[kind] = self.faults.get(kind, 0) + fault.get("times", 1)
        self.note("fault", kind)

    def on_say(self, message: String) -> None:
        asked = json.loads(message.data)
        self.note("say", asked)
        self.make(Literal("alerted-to", (asked["person"], asked["message"])))
        self.send("said", String(data=json.dumps({**asked, "heard": True})))

    def on_skill(self, message: String) -> None:
        asked = json.loads(message.data)
        self.note("skill", asked)
        if self.takes("never"):
            return
        late = self.takes("late")
        reason = "something slipped" if late or self.takes("fail") else ""
        if not reason and not self.takes("lie"):
            for literal in done_by(asked["skill"], asked["object"], asked["at"], self.layout):
                self.make(literal)
        reply = {"id": asked["id"], "ok": not reason, "reason": reason}
        self.send("skill", String(data=json.dumps(reply)))
        if late:
            time.sleep(1.0)
            self.send("skill", String(data=json.dumps({**reply, "ok": True, "reason": ""})))

    def make(self, literal: Literal) -> None:
        """Makes a literal true; an object is in one place."""
        places = ("at", "in", "has", "holding")
        facts = set(self.state.facts)
        if literal.predicate in places and literal.positive:
            thing = literal.args[-1] if literal.predicate == "has" else literal.args[0]
            facts = {f for f in facts if not (f.predicate in places and thing in f.args)}
        if literal.predicate == "person-in":
            facts = {
                f for f in facts if f.args[:1] != literal.args[:1] or f.predicate != "person-in"
            }
        facts.add(literal) if literal.positive else facts.discard(literal.atom)
        self.state = State(frozenset(facts))

    def on_pose(self, message: Float64MultiArray) -> None:
        self.note("pose", list(message.data))
        if self.streaming and self.mode == "position":
            self.joints["wrist_extension"], self.joints["joint_lift"] = message.data[:2]

    def on_streaming(self, _: Any, answer: Any) -> Any:
        self.streaming = answer.success = True
        return answer

    def switcher(self, mode: str) -> Any:
        def switch(_: Any, answer: Any) -> Any:
            answer.success = not self.stopped and self.mode != "homing"
            if answer.success:
                self.mode = mode
            return answer

        return switch

    def on_stop(self, _: Any, answer: Any) -> Any:
        self.note("stop", True)
        self.stop()
        answer.success = True
        return answer

    def on_runstop(self, asked: Any, answer: Any) -> Any:
        self.note("runstop", asked.data)
        self.stopped, self.target, self.loose = asked.data, None, False
        answer.success = True
        return answer

    # Actions

    def on_goal(self, goal: Any) -> GoalResponse:
        self.note("goal", type(goal).__name__)
        while self.takes("mute") or self.muted:
            self.muted = True
            time.sleep(RATE_S)
        refused = self.stopped or self.takes("reject")
        return GoalResponse.REJECT if refused else GoalResponse.ACCEPT

    def on_cancel(self, _: Any) -> CancelResponse:
        self.note("cancel", True)
        refused = self.takes("ignore-cancel")
        if not refused:
            self.stop()
        refused = refused or self.lasts("runaway")
        return CancelResponse.REJECT if refused else CancelResponse.ACCEPT

    def navigate(self, handle: Any) -> Any:
        pose = handle.request.pose.pose
        yaw = wrapped(2 * math.atan2(pose.orientation.z, pose.orientation.w))
        end = (pose.position.x, pose.position.y, yaw)
        self.target = (self.x + 1e4, self.y, 0.0) if self.takes("never") else end
        while self.target is not None and (self.x, self.y, self.yaw) != end:
            time.sleep(RATE_S)
        arrived = self.target is not None and not self.loose
        self.target = None
        if handle.is_cancel_requested:
            handle.canceled()
        elif arrived:
            handle.succeed()
        else:
            handle.abort()
        return NavigateToPose.Result()

    def reach(self, handle: Any) -> Any:
        result = FollowJointTrajectory.Result()
        if self.mode != "position":
            result.error_string = "it is in the wrong mode"
            handle.abort()
            return result
        trajectory = handle.request.trajectory
        self.joints.update(
            zip(trajectory.joint_names, trajectory.points[-1].positions, strict=True)
        )
        handle.succeed()
        return result

    # Helpers

    def stamp(self, seconds: float) -> Any:
        from builtin_interfaces.msg import Time

        seconds += self.jump
        return Time(sec=int(seconds), nanosec=int(seconds % 1 * 1e9))

    def send(self, name: str, message: Any) -> None:
        self.out[name].publish(message)

    def note(self, what: str, value: Any) -> None:
        """Tells the test what came in, and when."""
        self.send("log", String(data=json.dumps({"at": time.time(), "what": what, "value": value})))

    def takes(self, kind: str) -> bool:
        left = self.faults.get(kind, 0)
        self.faults[kind] = max(0, left - 1)
        return left > 0

    def lasts(self, kind: str) -> bool:
        return time.time() < self.until.get(kind, 0.0)


LASTING = ("blind", "stale", "runaway", "slow-stop", "flicker", "blink", "contradict")


def done_by(skill: str, thing: str, at: str, layout: Layout) -> list[Literal]:
    """What a skill brings about."""
    if skill == "grasp":
        return [Literal("holding", (thing,))]
    if skill == "release":
        if at not in layout.places:
            return [Literal("has", (at, thing))]
        return [Literal("in" if at in layout.containers else "at", (thing, at))]
    if skill in ("open", "close"):
        return [Literal("open", (at,), skill == "open")]
    return [Literal("is-full", (thing,))] if skill == "fill" else []


def half(yaw: float) -> tuple[float, float]:
    return math.sin(yaw / 2), math.cos(yaw / 2)


def main() -> None:
    rclpy.init()
    world, *people = (a for a in sys.argv[1:] if a != PLAIN)
    preferred = tuple(n for n in people if n != "none") if people else None
    node = MockDriver(world, preferred, PLAIN in sys.argv)
    executor = MultiThreadedExecutor(num_threads=6)
    executor.add_node(node)
    threading.Thread(target=node.beat, name="beat", daemon=True).start()
    print("ready", flush=True)
    try:
        executor.spin()
    except (KeyboardInterrupt, rclpy.executors.ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
