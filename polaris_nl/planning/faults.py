"""What is wrong with a program before any planning, with ways out: names, types, forks and its shape."""

from __future__ import annotations

import difflib
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

from polaris_nl.automaton.automaton import START, Automaton, Checkpoint, Transition
from polaris_nl.automaton.edits import (
    Connect,
    Disconnect,
    MoveCheckpoint,
    RemoveCheckpoint,
    RenameCheckpoint,
    SetConditional,
    SetGoals,
)
from polaris_nl.automaton.validation import Fault, no_goal
from polaris_nl.model.check import Types, formula_faults
from polaris_nl.model.formula import Formula, Literal, Or
from polaris_nl.model.state import ANY, Mutexes
from polaris_nl.model.text import sentence
from polaris_nl.model.wording import Wording
from polaris_nl.model.world import World
from polaris_nl.planning.budget import within
from polaris_nl.planning.result import Problem, Repair
from polaris_nl.planning.segments import Segments
from polaris_nl.planning.trial import Outcome, Trial

MOST = 3
"""Ways out of one fault that are offered at most."""
BUDGET_S = 2.0
"""How long ways out of one fault are looked for, in seconds."""
MOST_NAMES = 3
"""Names that are tried in the place of one that isn't known."""


class Faults:
    """Finds ways out of the faults of one world's programs."""

    def __init__(
        self, world: World, mutexes: Mutexes, segments: Segments, wording: Wording
    ) -> None:
        self._world = world
        self._mutexes = mutexes
        self._wording = wording
        self._trial = Trial(world, mutexes, segments)
        self._types: Types = {
            **world.domain.constants,
            **{e.name: e.type for e in world.entities.values()},
        }

    def problems(
        self, automaton: Automaton, faults: Sequence[Fault], cancelled: Callable[[], bool]
    ) -> tuple[Problem, ...]:
        """The problem that each fault is, with what mends it."""
        return tuple(self._problem(automaton, fault, faults, cancelled) for fault in faults)

    def _problem(
        self,
        automaton: Automaton,
        fault: Fault,
        faults: Sequence[Fault],
        cancelled: Callable[[], bool],
    ) -> Problem:
        over = within(BUDGET_S, cancelled)
        repairs: list[Repair] = []
        for repair in self._proposals(automaton, fault):
            if over() or len(repairs) == MOST:
                break
            outcome = self._trial.of(automaton, repair.edits, None, over)
            if outcome is not None and _mends(outcome, fault, faults):
                repairs.append(repair)
        text = fault.text
        if fault.cause == "underspecified":
            text = self._same_condition(automaton, fault)
        if repairs and "Did you mean" not in text:
            text = f"{sentence(text.partition(';')[0])} {sentence(f'you could {repairs[0].text}')}"
        return Problem(
            fault.cause, text, fault.checkpoint, fault.transition, repairs=tuple(repairs)
        )

    def _proposals(self, automaton: Automaton, fault: Fault) -> Iterator[Repair]:
        if fault.cause == "underspecified":
            yield from self._forks(automaton, fault)
        elif fault.cause == "structure":
            yield from _shapes(automaton, fault)
        elif fault.transition is not None:
            yield from self._conditionals(automaton.transitions[fault.transition])
        elif fault.checkpoint is not None:
            yield from self._goals(automaton.checkpoints[fault.checkpoint])

    # Names and types

    def _goals(self, checkpoint: Checkpoint) -> Iterator[Repair]:
        goals = checkpoint.goals
        for goal in goals:
            if self._is_right(goal):
                continue
            others = list(self._instead(goal))
            for other in others:
                changed = tuple(other if g == goal else g for g in goals)
                text = f"{self._wording.goal(other)} instead"
                yield Repair(text, (SetGoals(checkpoint.id, changed),), "change")
            kept = tuple(g for g in goals if g != goal)
            words = f" and only {self._wording.goals(kept)}" if kept else ""
            text = f'leave that out of "{checkpoint.name}"{words}'
            yield Repair(text, (SetGoals(checkpoint.id, kept),), "drop")

    def _conditionals(self, transition: Transition) -> Iterator[Repair]:
        for literal in transition.when:
            if literal.predicate in self._world.domain.predicates and self._is_right(literal):
                continue
            for other in self._instead(literal):
                if isinstance(other, Literal):
                    when = tuple(other if x == literal else x for x in transition.when)
                    text = f"wait until {self._wording.event(other)} instead"
                    yield Repair(text, (SetConditional(transition.id, when),), "change")
            kept = tuple(x for x in transition.when if x != literal)
            yield Repair("leave that condition out", (SetConditional(transition.id, kept),), "drop")

    def _is_right(self, goal: Formula) -> bool:
        faulty = next(formula_faults(goal, self._world.domain, self._types), None)
        return faulty is None and no_goal(goal) is None

    def _instead(self, goal: Formula) -> Iterator[Formula]:
        """What may have been meant: near names, or a part of an `or`."""
        if isinstance(goal, Or):
            yield from goal.parts
        if not isinstance(goal, Literal):
            return
        predicates = self._world.domain.predicates
        if goal.predicate not in predicates:
            for name in difflib.get_close_matches(goal.predicate, predicates, MOST_NAMES, 0.6):
                yield replace(goal, predicate=name)
            return
        parameters = predicates[goal.predicate].parameters
        for at, (arg, parameter) in enumerate(zip(goal.args, parameters, strict=False)):
            fitting = [e.name for e in self._world.of_type(*parameter.types)]
            if arg not in fitting:
                for name in self._near(arg, fitting):
                    args = (*goal.args[:at], name, *goal.args[at + 1 :])
                    yield replace(goal, args=args)

    def _near(self, name: str, fitting: Sequence[str]) -> list[str]:
        """Entities that may be meant by a name, or by an entity that has another type."""
        if name in self._types:
            related = {a for f in self._world.facts if name in f.args for a in f.args}
            owned = {e.name for e in self._world.entities.values() if e.owner == name}
            return [f for f in fitting if f in related or f in owned][:MOST_NAMES]
        called = {
            said: entity
            for entity in fitting
            for said in (*self._world.entities[entity].synonyms, entity)
        }
        spoken = difflib.get_close_matches(name, called, MOST_NAMES, 0.6)
        return list(dict.fromkeys(called[said] for said in spoken))

    # Forks

    def _forks(self, automaton: Automaton, fault: Fault) -> Iterator[Repair]:
        first, second = _same(automaton, fault)
        one, two = (automaton.checkpoints[t.target].name for t in (first, second))
        for literal in second.when if len(second.when) == 1 else ():
            for other in self._opposites(literal):
                text = f'do "{two}" once {self._wording.event(other)}'
                yield Repair(text, (SetConditional(second.id, (other,)),), "condition")
        after = MoveCheckpoint(second.target, first.target)
        yield Repair(f'do "{two}" after "{one}"', (after,), "reorder")
        if second.when:
            yield Repair(f'do "{two}" otherwise', (SetConditional(second.id, ()),), "condition")
        yield Repair(f'leave out "{two}"', (RemoveCheckpoint(second.target, subtree=True),), "drop")

    def _opposites(self, literal: Literal) -> Iterator[Literal]:
        """What may happen instead of an event: dismissed instead of acknowledged."""
        for group in self._mutexes.groups:
            if any(ANY in p.args for p in group.patterns):
                continue
            for pattern in group.patterns:
                if pattern.predicate != literal.predicate:
                    yield replace(literal, predicate=pattern.predicate)

    def _same_condition(self, automaton: Automaton, fault: Fault) -> str:
        first, second = _same(automaton, fault)
        source, one, two = (
            automaton.checkpoints[c].name for c in (first.source, first.target, second.target)
        )
        when = f"once {self._wording.events(first.when)}" if first.when else "without a condition"
        return (
            f"From {source}, both {one} and {two} come next {when}, so I can't tell which to take"
        )


