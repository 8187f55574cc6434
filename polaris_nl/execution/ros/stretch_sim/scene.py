"""What is so in the simulated world, and where everything is.

The facts are the truth (`state`); places follow from them: an object that somebody puts on a table gets a
spot on it. What geometry decides, where the robot and people are, becomes facts the other way round.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator

from polaris_nl.execution.ros.layout import Layout, Pose
from polaris_nl.execution.ros.stretch_sim.body import Body, Point3
from polaris_nl.execution.ros.stretch_sim.floor import Floor
from polaris_nl.execution.ros.stretch_sim.person import Person
from polaris_nl.model.errors import RunError, UsageError, did_you_mean
from polaris_nl.model.formula import Literal
from polaris_nl.model.state import Mutexes
from polaris_nl.model.world import World

SURFACE_M = 0.50
"""The height of tables and other surfaces: low, so that the arm can go out over them from where it rests."""
CONTAINER_M = 0.58
INSIDE_M = 0.34
HANDS_M = 1.0
"""How high people hold things."""
OBJECT_HALF_M = 0.04
_SPACING = 0.13
_SPOTS = [(i * _SPACING, j * _SPACING) for i in (0, -1, 1) for j in (0, -1, 1)]
_BESIDE = [(0.9, 0.5), (-0.9, 0.5), (0.9, -0.5), (-0.9, -0.5), (0.0, 1.0), (0.0, -1.0)]
PLACED = ("at", "in", "has", "holding")


class Scene:
    """The simulated world.

    Args:
        world: the world, at its start.
        mutexes: what displaces what.
        layout: where regions and furniture are.
        floor: where one can walk.
        body: the robot's body, which knows where things are.
    """

    def __init__(
        self, world: World, mutexes: Mutexes, layout: Layout, floor: Floor, body: Body
    ) -> None:
        self.world = world
        self.layout = layout
        self.floor = floor
        self.body = body
        self.state = world.initial
        self.people = {p.name: p for p in self._people()}
        self.objects = [e.name for e in world.of_type("object")]
        self._mutexes = mutexes
        self._region = layout.region_at(body.pose.x, body.pose.y)
        for name in self.objects:
            self._settle(name)

    @property
    def region(self) -> str:
        """The region that the robot is in, or ""."""
        return self._region

    @property
    def held(self) -> str | None:
        """The object in the gripper."""
        found = (f.args[0] for f in self.state.facts if f.predicate == "holding")
        return next(found, None)

    def kind(self, name: str) -> str:
        """The type of an entity; what was added during the run is an object."""
        entity = self.world.entities.get(name)
        return "object" if entity is None else entity.type

    def is_a(self, name: str, kind: str) -> bool:
        """Whether an entity is there and of a type."""
        if name in self.objects:
            return kind == "object"
        entity = self.world.entities.get(name)
        return entity is not None and self.world.domain.is_a(entity.type, kind)

    def where(self, name: str) -> Point3 | None:
        """Where an entity is on the map, in metres, or None if it isn't anywhere."""
        if name in self.people:
            return self.people[name].x, self.people[name].y, HANDS_M
        if name in self.layout.places:
            place = self.layout.places[name]
            return place.x, place.y, self.height(name)
        return self.body.where(name)

    def height(self, place: str) -> float:
        """The height of a surface's or container's top."""
        return CONTAINER_M if place in self.layout.containers else SURFACE_M

    def holder(self, name: str) -> Literal | None:
        """The fact that says where an object is, or None."""
        for fact in self.state.facts:
            args = fact.args
            if fact.predicate in PLACED and args[1 if fact.predicate == "has" else 0] == name:
                return fact
        return None

    def make_true(self, literals: Iterable[Literal]) -> None:
        """Somebody or something makes literals true; people walk to where they are to be."""
        now: list[Literal] = []
        for literal in literals:
            walks = literal.predicate == "person-in" and literal.args[0] in self.people
            if walks and literal.positive and literal.args[1] in self.layout.areas:
                self._walk(*literal.args)
            else:
                now.append(literal)
        before = {name: self.holder(name) for name in self.objects}
        self.state = self.state.after_event(now, self._mutexes)
        for name in self.objects:
            if self.holder(name) != before[name]:
                self._settle(name)

    def move(self, name: str, to: str) -> None:
        """Puts an object on a surface, in a container or into somebody's hands.

        Raises:
            UsageError: there is no such object or place.
        """
        if name not in self.objects:
            raise UsageError(f"There is no object {name}.{did_you_mean(name, self.objects)}")
        if to in self.people:
            literal = Literal("has", (to, name))
        elif to in self.layout.places:
            inside = to in self.layout.containers
            literal = Literal("in" if inside else "at", (name, to))
        else:
            places = (*self.layout.places, *self.people)
            raise UsageError(f"There is no place {to}.{did_you_mean(to, places)}")
        self.make_true([literal])

    def add(self, name: str, to: str) -> None:
        """Brings an object into the world.

        Raises:
            UsageError: the name is taken by something else, or there is no such place.
        """
        if name not in self.objects:
            if name in self.world.entities and not self.is_a(name, "object"):
                raise UsageError(f"{name} is there already, and it is no object.")
            self.objects.append(name)
        self.move(name, to)

    def remove(self, name: str) -> None:
        """Takes an object out of the world.

        Raises:
            UsageError: there is no such object.
        """
        holder = self.holder(name)
        if name not in self.objects or holder is None:
            raise UsageError(f"There is no object {name}.{did_you_mean(name, self.objects)}")
        if holder.predicate == "holding":
            self.body.grip(None)
            self.state = self.state.change((), (Literal("hand-empty"),))
        self.state = self.state.change((f for f in self.state.facts if name in f.args), ())
        self.body.forget(name)

    def step(self, seconds: float) -> None:
        """Lets people walk, and makes facts of where everybody is."""
        for person in self.people.values():
            if person.way:
                person.step(seconds)
                self._carry(person)
        pose = self.body.pose
        self._region = self.layout.region_at(pose.x, pose.y, self._region)
        self._locate("robot-at", (), self._region)
        for person in self.people.values():
            before = self._person_region(person.name)
            at = self.layout.region_at(person.x, person.y, before)
            self._locate("person-in", (person.name,), at)

    # Where things are

    def _settle(self, name: str) -> None:
        """Gives an object the place that its fact says."""
        holder = self.holder(name)
        if holder is None:
            self.body.forget(name)
        elif holder.predicate == "holding":
            self.body.grip(name)
        elif holder.predicate == "has":
            person = self.people.get(holder.args[0])
            if person is not None:
                self.body.put(name, self._in_hands(person))
        else:
            self.body.put(name, self._spot(name, holder.args[1]))

    def _spot(self, name: str, place: str) -> Point3:
        inside = place in self.layout.containers
        middle = self.layout.places.get(place, Pose(0.0, 0.0))
        taken = [
            self.body.where(other)
            for other in self.objects
            if other != name and (fact := self.holder(other)) is not None
            if fact.args[1:] == (place,)
        ]
        z = (INSIDE_M if inside else SURFACE_M) + OBJECT_HALF_M + 0.005
        spots = [(middle.x + dx, middle.y + dy) for dx, dy in _SPOTS]

        def room(spot: tuple[float, float]) -> float:
            distances = (math.dist(spot, other[:2]) for other in taken if other is not None)
            return min(min(distances, default=_SPACING), _SPACING)

        return (*max(spots, key=room), z)

    def _in_hands(self, person: Person) -> Point3:
        return person.x + 0.2 * math.cos(person.yaw), person.y + 0.2 * math.sin(person.yaw), HANDS_M

    def _carry(self, person: Person) -> None:
        for fact in self.state.facts:
            if fact.predicate == "has" and fact.args[0] == person.name:
                self.body.put(fact.args[1], self._in_hands(person))

    # People

    def _people(self) -> Iterator[Person]:
        count: dict[str, int] = {}
        for entity in self.world.of_type("person"):
            region = self._person_region(entity.name)
            if entity.pose is not None:
                yield Person(entity.name, *entity.pose)
            elif region in self.layout.areas:
                yield Person(entity.name, *self._stand(region, count.get(region, 0)))
                count[region] = count.get(region, 0) + 1

    def _stand(self, region: str, number: int) -> tuple[float, float]:
        x, y = self.layout.areas[region].middle
        dx, dy = _BESIDE[number % len(_BESIDE)]
        area = self.layout.areas[region]
        spot = (
            min(max(x + dx, area.left + 0.5), area.right - 0.5),
            min(max(y + dy, area.bottom + 0.5), area.top - 0.5),
        )
        return self.floor.nearest(*spot, 1.5) or (x, y)

    def _walk(self, name: str, region: str) -> None:
        person = self.people[name]
        others = [
            p
            for p in self.people
            if p != name and Literal("person-in", (p, region)) in self.state.facts
        ]
        goal = self._stand(region, len(others))
        person.way = self.floor.route((person.x, person.y), goal) or [goal]

    def _person_region(self, name: str) -> str:
        found = (
            f.args[1]
            for f in getattr(self, "state", self.world.initial).facts
            if f.predicate == "person-in" and f.args[0] == name
        )
        return next(found, "")

    def _locate(self, predicate: str, who: tuple[str, ...], region: str) -> None:
        if not region:
            return
        fact = Literal(predicate, (*who, region))
        if fact not in self.state.facts:
            gone = (f for f in self.state.facts if f.predicate == predicate and f.args[:-1] == who)
            self.state = self.state.change(gone, (fact,))


def start_pose(world: World, layout: Layout) -> Pose:
    """Where the robot stands at the start.

    Raises:
        RunError: the world has no map: no areas of regions, or none where the robot is.
    """
    region = next((f.args[0] for f in sorted(world.facts) if f.predicate == "robot-at"), "")
    pose = layout.standing(region)
    if pose is None:
        raise RunError(
            f"{world.name} says no area for {region or 'the region where the robot starts'}, so nothing can "
            "drive there; give each region an area, and each surface and container a pose."
        )
    lost = [e.name for e in world.of_type("surface", "container") if e.name not in layout.places]
    if lost:
        raise RunError(
            f"{world.name} says no pose for {lost[0]}, so nothing can reach it; give it one."
        )
    return pose
