"""ROS messages made of the simulation's values."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from builtin_interfaces.msg import Time
from geometry_msgs.msg import PoseStamped, TransformStamped
from nav_msgs.msg import Odometry
from sensor_msgs.msg import BatteryState, JointState
from std_msgs.msg import String
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import Marker as MarkerMessage
from visualization_msgs.msg import MarkerArray

from polaris_nl.execution.ros.layout import Pose
from polaris_nl.execution.ros.stretch_sim.driver import EMPTY_V, FULL_V
from polaris_nl.execution.ros.stretch_sim.perception import Marker

MAP, BASE, ODOM = "map", "base_link", "odom"
_COLOURS = {
    "object": (0.9, 0.5, 0.1),
    "person": (0.2, 0.5, 0.9),
    "container": (0.5, 0.35, 0.2),
    "surface": (0.7, 0.7, 0.7),
}


def time_of(seconds: float) -> Time:
    """A stamp."""
    whole = math.floor(seconds)
    return Time(sec=whole, nanosec=int((seconds - whole) * 1e9))


def text(value: Any) -> String:
    """JSON in a String."""
    return String(data=json.dumps(value, ensure_ascii=False))


def yaw_of(orientation: Any) -> float:
    """The heading of a quaternion, in rad."""
    q = orientation
    return math.atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z))


def pose_stamped(pose: Pose, stamp: float) -> PoseStamped:
    """A pose on the map."""
    message = PoseStamped()
    message.header.frame_id, message.header.stamp = MAP, time_of(stamp)
    _set_pose(message.pose, pose)
    return message


def joint_state(positions: Mapping[str, float], stamp: float) -> JointState:
    """The joints."""
    message = JointState()
    message.header.stamp = time_of(stamp)
    message.name = list(positions)
    message.position = [float(p) for p in positions.values()]
    message.velocity = message.effort = [0.0] * len(positions)
    return message


def odometry(pose: Pose, velocity: tuple[float, float], stamp: float) -> Odometry:
    """Where the base is by its wheels, which don't slip here: the same as on the map."""
    message = Odometry()
    message.header.frame_id, message.child_frame_id = ODOM, BASE
    message.header.stamp = time_of(stamp)
    _set_pose(message.pose.pose, pose)
    message.twist.twist.linear.x, message.twist.twist.angular.z = map(float, velocity)
    return message


def battery(volts: float, stamp: float) -> BatteryState:
    """The battery."""
    message = BatteryState()
    message.header.stamp = time_of(stamp)
    message.voltage = volts
    message.percentage = min(max((volts - EMPTY_V) / (FULL_V - EMPTY_V), 0.0), 1.0)
    message.power_supply_status = BatteryState.POWER_SUPPLY_STATUS_DISCHARGING
    message.present = True
    return message


def marker_array(seen: Sequence[Marker], stamp: float) -> MarkerArray:
    """What the cameras see."""
    message = MarkerArray()
    for number, marker in enumerate(seen):
        one = MarkerMessage()
        one.header.frame_id, one.header.stamp = MAP, time_of(stamp)
        one.ns, one.text, one.id = marker.kind, marker.name, number
        one.type, one.action = MarkerMessage.CUBE, MarkerMessage.ADD
        one.pose.position.x, one.pose.position.y, one.pose.position.z = marker.at
        one.pose.orientation.w = 1.0
        one.scale.x = one.scale.y = one.scale.z = 0.1
        one.color.r, one.color.g, one.color.b = _COLOURS.get(marker.kind, (1.0, 1.0, 1.0))
        one.color.a = 1.0
        message.markers.append(one)
    return message


def transforms(pose: Pose, seen: Iterable[Marker], stamp: float) -> TFMessage:
    """Where the base is on the map, and where what is seen is."""
    found = [_transform(BASE, (pose.x, pose.y, 0.0), pose.yaw, stamp)]
    found += [_transform(marker.name, marker.at, 0.0, stamp) for marker in seen]
    return TFMessage(transforms=found)


def _transform(
    child: str, at: tuple[float, float, float], yaw: float, stamp: float
) -> TransformStamped:
    message = TransformStamped()
    message.header.frame_id, message.header.stamp = MAP, time_of(stamp)
    message.child_frame_id = child
    moved = message.transform
    moved.translation.x, moved.translation.y, moved.translation.z = map(float, at)
    moved.rotation.z, moved.rotation.w = math.sin(yaw / 2), math.cos(yaw / 2)
    return message


def _set_pose(message: Any, pose: Pose) -> None:
    message.position.x, message.position.y = float(pose.x), float(pose.y)
    message.orientation.z, message.orientation.w = math.sin(pose.yaw / 2), math.cos(pose.yaw / 2)
