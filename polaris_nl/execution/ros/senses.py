"""The latest of everything a robot says, taken in message by message in the owner's thread.

What leaves here are frozen values: vitals for the watchdog, percepts for perception.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

from polaris_nl.execution.beliefs import AHEAD_S
from polaris_nl.execution.clock import Clock
from polaris_nl.execution.ros.frames import MAP, Frames, Transform
from polaris_nl.execution.ros.layout import Layout, Pose
from polaris_nl.execution.ros.perception import Detected, Percepts, Seen
from polaris_nl.execution.ros.profile import Profile
from polaris_nl.execution.ros.watch import CLOCK_JUMP_S, Vitals
from polaris_nl.model.errors import FormatError
from polaris_nl.model.formula import Literal, parse_literal
from polaris_nl.model.world import World

MOST_WORDS = 1000
MOST_REPLIES = 64


class Intake:
    """Takes messages in.

    Args:
        profile: the robot's profile.
        world: the world; what it doesn't know of is passed over.
        clock: the run's clock.
        believed: the region that a person is believed to be in.
    """

    def __init__(
        self,
        profile: Profile,
        world: World,
        clock: Clock,
        believed: Callable[[Literal], Literal | None],
    ) -> None:
        self.vitals = Vitals()
        self.percepts = Percepts()
        self.joints: Mapping[str, float] = {}
        self._profile = profile
        self._world = world
        self._layout = Layout.of(world)
        self._clock = clock
        self._believed = believed
        self._frames = Frames()
        self._offset: float | None = None
        self._replies: dict[str, Mapping[str, Any]] = {}
        self._spoken: set[tuple[str, str]] = set()
        self._take: Mapping[str, Callable[[Any], None]] = {
            "joint_states": self._joint_states,
            "odom": self._odom,
            "battery": self._battery,
            "mode": self._mode,
            "is_homed": self._homed,
            "is_runstopped": self._runstopped,
            "tf": self._tf,
            "tf_static": self._tf,
            "markers": self._markers,
            "perceived": self._perceived,
            "heard": self._heard,
            "said": self._said,
            "skill_result": self._skill_result,
        }

    def take(self, name: str, message: Any) -> None:
        """Takes a message in, by its topic's name in the profile."""
        take = self._take.get(name)
        if take is not None:
            take(message)

    def count(self, speakers: Mapping[str, int]) -> None:
        """Takes in how many servers answer on each name."""
        self.vitals = replace(self.vitals, speakers=speakers)

    # What primitives ask

    @property
    def base(self) -> Pose | None:
        """Where the base stands on the map."""
        return Pose(*self.percepts.base) if self.percepts.base is not None else None

    @property
    def mode(self) -> str:
        """The driver's mode."""
        return self.vitals.mode

    def position(self, name: str) -> tuple[float, float, float | None] | None:
        """Where an entity is, by its marker or by the map."""
        marker = self.percepts.markers.get(name)
        if marker is not None:
            return marker.x, marker.y, marker.z
        place = self._layout.places.get(name)
        return (place.x, place.y, None) if place is not None else None

    def stand(self, name: str) -> Pose | None:
        """Where the robot stands to get at an entity or into a region."""
        if name in self._layout.areas:
            return self._layout.standing(name)
        standoff = self._profile.base.standoff_m
        if name in self._layout.places:
            # Furniture is where the map says; markers only say where it is seen.
            place, region = self._layout.places[name], self._layout.regions.get(name, "")
            return self._layout.beside(place.x, place.y, region, standoff)
        where = self._believed(Literal("person-in", (name,)))
        region = where.args[1] if where is not None else ""
        marker = self.percepts.markers.get(name)
        area = self._layout.areas.get(region)
        if marker is not None and area is not None and area.holds(marker.x, marker.y):
            return self._layout.beside(marker.x, marker.y, region, standoff)
        return self._layout.standing(region)

    def sentence(self, message: str) -> str:
        """The words of a message: of its names the first that is a sentence."""
        entity = self._world.entities[message]
        names = (*entity.synonyms, entity.spoken)
        return next((n for n in names if len(n.split()) >= 3), names[0])

    def replied(self, request: str) -> Mapping[str, Any] | None:
        """The reply to a skill request."""
        return self._replies.get(request)

    def spoken(self, person: str, message: str) -> bool:
        """Whether a message was spoken and heard."""
        return (person, message) in self._spoken

    def expect_speech(self, person: str, message: str) -> None:
        """Forgets earlier words."""
        self._spoken.discard((person, message))

    # Messages

    def _now(self) -> float:
        return self._clock.now()

    def _tell_time(self, apart: float) -> float:
        """Takes in how far the clocks are apart by one message; returns the drift, in seconds.

        What a message takes on its way makes them look further apart than they are, so the fastest one
        is nearest to the truth. Were the first one believed, and late, all that is seen after it would
        lie in the future, and the robot would be blind. A jump isn't followed: it is for the watchdog.
        """
        if self._offset is None or 0.0 < self._offset - apart <= CLOCK_JUMP_S:
            self._offset = apart
        return self._offset - apart

    def _stamped(self, stamp: Any) -> float:
        """A message's time by the run's clock; now for one that has none."""
        seconds = stamp.sec + stamp.nanosec * 1e-9
        if seconds == 0 or self._offset is None:
            return self._now()
        return self._seen_at(seconds)

    def _seen_at(self, seconds: float) -> float:
        """A time of the robot's clock by ours; what is a little ahead came faster, and is of now."""
        at, now = seconds + (self._offset or 0.0), self._now()
        return now if 0.0 < at - now <= AHEAD_S else at

    def _joint_states(self, message: Any) -> None:
        now = self._now()
        seconds = message.header.stamp.sec + message.header.stamp.nanosec * 1e-9
        drift = 0.0
        if seconds:
            drift = self._tell_time(now - seconds)
        self.vitals = replace(self.vitals, heartbeat=now, drift=drift)
        self.joints = dict(zip(message.name, message.position, strict=False))

    def _odom(self, message: Any) -> None:
        twist, now = message.twist.twist, self._now()
        speed = math.hypot(twist.linear.x, twist.linear.y)
        self.vitals = replace(self.vitals, moved=(speed, twist.angular.z, now))
        if self._frames.base() is None:
            # Without transforms the odometry's frame is taken for the map.
            at = message.pose.pose
            self._stand(
                Transform.of(at.position, at.orientation).pose,
                self._stamped(message.header.stamp),
            )

    def _battery(self, message: Any) -> None:
        voltage = float(message.voltage)
        if not math.isnan(voltage):
            self.vitals = replace(self.vitals, voltage=voltage)

    def _mode(self, message: Any) -> None:
        self.vitals = replace(self.vitals, mode=str(message.data))

    def _homed(self, message: Any) -> None:
        self.vitals = replace(self.vitals, homed=bool(message.data))

    def _runstopped(self, message: Any) -> None:
        self.vitals = replace(self.vitals, runstopped=bool(message.data))

    def _tf(self, message: Any) -> None:
        for link in message.transforms:
            child, stamp = link.child_frame_id.lstrip("/"), self._stamped(link.header.stamp)
            at = Transform.of(link.transform.translation, link.transform.rotation)
            self._frames.take(link.header.frame_id, child, at, stamp)
            if child in self._world.entities:
                self._see(child, self._frames.on_map(child), stamp)
        found = self._frames.base()
        if found is not None:
            self._stand(*found)

    def _markers(self, message: Any) -> None:
        for marker in message.markers:
            if marker.action not in (marker.DELETE, marker.DELETEALL):
                local = Transform.of(marker.pose.position, marker.pose.orientation)
                frame = marker.header.frame_id or MAP
                stamp = self._stamped(marker.header.stamp)
                self._see(marker.text, self._frames.on_map(frame, local), stamp)

    def _see(self, name: str, at: Transform | None, stamp: float) -> None:
        """An entity is seen; what is older than what is known of it changes nothing."""
        entity, known = self._world.entities.get(name), self.percepts.markers.get(name)
        if entity is None or at is None or (known is not None and stamp < known.stamp):
            return
        seen = Seen(name, entity.type, *at.at, stamp)
        self.percepts = replace(self.percepts, markers={**self.percepts.markers, name: seen})

    def _stand(self, pose: Pose, stamp: float) -> None:
        base = pose.x, pose.y, pose.yaw
        self.percepts = replace(self.percepts, base=base, base_stamp=stamp)

    def _perceived(self, message: Any) -> None:
        """Each message tells all that the detectors perceive; what it leaves out isn't perceived any more."""
        value = _json(message.data)
        found: dict[Literal, Detected] = {}
        told = self._seconds(value.get("stamp"))
        for item in value.get("facts") or ():
            literal = self._literal(item.get("literal")) if isinstance(item, Mapping) else None
            if literal is not None:
                found[literal.atom] = Detected(literal, self._seconds(item.get("stamp"), told))
        self.percepts = replace(self.percepts, detected=found, detected_at=told)

    def _heard(self, message: Any) -> None:
        value = _json(message.data)
        literal = self._literal(value.get("literal"))
        if literal is not None:
            self._hear(literal)

    def _said(self, message: Any) -> None:
        value = _json(message.data)
        person, text = str(value.get("person")), str(value.get("message"))
        if (
            value.get("heard", True)
            and person in self._world.entities
            and text in self._world.entities
        ):
            self._spoken.add((person, text))
            if "alerted-to" in self._world.domain.predicates:
                self._hear(Literal("alerted-to", (person, text)))

    def _hear(self, literal: Literal) -> None:
        heard = (*self.percepts.heard, Detected(literal, self._now()))
        if len(heard) <= MOST_WORDS:
            self.percepts = replace(self.percepts, heard=heard)

    def _skill_result(self, message: Any) -> None:
        value = _json(message.data)
        self._replies[str(value.get("id"))] = value
        while len(self._replies) > MOST_REPLIES:
            del self._replies[next(iter(self._replies))]

    def _literal(self, text: object) -> Literal | None:
        """A literal of this world, or None."""
        try:
            literal = parse_literal(str(text))
        except FormatError:
            return None
        predicate = self._world.domain.predicates.get(literal.predicate)
        known = self._world.entities.keys()
        if predicate is None or len(predicate.parameters) != len(literal.args):
            return None
        return literal if all(a in known for a in literal.args) else None

    def _seconds(self, stamp: object, otherwise: float | None = None) -> float:
        if isinstance(stamp, int | float) and stamp > 0 and self._offset is not None:
            return self._seen_at(float(stamp))
        return self._now() if otherwise is None else otherwise


def _json(text: str) -> Mapping[str, Any]:
    try:
        value = json.loads(text)
    except ValueError:
        return {}
    return value if isinstance(value, Mapping) else {}
