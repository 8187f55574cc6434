"""What the robot's cameras and ears would tell: where things are, and facts that geometry can't show.

In sight is what is in the robot's region and not behind a closed door: the head is taken to look about.
"""

from __future__ import annotations

import random
from collections.abc import Iterator
from dataclasses import dataclass

from polaris_nl.execution.ros.stretch_sim.body import Point3
from polaris_nl.execution.ros.stretch_sim.scene import Scene
from polaris_nl.model.formula import Literal

GEOMETRIC = ("at", "in", "located", "connected", "robot-at", "person-in")
"""What follows from where things are, and is not told."""


@dataclass(frozen=True, slots=True)
class Marker:
    """An entity that is seen, and where."""

    name: str
    kind: str
    at: Point3


@dataclass(frozen=True, slots=True)
class Settings:
    """How good the cameras are: noise (standard deviation, m), and the share of markers that are missed."""

    noise_m: float = 0.0
    dropout: float = 0.0
    seed: int = 0


class Cameras:
    """Sees a scene.

    Args:
        scene: what there is.
        settings: how well it is seen.
    """

    def __init__(self, scene: Scene, settings: Settings) -> None:
        self._scene = scene
        self._settings = settings
        self._random = random.Random(settings.seed)

    def markers(self) -> list[Marker]:
        """What is seen now."""
        seen = []
        for name, at in self._visible():
            if self._random.random() < self._settings.dropout:
                continue
            x, y, z = (value + self._random.gauss(0.0, self._settings.noise_m) for value in at)
            seen.append(Marker(name, self._scene.kind(name), (x, y, z)))
        return seen

    def facts(self) -> list[Literal]:
        """The facts that are perceived now and that markers don't show, sorted."""
        visible = {name for name, _ in self._visible()}
        messages = {e.name for e in self._scene.world.of_type("message")}
        told = {
            f.args[1]: f.args[0]
            for f in sorted(self._scene.state.facts)
            if f.predicate == "alerted-to" and len(f.args) == 2
        }

        def known(name: str) -> bool:
            if name in messages:
                return name not in told or told[name] in visible
            return name in visible

        return sorted(
            f
            for f in self._scene.state.facts
            if f.predicate not in GEOMETRIC and all(map(known, f.args))
        )

    def hears(self, speaker: str) -> bool:
        """Whether the robot hears somebody; nobody in particular is heard everywhere."""
        return not speaker or speaker in {name for name, _ in self._visible()}

    def _visible(self) -> Iterator[tuple[str, Point3]]:
        scene = self._scene
        for name in (*scene.layout.places, *scene.objects, *scene.people):
            at = scene.where(name)
            if at is not None and (name == scene.held or self._sees(name, at)):
                yield name, at

    def _sees(self, name: str, at: Point3) -> bool:
        scene = self._scene
        if name in scene.layout.regions:
            region = scene.layout.regions[name]
        else:
            region = scene.layout.region_at(at[0], at[1], scene.region)
        if not region or region != scene.region:
            return False
        holder = scene.holder(name)
        if holder is None or holder.predicate != "in":
            return True
        return Literal("open", (holder.args[1],)) in scene.state.facts
