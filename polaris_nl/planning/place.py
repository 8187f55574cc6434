"""Where in a program a problem stands."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

from polaris_nl.automaton.automaton import Automaton, Checkpoint, Transition
from polaris_nl.model.formula import Literal
from polaris_nl.model.state import State
from polaris_nl.model.text import sentence
from polaris_nl.planning.result import Problem, Segment


@dataclass(frozen=True, slots=True)
class Place:
    """Where in a program a problem stands.

    Attributes:
        state: the state before the segment, the conditional made true.
        goals: the literals that the checkpoint asks for.
        known: the segments that have a plan so far, by the checkpoint that they lead to.
    """

    automaton: Automaton
    checkpoint: Checkpoint
    transition: Transition
    state: State
    goals: tuple[Literal, ...]
    known: Mapping[str, Segment] = field(default_factory=dict)

    def back(self, start: State) -> Iterator[tuple[Transition | Segment, State]]:
        """What happened before, the latest first: conditionals and segments, each with the state before it.

        Args:
            start: the state at the program's start.
        """
        transition: Transition | None = self.transition
        while transition is not None:
            earlier = self.known.get(transition.source)
            if transition.when:
                yield transition, earlier.after if earlier else start
            if earlier is None:
                return
            if earlier.actions:
                yield earlier, earlier.before
            transition = self.automaton.incoming(earlier.target)


def inside(checkpoint: Checkpoint, transition: Transition | None, omitted: Checkpoint) -> Problem:
    """The problem of a checkpoint that comes after one that is left out."""
    text = f'"{checkpoint.name}" waits for "{omitted.name}", which I can\'t do.'
    return Problem("inside", sentence(text), checkpoint.id, transition.id if transition else None)
