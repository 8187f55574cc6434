"""What is believed, since when and by what it was seen: from percepts to an observation.

A percept is a literal with the time at which it was true, not the time at which it arrived. What is
too old for its kind is unknown, never false; what contradicts itself is unknown, too, until it is seen
again without the contradiction.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from polaris_nl.execution.backend import READY, Health, Observation, Sighting
from polaris_nl.model.formula import Literal
from polaris_nl.model.state import Mutexes, State

AHEAD_S = 0.5
"""How far a percept's time may lie ahead of the present, in seconds; clocks differ a little."""


@dataclass(frozen=True, slots=True)
class Percept:
    """Something perceived: that a literal was true at a time, in the run's seconds."""

    literal: Literal
    at: float
    source: str


@dataclass(frozen=True, slots=True)
class Lifetimes:
    """How long what was seen is believed, in seconds; None for ever.

    Attributes:
        by_predicate: for some predicates; what moves by itself, or is seen all the time, has a short
            life.
        default: for all others.
    """

    by_predicate: Mapping[str, float | None] = field(default_factory=dict)
    default: float | None = None

    def of(self, predicate: str) -> float | None:
        """The lifetime for a predicate."""
        return self.by_predicate.get(predicate, self.default)


@dataclass(frozen=True, slots=True)
class _Belief:
    holds: bool
    sighting: Sighting
    contradicted: bool = False


@dataclass(frozen=True)
class Beliefs:
    """What is believed of each atom; an immutable value."""

    _known: Mapping[Literal, _Belief] = field(default_factory=dict)

    @classmethod
    def assumed(cls, state: State, at: float) -> Beliefs:
        """What the world file says, until something is seen."""
        sighting = Sighting(at, "assumed")
        return cls({fact: _Belief(True, sighting) for fact in state.facts})

    def after(self, percepts: Iterable[Percept], mutexes: Mutexes, now: float) -> Beliefs:
        """What is believed after some percepts.

        What was seen to be true is no longer believed of what it excludes, where that was seen
        earlier; seen at the same time, both are unknown. A percept that is older than what is known
        of its atom changes nothing, and neither does one from the future.

        Args:
            percepts: in any order.
            mutexes: what excludes what.
            now: the present, in seconds.
        """
        known = dict(self._known)
        for percept in sorted(percepts, key=lambda p: p.at):
            if percept.at > now + AHEAD_S:
                continue
            atom, old = percept.literal.atom, known.get(percept.literal.atom)
            if old is not None and old.sighting.at > percept.at:
                continue
            sighting = Sighting(percept.at, percept.source)
            known[atom] = _Belief(percept.literal.positive, sighting)
            if percept.literal.positive:
                _displace(known, atom, sighting, mutexes)
        return Beliefs(known)

    def observation(
        self,
        now: float,
        lifetimes: Lifetimes,
        health: Health = READY,
        moving: bool | None = None,
    ) -> Observation:
        """What is perceived at a time, as the executor takes it.

        Args:
            now: the present, in seconds.
            lifetimes: when beliefs are too old.
            health: how the robot is.
            moving: whether it moves.
        """
        facts, unknown = [], []
        for atom, belief in self._known.items():
            if belief.holds:
                facts.append(atom)
            life = lifetimes.of(atom.predicate)
            if belief.contradicted or (life is not None and now - belief.sighting.at > life):
                unknown.append(atom)
        seen = {atom: belief.sighting for atom, belief in self._known.items()}
        return Observation(
            State(frozenset(facts)), frozenset(unknown), seen=seen, health=health, moving=moving
        )


def contradicted(state: State, mutexes: Mutexes) -> frozenset[Literal]:
    """The facts that can't be true together, each with the others."""
    pairs = mutexes.pairs(sorted(state.facts))
    return frozenset(x for pair in pairs for x in pair)


def _displace(
    known: dict[Literal, _Belief], atom: Literal, sighting: Sighting, mutexes: Mutexes
) -> None:
    believed = State(frozenset(x for x, belief in known.items() if belief.holds))
    for other in mutexes.excluded(believed, atom):
        rival = known[other]
        if rival.sighting.at < sighting.at:
            known[other] = _Belief(False, sighting)
        else:
            known[other] = _Belief(True, rival.sighting, contradicted=True)
            known[atom] = _Belief(True, sighting, contradicted=True)
