"""The simulator in MuJoCo: it drives, carries and draws; these tests need the extra `sim`."""

from __future__ import annotations

import math
import time
from pathlib import Path
from typing import Any

import av
import numpy as np
import pytest
from PIL import Image

from polaris_nl.execution.ros.layout import wrapped
from polaris_nl.execution.ros.stretch_sim.driver import NAVIGATION, POSITION
from polaris_nl.execution.ros.stretch_sim.mujoco_body import MujocoBody
from polaris_nl.execution.ros.stretch_sim.picture import Painter
from polaris_nl.execution.ros.stretch_sim.simulator import Options, Simulator
from polaris_nl.execution.ros.stretch_sim.skills import Reply, Request
from polaris_nl.execution.ros.stretch_sim.snapshot import snapshot
from polaris_nl.execution.ros.stretch_sim.trajectory import Waypoint
from polaris_nl.model.world_file import load_world
from tests.stretch_sim.client import SUCCEEDED
from tests.stretch_sim.conftest import Start

STEP = 0.02


class Story:
    """A physical simulation in which time is let pass."""

    def __init__(self, world: str) -> None:
        self.simulator = Simulator(load_world(world), 0.0, Options(people=()), MujocoBody)
        self.body: Any = self.simulator.body
        self.now = 0.0
        self.simulator.step(0.0)

    def run(self, seconds: float) -> None:
        for _ in range(round(seconds / STEP)):
            self.now += STEP
            self.simulator.step(self.now)

    def until(self, state: Any, seconds: float) -> None:
        end = self.now + seconds
        while state.state == "active" and self.now < end:
            self.run(0.1)
        assert state.state == "succeeded", state.reason

    def at(self, place: str) -> None:
        simulator = self.simulator
        where = simulator.layout.places[place]
        goal = simulator.layout.beside(where.x, where.y, simulator.layout.regions[place], 0.75)
        assert goal is not None
        simulator.driver.switch(NAVIGATION)
        self.until(simulator.navigate(goal), 120.0)
        self.run(0.5)
        assert simulator.body.pose.distance(goal.x, goal.y) < 0.25
        assert abs(wrapped(simulator.body.pose.yaw - goal.yaw)) < 0.25
        assert simulator.body.velocity == (0.0, 0.0)

    def arm(self, lift: float, extension: float) -> None:
        driver = self.simulator.driver
        driver.switch(POSITION)
        self.until(
            driver.follow(["joint_lift", "wrist_extension"], [Waypoint((lift, extension))]), 11.0
        )
        self.run(0.5)

    def skill(self, skill: str, thing: str, at: str) -> None:
        replies: list[Reply] = []
        self.simulator.perform(Request("1", skill, thing, at), replies.append)
        self.run(2.0)
        assert replies == [Reply("1", True)]


def test_it_rolls_on_its_wheels_carries_with_a_weld_and_things_have_weight() -> None:
    story = Story("dinner-party")
    simulator, body = story.simulator, story.body
    start = body.pose
    story.run(2.0)
    assert body.pose.distance(start.x, start.y) < 0.01
    assert abs(body.data.qpos[2]) < 0.01, "it stands on the floor"
    began = time.perf_counter()
    story.at("dining-table")
    assert story.now / (time.perf_counter() - began) > 1.0, "slower than real time"
    story.arm(0.85, 0.35)
    assert math.isclose(body.joints["joint_lift"], 0.85, abs_tol=0.02)
    story.skill("grasp", "cup", "dining-table")
    assert math.dist(simulator.scene.where("cup") or (), body.gripper) < 0.02
    story.arm(0.55, 0.0)
    story.at("countertop")
    assert math.dist(simulator.scene.where("cup") or (), body.gripper) < 0.03, "it was carried"
    story.arm(0.85, 0.35)
    # Let go in the air, it falls.
    height = (simulator.scene.where("cup") or (0, 0, 0))[2]
    body.grip(None)
    story.run(1.0)
    assert (simulator.scene.where("cup") or (0, 0, 0))[2] < height - 0.2
    body.grip("cup")
    story.skill("release", "cup", "countertop")
    story.run(1.0)
    where, top = simulator.scene.where("cup"), simulator.layout.places["countertop"]
    assert where is not None
    assert top.distance(*where[:2]) < 0.3
    assert math.isclose(where[2], 0.55, abs_tol=0.03)


