"""People of the simulated world, who do as the world file says (`human_actions`)."""

from __future__ import annotations

import random
from collections.abc import Callable, Iterable, Iterator

from polaris_nl.model.state import Mutexes, State
from polaris_nl.model.world import HumanAction, World


class People:
    """What people do, each thing once, some time after they can; the same for the same seed.

    Args:
        world: whose people.
        preferred: names of human actions that people prefer; None for the world's own order, empty
            for people who do nothing.
        mutexes: of actions whose effects exclude each other, the first is done.
        delay_s: the shortest and longest time that a person takes, in seconds.
        seed: makes the same run again.
        acted: what they have done before.
    """

    def __init__(
        self,
        world: World,
        preferred: tuple[str, ...] | None,
        mutexes: Mutexes,
        delay_s: tuple[float, float],
        seed: int,
        acted: Iterable[str] = (),
    ) -> None:
        self._willing = _willing(world, preferred, mutexes)
        self._delay_s = delay_s
        self._random = random.Random(seed)
        self._acts_at: dict[str, float] = {}
        self._acted = set(acted)

    def acting(self, state: Callable[[], State], now: float) -> Iterator[HumanAction]:
        """What people do now; each sees the state that the one before has made."""
        for action in self._willing:
            if action.name in self._acted or not all(map(state().holds, action.when)):
                self._acts_at.pop(action.name, None)
                continue
            at = self._acts_at.get(action.name)
            if at is None:
                at = self._acts_at[action.name] = now + self._random.uniform(*self._delay_s)
            if now >= at:
                self._acted.add(action.name)
                yield action


def _willing(
    world: World, preferred: tuple[str, ...] | None, mutexes: Mutexes
) -> tuple[HumanAction, ...]:
    """The human actions that will be done: preferred ones, and of those that exclude each other the first."""
    actions = list(world.scenario.human_actions)
    if preferred is not None:
        first = [a for a in actions if a.name in preferred]
        actions = first + [a for a in actions if a.name not in preferred]
        if not preferred:
            return ()
    chosen: list[HumanAction] = []
    for action in actions:
        if not any(_rivals(action, other, mutexes) for other in chosen):
            chosen.append(action)
    return tuple(chosen)


def _rivals(a: HumanAction, b: HumanAction, mutexes: Mutexes) -> bool:
    return any(
        mutexes.exclusive(x, y) for x in a.effect for y in b.effect if x.positive and y.positive
    )
