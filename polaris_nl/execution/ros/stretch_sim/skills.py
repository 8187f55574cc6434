"""What the gripper does to things: grasp, release, open, close and fill, each with the reasons why not.

A grasp here is an *attached grasp*: fingers and friction are not simulated, the object is attached to the
gripper, and set down on a free spot when it is released.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from polaris_nl.execution.ros.stretch_sim.joints import ARM
from polaris_nl.execution.ros.stretch_sim.scene import Scene
from polaris_nl.model.formula import Literal

SKILL_S = 1.5
NEAR_M = 1.3
EXTENDED_M = 0.08
REACH_M = 0.55
HAND_EMPTY = Literal("hand-empty")


@dataclass(frozen=True, slots=True)
class Request:
    """What is asked for: the object, and the surface, container or person `at` which it is done."""

    id: str
    skill: str
    object: str = ""
    at: str = ""


@dataclass(frozen=True, slots=True)
class Reply:
    """How it went; `reason` says why not, in words."""

    id: str
    ok: bool
    reason: str = ""


def problem(request: Request, scene: Scene) -> str:
    """Why a skill can't be done now, or ""."""
    check = _CHECKS.get(request.skill)
    if check is None:
        return f"there is no skill {request.skill!r}"
    target = request.at or request.object
    return check(request, scene) or unreachable(target, scene)


def unreachable(target: str, scene: Scene) -> str:
    """Why the gripper doesn't get to an entity, or ""."""
    where = scene.where(target)
    if where is None:
        return f"{target or 'that'} isn't there"
    pose = scene.body.pose
    distance = pose.distance(*where[:2])
    if distance > NEAR_M:
        return f"the robot is {distance:.1f} m from {target}, too far away"
    if scene.body.joints[ARM] < EXTENDED_M:
        return "the arm isn't extended"
    gap = math.dist(scene.body.gripper[:2], where[:2])
    if gap > REACH_M:
        return f"{target} is {gap:.1f} m from the gripper, out of its reach"
    return ""


def effect(request: Request, scene: Scene) -> None:
    """Does it."""
    scene.make_true(_EFFECTS[request.skill](request, scene))


def _grasp(request: Request, scene: Scene) -> str:
    if not scene.is_a(request.object, "object"):
        return f"there is no object {request.object}"
    if scene.held is not None:
        return f"the hand is full: it holds {scene.held}"
    holder = scene.holder(request.object)
    place = _place(holder)
    if holder is None or (request.at and place != request.at):
        return f"{request.object} isn't at {request.at or 'any place'}"
    if holder.predicate == "in" and Literal("open", (place,)) not in scene.state.facts:
        return f"{place} is closed"
    return ""


def _release(request: Request, scene: Scene) -> str:
    if scene.held is None:
        return "the hand is empty"
    if request.object and scene.held != request.object:
        return f"the hand holds {scene.held}, not {request.object}"
    if request.at not in (*scene.layout.places, *scene.people):
        return f"there is no surface, container or person {request.at}"
    if (
        scene.is_a(request.at, "container")
        and Literal("open", (request.at,)) not in scene.state.facts
    ):
        return f"{request.at} is closed"
    return ""


def _open(request: Request, scene: Scene) -> str:
    name = request.at or request.object
    if not scene.is_a(name, "container"):
        return f"{name} can't be opened"
    if scene.held is not None:
        return f"the hand is full: it holds {scene.held}"
    return ""


def _fill(request: Request, scene: Scene) -> str:
    if scene.held != request.object:
        return f"the hand doesn't hold {request.object}"
    if not scene.is_a(request.at, "surface"):
        return f"there is nothing to fill it from at {request.at}"
    return ""


def _place(holder: Literal | None) -> str:
    if holder is None or holder.predicate == "holding":
        return ""
    return holder.args[0] if holder.predicate == "has" else holder.args[1]


def _released(request: Request, scene: Scene) -> list[Literal]:
    held = scene.held or request.object
    if request.at in scene.people:
        return [Literal("has", (request.at, held))]
    inside = scene.is_a(request.at, "container")
    return [Literal("in" if inside else "at", (held, request.at))]


def _opened(positive: bool) -> Callable[[Request, Scene], list[Literal]]:
    return lambda request, scene: [
        Literal("open", (request.at or request.object,), positive=positive)
    ]


_CHECKS: Mapping[str, Callable[[Request, Scene], str]] = {
    "grasp": _grasp,
    "release": _release,
    "open": _open,
    "close": _open,
    "fill": _fill,
}
_EFFECTS: Mapping[str, Callable[[Request, Scene], list[Literal]]] = {
    "grasp": lambda request, scene: [Literal("holding", (request.object,))],
    "release": _released,
    "open": _opened(True),
    "close": _opened(False),
    "fill": lambda request, scene: [Literal("is-full", (request.object,))],
}


# The demos' services take no object: they do it to what is nearest.


def nearest_object(scene: Scene) -> Request | None:
    """What a grasp without an object would take, or None."""
    found = []
    for name in scene.objects:
        request = Request("demo", "grasp", name, _place(scene.holder(name)))
        where = scene.where(name)
        if where is not None and not problem(request, scene):
            found.append((math.dist(where[:2], scene.body.gripper[:2]), request))
    return min(found, key=lambda pair: pair[0])[1] if found else None


def nearest_person(scene: Scene) -> Request | None:
    """To whom a hand-over would give what is held, or None."""
    near = [
        (scene.body.pose.distance(p.x, p.y), Request("demo", "release", scene.held or "", p.name))
        for p in scene.people.values()
    ]
    near = [(distance, request) for distance, request in near if distance <= NEAR_M]
    return min(near, key=lambda pair: pair[0])[1] if near and scene.held else None


def nearest_container(scene: Scene) -> Request | None:
    """What an opening without a name would open, or None."""
    found = []
    for name in sorted(scene.layout.containers):
        request = Request("demo", "open", "", name)
        if Literal("open", (name,)) not in scene.state.facts and not problem(request, scene):
            where = scene.layout.places[name]
            found.append((where.distance(*scene.body.gripper[:2]), request))
    return min(found, key=lambda pair: pair[0])[1] if found else None
