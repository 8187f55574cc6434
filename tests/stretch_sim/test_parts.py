"""The simulator's pure parts, without ROS: driver, trajectories, floor, people, faults."""

from __future__ import annotations

import math
from itertools import pairwise
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from polaris_nl.execution.ros.layout import Layout, Pose
from polaris_nl.execution.ros.stretch_sim.body import KinematicBody
from polaris_nl.execution.ros.stretch_sim.driver import NAVIGATION, SILENCE_S, TRAJECTORY, Driver
from polaris_nl.execution.ros.stretch_sim.faults import Mishaps, parse_fault
from polaris_nl.execution.ros.stretch_sim.floor import ROBOT_RADIUS_M, Floor, floor_of, read_map
from polaris_nl.execution.ros.stretch_sim.joints import JOINTS, ROTATE, TRANSLATE
from polaris_nl.execution.ros.stretch_sim.simulator import Options, Simulator
from polaris_nl.execution.ros.stretch_sim.skills import Reply, Request
from polaris_nl.execution.ros.stretch_sim.speech import Saying
from polaris_nl.execution.ros.stretch_sim.trajectory import Waypoint
from polaris_nl.model.errors import FormatError, RunError, UsageError
from polaris_nl.model.formula import parse_literal
from polaris_nl.model.world import World
from polaris_nl.model.world_file import load_world

STEP = 0.02


class Bench:
    """A driver with a body on an endless floor."""

    def __init__(self) -> None:
        self.body = KinematicBody(Pose(0.0, 0.0), lambda x, y: True)
        self.mishaps = Mishaps()
        self.now = 100.0
        self.driver = Driver(self.body, self.mishaps, self.now)

    def run(self, seconds: float) -> None:
        for _ in range(round(seconds / STEP)):
            self.now += STEP
            self.driver.step(self.now, STEP)
            self.body.step(STEP)


def test_a_velocity_is_withdrawn_after_silence_and_no_sooner() -> None:
    bench = Bench()
    assert not bench.driver.velocity(0.2, 0.0)
    bench.driver.switch(NAVIGATION)
    assert bench.driver.velocity(0.2, 0.0)
    bench.run(SILENCE_S - STEP)
    assert bench.body.velocity[0] > 0.15
    bench.run(0.5)
    assert bench.body.velocity == (0.0, 0.0)


def test_the_run_stop_zeroes_velocity_at_once() -> None:
    bench = Bench()
    bench.driver.switch(NAVIGATION)
    bench.driver.velocity(0.2, 0.5)
    bench.run(0.3)
    bench.driver.runstop(True)
    assert bench.body.velocity == (0.0, 0.0)
    at = bench.body.pose
    assert not bench.driver.velocity(0.2, 0.0)
    bench.run(1.0)
    assert bench.body.pose == at


@given(
    st.lists(
        st.sampled_from(
            [
                "navigate",
                "position",
                "drive",
                "arm",
                "home",
                "stow",
                "stop",
                "press",
                "release",
                "wait",
            ]
        ),
        max_size=25,
    )
)
def test_whatever_is_commanded_limits_hold_and_a_pressed_run_stop_means_rest(
    commands: list[str],
) -> None:
    bench = Bench()
    driver = bench.driver
    for command in commands:
        match command:
            case "navigate" | "position":
                driver.switch(NAVIGATION if command == "navigate" else "position")
            case "drive":
                driver.velocity(3.0, -5.0)
            case "arm":
                if not driver.refuses(bench.now):
                    driver.follow(["joint_lift", "wrist_extension"], [Waypoint((1.0, 0.5))])
            case "press" | "release":
                driver.runstop(command == "press")
            case "home":
                driver.home()
            case "stow":
                driver.stow()
            case "stop":
                driver.stop()
        before = bench.body.pose, dict(bench.body.joints)
        bench.run(0.3)
        for name, value in bench.body.joints.items():
            assert JOINTS[name].allows(value)
        assert abs(bench.body.velocity[0]) <= 0.3 + 1e-9
        if driver.runstopped:
            assert (bench.body.pose, dict(bench.body.joints)) == before


@pytest.mark.parametrize(
    ("names", "points", "word"),
    [
        ((), (), "no points"),
        (("joint_lift",), (Waypoint((0.1, 0.2)),), "for each joint"),
        (("joint_lift",), (Waypoint((9.0,)),), "joint_lift"),
        (("nose",), (Waypoint((0.1,)),), "nose"),
        ((TRANSLATE, ROTATE), (Waypoint((0.1, 0.1)),), "at once"),
    ],
)
def test_wrong_trajectories_are_aborted_with_a_reason(
    names: tuple[str, ...], points: tuple[Waypoint, ...], word: str
) -> None:
    bench = Bench()
    trajectory = bench.driver.follow(names, points)
    assert (trajectory.state, trajectory.invalid) == ("aborted", True)
    assert word in trajectory.reason


