"""Why an action is in a plan: the causal links from what it brings about to the goals that need it.

A causal link is an action, a fact that it makes true and a later action or goal that needs the fact
(McAllester and Rosenblitt, "Systematic Nonlinear Planning", AAAI 1991). Links alone say too much:
the way to the kitchen is linked to everything that is done after the kitchen. So an action is only
said to serve a goal if a chain of links leads there on which every action is needed: the goal is
missed without it, where all that can't be done without it is left out, too (greedy action
elimination: Nakhost and Mueller, "Action Elimination and Plan Neighborhood Graph Search", ICAPS 2010).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

from polaris_nl.automaton.automaton import START, Automaton
from polaris_nl.model.domain import Action
from polaris_nl.model.evaluate import after, applicable
from polaris_nl.model.formula import Literal, bind, literals_in
from polaris_nl.model.state import State
from polaris_nl.model.world import World
from polaris_nl.planning.result import BranchingPlan, Segment


@dataclass(frozen=True, slots=True)
class Step:
    """The place of an action in a branching plan.

    Attributes:
        checkpoint: the checkpoint that its segment ends at.
        at: its place in the segment, from 0.
    """

    checkpoint: str
    at: int


@dataclass(frozen=True, slots=True)
class Reason:
    """A causal link.

    Attributes:
        fact: what the action makes true or, where it is negative, false.
        needed_by: the later action that needs it, or None where it is a goal itself.
        checkpoint: the checkpoint whose segment or goal needs it.
        step: the place of `needed_by`, or None.
    """

    fact: Literal
    needed_by: Action | None
    checkpoint: str
    step: Step | None = None


@dataclass(frozen=True, slots=True)
class Purpose:
    """A goal that an action serves.

    Attributes:
        goal: the goal, of `checkpoint`.
        chain: from the action to the goal, link by link; the last one is the goal's own.
    """

    goal: Literal
    checkpoint: str
    chain: tuple[Reason, ...]


def reasons_for(
    plan: BranchingPlan, automaton: Automaton, world: World, segment: Segment, at: int
) -> tuple[Reason, ...]:
    """What needs an action at once: the first use of each fact that it brings about, on every branch.

    Args:
        plan: the whole plan.
        automaton: its program.
        world: the world it is planned in.
        segment: the segment of the action.
        at: the action's place in it, from 0.
    """
    return Reasons(plan, automaton, world).links(Step(segment.target, at))


@dataclass(frozen=True)
class Reasons:
    """Finds out what the actions of one plan are for."""

    plan: BranchingPlan
    automaton: Automaton
    world: World

    def links(self, step: Step) -> tuple[Reason, ...]:
        """The first use of each fact that an action brings about, on every branch."""
        found: dict[tuple[Literal, str], Reason] = {}
        for fact in self._made(step):
            for branch in self._branches(step.checkpoint):
                first = next(self._uses(fact, step, branch), None)
                if first is not None:
                    found.setdefault((fact, first.checkpoint), first)
        return tuple(found.values())

    def purposes(self, step: Step) -> tuple[Purpose, ...]:
        """The goals that an action serves, nearest first, each with the chain that leads to it."""
        found = []
        for checkpoint, goal in self._missed(step):
            chain = tuple(self._chain(step, goal, checkpoint))
            if chain and chain[-1].step is None:
                found.append(Purpose(goal, checkpoint, chain))
        return tuple(found)

    def _chain(self, step: Step, goal: Literal, checkpoint: str) -> Iterator[Reason]:
        """At each action the first use that serves the goal."""
        branch = self._path(checkpoint)
        while True:
            link = self._next(step, goal, checkpoint, branch)
            if link is None:
                return
            yield link
            if link.step is None:
                return
            step = link.step

    def _next(
        self, step: Step, goal: Literal, checkpoint: str, branch: Sequence[str]
    ) -> Reason | None:
        found: list[Reason] = []
        for fact in self._made(step):
            for use in self._uses(fact, step, branch):
                if use.step is None:
                    if (fact, use.checkpoint) == (goal, checkpoint):
                        return use
                elif (checkpoint, goal) in self._missed(use.step):
                    found.append(use)
                    break
        return min(found, key=lambda use: self._order(use, branch), default=None)

    def _order(self, use: Reason, branch: Sequence[str]) -> tuple[int, int]:
        assert use.step is not None
        return branch.index(use.step.checkpoint), use.step.at

    def _uses(self, fact: Literal, step: Step, branch: Sequence[str]) -> Iterator[Reason]:
        """What needs a fact along one branch, from an action on, until it is undone."""
        states = self.states[step.checkpoint]
        here, at = branch.index(step.checkpoint), step.at + 1
        for number, target in enumerate(branch[here:]):
            segment = self.plan.segments[target]
            states = self.states[target]
            if number and not segment.before.holds(fact):
                return
            for place in range(at if not number else 0, len(segment.actions)):
                action = segment.actions[place]
                if self._needs(action, states[place], fact):
                    yield Reason(fact, action, target, Step(target, place))
                if not states[place + 1].holds(fact):
                    return
            if fact in segment.goals:
                yield Reason(fact, None, target)

    def _needs(self, action: Action, state: State, fact: Literal) -> bool:
        operator = self.world.domain.operators[action.operator]
        if action not in self._asked_by:
            asked = literals_in(bind(operator.precondition, operator.binding(action)))
            self._asked_by[action] = frozenset(
                x.predicate if any(a.startswith("?") for a in x.args) else x.atom for x in asked
            )
        if self._asked_by[action].isdisjoint((fact.atom, fact.predicate)):
            return False  # Quick: most actions have nothing to do with a fact.
        without = state.change((fact,), ()) if fact.positive else state.change((), (fact.atom,))
        return not applicable(action, operator, without, self.world)

    def _made(self, step: Step) -> tuple[Literal, ...]:
        states = self.states[step.checkpoint]
        removed, added = states[step.at].difference(states[step.at + 1])
        return (*added, *(fact.negation for fact in removed))

    def _missed(self, step: Step) -> tuple[tuple[str, Literal], ...]:
        """The goals, each with its checkpoint, that are missed without an action."""
        if step not in self._known:
            self._known[step] = tuple(self._eliminated(step))
        return self._known[step]

    def _eliminated(self, step: Step) -> Iterator[tuple[str, Literal]]:
        waiting = [(step.checkpoint, self.states[step.checkpoint][step.at], step.at + 1)]
        while waiting:
            target, state, at = waiting.pop()
            segment = self.plan.segments[target]
            state = self._rest(segment, state, at)
            if state == segment.after:
                continue  # From here on all is as it is with the action.
            yield from ((target, goal) for goal in segment.goals if not state.holds(goal))
            for onward in reversed(self.automaton.children(target)):
                if onward in self.plan.segments:
                    # What happens between two segments happens without the action, too.
                    gone, come = segment.after.difference(self.plan.segments[onward].before)
                    waiting.append((onward, state.change(gone, come), 0))

    def _rest(self, segment: Segment, state: State, at: int) -> State:
        """The state after those actions of a segment, from a place on, that can be done."""
        for place in range(at, len(segment.actions)):
            if state == self.states[segment.target][place]:
                return segment.after
            action = segment.actions[place]
            operator = self.world.domain.operators[action.operator]
            if applicable(action, operator, state, self.world):
                state = after(action, operator, state, self.world)
        return state

    def _branches(self, checkpoint: str) -> Iterator[tuple[str, ...]]:
        """The checkpoints of each branch that leads over one, the start left out."""
        for target in self.automaton.subtree(checkpoint):
            onward = [c for c in self.automaton.children(target) if c in self.plan.segments]
            if target in self.plan.segments and not onward:
                yield self._path(target)

    def _path(self, checkpoint: str) -> tuple[str, ...]:
        return tuple(t.target for t in self.automaton.path(checkpoint) if t.target != START)

    @cached_property
    def _asked_by(self) -> dict[Action, frozenset[Literal | str]]:
        """What an action's precondition speaks of: atoms, and predicates where any entity will do."""
        return {}

    @cached_property
    def _known(self) -> dict[Step, tuple[tuple[str, Literal], ...]]:
        return {}

    @cached_property
    def states(self) -> dict[str, list[State]]:
        """By checkpoint, the state before each action of its segment, and the one at its end."""
        return {target: self._along(segment) for target, segment in self.plan.segments.items()}

    def _along(self, segment: Segment) -> list[State]:
        states = [segment.before]
        for action in segment.actions:
            operator = self.world.domain.operators[action.operator]
            states.append(after(action, operator, states[-1], self.world))
        return states
