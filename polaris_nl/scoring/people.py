"""What people may do: the world's human actions, and, for human effort, what they do by hand.

By hand, a person brings about one fact that the robot could bring about as well and that people may
(`; EXOGENOUS:`): puts a thing somewhere, opens something, gives it to somebody. This is how the
paper's assumption that people stay where they are is relaxed. What the operator asks for that isn't
the robot's own affair (where it is, what it holds) is asked of people too: the cupboard is open
before anything is put in it or taken from it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from polaris_nl.model.domain import Domain, Operator, conjuncts, effect_literals
from polaris_nl.model.evaluate import instances_of
from polaris_nl.model.formula import And, Formula, Imply, Literal, Not, Or, Quantified, bind
from polaris_nl.model.state import Mutexes, State
from polaris_nl.model.world import World
from polaris_nl.planning.result import Segment
from polaris_nl.scoring.play import Play


@dataclass(frozen=True, slots=True)
class Act:
    """One thing that a person may do: `effect`, while everything in `when` holds.

    Attributes:
        by_hand: it isn't listed in the world's file.
    """

    name: str
    effect: tuple[Literal, ...]
    when: tuple[Literal, ...] = ()
    by_hand: bool = False


def listed_acts(world: World) -> tuple[Act, ...]:
    """The world's human actions."""
    return tuple(Act(a.name, a.effect, a.when) for a in world.scenario.human_actions)


class Hands:
    """What people do by hand in one world.

    Args:
        world: its domain says what the robot and people may bring about.
        mutexes: what displaces what.
    """

    def __init__(self, world: World, mutexes: Mutexes) -> None:
        self._world = world
        self._mutexes = mutexes
        self._asked: dict[Literal, tuple[tuple[Literal, ...], ...]] = {}

    def acts(self, play: Play) -> tuple[Act, ...]:
        """Everything by hand that can make a difference to a program or its objectives."""
        waiting = list(dict.fromkeys(self._mattering(play)))
        seen = set(waiting)
        found = []
        while waiting:
            literal = waiting.pop(0)
            for when in self._ways(literal) if self._may(literal) else ():
                found.append(Act(str(literal), (literal,), when, by_hand=True))
                new = [x for x in when if x not in seen]
                waiting += new
                seen.update(new)
        return tuple(found)

    def allows(self, state: State, act: Act) -> bool:
        """Whether what an act displaces can be taken from where it is."""
        made = act.effect[0] if act.by_hand else None
        for fact in self._mutexes.excluded(state, made) if made and made.positive else ():
            ways = self._ways(fact.negation)
            if ways and not any(all(map(state.holds, when)) for when in ways):
                return False
        return True

    def _may(self, literal: Literal) -> bool:
        domain = self._world.domain
        return domain.people_can_change(literal.predicate) and bool(self._ways(literal))

    def _ways(self, literal: Literal) -> tuple[tuple[Literal, ...], ...]:
        """What has to hold before a person makes a literal true, one set for each operator that could."""
        if literal not in self._asked:
            domain = self._world.domain
            ways = (_asked(domain, op, literal) for op in domain.operators.values())
            self._asked[literal] = tuple(dict.fromkeys(way for some in ways for way in some))
        return self._asked[literal]

    def _mattering(self, play: Play) -> Iterator[Literal]:
        for objective in self._world.scenario.objectives:
            yield from _wanted(objective.goal, self._world)
        for transition in play.automaton.transitions.values():
            yield from transition.when
        for human in self._world.scenario.human_actions:
            yield from human.when
        for segment in play.plan.segments.values():
            yield from segment.goals
            yield from self._needed(segment)

    def _needed(self, segment: Segment) -> Iterator[Literal]:
        for action in segment.actions:
            operator = self._world.domain.operators[action.operator]
            yield from _wanted(bind(operator.precondition, operator.binding(action)), self._world)


def useful(acts: Iterable[Act], state: State, hands: Hands) -> Iterator[Act]:
    """The acts that people may do in a state and that change it."""
    for act in acts:
        able = all(map(state.holds, act.when)) and not all(map(state.holds, act.effect))
        if able and hands.allows(state, act):
            yield act


def _wanted(formula: Formula, world: World) -> Iterator[Literal]:
    """The literals whose truth can help to make a formula true."""
    if isinstance(formula, Literal):
        yield formula
    elif isinstance(formula, And | Or):
        for part in formula.parts:
            yield from _wanted(part, world)
    elif isinstance(formula, Not):
        yield from (x.negation for x in _wanted(formula.part, world))
    elif isinstance(formula, Imply):
        yield from (x.negation for x in _wanted(formula.condition, world))
        yield from _wanted(formula.conclusion, world)
    elif isinstance(formula, Quantified):
        for body in instances_of(formula, world):
            yield from _wanted(body, world)


def _asked(domain: Domain, operator: Operator, literal: Literal) -> Iterator[tuple[Literal, ...]]:
    for effect in effect_literals(operator.effect):
        binding = _match(effect, literal)
        if binding is not None:
            parts = conjuncts(bind(operator.precondition, binding))
            yield tuple(p for p in parts if isinstance(p, Literal) and _peoples(domain, p))


def _peoples(domain: Domain, literal: Literal) -> bool:
    """Whether a precondition is the world's rather than the robot's own, and names things only."""
    predicate = literal.predicate
    own = domain.robot_can_change(predicate) and not domain.people_can_change(predicate)
    return not own and not any(arg.startswith("?") for arg in literal.args)


def _match(pattern: Literal, ground: Literal) -> dict[str, str] | None:
    same = (pattern.predicate, pattern.positive) == (ground.predicate, ground.positive)
    if not same or len(pattern.args) != len(ground.args):
        return None
    binding: dict[str, str] = {}
    for wanted, found in zip(pattern.args, ground.args, strict=True):
        if wanted.startswith("?") and binding.setdefault(wanted, found) != found:
            return None
        if not wanted.startswith("?") and wanted != found:
            return None
    return binding
