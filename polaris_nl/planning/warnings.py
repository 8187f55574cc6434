"""What is legal in a program and may still not be meant."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping, Sequence

from polaris_nl.automaton.automaton import Automaton, Transition
from polaris_nl.model.formula import Literal, Quantified
from polaris_nl.model.goals import choices
from polaris_nl.model.state import Mutexes, State
from polaris_nl.model.text import listed, sentence
from polaris_nl.model.wording import Wording
from polaris_nl.model.world import World
from polaris_nl.planning.kinds import none_of
from polaris_nl.planning.result import Warning


def warnings_of(
    automaton: Automaton,
    states: Mapping[str, State],
    mutexes: Mutexes,
    world: World,
    wording: Wording,
) -> tuple[Warning, ...]:
    """Conditionals that hold already, are impossible or overlap, elses that can't be taken, goals of nothing.

    Args:
        automaton: the program.
        mutexes: what excludes what.
        world: entities and facts.
        wording: words for them.
        states: the state at each checkpoint that has a plan, the start included.
    """
    found = _Warnings(automaton, mutexes, world, wording)
    return tuple(w for checkpoint, state in states.items() for w in found.at(checkpoint, state))


class _Warnings:
    """The warnings of one program."""

    def __init__(
        self, automaton: Automaton, mutexes: Mutexes, world: World, wording: Wording
    ) -> None:
        self._automaton = automaton
        self._mutexes = mutexes
        self._world = world
        self._wording = wording

    def at(self, checkpoint: str, state: State) -> Iterator[Warning]:
        """What is to be said of the ways that lead on from a checkpoint, and of where they lead."""
        outgoing = self._automaton.outgoing(checkpoint)
        open_ways: list[Transition] = []
        for transition in outgoing:
            closed = list(self._impossible(transition, state)) if transition.when else []
            yield from closed
            if transition.when and not closed:
                open_ways.append(transition)
                yield from self._holds_already(transition, outgoing, state)
        for first, second in itertools.combinations(open_ways, 2):
            yield from self._overlap(first, second, state)
        for transition in outgoing:
            yield from self._nothing_to_do(transition, state)

    def _impossible(self, transition: Transition, state: State) -> Iterator[Warning]:
        name = self._name(transition)
        exclusive = self._exclude(transition.when)
        never = [x for x in transition.when if not state.holds(x) and not self._may_come(x)]
        fixed = [x for x in never if not self._world.domain.robot_can_change(x.predicate)]
        if exclusive is not None:
            a, b = (self._wording.event(x) for x in exclusive)
            text = f"{name} may never come: that {a} and that {b} exclude each other"
        elif fixed:
            text = f"{name} can never come: nothing can change whether {self._events(fixed)}"
        elif never:
            text = (
                f"{name} can never come: I would wait until {self._events(never)}, and only I could"
                " see to that. Make it a step of its own instead"
            )
        else:
            return
        yield Warning(sentence(text), transition.id)

    def _holds_already(
        self, transition: Transition, siblings: Sequence[Transition], state: State
    ) -> Iterator[Warning]:
        if not all(map(state.holds, transition.when)):
            return
        words = self._events(transition.when)
        other = next((t for t in siblings if not t.when), None)
        if other is not None:
            text = f"{self._name(other)} will never come, as it already holds there that {words}"
        else:
            text = (
                f"the robot won't wait before {self._name(transition)}, as it already holds there"
                f" that {words}"
            )
        yield Warning(sentence(text), transition.id)

    def _overlap(self, first: Transition, second: Transition, state: State) -> Iterator[Warning]:
        """Two ways that may be right at once; one condition may hold all that the other one asks for."""
        if self._exclude((*first.when, *second.when)):
            return
        one, two = self._name(first), self._name(second)
        # What holds already distinguishes nothing.
        a, b = ({x for x in t.when if not state.holds(x)} for t in (first, second))
        if not a or not b:
            a, b = set(first.when), set(second.when)
        if a <= b:
            text = (
                f"{one} and {two} may both be right: whenever {self._events(second.when)}, the robot"
                f" takes {one}, which comes first, and so {two} will never come. Say what has to be"
                f" different for {one}"
            )
        elif b < a:
            text = (
                f"{one} and {two} may both be right: when {self._events(first.when)}, the robot takes"
                f" {one}, which comes first"
            )
        elif a & b:
            shared = self._events(sorted(a & b))
            text = (
                f"{one} and {two} may both be right when {shared}; the robot takes the first that"
                " holds"
            )
        else:
            return
        yield Warning(sentence(text), second.id)

    def _nothing_to_do(self, transition: Transition, before: State) -> Iterator[Warning]:
        """A goal for all of a kind of which there is none, said aloud (DESIGN section 5 point 7)."""
        state = before.after_event(transition.when, self._mutexes)
        checkpoint = self._automaton.checkpoints[transition.target]
        for goal in checkpoint.goals:
            if not isinstance(goal, Quantified) or goal.quantifier != "forall":
                continue
            if next(choices((goal,), state, self._world), None) == ():
                none = none_of(goal, self._wording)
                text = f'{none}, so "{self._wording.goal(goal)}" has nothing to do'
                yield Warning(sentence(text), transition.id)

    def _may_come(self, literal: Literal) -> bool:
        """Whether people may bring a literal about, if only by displacing what excludes it."""
        people = self._world.domain.people_can_change
        if people(literal.predicate):
            return True
        shared = [g for g in self._mutexes.groups if any(True for _ in g.keys(literal.atom))]
        others = [p for g in shared for p in g.patterns if p.predicate != literal.predicate]
        if not literal.positive:
            return any(people(p.predicate) for p in others)
        # The hand becomes empty where somebody takes from it what it holds.
        return literal.predicate in self._mutexes.defaults and any(
            people(p.predicate)
            for other in others
            for g in self._mutexes.groups
            if any(q.predicate == other.predicate for q in g.patterns)
            for p in g.patterns
        )

    def _exclude(self, literals: Sequence[Literal]) -> tuple[Literal, Literal] | None:
        """The first two literals that can't hold together, or None."""
        for a, b in itertools.combinations(literals, 2):
            if a == b.negation or (a.positive and b.positive and self._mutexes.exclusive(a, b)):
                return a, b
        return None

    def _name(self, transition: Transition) -> str:
        return self._automaton.checkpoints[transition.target].name

    def _events(self, when: Sequence[Literal]) -> str:
        return listed([self._wording.event(x) for x in when])
