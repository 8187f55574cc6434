"""What is wrong with a program before any planning: its structure and its names."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal as OneOf

from polaris_nl.automaton.automaton import START, Automaton, Transition
from polaris_nl.model.check import Types, action_faults, formula_faults
from polaris_nl.model.domain import KIND
from polaris_nl.model.formula import And, Equal, Formula, Imply, Literal, Not, Or, Quantified
from polaris_nl.model.world import World

Cause = OneOf["structure", "invalid", "underspecified"]


@dataclass(frozen=True, slots=True)
class Fault:
    """Something that keeps a program from being planned.

    Attributes:
        cause: `structure` (not a tree), `invalid` (names or types), `underspecified` (DESIGN
            section 5 point 3).
        text: a sentence for a person, with a way out.
    """

    cause: Cause
    text: str
    checkpoint: str | None = None
    transition: str | None = None


def validate(automaton: Automaton, world: World) -> tuple[Fault, ...]:
    """Every structural fault, unknown name, wrong type and underspecified pair of a program."""
    types = {**world.domain.constants, **{e.name: e.type for e in world.entities.values()}}
    return (
        *_structure(automaton),
        *_names(automaton, world, types),
        *_no_goals(automaton),
        *_underspecified(automaton),
    )


def _structure(automaton: Automaton) -> Iterator[Fault]:
    start = automaton.checkpoints.get(START)
    if start is None:
        yield Fault(
            "structure", f"The program has no start; its first checkpoint is {START}, called start."
        )
        return
    if start.goals or start.action:
        yield Fault("structure", "The start has goals; move them to a checkpoint after it.", START)
    for transition in automaton.transitions.values():
        for end in (transition.source, transition.target):
            if end not in automaton.checkpoints:
                text = f"The transition {transition.id} names {end}, which isn't there; remove it."
                yield Fault("structure", text, transition=transition.id)
    ways_in = Counter(t.target for t in automaton.transitions.values())
    for checkpoint in automaton.checkpoints.values():
        if checkpoint.id == START and ways_in[START]:
            yield Fault(
                "structure",
                "Something leads back to the start, and programs can't loop yet.",
                START,
            )
        if ways_in[checkpoint.id] > 1:
            text = f"Several transitions lead to {checkpoint.name}; give each a checkpoint."
            yield Fault("structure", text, checkpoint.id)
    reached = set(automaton.subtree(START))
    for checkpoint in automaton.checkpoints.values():
        if checkpoint.id not in reached:
            text = f"Nothing leads to {checkpoint.name}; connect it to a checkpoint, or remove it."
            yield Fault("structure", text, checkpoint.id)
    names = Counter(c.name for c in automaton.checkpoints.values())
    for name in sorted(name for name, count in names.items() if count > 1):
        yield Fault(
            "structure", f"{names[name]} checkpoints are called {name}; rename all but one."
        )


def _names(automaton: Automaton, world: World, types: Types) -> Iterator[Fault]:
    for checkpoint in automaton.checkpoints.values():
        for goal in checkpoint.goals:
            for text in formula_faults(goal, world.domain, types):
                yield Fault("invalid", f"In {checkpoint.name}: {text}", checkpoint.id)
        if checkpoint.action is not None:
            for text in action_faults(checkpoint.action, world.domain, types):
                yield Fault("invalid", f"In {checkpoint.name}: {text}", checkpoint.id)
    for transition in automaton.transitions.values():
        for literal in transition.when:
            for text in formula_faults(literal, world.domain, types):
                target = automaton.checkpoints.get(transition.target)
                where = f"to {target.name}" if target else transition.id
                yield Fault(
                    "invalid", f"In the conditional {where}: {text}", transition=transition.id
                )


def _no_goals(automaton: Automaton) -> Iterator[Fault]:
    for checkpoint in automaton.checkpoints.values():
        for goal in checkpoint.goals:
            part = no_goal(goal)
            if part is not None:
                text = f"In {checkpoint.name}: {part} is no goal, as {_why_no_goal(part)}."
                yield Fault("invalid", text, checkpoint.id)
    for transition in automaton.transitions.values():
        for literal in transition.when:
            if literal.predicate == KIND:
                text = f"{literal} is no conditional, as what kind a thing is never changes."
                yield Fault("invalid", text, transition.target, transition.id)


def no_goal(goal: Formula, chosen: bool = False) -> Formula | None:
    """The first part of a goal that asks for no fact, such as an `or`; None where all of it does.

    Args:
        goal: the goal.
        chosen: whether it stands inside an `exists`, where kinds and equality pick the things.
    """
    if isinstance(goal, Literal):
        return goal if goal.predicate == KIND and not chosen else None
    if isinstance(goal, And):
        return next((p for p in (no_goal(x, chosen) for x in goal.parts) if p is not None), None)
    if isinstance(goal, Imply):
        return no_goal(goal.conclusion, chosen)
    if isinstance(goal, Quantified):
        return no_goal(goal.body, chosen or goal.quantifier == "exists")
    picks = goal.part if isinstance(goal, Not) else goal
    kind = isinstance(picks, Literal) and picks.predicate == KIND
    return None if chosen and (isinstance(picks, Equal) or kind) else goal


def _why_no_goal(part: Formula) -> str:
    if isinstance(part, Literal):
        return "the world's file says what kind a thing is, and no action changes it"
    if isinstance(part, Or):
        return (
            'I can\'t choose between goals ("or") yet; ask for one of them, or make two ways with a'
            " condition each"
        )
    return "a goal is a fact, or one for all or some of a kind; ask for one of the facts in it"


def _underspecified(automaton: Automaton) -> Iterator[Fault]:
    for checkpoint in automaton.checkpoints.values():
        seen: dict[object, Transition] = {}
        for transition in automaton.outgoing(checkpoint.id):
            first = seen.setdefault((transition.conditional, transition.on), transition)
            if first is not transition:
                yield _same_conditional(automaton, first, transition)


def _same_conditional(automaton: Automaton, first: Transition, second: Transition) -> Fault:
    def name(checkpoint: str) -> str:
        found = automaton.checkpoints.get(checkpoint)
        return found.name if found else checkpoint

    source, one, two = name(first.source), name(first.target), name(second.target)
    condition = (
        f"under the same condition, {' and '.join(map(str, first.when))}"
        if first.when
        else "without a condition"
    )
    text = (
        f"From {source}, both {one} and {two} come next {condition}, so the robot can't tell which to take;"
        f" give one of them another condition, or put one after the other."
    )
    return Fault("underspecified", text, second.target, second.id)
