"""People who act as the world says: `human_actions`, a little while after their conditions hold."""

from __future__ import annotations

import random
from collections.abc import Sequence
from dataclasses import dataclass

from polaris_nl.execution.ros.stretch_sim.scene import Scene
from polaris_nl.model.formula import Literal
from polaris_nl.model.state import Mutexes
from polaris_nl.model.world import HumanAction, World

DELAY_S = (4.0, 8.0)
"""The shortest and longest time that somebody takes: the robot has drawn its arm in by then."""


@dataclass(frozen=True, slots=True)
class Deed:
    """What somebody did, and what of it can be heard."""

    action: HumanAction
    spoken: tuple[Literal, ...]
    speaker: str


class People:
    """The people of a world.

    Args:
        scene: what they change.
        preferred: names of human actions that they prefer; None for whatever the world lists first, empty for
            people who do nothing.
        mutexes: which of their actions exclude each other.
        seed: makes the same run again.
    """

    def __init__(
        self, scene: Scene, preferred: Sequence[str] | None, mutexes: Mutexes, seed: int = 0
    ) -> None:
        self._scene = scene
        self._random = random.Random(seed)
        self._willing = willing(scene.world, preferred, mutexes)
        self._due: dict[str, float] = {}
        self._done: set[str] = set()
        self._lasting: set[str] = set()

    def step(self, time: float) -> list[Deed]:
        """Lets time pass, in the simulation's seconds.

        Returns:
            What was done now.
        """
        deeds = []
        for action in self._willing:
            if not self._may(action):
                continue
            if not all(self._scene.state.holds(x) for x in action.when):
                self._due.pop(action.name, None)
                continue
            if time >= self._due.setdefault(action.name, time + self._random.uniform(*DELAY_S)):
                self._done.add(action.name)
                self._lasting.discard(action.name)
                self._due.pop(action.name)
                self._scene.make_true(action.effect)
                deeds.append(self._deed(action))
        return deeds

    def _may(self, action: HumanAction) -> bool:
        """Whether it isn't done yet, or was undone since its effect was seen (walking takes a while)."""
        if action.name not in self._done:
            return True
        if all(map(self._scene.state.holds, action.effect)):
            self._lasting.add(action.name)
            return False
        return action.name in self._lasting

    def _deed(self, action: HumanAction) -> Deed:
        names = [name for x in (*action.when, *action.effect) for name in x.args]
        speaker = next((name for name in names if name in self._scene.people), "")
        messages = {e.name for e in self._scene.world.of_type("message")}
        spoken = tuple(x for x in action.effect if x.args and messages.issuperset(x.args))
        return Deed(action, spoken, speaker)


def willing(
    world: World, preferred: Sequence[str] | None, mutexes: Mutexes
) -> tuple[HumanAction, ...]:
    """The human actions that will be done: preferred ones first, and of those that exclude each other one."""
    actions = list(world.scenario.human_actions)
    if preferred is not None:
        if not preferred:
            return ()
        actions.sort(key=lambda action: action.name not in preferred)
    chosen: list[HumanAction] = []
    for action in actions:
        if not any(_rivals(action, other, mutexes) for other in chosen):
            chosen.append(action)
    return tuple(chosen)


def _rivals(a: HumanAction, b: HumanAction, mutexes: Mutexes) -> bool:
    pairs = ((x, y) for x in a.effect for y in b.effect if x.positive and y.positive)
    return any(mutexes.exclusive(x, y) is not None for x, y in pairs)
