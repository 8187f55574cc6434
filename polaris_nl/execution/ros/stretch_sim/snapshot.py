"""What a picture shows of a moment: plain values, so that whoever draws needn't touch the simulation."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from polaris_nl.execution.ros.layout import Pose
from polaris_nl.execution.ros.stretch_sim.body import Point3
from polaris_nl.execution.ros.stretch_sim.simulator import Simulator


@dataclass(frozen=True, slots=True)
class Snapshot:
    """One moment.

    Attributes:
        pose: of the base.
        joints: in m or rad.
        things: where each object is that is somewhere.
        people: where everybody stands and looks.
        open: containers that are open.
        held: the object in the gripper, or "".
        caption: what is going on, in one line.
    """

    pose: Pose
    joints: Mapping[str, float]
    things: Mapping[str, Point3]
    people: Mapping[str, Pose]
    open: frozenset[str]
    held: str
    caption: str


def snapshot(simulator: Simulator, last_words: str = "") -> Snapshot:
    """This moment of a simulation.

    Args:
        simulator: the simulation.
        last_words: what was said last, by the robot or to it.
    """
    scene = simulator.scene
    things = {name: at for name in scene.objects if (at := scene.where(name)) is not None}
    held = scene.held or ""
    parts = [f"{simulator.time:6.1f} s", simulator.driver.mode, scene.region or "nowhere"]
    if held:
        parts.append(f"holds {held}")
    if last_words:
        parts.append(last_words)
    return Snapshot(
        simulator.body.pose,
        dict(simulator.body.joints),
        things,
        {p.name: Pose(p.x, p.y, p.yaw) for p in scene.people.values()},
        frozenset(f.args[0] for f in scene.state.facts if f.predicate == "open"),
        held,
        "  |  ".join(parts),
    )
