"""Starting the simulator: the options, the body, and the loop until somebody stops it."""

from __future__ import annotations

import importlib.util
import signal
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from polaris_nl.execution.ros.middleware import interface, load_rclpy
from polaris_nl.execution.ros.stretch_sim.simulator import Options, Simulator
from polaris_nl.model.errors import RunError
from polaris_nl.model.world import World

if TYPE_CHECKING:
    from polaris_nl.execution.ros.stretch_sim.film import Film
    from polaris_nl.execution.ros.stretch_sim.simulator import MakeBody

SPIN_S = 0.1


@dataclass(frozen=True, slots=True)
class Order:
    """What to start: a world, how to simulate it, whether without forces, and where to draw it."""

    world: World
    options: Options
    kinematic: bool = False
    render: Path | None = None


@dataclass(frozen=True, slots=True)
class Ready:
    """The simulator is ready: whether with forces, and a sentence for a person."""

    physical: bool
    text: str


@dataclass(frozen=True, slots=True)
class Closing:
    """The simulator has ended: figures, and a sentence for a person."""

    figures: Mapping[str, float]
    text: str


def serve(order: Order, ready: Callable[[Ready], None]) -> Closing:
    """Runs the simulator until SIGINT or SIGTERM.

    Args:
        order: what to start.
        ready: is called once everything is offered.

    Raises:
        RunError: ROS 2 or a message package is missing, or the world can't be driven in.
    """
    rclpy = load_rclpy()
    for name in ("control_msgs/action/FollowJointTrajectory", "nav2_msgs/action/NavigateToPose"):
        interface(name)
    from rclpy.executors import SingleThreadedExecutor
    from rclpy.signals import SignalHandlerOptions

    from polaris_nl.execution.ros.stretch_sim.node import StretchNode

    stopped: list[int] = []
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda got, frame: stopped.append(got))
    make_body = None if order.kinematic else _physics()
    simulator = Simulator(order.world, time.time(), order.options, make_body)
    film = _film(order, simulator)
    if film is not None:
        film.begin()
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
    try:
        node = StretchNode(simulator, film)
        executor = SingleThreadedExecutor()
        executor.add_node(node)
        ready(_ready(order, simulator))
        while not stopped:
            executor.spin_once(timeout_sec=SPIN_S)
        executor.shutdown()
        node.destroy_node()
    finally:
        rclpy.shutdown()
        problem = film.close(simulator.wall) if film else ""
    if problem:
        raise RunError(problem)
    factor = simulator.real_time_factor
    text = f"The simulated Stretch has ended; it ran at {factor:.2f} x real time."
    if film is not None:
        text += f" {order.render} is drawn (pictures: {film.frames})."
    return Closing(
        {"real_time_factor": round(factor, 3), "seconds": round(simulator.time, 2)}, text
    )


def _physics() -> MakeBody | None:
    """What makes bodies with forces, or None where MuJoCo or the robot's description isn't installed."""
    if any(importlib.util.find_spec(name) is None for name in ("mujoco", "stretch_urdf")):
        return None
    from polaris_nl.execution.ros.stretch_sim.mujoco_body import MujocoBody

    return MujocoBody


def _film(order: Order, simulator: Simulator) -> Film | None:
    if order.render is None:
        return None
    try:
        from polaris_nl.execution.ros.stretch_sim.film import Film
        from polaris_nl.execution.ros.stretch_sim.picture import Painter
    except ModuleNotFoundError as error:
        raise RunError(
            f'To draw, {error.name} is needed, which isn\'t installed: pip install "polaris-nl[sim]"'
        ) from error
    start = simulator.body.pose
    return Film(
        order.render, lambda: Painter(order.world, simulator.layout, simulator.floor, start)
    )


def _ready(order: Order, simulator: Simulator) -> Ready:
    physical = simulator.body.physical
    how = (
        "in MuJoCo; its grasps are attached, not held by friction"
        if physical
        else "without forces: it moves as it is told (kinematic), and its grasps are attached"
    )
    if not physical and not order.kinematic:
        how += '; for forces, pip install "polaris-nl[sim]"'
    text = f"The simulated Stretch is ready in {order.world.name}, {how}. Stop it with Ctrl-C."
    return Ready(physical, text)
