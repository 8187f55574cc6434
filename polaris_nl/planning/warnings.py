"""What is legal in a program and may still not be meant."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping

from polaris_nl.automaton.automaton import Automaton, Transition
from polaris_nl.model.formula import Literal
from polaris_nl.model.state import Mutexes, State
from polaris_nl.model.text import listed, sentence
from polaris_nl.model.wording import Wording
from polaris_nl.model.world import World
from polaris_nl.planning.result import Warning


def warnings_of(
    automaton: Automaton,
    states: Mapping[str, State],
    mutexes: Mutexes,
    world: World,
    wording: Wording,
) -> tuple[Warning, ...]:
    """Conditionals that hold already, are impossible or overlap, and elses that can't be taken.

    Args:
        automaton: the program.
        mutexes: what excludes what.
        world: entities and facts.
        wording: words for them.
        states: the state at each checkpoint that has a plan, the start included.
    """
    found: list[Warning] = []
    for checkpoint, state in states.items():
        outgoing = automaton.outgoing(checkpoint)
        for transition in outgoing:
            found.extend(_alone(automaton, transition, outgoing, state, mutexes, world, wording))
        found.extend(_overlaps(automaton, outgoing, mutexes, wording))
    return tuple(found)


def _alone(
    automaton: Automaton,
    transition: Transition,
    siblings: tuple[Transition, ...],
    state: State,
    mutexes: Mutexes,
    world: World,
    wording: Wording,
) -> Iterator[Warning]:
    if not transition.when:
        return
    name = automaton.checkpoints[transition.target].name
    words = _words(transition.when, wording)
    exclusive = _exclude(transition.when, mutexes)
    if exclusive is not None:
        a, b = exclusive
        text = (
            f"{name} may never come: {wording.event(a)} and {wording.event(b)} exclude each other"
        )
        yield Warning(sentence(text), transition.id)
        return
    static = [
        x
        for x in transition.when
        if not state.holds(x)
        and not world.domain.people_can_change(x.predicate)
        and not world.domain.robot_can_change(x.predicate)
    ]
    if static:
        yield Warning(
            sentence(f"{name} can never come: nothing can change whether {words}"), transition.id
        )
    elif all(state.holds(x) for x in transition.when):
        other = next((t for t in siblings if not t.when), None)
        if other is not None:
            skipped = automaton.checkpoints[other.target].name
            text = f"{skipped} will never come, as it already holds there that {words}"
        else:
            text = f"the robot won't wait before {name}, as it already holds there that {words}"
        yield Warning(sentence(text), transition.id)


def _overlaps(
    automaton: Automaton, outgoing: tuple[Transition, ...], mutexes: Mutexes, wording: Wording
) -> Iterator[Warning]:
    labelled = [t for t in outgoing if t.when]
    for a, b in itertools.combinations(labelled, 2):
        if a.conditional & b.conditional and not _exclude(a.when + b.when, mutexes):
            one, two = (automaton.checkpoints[t.target].name for t in (a, b))
            shared = _words(tuple(sorted(a.conditional & b.conditional)), wording)
            text = f"{one} and {two} may both be right when {shared}; the robot takes the first that holds"
            yield Warning(sentence(text), b.id)


def _exclude(literals: tuple[Literal, ...], mutexes: Mutexes) -> tuple[Literal, Literal] | None:
    """The first two literals that can't hold together, or None."""
    for a, b in itertools.combinations(literals, 2):
        if a == b.negation or (a.positive and b.positive and mutexes.exclusive(a, b)):
            return a, b
    return None


def _words(when: tuple[Literal, ...], wording: Wording) -> str:
    return listed([wording.event(x) for x in when])
