"""Perception as pure functions: poses and detections to facts, with patience."""

from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from polaris_nl.execution.ros.knowledge import facts, sightings, unknown
from polaris_nl.execution.ros.perception import (
    Detected,
    Memory,
    Percepts,
    Scene,
    Seen,
    perceive,
    remembered,
    variable_of,
)
from polaris_nl.execution.ros.profile import Sight, profile_for
from polaris_nl.model.formula import Literal, parse_literal
from polaris_nl.planning.planner import Planner

T0 = 100.0
HOW = profile_for("stretch-sim").perception
LONG = HOW.stale_s + 0.5


def scene(care: Planner, how: Sight = HOW) -> Scene:
    return Scene.of(care.world, how, care.mutexes)


def lit(text: str) -> Literal:
    return parse_literal(text)


def at(scene: Scene, place: str, now: float) -> Percepts:
    """What is perceived from the middle of a region."""
    pose = scene.layout.standing(place)
    assert pose is not None
    return Percepts(base=(pose.x, pose.y, 0.0), base_stamp=now, detected_at=now)


def seen(scene: Scene, name: str, kind: str, place: str, stamp: float) -> Seen:
    where = scene.layout.places.get(place) or scene.layout.standing(place)
    assert where is not None
    return Seen(name, kind, where.x + 0.1, where.y, 0.8, stamp)


def watch(scene: Scene, memory: Memory, look: Percepts, start: float, seconds: float) -> Memory:
    """Looks at the same again and again, with fresh stamps."""
    for step in range(int(seconds / 0.1) + 1):
        now = start + step * 0.1
        fresh = replace(
            look,
            base_stamp=now,
            detected_at=now,
            markers={n: replace(m, stamp=now) for n, m in look.markers.items()},
            detected={a: replace(d, stamp=now) for a, d in look.detected.items()},
        )
        memory = perceive(memory, fresh, now, scene)
    return memory


def test_before_anything_is_seen_the_world_file_is_assumed(care: Planner) -> None:
    memory = remembered(care.world, T0)
    assert facts(memory) == care.world.initial
    assert {s.source for s in sightings(memory).values()} == {"assumed"}


def test_the_robot_is_where_its_base_is(care: Planner) -> None:
    s = scene(care)
    memory = watch(s, remembered(care.world, T0), at(s, "cafeteria", T0), T0, 0.5)
    assert lit("(robot-at cafeteria)") in facts(memory)
    assert lit("(robot-at home)") not in facts(memory)


def test_at_a_door_it_stays_in_the_region_that_it_comes_from(care: Planner) -> None:
    s = scene(care)
    memory = remembered(care.world, T0)
    for step, y in enumerate((3.8, 3.95, 4.05, 3.97, 4.1, 4.2)):
        look = Percepts(base=(1.2, y, 0.0), base_stamp=T0 + step)
        memory = perceive(memory, look, T0 + step, s)
        assert lit("(robot-at home)") in facts(memory)
    memory = watch(s, memory, Percepts(base=(1.2, 4.6, 0.0)), T0 + 10, 0.5)
    assert lit("(robot-at hall)") in facts(memory)


def test_an_object_is_on_the_surface_that_it_is_near(care: Planner) -> None:
    s = scene(care)
    tray = seen(s, "tray", "object", "dining-table", T0)
    look = replace(at(s, "cafeteria", T0), markers={"tray": tray})
    memory = watch(s, remembered(care.world, T0), look, T0, 0.5)
    assert lit("(at tray dining-table)") in facts(memory)
    assert lit("(at tray empty-trays)") not in facts(memory)
    assert sightings(memory)[lit("(at tray dining-table)")].source == "camera"


def test_in_a_container_it_is_in_and_far_from_everything_it_is_nowhere(care: Planner) -> None:
    s = scene(care)
    look = replace(at(s, "kitchen", T0), markers={"cup": seen(s, "cup", "object", "fridge", T0)})
    memory = watch(s, remembered(care.world, T0), look, T0, 0.5)
    assert lit("(in cup fridge)") in facts(memory)
    floor = replace(look, markers={"cup": Seen("cup", "object", 4.3, 3.0, 0.0, T0)})
    memory = watch(s, memory, floor, T0 + 1, 0.5)
    assert not [f for f in facts(memory).facts if f.args[:1] == ("cup",)]


def test_a_flicker_changes_nothing(care: Planner) -> None:
    s = scene(care)
    memory = remembered(care.world, T0)
    for step in range(40):
        place = ("empty-trays", "dining-table")[step % 2]
        now = T0 + step * 0.1
        look = replace(
            at(s, "cafeteria", now), markers={"tray": seen(s, "tray", "object", place, now)}
        )
        memory = perceive(memory, look, now, s)
        assert lit("(at tray empty-trays)") in facts(memory)


