"""Which ROS 2 is there: the one that is sourced, or the wheels; and which interface packages."""

from __future__ import annotations

import importlib
import importlib.util
import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import Any

from polaris_nl.model.errors import RunError

INSTALL = 'pip install "polaris-nl[ros]"'
INTERFACES = "python scripts/build_interfaces.py (in a checkout: make robot)"
"""What builds the interface packages that no wheel brings."""
BUILT = ("control_msgs", "nav2_msgs", "tf2_msgs")
MESSAGES = (*BUILT, "visualization_msgs")
"""What a robot is driven and seen with; without them there is joint_pose_cmd, cmd_vel and odometry."""


@dataclass(frozen=True, slots=True)
class Installation:
    """The ROS 2 that a robot is reached with.

    Attributes:
        sourced: a ROS installation is set up in this shell, and its rclpy is the one that is found.
        distribution: its name, such as `jazzy`.
        place: the folder that rclpy comes from.
    """

    sourced: bool
    distribution: str
    place: Path

    @property
    def words(self) -> str:
        """What it is, for a person."""
        kind = f"the installation {self.distribution}" if self.sourced else "wheels"
        return f"{kind}, {self.place}"


def installation(environment: Mapping[str, str] = os.environ) -> Installation:
    """Finds the ROS 2 that would be used; loads nothing.

    A sourced installation puts its packages on PYTHONPATH, ahead of whatever is installed here, so
    that it wins by itself. Where it was made for another Python its rclpy isn't found at all.

    Raises:
        RunError: there is none.
    """
    distribution = environment.get("ROS_DISTRO", "")
    spec = importlib.util.find_spec("rclpy")
    if spec is None or spec.origin is None:
        if distribution:
            raise RunError(
                f"ROS 2 {distribution} is set up here, but not for this Python; use the Python that it "
                f"was made for, or open a shell without it and install the wheels: {INSTALL}"
            )
        raise RunError(f"A Stretch is reached over ROS 2, which is missing here. {INSTALL}")
    place = Path(spec.origin).parent.parent
    prefixes = [p for p in environment.get("AMENT_PREFIX_PATH", "").split(os.pathsep) if p]
    sourced = any(place.is_relative_to(p) for p in prefixes)
    return Installation(sourced, distribution if sourced else "jazzy", place)


def stay_on_this_machine() -> None:
    """Keeps ROS to the loopback device unless the environment says otherwise; to be called before the start.

    A robot is on the network, and reached as the environment is set up for it; what is simulated runs here.
    """
    if not {"ROS_AUTOMATIC_DISCOVERY_RANGE", "ROS_LOCALHOST_ONLY"} & os.environ.keys():
        os.environ["ROS_AUTOMATIC_DISCOVERY_RANGE"] = "LOCALHOST"


def load_rclpy() -> ModuleType:
    """The rclpy module.

    Raises:
        RunError: it is missing, or can't be loaded; the sentence says what brings it.
    """
    found = installation()
    try:
        return importlib.import_module("rclpy")
    except ImportError as error:
        raise RunError(
            f"The ROS 2 in {found.place} can't be loaded ({_first_line(error)}). Where it was set up for "
            f"another Python, open a shell without it and install the wheels: {INSTALL}"
        ) from error


def has_interface(package: str) -> bool:
    """Whether a package of message types is installed."""
    return importlib.util.find_spec(package) is not None


def interface(name: str) -> Any:
    """A message, service or action class, such as `std_msgs/msg/String`.

    Raises:
        RunError: its package is missing.
    """
    package, kind, short = name.split("/")
    try:
        return getattr(importlib.import_module(f"{package}.{kind}"), short)
    except (ImportError, AttributeError) as error:
        raise RunError(f"The message type {name} is missing here. {build_hint(package)}") from error


def build_hint(package: str) -> str:
    """What brings a package of message types."""
    if package in BUILT:
        return f"Build it: {INTERFACES}"
    return f"Install it: {INSTALL}"


def _first_line(error: Exception) -> str:
    return (str(error).splitlines() or [type(error).__name__])[0].rstrip(".")
