"""What can come about if nothing ever became false, and what is missing where even that isn't enough.

The delete relaxation of classical planning (Bonet and Geffner, "Planning as heuristic search",
Artificial Intelligence 129, 2001): a goal out of reach there is out of reach for certain, and what
its actions lack shows the reason: a door, somebody's whereabouts, a thing that nobody has seen.
"""

from __future__ import annotations

import itertools
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from polaris_nl.model.domain import conjuncts, effect_literals
from polaris_nl.model.evaluate import instances_of
from polaris_nl.model.formula import And, Equal, Formula, Imply, Literal, Not, Or, Quantified, bind
from polaris_nl.model.state import State
from polaris_nl.model.world import World

MOST_ACTIONS = 20_000
"""With more ground actions than this, reasons are not looked for."""
DEEPEST = 6
"""How many steps a lack is followed back."""


@dataclass(frozen=True, slots=True)
class Lack:
    """Why a goal is out of reach.

    Attributes:
        roots: facts that no action can bring about, and with which the goal would be in reach.
        through: the facts between them and the goal, the goal's own lack first.
    """

    roots: tuple[Literal, ...]
    through: tuple[Literal, ...] = ()


@dataclass(frozen=True, slots=True)
class _Ground:
    precondition: Formula
    effects: tuple[Literal, ...]


class Relaxation:
    """What can come about from one state.

    Args:
        world: entities and operators; the fewer entities, the quicker.
        state: the state.
    """

    def __init__(self, world: World, state: State) -> None:
        self._world = world
        self._state = state
        self._actions = tuple(itertools.islice(_grounded(world), MOST_ACTIONS + 1))
        self.decided = len(self._actions) <= MOST_ACTIONS
        self._true = set(state.facts)
        self._false: set[Literal] = set()
        self._mentions = Counter((f.predicate, a) for f in world.facts for a in f.args)
        self._by_effect: dict[Literal, list[_Ground]] = {}
        if self.decided:
            self._spread()

    def reaches(self, literal: Literal) -> bool:
        """Whether a literal may come about."""
        if not literal.positive:
            return literal.atom not in self._state.facts or literal.atom in self._false
        return literal in self._true or (
            literal.predicate not in self._world.domain.predicates
            and self._world.holds(literal, self._state)
        )

    def lack(self, goal: Literal) -> Lack | None:
        """What a goal lacks; None where it lacks nothing, or where that isn't known."""
        if not self.decided or self.reaches(goal):
            return None
        return self._lack(goal, frozenset(), DEEPEST)

    def _lack(self, goal: Literal, above: frozenset[Literal], depth: int) -> Lack | None:
        found: list[Lack] = []
        if above and self._from_outside(goal):
            found.append(Lack((goal,)))
        elif depth and goal not in above:
            for ground in self._by_effect.get(goal, ()):
                gap = self._gap(ground.precondition)
                lacks = [self._lack(x, above | {goal}, depth - 1) for x in gap or ()]
                if gap and all(lack is not None for lack in lacks):
                    roots = tuple(dict.fromkeys(r for x in lacks if x for r in x.roots))
                    through = tuple(dict.fromkeys(r for x in lacks if x for r in x.through))
                    found.append(Lack(roots, (*gap, *through)))
        return min(found, key=self._price, default=None)

    def _from_outside(self, literal: Literal) -> bool:
        domain = self._world.domain
        return domain.people_can_change(literal.predicate) or not domain.achievers(literal)

    def _price(self, lack: Lack) -> tuple[object, ...]:
        """Few roots, rather by people, rather what was true at the start, a way rather than a thing there.

        Among equals, what is about the places that most is known of, and always the same one.
        """
        people = self._world.domain.people_can_change
        fixed = sum(not people(x.predicate) for x in lack.roots)
        new = sum(x not in self._world.facts for x in lack.roots)
        elsewhere = not any(x.predicate == "robot-at" for x in lack.through)
        known = sum(self._mentions[x.predicate, a] for x in lack.roots for a in x.args)
        return len(lack.roots) + fixed, new, elsewhere, len(lack.through), -known, lack.roots

    def _gap(self, formula: Formula) -> tuple[Literal, ...] | None:
        """The fewest literals that a condition lacks; None where no literal would help."""
        if isinstance(formula, Literal):
            return () if self.reaches(formula) else (formula,)
        if isinstance(formula, And):
            return self._gaps(formula.parts)
        if isinstance(formula, Quantified):
            bodies = tuple(instances_of(formula, self._world))
            if formula.quantifier == "forall":
                return self._gaps(bodies)
            return self._least(bodies)
        if isinstance(formula, Or):
            return self._least(formula.parts)
        if isinstance(formula, Imply):
            return self._least((_negated(formula.condition), formula.conclusion))
        if isinstance(formula, Not) and not isinstance(formula.part, Equal):
            return self._gap(_negated(formula.part))
        equal = formula.part if isinstance(formula, Not) else formula
        same = isinstance(equal, Equal) and equal.left == equal.right
        return () if same is not isinstance(formula, Not) else None

    def _gaps(self, parts: Sequence[Formula]) -> tuple[Literal, ...] | None:
        gaps = [self._gap(part) for part in parts]
        if any(gap is None for gap in gaps):
            return None
        return tuple(dict.fromkeys(x for gap in gaps if gap for x in gap))

    def _least(self, parts: Sequence[Formula]) -> tuple[Literal, ...] | None:
        gaps = [gap for part in parts if (gap := self._gap(part)) is not None]
        # What never changes is hardest to come by: a table stays in its room.
        return min(gaps, key=lambda g: (sum(map(self._is_fixed, g)), len(g)), default=None)

    def _is_fixed(self, literal: Literal) -> bool:
        domain = self._world.domain
        changes = domain.robot_can_change(literal.predicate)
        return not (changes or domain.people_can_change(literal.predicate))

    def _spread(self) -> None:
        for ground in self._actions:
            for effect in ground.effects:
                self._by_effect.setdefault(effect, []).append(ground)
        waiting = list(self._actions)
        grown = True
        while grown:
            grown = False
            later = []
            for ground in waiting:
                if self._gap(ground.precondition) != ():
                    later.append(ground)
                    continue
                grown = True
                self._true.update(e for e in ground.effects if e.positive)
                self._false.update(e.atom for e in ground.effects if not e.positive)
            waiting = later


