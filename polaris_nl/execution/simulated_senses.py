"""What is perceived of the simulated world: everything, but for what faults take away or make up."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from polaris_nl.execution.backend import READY, Health, Observation, Sighting
from polaris_nl.execution.beliefs import contradicted
from polaris_nl.execution.faults import Fault, Troubles
from polaris_nl.model.formula import Literal
from polaris_nl.model.state import Mutexes, State
from polaris_nl.model.world import World

SILENT_S = 0.5
"""Seconds without a heartbeat after which the robot counts as silent."""
FRESH_S = 1.0
"""Seconds for which what was seen is believed while only older news arrive."""
_PERCEPTION = ("blind", "stale", "flicker", "blink", "contradict")


class Senses:
    """Perception, heartbeat and odometry of the simulated robot.

    Args:
        world: what there is to be seen.
        mutexes: what can't be true together.
        start: the time of the start, in seconds.
    """

    def __init__(self, world: World, mutexes: Mutexes, start: float) -> None:
        self._mutexes = mutexes
        self._everything = frozenset(world.domain.predicates)
        self._last = Observation(world.initial)
        self._last_at = start
        self._heard_at = start
        self._flip = False

    def perceive(
        self, state: State, troubles: Troubles, now: float, moving: bool, silent: bool
    ) -> Observation:
        """What is perceived at a time.

        Args:
            state: what is so.
            troubles: what is wrong.
            now: the time, in seconds.
            moving: whether the robot moves.
            silent: whether nothing is heard of it.
        """
        if silent:
            return self._unheard(now)
        self._heard_at = now
        kind = troubles.health
        health = READY if kind == "ready" else Health(kind)
        faults = troubles.lasting(*_PERCEPTION)
        if not faults:
            if self._last.state is not state or self._last.unknown or self._last.blind:
                self._last = Observation(state, seen=self._seen(state, now))
            self._last_at = now
            found = self._last
        else:
            found = self._troubled(state, faults, now)
        return replace(found, health=health, moving=moving)

    def _unheard(self, now: float) -> Observation:
        """The last that was perceived; after a while the robot counts as silent, and nothing is known."""
        if now - self._heard_at <= SILENT_S:
            return replace(self._last, moving=None)
        return replace(self._last, blind=self._everything, health=Health("silent"), moving=None)

    def _troubled(self, state: State, faults: Iterable[Fault], now: float) -> Observation:
        kinds = {fault.kind for fault in faults}
        if "blind" in kinds:
            return replace(self._last, blind=self._everything)
        if "stale" in kinds:
            old = now - self._last_at > FRESH_S
            return replace(self._last, blind=self._everything if old else frozenset())
        self._flip = not self._flip
        unknown: frozenset[Literal] = frozenset()
        for fault in faults:
            if fault.kind == "flicker" and self._flip:
                negated = [x.negation for x in fault.literals]
                state = self._shown(state, negated)
            elif fault.kind in ("flicker", "blink"):
                state = self._shown(state, fault.literals)
            else:
                state = self._shown(state, fault.literals)
                unknown |= contradicted(state, self._mutexes)
        self._last_at = now
        self._last = Observation(state, unknown, seen=self._seen(state, now))
        return self._last

    def _shown(self, state: State, literals: Iterable[Literal]) -> State:
        """A state as it seems: nothing is displaced by what only seems so."""
        literals = tuple(literals)
        return state.change(
            (x.atom for x in literals if not x.positive), (x for x in literals if x.positive)
        )

    def _seen(self, state: State, now: float) -> dict[Literal, Sighting]:
        """When the facts that are new were seen; the others were seen before."""
        before = self._last.state.facts
        seen = dict.fromkeys(state.facts - before, Sighting(now, "camera"))
        return seen | dict.fromkeys(before - state.facts, Sighting(now, "camera"))