def test_times_that_do_not_rise_are_wrong_in_trajectory_mode_only() -> None:
    points = [Waypoint((0.5,), 2.0), Waypoint((0.6,), 1.0)]
    bench = Bench()
    trajectory = bench.driver.follow(["joint_lift"], points)
    bench.run(4.0)
    assert trajectory.state == "succeeded"
    bench.driver.switch(TRAJECTORY)
    assert "rise" in bench.driver.follow(["joint_lift"], points).reason


def test_a_point_that_is_never_reached_is_given_up_after_ten_seconds() -> None:
    bench = Bench()
    trajectory = bench.driver.follow(["joint_lift"], [Waypoint((1.0,))])
    bench.run(0.5)
    bench.driver.stop()
    bench.run(9.0)
    assert trajectory.state == "active"
    bench.run(1.0)
    assert trajectory.state == "aborted"


# The floor


@pytest.fixture(scope="module", params=["care-home", "dinner-party"])
def world(request: pytest.FixtureRequest) -> World:
    return load_world(request.param)


@pytest.fixture(scope="module")
def layout(world: World) -> Layout:
    return Layout.of(world)


@pytest.fixture(scope="module")
def floor(world: World, layout: Layout) -> Floor:
    return floor_of(layout, world.map)


def test_every_region_and_piece_of_furniture_is_reached_without_touching_walls(
    layout: Layout, floor: Floor
) -> None:
    start = layout.standing("home")
    assert start is not None
    goals = [layout.standing(region) for region in layout.areas]
    goals += [
        layout.beside(at.x, at.y, layout.regions[name], 0.75) for name, at in layout.places.items()
    ]
    for goal in goals:
        assert goal is not None
        free = floor.nearest(goal.x, goal.y, 0.5)
        assert free is not None
        way = [(start.x, start.y), *floor.route((start.x, start.y), free)]
        assert way[-1] == free
        for a, b in pairwise(way):
            assert floor.sees(a, b, ROBOT_RADIUS_M * 0.9)


def test_walls_cover_what_is_solid_and_leave_doors_open(layout: Layout, floor: Floor) -> None:
    walls = floor.walls(layout)
    assert 10 < len(walls) < 80
    for name in layout.areas:
        middle = layout.standing(name)
        assert middle is not None
        assert not any(wall.holds(middle.x, middle.y) for wall in walls)
    left, bottom = min(w.left for w in walls), min(w.bottom for w in walls)
    assert any(w.holds(left + 0.02, bottom + 0.02) for w in walls)


def test_maps_that_cannot_be_read_say_so(tmp_path: Path) -> None:
    path = tmp_path / "x.map.yaml"
    with pytest.raises(FormatError, match="can't be read"):
        read_map(path)
    path.write_text("image: x.pgm\nresolution: 0.05\norigin: [0, 0, 0]\n")
    (tmp_path / "x.pgm").write_bytes(b"P2\n2 2\n255\n0 0 0 0\n")
    with pytest.raises(FormatError, match="8-bit PGM"):
        read_map(path)
    (tmp_path / "x.pgm").write_bytes(b"P5\n# made by hand\n2 2\n255\n\xfe\xfe\x00\xfe")
    floor = read_map(path)
    assert floor.solid == bytes([1, 0, 0, 0])


def test_a_world_without_a_map_file_has_furniture_in_the_way(layout: Layout) -> None:
    floor = floor_of(layout, None)
    place = next(iter(layout.places.values()))
    assert not floor.fits(place.x, place.y)
    area = next(iter(layout.areas.values()))
    assert floor.route(area.middle, (area.left + 0.5, area.bottom + 0.5))


# The whole, without ROS


class Story:
    """A kinematic simulation in which time is let pass."""

    def __init__(self, world: str, people: tuple[str, ...] | None = (), **options: float) -> None:
        self.simulator = Simulator(load_world(world), 0.0, Options(people, **options))
        self.now = 0.0
        self.said: list[Saying] = []
        self.deeds: list[str] = []
        self.simulator.step(0.0)

    def run(self, seconds: float) -> None:
        for _ in range(round(seconds / STEP)):
            self.now += STEP
            happened = self.simulator.step(self.now)
            self.said += happened.said
            self.deeds += [d.action.name for d in happened.deeds]

    def facts(self) -> set[str]:
        return set(map(str, self.simulator.scene.state.facts))


