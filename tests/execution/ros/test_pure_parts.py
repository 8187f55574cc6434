"""Layout, frames, watchdog, steering: the robot back end's pure parts."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from polaris_nl.execution.ros.frames import Frames, Transform
from polaris_nl.execution.ros.layout import Layout, Pose, wrapped
from polaris_nl.execution.ros.primitives import steering
from polaris_nl.execution.ros.profile import profile_for
from polaris_nl.execution.ros.watch import Vitals, health_of, moving
from polaris_nl.model.world_file import load_world

WORLDS = ("care-home", "dinner-party")
LIMITS = profile_for("stretch-sim").safety
WELL = Vitals(10.0, (0.0, 0.0, 10.0), homed=True, runstopped=False, mode="position", voltage=12.0)


@pytest.mark.parametrize("world", WORLDS)
def test_the_robot_stands_in_its_region_and_clear_of_furniture(world: str) -> None:
    layout = Layout.of(load_world(world))
    for region, area in layout.areas.items():
        pose = layout.standing(region)
        assert pose is not None
        assert area.holds(pose.x, pose.y, 0.3)
        assert layout.clearance(pose.x, pose.y) >= 0.7
        assert layout.region_at(pose.x, pose.y) == region


@pytest.mark.parametrize("world", WORLDS)
def test_beside_furniture_the_arm_points_at_it(world: str) -> None:
    layout = Layout.of(load_world(world))
    for name, place in layout.places.items():
        region = layout.regions[name]
        pose = layout.beside(place.x, place.y, region, 0.75)
        assert pose is not None
        assert layout.areas[region].holds(pose.x, pose.y, 0.3)
        assert pose.distance(place.x, place.y) == pytest.approx(0.75)
        arm = pose.yaw - math.pi / 2
        bearing = math.atan2(place.y - pose.y, place.x - pose.x)
        assert wrapped(arm - bearing) == pytest.approx(0.0, abs=1e-6)


def test_unknown_regions_have_no_places_to_stand() -> None:
    layout = Layout.of(load_world("care-home"))
    assert layout.standing("attic") is None
    assert layout.beside(0.0, 0.0, "attic", 0.7) is None
    assert layout.region_at(-50.0, 0.0) == ""
    assert layout.place_at(-50.0, 0.0, 0.6) == ""


def test_poses_go_through_the_tree_of_frames() -> None:
    frames = Frames()
    quarter = (0.0, 0.0, math.sin(math.pi / 4), math.cos(math.pi / 4))
    frames.take("map", "odom", Transform((1.0, 0.0, 0.0), quarter), 1.0)
    frames.take("odom", "base_link", Transform((2.0, 0.0, 0.0)), 2.0)
    found = frames.base()
    assert found is not None
    base, stamp = found
    assert (base.x, base.y, base.yaw, stamp) == pytest.approx((1.0, 2.0, math.pi / 2, 2.0))
    # A camera that looks down from the base: what it sees a metre ahead lies a metre below it.
    down = (math.sin(math.pi / 2), 0.0, 0.0, math.cos(math.pi / 2))
    frames.take("base_link", "camera", Transform((0.0, 0.0, 1.3), down), 2.0)
    seen = frames.on_map("camera", Transform((0.0, 0.0, 1.0)))
    assert seen is not None
    assert seen.at == pytest.approx((1.0, 2.0, 0.3))


def test_a_gap_or_a_circle_in_the_frames_is_no_pose() -> None:
    frames = Frames()
    frames.take("odom", "base_link", Transform(), 1.0)
    assert frames.base() is None
    frames.take("base_link", "odom", Transform(), 1.0)
    assert frames.base() is None


@pytest.mark.parametrize(
    ("change", "kind"),
    [
        ({}, "ready"),
        ({"heartbeat": None}, "silent"),
        ({"heartbeat": 9.4}, "silent"),
        ({"heartbeat": 9.6}, "ready"),
        ({"runstopped": True}, "runstopped"),
        ({"mode": "runstopped"}, "runstopped"),
        ({"homed": False}, "unhomed"),
        ({"voltage": 10.0}, "battery"),
        ({"mode": "homing"}, "mode"),
        ({"drift": 5.0}, "clock"),
        ({"drift": -5.0}, "clock"),
        ({"speakers": {"/stop_the_robot": 2}}, "duplicate"),
        ({"speakers": {"/stop_the_robot": 1}}, "ready"),
        ({"heartbeat": 9.0, "runstopped": True}, "silent"),
    ],
)
def test_health(change: dict[str, object], kind: str) -> None:
    assert health_of(replace(WELL, **change), 10.0, LIMITS).kind == kind


def test_motion_is_what_odometry_shows_lately() -> None:
    assert moving(WELL, 10.0, LIMITS) is False
    assert moving(replace(WELL, moved=(0.1, 0.0, 10.0)), 10.0, LIMITS) is True
    assert moving(replace(WELL, moved=(0.0, -0.3, 10.0)), 10.0, LIMITS) is True
    assert moving(replace(WELL, moved=(0.0, 0.0, 9.0)), 10.0, LIMITS) is None
    assert moving(replace(WELL, moved=None), 10.0, LIMITS) is None


@given(st.floats(-3, 3), st.floats(-3, 3), st.floats(-3.1, 3.1), st.floats(-3.1, 3.1))
def test_steering_brings_the_base_to_where_it_is_to_be(
    x: float, y: float, yaw: float, start: float
) -> None:
    base, target, step = Pose(0.0, 0.0, start), Pose(x, y, yaw), 0.1
    for _ in range(600):
        linear, angular = steering(base, target, 0.15)
        linear, angular = max(-0.26, min(0.26, linear)), max(-0.8, min(0.8, angular))
        turned = wrapped(base.yaw + angular * step)
        base = Pose(
            base.x + linear * step * math.cos(turned),
            base.y + linear * step * math.sin(turned),
            turned,
        )
    assert base.distance(x, y) <= 0.25
    assert abs(wrapped(base.yaw - yaw)) <= 0.25
