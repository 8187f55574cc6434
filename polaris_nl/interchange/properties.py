"""What can be told of a program by its shape: the properties that ISL names of its programs."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import networkx as nx

from polaris_nl.automaton.automaton import START, Automaton
from polaris_nl.model.formula import Formula, Literal
from polaris_nl.model.text import listed


@dataclass(frozen=True, slots=True)
class Property:
    """Whether a program has a property, and where it hasn't.

    Attributes:
        name: `loop_free`, `deterministic`, `executable` or `satisfiable`.
        against: what keeps it from having it, a sentence each; none where it has it.
    """

    name: str
    against: tuple[str, ...]

    @property
    def holds(self) -> bool:
        """Whether the program has it."""
        return not self.against


def properties(automaton: Automaton) -> tuple[Property, ...]:
    """Four properties of a program, by its shape alone.

    `loop_free`: no checkpoint comes after itself. `deterministic`: no two transitions from a
    checkpoint have the same conditional. `executable`: something comes after the start, and every
    checkpoint can be reached from there. `satisfiable`: no checkpoint and no conditional asks for a
    fact and its opposite.
    """
    return (
        Property("loop_free", tuple(_loops(automaton))),
        Property("deterministic", tuple(_choices(automaton))),
        Property("executable", tuple(_unreachable(automaton))),
        Property("satisfiable", tuple(_contradictions(automaton))),
    )


def _name(automaton: Automaton, checkpoint: str) -> str:
    return f'"{automaton.checkpoints[checkpoint].name}"'


def _loops(automaton: Automaton) -> Iterator[str]:
    order = {checkpoint: place for place, checkpoint in enumerate(automaton.checkpoints)}
    parts = nx.strongly_connected_components(nx.DiGraph(automaton.graph))
    for part in sorted(
        (sorted(p, key=order.__getitem__) for p in parts), key=lambda p: order[p[0]]
    ):
        if len(part) > 1:
            names = listed([_name(automaton, c) for c in part])
            yield f"{names} come after one another in a loop."
        elif automaton.graph.has_edge(part[0], part[0]):
            yield f"{_name(automaton, part[0])} comes after itself."


def _choices(automaton: Automaton) -> Iterator[str]:
    for checkpoint in automaton.checkpoints:
        alike: dict[object, list[str]] = {}
        for transition in automaton.outgoing(checkpoint):
            key = (transition.conditional, transition.on)
            alike.setdefault(key, []).append(_name(automaton, transition.target))
        for targets in alike.values():
            if len(targets) > 1:
                source = _name(automaton, checkpoint)
                yield f"From {source}, {listed(targets)} come next under the same condition."


def _unreachable(automaton: Automaton) -> Iterator[str]:
    reached = nx.descendants(automaton.graph, START) | {START}
    for checkpoint in automaton.checkpoints:
        if checkpoint not in reached:
            yield f"Nothing leads from the start to {_name(automaton, checkpoint)}."
    if len(reached) == 1:
        yield "Nothing comes after the start."


def _contradictions(automaton: Automaton) -> Iterator[str]:
    for checkpoint in automaton.checkpoints.values():
        for literal in _opposed(checkpoint.goals):
            name = _name(automaton, checkpoint.id)
            yield f"{name} asks for {literal} and for its opposite."
    for transition in automaton.transitions.values():
        for literal in _opposed(transition.when):
            name = _name(automaton, transition.target)
            yield f"The condition before {name} asks for {literal} and for its opposite."


def _opposed(formulas: Iterable[Formula]) -> Iterator[Literal]:
    literals = dict.fromkeys(f for f in formulas if isinstance(f, Literal))
    return (x for x in literals if x.positive and x.negation in literals)