def test_two_glimpses_far_apart_confirm_nothing(care: Planner) -> None:
    s = scene(care)
    memory = remembered(care.world, T0)
    for now in (T0, T0 + 5.0, T0 + 10.0):
        word = Detected(lit("(acknowledged lunchtime)"), now)
        look = replace(at(s, "home", now), detected={word.literal: word})
        memory = perceive(memory, look, now, s)
    assert lit("(acknowledged lunchtime)") not in facts(memory)


def test_what_should_be_in_sight_and_is_not_is_unknown_and_never_false(care: Planner) -> None:
    s = scene(care)
    memory = watch(s, remembered(care.world, T0), at(s, "cafeteria", T0), T0, LONG)
    now = T0 + LONG
    gone = unknown(memory, at(s, "cafeteria", now), now, s)
    assert lit("(at tray empty-trays)") in facts(memory)
    assert {lit("(at tray empty-trays)"), lit("(at tray table)"), lit("(holding tray)")} <= gone
    # What is elsewhere is remembered.
    assert not [f for f in gone if "blue-cup" in f.args]


def test_the_same_out_of_sight_is_remembered_for_longer_and_then_unknown(care: Planner) -> None:
    s = scene(care)
    memory = watch(s, remembered(care.world, T0), at(s, "home", T0), T0, LONG)
    now = T0 + LONG
    assert not unknown(memory, at(s, "home", now), now, s)
    later = T0 + HOW.memory_s + 1
    memory = perceive(memory, at(s, "home", later), later, s)
    assert lit("(at tray empty-trays)") in unknown(memory, at(s, "home", later), later, s)


def test_nobody_sees_into_a_closed_cupboard(care: Planner) -> None:
    s = scene(care)
    memory = watch(s, remembered(care.world, T0), at(s, "kitchen", T0), T0, LONG)
    gone = unknown(memory, at(s, "kitchen", T0 + LONG), T0 + LONG, s)
    assert lit("(at cup worktop)") in gone
    assert lit("(in plate cupboard)") not in gone


def test_with_markers_only_what_lies_on_a_seen_surface_is_missed(care: Planner) -> None:
    s = scene(care, replace(HOW, sight="marker"))
    look = at(s, "cafeteria", T0)
    memory = watch(s, remembered(care.world, T0), look, T0, LONG)
    assert not unknown(memory, look, T0 + LONG, s)
    look = replace(
        look, markers={"empty-trays": seen(s, "empty-trays", "surface", "empty-trays", T0)}
    )
    memory = watch(s, memory, look, T0 + LONG, LONG)
    now = T0 + 2 * LONG
    fresh = {n: replace(m, stamp=now) for n, m in look.markers.items()}
    assert lit("(at tray empty-trays)") in unknown(memory, replace(look, markers=fresh), now, s)


def test_old_stamps_are_no_sightings(care: Planner) -> None:
    s = scene(care)
    memory = remembered(care.world, T0)
    for step in range(30):
        now = T0 + step * 0.1
        old = seen(s, "tray", "object", "dining-table", T0 - 30.0)
        memory = perceive(memory, replace(at(s, "cafeteria", now), markers={"tray": old}), now, s)
    assert lit("(at tray dining-table)") not in facts(memory)


def test_detectors_tell_what_geometry_cannot_and_their_silence_means_false(care: Planner) -> None:
    s = scene(care)
    cup = seen(s, "cupboard", "container", "cupboard", T0)
    words = {lit("(open cupboard)"): Detected(lit("(open cupboard)"), T0)}
    look = replace(at(s, "kitchen", T0), markers={"cupboard": cup}, detected=words)
    memory = watch(s, remembered(care.world, T0), look, T0, 0.5)
    assert lit("(open cupboard)") in facts(memory)
    memory = watch(s, memory, replace(look, detected={}), T0 + 1, 0.5)
    assert lit("(open cupboard)") not in facts(memory)
    # The laundry basket isn't seen from here: no word about it means nothing.
    assert lit("(open laundry-basket)") in facts(memory)


def test_leaving_a_room_makes_nothing_false_there(care: Planner) -> None:
    s = scene(care)
    full = lit("(is-full tray)")
    look = replace(
        at(s, "room-1", T0),
        markers={"tray": seen(s, "tray", "object", "table", T0)},
        detected={full: Detected(full, T0)},
    )
    memory = watch(s, remembered(care.world, T0), look, T0, 1.0)
    assert full in facts(memory)
    # The detectors go on, about another room; what was seen of this one is still fresh for a while.
    for step in range(1, 15):
        now = T0 + 1.0 + step * 0.1
        gone = replace(
            at(s, "hall", now), markers={"tray": replace(look.markers["tray"], stamp=T0 + 1.0)}
        )
        memory = perceive(memory, gone, now, s)
    assert full in facts(memory)