def test_a_wall_stops_the_base_and_the_run_stop_all_of_it() -> None:
    story = Story("care-home")
    driver, body = story.simulator.driver, story.body
    driver.switch(NAVIGATION)
    for _ in range(200):
        driver.velocity(0.3, 0.0)
        story.run(0.1)
    assert body.pose.x < 2.5, "the wall of the room"
    for _ in range(10):
        driver.velocity(-0.3, 0.0)
        story.run(0.1)
    assert body.velocity[0] < -0.1
    driver.runstop(True)
    story.run(0.3)
    assert abs(body.velocity[0]) < 0.02
    at = body.pose
    story.run(1.0)
    assert body.pose.distance(at.x, at.y) < 0.01


def test_things_that_appear_vanish_and_are_taken_have_bodies() -> None:
    story = Story("dinner-party")
    scene = story.simulator.scene
    scene.add("vase", "sideboard")
    story.run(0.5)
    top = story.simulator.layout.places["sideboard"]
    where = scene.where("vase")
    assert where is not None
    assert top.distance(*where[:2]) < 0.3
    scene.remove("vase")
    assert scene.where("vase") is None
    scene.move("cup", "host")
    story.run(0.1)
    assert (scene.where("cup") or (0, 0, 0))[2] > 0.8


def test_pictures_show_robot_rooms_and_names() -> None:
    story = Story("care-home")
    simulator = story.simulator
    painter = Painter(simulator.world, simulator.layout, simulator.floor, simulator.body.pose)
    try:
        picture = painter.draw(snapshot(simulator, "robot: Lunch is ready."))
        again = painter.draw(snapshot(simulator, "robot: Lunch is ready."))
        simulator.scene.move("tray", "food-station")
        story.at("worktop")
        later = painter.draw(snapshot(simulator))
    finally:
        painter.close()
    assert picture.shape == (508, 1280, 3)
    assert np.array_equal(picture, again)
    near, far = picture[:480, :640], picture[:480, 640:]
    for view in (near, far):
        assert len(np.unique(view.reshape(-1, 3), axis=0)) > 100
        assert view.std() > 20
    assert (np.abs(near.astype(int) - later[:480, :640].astype(int)) > 20).mean() > 0.2
    changed = (np.abs(far.astype(int) - later[:480, 640:].astype(int)) > 20).mean()
    assert 0.0005 < changed < 0.1, "in the overview only the robot moves"


@pytest.mark.parametrize("name", ["run.mp4", "run.png"])
def test_a_run_is_drawn_into_a_file(start: Start, tmp_path: Path, name: str) -> None:
    path = tmp_path / name
    process, sim = start("--people", "none", "--speed", "2", "--render", str(path))
    assert process.ready["physics"]
    assert sim.call("/switch_to_navigation_mode")[0]
    standing = sim.layout.standing("home")
    assert standing is not None
    handle = sim.go(type(standing)(standing.x, standing.y - 0.8, 0.0))
    assert sim.outcome(handle)[0] == SUCCEEDED
    assert process.stop()["ready"] is False
    if path.suffix == ".png":
        picture = np.asarray(Image.open(path))
        assert picture.std() > 20
        return
    with av.open(str(path)) as film:
        frames = [frame.to_ndarray(format="rgb24") for frame in film.decode(video=0)]
    assert len(frames) >= 5
    assert frames[0].std() > 20
    assert np.abs(frames[0].astype(int) - frames[-1].astype(int)).mean() > 2
