"""From poses and detections to facts with times and sources. Pure.

What can have one value only is one variable: the region of the robot or a person, the place of an
object, the truth of an atom. A new value is believed when it has been seen for a while, so that a
flicker changes nothing. What is in sight and isn't seen any more is unknown after a while, never
false; what is out of sight is remembered for longer. Times are those of the run's clock, in seconds.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace

from polaris_nl.execution.ros.layout import Layout
from polaris_nl.execution.ros.profile import Sight
from polaris_nl.model.formula import Literal
from polaris_nl.model.state import Mutexes, State
from polaris_nl.model.world import World

PLACES = ("at", "in", "has", "holding")
"""Where an object is: in exactly one of these."""
ROBOT = Literal("robot-at")
HAND = Literal("hand-empty")
GAP_S = 1.0
"""Looks that are further apart don't confirm each other."""
ASSUMED = "assumed"
HEARD = "speech"

Variable = Literal
"""What has one value: `(robot-at)`, `(person-in resident)`, `(at cup)` for its place, an atom for its truth."""

_Look = tuple[Variable, Literal | None, float, str]
"""What is seen of a variable: its value, when, and by what."""


@dataclass(frozen=True, slots=True)
class Seen:
    """A marker: what it is, where (m, on the map), and when it was seen."""

    name: str
    kind: str
    x: float
    y: float
    z: float
    stamp: float


@dataclass(frozen=True, slots=True)
class Detected:
    """What a detector says about an atom."""

    literal: Literal
    stamp: float


@dataclass(frozen=True)
class Percepts:
    """The latest of everything that was perceived.

    Attributes:
        base: the robot's x, y and heading on the map; None until it is known.
        base_stamp: when that was.
        markers: the latest marker of each entity.
        detected: the latest word of the detectors on each atom, and `detected_at`, when they last spoke.
        heard: what people said, in order; it stays true until they say otherwise.
    """

    base: tuple[float, float, float] | None = None
    base_stamp: float = -1.0
    markers: Mapping[str, Seen] = field(default_factory=dict)
    detected: Mapping[Literal, Detected] = field(default_factory=dict)
    detected_at: float = -1.0
    heard: tuple[Detected, ...] = ()


@dataclass(frozen=True)
class Scene:
    """What perception goes by, the same during a run.

    Attributes:
        layout: the map.
        how: how patient perception is.
        mutexes: what excludes what, for what people say.
        choices: for each variable that has several values, all of them.
    """

    layout: Layout
    how: Sight
    mutexes: Mutexes
    choices: Mapping[Variable, frozenset[Literal]]

    @classmethod
    def of(cls, world: World, how: Sight, mutexes: Mutexes) -> Scene:
        """The scene of a world."""
        return cls(Layout.of(world), how, mutexes, choices_of(world))


@dataclass(frozen=True, slots=True)
class Belief:
    """What is believed of a variable.

    Attributes:
        value: an atom, or None for "none of them".
        stamp, source: when and by what it was last confirmed.
        other: another value that has been seen since `other_since`, last at `other_stamp`, and isn't
            believed yet.
    """

    value: Literal | None
    stamp: float
    source: str
    other: Literal | None = None
    other_since: float | None = None
    other_stamp: float = -1.0


@dataclass(frozen=True)
class Memory:
    """All beliefs, the facts that never change, and since when it is kept."""

    static: frozenset[Literal]
    beliefs: Mapping[Variable, Belief]
    since: float
    heard: int = 0


def remembered(world: World, now: float, state: State | None = None) -> Memory:
    """What is believed before anything is seen: a state (the world's at its start), as an assumption."""
    facts = (state or world.initial).facts
    changing = [p for p in world.domain.predicates if _changes(world, p)]
    static = frozenset(f for f in facts if f.predicate not in changing)
    beliefs = {
        variable_of(f): Belief(f, now, ASSUMED)
        for f in facts
        if f.predicate in changing and f != HAND
    }
    return Memory(static, beliefs, now)


def _changes(world: World, predicate: str) -> bool:
    return world.domain.robot_can_change(predicate) or world.domain.people_can_change(predicate)


def perceive(memory: Memory, percepts: Percepts, now: float, scene: Scene) -> Memory:
    """Takes percepts in.

    Args:
        memory: what was believed before.
        percepts: the latest of everything.
        now: the time.
        scene: what perception goes by.

    Returns:
        What is believed now.
    """
    beliefs = dict(memory.beliefs)
    for variable, value, stamp, source in _values(memory, percepts, now, scene):
        before = beliefs.get(variable, Belief(None, memory.since, ASSUMED))
        beliefs[variable] = _believe(before, value, stamp, source, scene.how.settle_s)
    for word in percepts.heard[memory.heard :]:
        for rival in [b.value for b in beliefs.values() if b.value is not None]:
            if word.literal.positive and scene.mutexes.exclusive(word.literal, rival):
                beliefs[variable_of(rival)] = Belief(None, word.stamp, HEARD)
        value = word.literal if word.literal.positive else None
        beliefs[variable_of(word.literal.atom)] = Belief(value, word.stamp, HEARD)
    return replace(memory, beliefs=beliefs, heard=len(percepts.heard))


