"""Planning several checkpoints of a branch together (DESIGN section 5 point 6).

Segment after segment, each as short as can be, may walk into a dead end, or take longer than it has
to. Together they are one planning problem: the goals of each checkpoint are to be reached in order,
and an extra action without a cost of its own in the world marks that they are. It also brings about
what the next transition waits for, with all that this displaces.
"""

from __future__ import annotations

import itertools
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

from polaris_nl.automaton.program import parse_action
from polaris_nl.model.domain import Action, Domain, Operator, Predicate
from polaris_nl.model.errors import PlanningError
from polaris_nl.model.formula import And, Formula, Literal, When
from polaris_nl.model.state import ANY, Mutexes, State
from polaris_nl.model.world import World
from polaris_nl.planning.budget import within
from polaris_nl.planning.memory import Memory
from polaris_nl.planning.pddl_text import domain_text, problem_text
from polaris_nl.planning.projection import Projection
from polaris_nl.planning.search import OPTIMAL, OPTIMAL_ANY, QUICK, search
from polaris_nl.planning.simulate import Simulator
from polaris_nl.planning.translate import translate

MOST_DISPLACED = 2_000
"""Facts that one event may displace; with more, it isn't planned ahead over."""
MOST_DENIED = 2
"""Goals of a sequence that may be negative: the translator counts all combinations of what may hold instead."""
MOST_REMEMBERED = 2_000
_STAGE = "polaris-stage-"
_REACH = "polaris-reach-"

Ways = tuple[tuple[Action, ...], ...]


@dataclass(frozen=True, slots=True)
class Stage:
    """A checkpoint in a sequence.

    Attributes:
        goals: what holds when it is reached.
        when: what comes about then, before the next checkpoint: the conditional of the transition.
    """

    goals: tuple[Literal, ...]
    when: tuple[Literal, ...] = ()


@dataclass(frozen=True, slots=True)
class _Found:
    """What was found; not finding anything is certain only if it didn't take all of the budget."""

    ways: Ways | None
    budget_s: float
    certain: bool