def test_people_choose_as_told_wait_a_little_and_act_again_only_where_it_is_undone() -> None:
    for people, expected in (
        (None, ["acknowledge", "walk to her room"]),
        (("dismiss",), ["dismiss"]),
        ((), []),
    ):
        story = Story("care-home", people)
        story.simulator.scene.make_true([parse_literal("(alerted-to resident lunchtime)")])
        story.run(3.0)
        assert story.deeds == []
        story.run(40.0)
        assert story.deeds == expected
    assert "(acknowledged lunchtime)" not in story.facts()
    story = Story("dinner-party", None)
    for times in (1, 2):
        story.simulator.scene.move("cup", "countertop")
        story.run(9.0)
        assert story.deeds == ["wash the cup"] * times
        assert {"(at cup drying-rack)", "(is-clean cup)"} <= story.facts()


def test_who_is_in_another_room_is_not_told() -> None:
    story = Story("care-home")
    story.simulator.say(Saying("resident", "lunchtime", "Lunch is ready."))
    story.run(5.0)
    assert story.said == []
    story.simulator.scene.make_true([parse_literal("(person-in resident home)")])
    story.run(40.0)
    assert "(person-in resident home)" in story.facts()
    story.simulator.say(Saying("resident", "lunchtime", "Lunch is ready."))
    story.run(5.0)
    assert [s.message for s in story.said] == ["lunchtime"]
    assert "(alerted-to resident lunchtime)" in story.facts()


def test_what_somebody_takes_from_the_gripper_is_gone_from_it() -> None:
    story = Story("care-home")
    scene = story.simulator.scene
    scene.make_true([parse_literal("(holding cup)")])
    story.run(0.1)
    assert scene.where("cup") == scene.body.gripper
    scene.make_true([parse_literal("(has caregiver cup)")])
    story.run(0.1)
    assert scene.held is None
    assert "(hand-empty)" in story.facts()
    assert math.dist(scene.where("cup") or (), scene.body.gripper) > 1.0


def test_a_skill_is_checked_again_when_its_time_has_come() -> None:
    story = Story("care-home")
    simulator = story.simulator
    place = simulator.layout.places["worktop"]
    pose = simulator.layout.beside(place.x, place.y, "kitchen", 0.75)
    assert pose is not None
    simulator.driver.switch(NAVIGATION)
    navigation = simulator.navigate(pose)
    story.run(120.0)
    assert navigation.state == "succeeded"
    simulator.driver.switch("position")
    simulator.driver.follow(["joint_lift", "wrist_extension"], [Waypoint((0.8, 0.35))])
    story.run(3.0)
    replies: list[Reply] = []
    simulator.perform(Request("1", "grasp", "cup", "worktop"), replies.append)
    simulator.perform(Request("2", "grasp", "cup", "worktop"), replies.append)
    assert replies == [Reply("2", False, "another skill is under way")]
    simulator.scene.move("cup", "desk")
    story.run(2.0)
    assert replies[1:] == [Reply("1", False, "cup isn't at worktop")]
    simulator.scene.move("cup", "worktop")
    simulator.perform(Request("3", "grasp", "cup", "worktop"), replies.append)
    story.run(0.2)
    simulator.driver.runstop(True)
    story.run(0.2)
    assert replies[2:] == [Reply("3", False, "the run-stop is pressed")]


@pytest.mark.parametrize(
    ("text", "word"),
    [
        ("nonsense", "JSON object"),
        ("[1]", "JSON object"),
        ('{"fault": "rejct"}', "reject"),
        ('{"fault": "reject", "of": "dancing"}', "dancing"),
        ('{"fault": "reject", "often": 3}', "often"),
        ('{"fault": "event", "literals": ["(open"]}', "event"),
        ('{"fault": "blind", "seconds": "long"}', "blind"),
    ],
)
def test_faults_that_cannot_be_read_are_named(text: str, word: str) -> None:
    with pytest.raises(UsageError, match=word):
        parse_fault(text)


def test_faults_about_things_that_are_not_there_are_named() -> None:
    story = Story("care-home")
    for text, word in (
        ('{"fault": "move", "object": "cup", "to": "moon"}', "moon"),
        ('{"fault": "move", "object": "cap", "to": "desk"}', "cup"),
        ('{"fault": "remove", "object": "unicorn"}', "unicorn"),
        ('{"fault": "add", "object": "desk", "to": "table"}', "desk"),
    ):
        with pytest.raises(UsageError, match=word):
            story.simulator.strike(parse_fault(text))
    before = story.facts()
    story.simulator.strike(parse_fault('{"fault": "add", "object": "vase", "to": "desk"}'))
    assert story.facts() - before == {"(at vase desk)"}


def test_a_world_without_areas_is_refused_with_a_way_out(tmp_path: Path) -> None:
    path = tmp_path / "flat.yaml"
    path.write_text(
        "schema: polaris-world/1\nname: flat\ndomain: caregiving\n"
        "entities:\n  - {name: home, type: region}\n"
        'facts: ["(robot-at home)", "(hand-empty)"]\n'
    )
    with pytest.raises(RunError, match="give each region an area"):
        Simulator(load_world(str(path)), 0.0)