def _believe(
    before: Belief,
    value: Literal | None,
    stamp: float,
    source: str,
    settle_s: float,
) -> Belief:
    """One variable after one look at it."""
    if stamp < before.stamp:
        return before
    if value == before.value:
        return Belief(value, stamp, source)
    since = before.other_since
    if value != before.other or since is None or stamp - before.other_stamp > GAP_S:
        return replace(before, other=value, other_since=stamp, other_stamp=stamp)
    if stamp - since >= settle_s:
        return Belief(value, stamp, source)
    return replace(before, other_stamp=stamp)


def _values(memory: Memory, percepts: Percepts, now: float, scene: Scene) -> Iterator[_Look]:
    """What is seen of each variable: its value, when, and by what."""
    layout, how = scene.layout, scene.how

    def fresh(stamp: float) -> bool:
        return 0.0 <= now - stamp <= how.stale_s

    if percepts.base is not None and fresh(percepts.base_stamp):
        before = memory.beliefs.get(ROBOT)
        was = before.value.args[0] if before is not None and before.value is not None else ""
        region = layout.region_at(*percepts.base[:2], was)
        place = Literal("robot-at", (region,)) if region else None
        yield ROBOT, place, percepts.base_stamp, "odometry"
    told: set[Variable] = set()
    if fresh(percepts.detected_at):
        for atom, word in percepts.detected.items():
            if atom == HAND or not fresh(word.stamp):
                continue  # Whether the hand is empty follows from what it holds.
            if word.literal.positive:
                told.add(variable_of(atom))
                yield variable_of(atom), atom, word.stamp, "detector"
            elif variable_of(atom) == atom:
                told.add(atom)
                yield atom, None, word.stamp, "detector"
        yield from _silent(memory, percepts, told, fresh, how)
    for marker in percepts.markers.values():
        if fresh(marker.stamp):
            yield from _placed(marker, memory, told, layout, how)


def _placed(
    marker: Seen, memory: Memory, told: set[Variable], layout: Layout, how: Sight
) -> Iterator[_Look]:
    """What a marker's place says."""
    if marker.kind == "person":
        variable = Literal("person-in", (marker.name,))
        before = memory.beliefs.get(variable)
        was = before.value.args[1] if before is not None and before.value is not None else ""
        region = layout.region_at(marker.x, marker.y, was)
        value = Literal("person-in", (marker.name, region)) if region else None
        yield variable, value, marker.stamp, "camera"
    elif marker.kind == "object" and (variable := Literal("at", (marker.name,))) not in told:
        place = layout.place_at(marker.x, marker.y, how.near_m)
        predicate = "in" if place in layout.containers else "at"
        value = Literal(predicate, (marker.name, place)) if place else None
        yield variable, value, marker.stamp, "camera"


def _silent(
    memory: Memory,
    percepts: Percepts,
    told: set[Variable],
    fresh: Callable[[float], bool],
    how: Sight,
) -> Iterator[_Look]:
    """What detectors didn't say though its subject was in sight even after that: it is false now.

    A subject that was seen only before the detectors spoke may have gone out of sight since: as the robot
    leaves a room, silence tells nothing.
    """
    for variable, belief in memory.beliefs.items():
        watched = variable.predicate in how.detects and variable.args and variable not in told
        if not watched or belief.value is None or variable.predicate in PLACES:
            continue
        marker = percepts.markers.get(variable.args[0])
        if marker is not None and marker.stamp >= percepts.detected_at and fresh(marker.stamp):
            yield variable, None, percepts.detected_at, "detector"


def variable_of(atom: Literal) -> Variable:
    """The variable that an atom is a value of."""
    if atom.predicate == "robot-at":
        return ROBOT
    if atom.predicate == "person-in":
        return Literal("person-in", atom.args[:1])
    if atom.predicate in PLACES and atom.args:
        return Literal("at", (atom.args[-1] if atom.predicate == "has" else atom.args[0],))
    return atom


def choices_of(world: World) -> dict[Variable, frozenset[Literal]]:
    """All values of each variable that has several: places of objects, regions of people and robot."""
    regions = [e.name for e in world.of_type("region")]
    found = {ROBOT: frozenset(Literal("robot-at", (r,)) for r in regions)}
    people = [e.name for e in world.of_type("person")]
    for person in people:
        where = frozenset(Literal("person-in", (person, r)) for r in regions)
        found[Literal("person-in", (person,))] = where
    surfaces = [e.name for e in world.of_type("surface")]
    containers = [e.name for e in world.of_type("container")]
    for thing in (e.name for e in world.of_type("object")):
        found[Literal("at", (thing,))] = frozenset(
            [
                *(Literal("at", (thing, s)) for s in surfaces),
                *(Literal("in", (thing, c)) for c in containers),
                *(Literal("has", (p, thing)) for p in people),
                Literal("holding", (thing,)),
            ]
        )
    return found