def test_what_is_held_is_not_on_the_table_that_it_hangs_over(care: Planner) -> None:
    s = scene(care)
    word = Detected(lit("(holding tray)"), T0)
    look = replace(
        at(s, "cafeteria", T0),
        markers={"tray": seen(s, "tray", "object", "empty-trays", T0)},
        detected={word.literal: word},
    )
    memory = watch(s, remembered(care.world, T0), look, T0, 0.5)
    assert lit("(holding tray)") in facts(memory)
    assert lit("(hand-empty)") not in facts(memory)
    assert lit("(at tray empty-trays)") not in facts(memory)
    memory = watch(s, memory, replace(look, detected={}), T0 + 1, 0.5)
    assert lit("(at tray empty-trays)") in facts(memory)
    assert lit("(hand-empty)") in facts(memory)


def test_what_people_say_holds_at_once_and_until_they_say_otherwise(care: Planner) -> None:
    s = scene(care)
    yes = Detected(lit("(acknowledged lunchtime)"), T0)
    look = replace(at(s, "home", T0), heard=(yes,))
    memory = perceive(remembered(care.world, T0), look, T0, s)
    assert yes.literal in facts(memory)
    later = T0 + HOW.memory_s * 2
    memory = perceive(memory, replace(look, base_stamp=later), later, s)
    assert yes.literal in facts(memory)
    assert yes.literal not in unknown(memory, look, later, s)
    no = Detected(lit("(dismissed lunchtime)"), later)
    memory = perceive(memory, replace(look, heard=(yes, no)), later, s)
    assert no.literal in facts(memory)
    assert yes.literal not in facts(memory)


def test_what_contradicts_itself_is_unknown(care: Planner) -> None:
    s = scene(care)
    both = [lit("(acknowledged lunchtime)"), lit("(dismissed lunchtime)")]
    look = replace(at(s, "home", T0), detected={x: Detected(x, T0) for x in both})
    memory = watch(s, remembered(care.world, T0), look, T0, 0.5)
    assert set(both) <= unknown(memory, look, T0 + 0.5, s)


def test_a_person_is_in_the_region_where_she_is_seen(care: Planner) -> None:
    s = scene(care)
    look = replace(
        at(s, "room-1", T0), markers={"resident": seen(s, "resident", "person", "room-1", T0)}
    )
    memory = watch(s, remembered(care.world, T0), look, T0, 0.5)
    assert lit("(person-in resident room-1)") in facts(memory)
    assert lit("(person-in resident recreation-area)") not in facts(memory)


@pytest.mark.parametrize(
    ("atom", "variable"),
    [
        ("(at cup table)", "(at cup)"),
        ("(in cup fridge)", "(at cup)"),
        ("(holding cup)", "(at cup)"),
        ("(has resident cup)", "(at cup)"),
        ("(robot-at home)", "(robot-at)"),
        ("(person-in resident home)", "(person-in resident)"),
        ("(open fridge)", "(open fridge)"),
    ],
)
def test_variables(atom: str, variable: str) -> None:
    assert variable_of(lit(atom)) == lit(variable)


@given(
    st.lists(
        st.tuples(
            st.sampled_from(["tray", "cup", "blue-cup"]),
            st.floats(-1, 17),
            st.floats(-1, 12),
            st.booleans(),
            st.booleans(),
        ),
        max_size=30,
    )
)
def test_an_object_is_never_believed_to_be_in_two_places(
    care: Planner, looks: list[tuple[str, float, float, bool, bool]]
) -> None:
    s = scene(care)
    memory = remembered(care.world, T0)
    for step, (name, x, y, held, old) in enumerate(looks):
        now = T0 + step * 0.2
        stamp = now - (30.0 if old else 0.0)
        word = Literal("holding", (name,))
        look = replace(
            at(s, "hall", now),
            markers={name: Seen(name, "object", x, y, 0.5, stamp)},
            detected={word: Detected(word, stamp)} if held else {},
        )
        memory = perceive(memory, look, now, s)
        state = facts(memory)
        places = [f for f in state.facts if f.predicate in ("at", "in", "holding", "has")]
        things = [variable_of(f) for f in places]
        assert len(things) == len(set(things))
        assert (lit("(hand-empty)") in state) == (not any(f.predicate == "holding" for f in places))
