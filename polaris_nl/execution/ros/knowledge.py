"""What is known, and what isn't, of what was perceived. Pure."""

from __future__ import annotations

from dataclasses import dataclass

from polaris_nl.execution.backend import Sighting
from polaris_nl.execution.beliefs import contradicted
from polaris_nl.execution.ros.perception import (
    HAND,
    HEARD,
    ROBOT,
    Belief,
    Memory,
    Percepts,
    Scene,
    Variable,
)
from polaris_nl.model.formula import Literal
from polaris_nl.model.state import State


def facts(memory: Memory) -> State:
    """The facts that are believed, unknown ones included; the hand is empty where it holds nothing."""
    believed = {b.value for b in memory.beliefs.values() if b.value is not None}
    if not any(fact.predicate == "holding" for fact in believed):
        believed.add(HAND)
    return State(memory.static | believed)


def sightings(memory: Memory) -> dict[Literal, Sighting]:
    """When and by what each believed fact was last confirmed."""
    return {
        b.value: Sighting(b.stamp, b.source) for b in memory.beliefs.values() if b.value is not None
    }


def unknown(memory: Memory, percepts: Percepts, now: float, scene: Scene) -> frozenset[Literal]:
    """The atoms about which nothing is known: what should be seen and isn't, or was seen too long ago."""
    found: set[Literal] = set()
    robot = memory.beliefs.get(ROBOT)
    region = robot.value.args[0] if robot is not None and robot.value is not None else ""
    for variable, belief in memory.beliefs.items():
        if belief.source == HEARD:
            continue  # What was said has been said.
        look = _Glance(memory, percepts, now, scene, region)
        limit = scene.how.stale_s if look.sees(variable, belief) else scene.how.memory_s
        if now - belief.stamp > limit:
            found |= scene.choices.get(variable, frozenset({variable}))
    found |= contradicted(_exclusive(memory), scene.mutexes)
    return frozenset(found)


def _exclusive(memory: Memory) -> State:
    """What may be believed beside what it excludes: all but the values of variables that have just one."""
    return State(
        frozenset(v for v, belief in memory.beliefs.items() if belief.value == v and v != ROBOT)
    )


@dataclass(frozen=True, slots=True)
class _Glance:
    """What can be seen from where the robot is, at one time."""

    memory: Memory
    percepts: Percepts
    now: float
    scene: Scene
    region: str

    def sees(self, variable: Variable, belief: Belief) -> bool:
        """Whether a variable's value would be seen if it were as believed."""
        value = belief.value
        if variable == ROBOT:
            return True
        if variable.predicate == "person-in":
            by_region = self.scene.how.sight == "region"
            return by_region and value is not None and value.args[1] == self.region
        if variable.predicate == "at":
            return value is not None and self._sees_object(value)
        subject = variable.args[0] if variable.args else ""
        if variable.predicate not in self.scene.how.detects:
            return False
        return (
            self._place(subject) if subject in self.scene.layout.places else self._marker(subject)
        )

    def _sees_object(self, value: Literal) -> bool:
        if value.predicate == "holding":
            return True
        if value.predicate == "has":
            return False  # Pockets and laps can't be looked into.
        place = value.args[1]
        return self._place(place) and (value.predicate == "at" or self._open(place))

    def _open(self, container: str) -> bool:
        belief = self.memory.beliefs.get(Literal("open", (container,)))
        return belief is not None and belief.value is not None

    def _place(self, place: str) -> bool:
        if self.scene.how.sight == "marker":
            return self._marker(place)
        return self.region != "" and self.scene.layout.regions.get(place) == self.region

    def _marker(self, name: str) -> bool:
        marker = self.percepts.markers.get(name)
        return marker is not None and self.now - marker.stamp <= self.scene.how.stale_s