class Ahead:
    """Plans sequences of checkpoints in one world, and remembers them."""

    def __init__(self, world: World, mutexes: Mutexes) -> None:
        self._world = world
        self._mutexes = mutexes
        self._projection = Projection(world, mutexes)
        self._simulator = Simulator(world)
        self._known: Memory[tuple[State, tuple[Stage, ...]], _Found] = Memory(MOST_REMEMBERED)

    def ways(
        self,
        state: State,
        stages: Sequence[Stage],
        budget_s: float,
        cancelled: Callable[[], bool],
    ) -> Ways | None:
        """The actions to each stage, as few in all as can be found; None where nothing is found.

        Args:
            state: where the sequence starts.
            stages: in order; what comes about after the last is left aside.
            budget_s: the hard limit, in seconds.
            cancelled: asked now and then; True ends the work.
        """
        key = (state, tuple(stages))
        known = self._known.get(key)
        if known is None or not (known.certain or known.budget_s >= budget_s):
            started = time.monotonic()
            ways = self._plan(state, stages, budget_s, cancelled)
            certain = ways is not None or time.monotonic() - started < budget_s * 0.7
            known = _Found(ways, budget_s, certain)
            if not cancelled():
                self._known.put(key, known)
        return known.ways

    def _plan(
        self,
        state: State,
        stages: Sequence[Stage],
        budget_s: float,
        cancelled: Callable[[], bool],
    ) -> Ways | None:
        named = [x for stage in stages for x in (*stage.goals, *stage.when)]
        world, start = self._projection.of(state, named)
        domain = self._extended(world, stages)
        denied = sum(not goal.positive for stage in stages for goal in stage.goals)
        if domain is None or denied > MOST_DENIED:
            return None
        first = Literal(f"{_STAGE}0")
        goals = (*stages[-1].goals, Literal(f"{_STAGE}{len(stages) - 1}"))
        text = problem_text(replace(world, domain=domain), start.change((), (first,)), goals)
        try:
            task = translate(domain_text(domain, written=True), text, within(budget_s, cancelled))
            if not task.sas:
                return None
            engine = OPTIMAL if task.plain else OPTIMAL_ANY
            found = search(task.sas, engine, budget_s * 0.7, cancelled)
            if found.status == "undecided":
                found = search(task.sas, QUICK, budget_s * 0.3, cancelled)
        except PlanningError:
            return None
        if found.status != "solved":
            return None
        return self._early(state, stages, _split(found.plan, len(stages)))

    def _early(self, state: State, stages: Sequence[Stage], ways: Ways) -> Ways:
        """The same actions, each stage reached as soon as its goals hold and nothing is waited for."""
        found: list[tuple[Action, ...]] = []
        carried: tuple[Action, ...] = ()
        for stage, way in zip(stages, ways, strict=True):
            actions, carried = (*carried, *way), ()
            steps = self._simulator.run(state, actions)
            if steps is None:
                return ways
            states = [state, *(step.state for step in steps)]
            if not stage.when and len(found) < len(stages) - 1:
                reached = (n for n, s in enumerate(states) if all(map(s.holds, stage.goals)))
                count = next(reached, len(actions))
                actions, carried = actions[:count], actions[count:]
            state = states[len(actions)]
            state = state.after_event(stage.when, self._mutexes) if stage.when else state
            found.append(actions)
        return tuple(found)

    def _extended(self, world: World, stages: Sequence[Stage]) -> Domain | None:
        """The domain with the actions that mark that a stage is reached; None where it can't be said."""
        predicates = dict(world.domain.predicates)
        operators = dict(world.domain.operators)
        for number in range(len(stages)):
            name = f"{_STAGE}{number}"
            predicates[name] = Predicate(name)
        for number, stage in enumerate(stages[:-1]):
            event = self._event(stage.when, world)
            if event is None:
                return None
            now, then = Literal(f"{_STAGE}{number}"), Literal(f"{_STAGE}{number + 1}")
            name = f"{_REACH}{number}"
            operators[name] = Operator(
                name, (), And((now, *stage.goals)), And((now.negation, then, *event))
            )
        # Conditions of operators may name constants only.
        constants = {e.name: e.type for e in world.entities.values()}
        return replace(
            world.domain, predicates=predicates, operators=operators, constants=constants
        )

    def _event(self, when: Sequence[Literal], world: World) -> list[Formula] | None:
        """What a conditional changes, as effects: the same as `State.after_event`."""
        gained = [x for x in when if x.positive]
        if any(self._mutexes.exclusive(a, b) for a, b in itertools.combinations(gained, 2)):
            return None
        lost = {x.atom for x in when if not x.positive}
        for atom in gained:
            lost.update(itertools.islice(self._excluded(atom, world), MOST_DISPLACED + 1))
        lost -= set(gained)
        if len(lost) > MOST_DISPLACED:
            return None
        effects: list[Formula] = [x.negation for x in sorted(lost)]
        for group in self._mutexes.groups:
            for default in group.patterns:
                if default.predicate not in self._mutexes.defaults or default.args:
                    continue
                if default in lost and default.negation in when:
                    return None
                if not any(_is_in(group.keys(x)) for x in gained):
                    members = (x for x in sorted(lost) if x != default and _is_in(group.keys(x)))
                    effects.extend(When(x, default) for x in members)
        return [*effects, *gained]

    def _excluded(self, atom: Literal, world: World) -> Iterator[Literal]:
        """The atoms that can't hold beside an atom, of the entities there are."""
        for group in self._mutexes.groups:
            for key in group.keys(atom):
                bound = dict(key)
                for pattern in group.patterns:
                    parameters = world.domain.predicates[pattern.predicate].parameters
                    choices = [
                        [e.name for e in world.of_type(*p.types)] if a == ANY else [bound.get(a, a)]
                        for a, p in zip(pattern.args, parameters, strict=True)
                    ]
                    for args in itertools.product(*choices):
                        other = Literal(pattern.predicate, args)
                        if other != atom:
                            yield other


def _is_in(keys: Iterator[object]) -> bool:
    return any(True for _ in keys)


def _split(plan: Sequence[str], count: int) -> Ways:
    ways: list[list[Action]] = [[]]
    for text in plan:
        action = parse_action(text)
        if action.operator.startswith(_REACH):
            ways.append([])
        else:
            ways[-1].append(action)
    assert len(ways) == count
    return tuple(map(tuple, ways))
