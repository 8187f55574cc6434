"""The goal automaton: checkpoints joined by conditional transitions.

After Porfirio, Roberts and Hiatt, "Goal-Oriented End-User Programming of Robots" (HRI 2024),
section 3.2: the tuple (P, C, Lc, ->, c0). `Checkpoint.goals` is Lc, and c0 is the always empty
checkpoint `start`.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING
from typing import Literal as OneOf

from polaris_nl.model.domain import Action
from polaris_nl.model.errors import EditError, did_you_mean
from polaris_nl.model.formula import Goal, Literal

if TYPE_CHECKING:
    import networkx as nx

START = "c0"


@dataclass(frozen=True, slots=True)
class Checkpoint:
    """A named set of goals.

    Attributes:
        id: stable for the checkpoint's life, such as `c3`.
        name: what the user calls it.
        goals: in the order they were said; the order has no meaning.
        action: an action the user insists on instead of goals, or None.
    """

    id: str
    name: str
    goals: tuple[Goal, ...] = ()
    action: Action | None = None


@dataclass(frozen=True, slots=True)
class Transition:
    """From a checkpoint to the next, once a conditional holds.

    Attributes:
        when: the conditional, a set of literals (the order has no meaning); empty = no conditional.
        on: taken when the action of the source succeeded or failed, or None.
    """

    id: str
    source: str
    target: str
    when: tuple[Literal, ...] = ()
    on: OneOf["success", "failure"] | None = None

    @property
    def conditional(self) -> frozenset[Literal]:
        """The conditional as a set, for comparing."""
        return frozenset(self.when)


def _start() -> Mapping[str, Checkpoint]:
    return {START: Checkpoint(START, "start")}


@dataclass(frozen=True)
class Automaton:
    """A program. Values are frozen: `polaris_nl.automaton.edits.apply` makes new ones.

    Attributes:
        checkpoints: by id, in the order they were made.
        transitions: by id, in the order they were made.
    """

    checkpoints: Mapping[str, Checkpoint] = field(default_factory=_start)
    transitions: Mapping[str, Transition] = field(default_factory=dict)

    @cached_property
    def graph(self) -> nx.MultiDiGraph[str]:
        """Checkpoint ids joined by transition ids (the edge keys). Never change it."""
        import networkx as nx  # Takes longer to load than a screen may take to appear.

        graph: nx.MultiDiGraph[str] = nx.MultiDiGraph()
        graph.add_nodes_from(self.checkpoints)
        for transition in self.transitions.values():
            graph.add_edge(transition.source, transition.target, key=transition.id)
        return graph

    @cached_property
    def _outgoing(self) -> Mapping[str, tuple[Transition, ...]]:
        found: dict[str, list[Transition]] = {}
        for transition in self.transitions.values():
            found.setdefault(transition.source, []).append(transition)
        return {source: tuple(transitions) for source, transitions in found.items()}

    @cached_property
    def _incoming(self) -> Mapping[str, tuple[Transition, ...]]:
        found: dict[str, list[Transition]] = {}
        for transition in self.transitions.values():
            found.setdefault(transition.target, []).append(transition)
        return {target: tuple(transitions) for target, transitions in found.items()}

    def outgoing(self, checkpoint: str) -> tuple[Transition, ...]:
        """The transitions that leave a checkpoint."""
        return self._outgoing.get(checkpoint, ())

    def incoming(self, checkpoint: str) -> Transition | None:
        """The transition that leads to a checkpoint; None for the start, and for an unconnected one."""
        return next(iter(self._incoming.get(checkpoint, ())), None)

    def parent(self, checkpoint: str) -> str | None:
        """The checkpoint before this one, or None."""
        transition = self.incoming(checkpoint)
        return transition.source if transition else None

    def children(self, checkpoint: str) -> tuple[str, ...]:
        """The checkpoints right after this one."""
        return tuple(t.target for t in self.outgoing(checkpoint))

    def subtree(self, checkpoint: str) -> tuple[str, ...]:
        """A checkpoint and all that come after it, parents before children."""
        found: dict[str, None] = {}
        waiting = [checkpoint]
        while waiting:
            current = waiting.pop()
            if current not in found:
                found[current] = None
                waiting.extend(reversed(self.children(current)))
        return tuple(found)

    def path(self, checkpoint: str) -> tuple[Transition, ...]:
        """The transitions from the start to a checkpoint."""
        found: list[Transition] = []
        seen = {checkpoint}
        transition = self.incoming(checkpoint)
        while transition is not None:
            found.append(transition)
            if transition.source in seen:
                break
            seen.add(transition.source)
            transition = self.incoming(transition.source)
        return tuple(reversed(found))

    def leaves(self) -> Iterator[str]:
        """The checkpoints that nothing comes after, in the order they are met from the start."""
        for checkpoint in self.subtree(START):
            if not self.outgoing(checkpoint):
                yield checkpoint

    def is_else(self, transition: str) -> bool:
        """Whether a transition has no conditional while a sibling has one (DESIGN section 2)."""
        this = self.transitions[transition]
        return not this.when and any(t.when for t in self.outgoing(this.source))

    def named(self, name: str) -> Checkpoint | None:
        """The checkpoint of a name, or None."""
        return next((c for c in self.checkpoints.values() if c.name == name), None)

    def checkpoint(self, checkpoint: str) -> Checkpoint:
        """The checkpoint of an id.

        Raises:
            EditError: there is none.
        """
        if checkpoint not in self.checkpoints:
            hint = did_you_mean(checkpoint, self.checkpoints)
            raise EditError(f"There is no checkpoint {checkpoint} in this program.{hint}")
        return self.checkpoints[checkpoint]

    def transition(self, transition: str) -> Transition:
        """The transition of an id.

        Raises:
            EditError: there is none.
        """
        if transition not in self.transitions:
            hint = did_you_mean(transition, self.transitions)
            raise EditError(f"There is no transition {transition} in this program.{hint}")
        return self.transitions[transition]

    def fresh_checkpoint_id(self) -> str:
        """An id that no checkpoint has."""
        return _fresh("c", self.checkpoints)

    def fresh_transition_id(self) -> str:
        """An id that no transition has."""
        return _fresh("t", self.transitions)

    def fresh_name(self, wanted: str) -> str:
        """The wanted name where it is free, else the same with the next free number: `home`, `home 2`."""
        taken = {c.name for c in self.checkpoints.values()}
        if wanted not in taken:
            return wanted
        number = 2
        while f"{wanted} {number}" in taken:
            number += 1
        return f"{wanted} {number}"

    def with_checkpoint(self, checkpoint: Checkpoint) -> Automaton:
        """Adds a checkpoint, or replaces the one of the same id in place."""
        return replace(self, checkpoints={**self.checkpoints, checkpoint.id: checkpoint})

    def with_transition(self, transition: Transition) -> Automaton:
        """Adds a transition, or replaces the one of the same id in place."""
        return replace(self, transitions={**self.transitions, transition.id: transition})

    def without(self, checkpoints: frozenset[str], transitions: frozenset[str]) -> Automaton:
        """Leaves out checkpoints, the transitions at them, and other transitions."""
        return Automaton(
            {k: c for k, c in self.checkpoints.items() if k not in checkpoints},
            {
                k: t
                for k, t in self.transitions.items()
                if k not in transitions
                and t.source not in checkpoints
                and t.target not in checkpoints
            },
        )


def _fresh(letter: str, taken: Mapping[str, object]) -> str:
    numbers = [int(k[1:]) for k in taken if k[:1] == letter and k[1:].isdecimal() and k.isascii()]
    return f"{letter}{max(numbers, default=0) + 1}"
