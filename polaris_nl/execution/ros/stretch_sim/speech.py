"""What the robot says, and who hears it: a person in the same region, once it has been said to the end."""

from __future__ import annotations

from dataclasses import dataclass

from polaris_nl.execution.ros.stretch_sim.faults import Mishaps
from polaris_nl.execution.ros.stretch_sim.scene import Scene
from polaris_nl.model.formula import Literal

SPEECH_S = (0.5, 0.05, 4.0)
"""How long saying something takes: at least, for each character, at most."""


@dataclass(frozen=True, slots=True)
class Saying:
    """Something the robot says: to whom, which message, in what words."""

    person: str
    message: str
    text: str


class Speech:
    """The robot's voice.

    Args:
        scene: who is where; being told is a fact of it.
        mishaps: what goes wrong.
    """

    def __init__(self, scene: Scene, mishaps: Mishaps) -> None:
        self._scene = scene
        self._mishaps = mishaps
        self._under_way: list[tuple[float, Saying, bool]] = []

    def say(self, saying: Saying, time: float) -> None:
        """Begins to say something."""
        if self._mishaps.take("reject", "say") or self._mishaps.take("never", "say"):
            return
        lies = self._mishaps.take("lie", "say") is not None
        least, each, most = SPEECH_S
        self._under_way.append((time + min(least + each * len(saying.text), most), saying, lies))

    def step(self, time: float) -> list[Saying]:
        """Lets time pass; what was said to the end, and heard (or is claimed to be)."""
        due = [(saying, lies) for at, saying, lies in self._under_way if at <= time]
        self._under_way = [item for item in self._under_way if item[0] > time]
        return [saying for saying, lies in due if lies or self._told(saying)]

    def _told(self, saying: Saying) -> bool:
        here = Literal("person-in", (saying.person, self._scene.region))
        if saying.person in self._scene.people and here not in self._scene.state.facts:
            return False
        if saying.message and "alerted-to" in self._scene.world.domain.predicates:
            self._scene.make_true([Literal("alerted-to", (saying.person, saying.message))])
        return True