def _same(automaton: Automaton, fault: Fault) -> tuple[Transition, Transition]:
    """The two transitions that can't be told apart."""
    second = automaton.transitions[fault.transition or ""]
    first = next(
        t
        for t in automaton.outgoing(second.source)
        if (t.conditional, t.on) == (second.conditional, second.on)
    )
    return first, second


def _shapes(automaton: Automaton, fault: Fault) -> Iterator[Repair]:
    if fault.transition is not None:
        yield Repair("remove that transition", (Disconnect(fault.transition),), "shape")
    elif fault.checkpoint not in (None, START):
        yield from _connections(automaton, automaton.checkpoints[str(fault.checkpoint)])
    elif fault.checkpoint is None:
        names: set[str] = set()
        for checkpoint in automaton.checkpoints.values():
            if checkpoint.name in names:
                name = automaton.fresh_name(checkpoint.name)
                text = f'call the later one "{name}"'
                yield Repair(text, (RenameCheckpoint(checkpoint.id, name),), "shape")
            names.add(checkpoint.name)


def _connections(automaton: Automaton, checkpoint: Checkpoint) -> Iterator[Repair]:
    ways_in = [t for t in automaton.transitions.values() if t.target == checkpoint.id]
    if len(ways_in) > 1:
        for transition in reversed(ways_in):
            source = automaton.checkpoints.get(transition.source)
            if source is not None:
                text = f'take away the way from "{source.name}" to "{checkpoint.name}"'
                yield Repair(text, (Disconnect(transition.id),), "shape")
    elif not ways_in:
        last = next(automaton.leaves(), START)
        name = automaton.checkpoints[last].name
        way = Transition(automaton.fresh_transition_id(), last, checkpoint.id)
        yield Repair(f'do "{checkpoint.name}" after "{name}"', (Connect(way),), "shape")
        yield Repair(f'leave out "{checkpoint.name}"', (RemoveCheckpoint(checkpoint.id),), "drop")


def _mends(outcome: Outcome, fault: Fault, faults: Sequence[Fault]) -> bool:
    """Whether a fault is gone and no other has come; and, where none is left, whether there is a plan."""
    before = {(f.cause, f.checkpoint, f.transition, f.text) for f in faults}
    left = {(f.cause, f.checkpoint, f.transition, f.text) for f in outcome.faults}
    this = (fault.cause, fault.checkpoint, fault.transition, fault.text)
    return left < before and this not in left and fault.checkpoint not in outcome.failed