def _grounded(world: World) -> Iterator[_Ground]:
    for operator in world.domain.operators.values():
        names = [p.name for p in operator.parameters]
        fitting = [[e.name for e in world.of_type(*p.types)] for p in operator.parameters]
        for values in itertools.product(*fitting):
            binding = dict(zip(names, values, strict=True))
            made = _made(bind(operator.effect, binding), world)
            yield _Ground(bind(operator.precondition, binding), made)


def _made(effect: Formula, world: World) -> tuple[Literal, ...]:
    found: list[Literal] = []
    for part in conjuncts(effect):
        if isinstance(part, Quantified):
            for body in instances_of(part, world):
                found.extend(_made(body, world))
        else:
            found.extend(effect_literals(part))
    return tuple(found)


def _negated(formula: Formula) -> Formula:
    if isinstance(formula, Literal):
        return formula.negation
    if isinstance(formula, Not):
        return formula.part
    if isinstance(formula, And):
        return Or(tuple(map(_negated, formula.parts)))
    if isinstance(formula, Or):
        return And(tuple(map(_negated, formula.parts)))
    if isinstance(formula, Imply):
        return And((formula.condition, _negated(formula.conclusion)))
    if isinstance(formula, Quantified):
        other = "exists" if formula.quantifier == "forall" else "forall"
        return Quantified(other, formula.variables, _negated(formula.body))
    return Not(formula)
