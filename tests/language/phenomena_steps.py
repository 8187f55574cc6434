"""Programs as steps that can be compared: without ids, in any order, goals "for all" one by one."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

from polaris_nl.automaton.automaton import START, Automaton
from polaris_nl.model.domain import KIND
from polaris_nl.model.evaluate import instances_of
from polaris_nl.model.formula import And, Formula, Imply, Literal, Quantified, parse_formula
from polaris_nl.model.world import World


class Step(NamedTuple):
    """A checkpoint with what leads to it and what comes after it; comparable, without ids."""

    when: frozenset[str]
    goals: frozenset[str]
    name: str
    then: tuple[Step, ...]


def tree_of(program: Automaton, world: World) -> tuple[Step, ...] | None:
    """A program as steps, in an order of its own; None where it is no tree rooted in the start."""
    if len(program.transitions) != len(program.checkpoints) - 1:
        return None
    if len(program.subtree(START)) != len(program.checkpoints):
        return None

    def steps(checkpoint: str) -> tuple[Step, ...]:
        return ordered(
            Step(
                frozenset(map(str, t.when)),
                normal(program.checkpoints[t.target].goals, world),
                program.checkpoints[t.target].name,
                steps(t.target),
            )
            for t in program.outgoing(checkpoint)
        )

    return steps(START)


def same(wanted: Sequence[Step], found: Sequence[Step]) -> bool:
    """Whether two lists of steps are one, in any order; an empty name fits all names."""
    if len(wanted) != len(found):
        return False
    if not wanted:
        return True
    first, *others = wanted
    return any(
        (first.when, first.goals) == (step.when, step.goals)
        and first.name in ("", step.name)
        and same(first.then, step.then)
        and same(others, [*found[:i], *found[i + 1 :]])
        for i, step in enumerate(found)
    )


def normal(goals: Iterable[Formula], world: World) -> frozenset[str]:
    """Goals without `for all` and without kinds; conditions that depend on facts stay."""
    return frozenset(str(part) for goal in goals for part in _parts(goal, world))


def described(steps: Sequence[Step] | None) -> str:
    """Steps on one line, for a person."""
    if steps is None:
        return "no tree"
    parts = []
    for step in steps:
        when = f"[{' '.join(sorted(step.when))}] " if step.when else ""
        then = f" > {described(step.then)}" if step.then else ""
        parts.append(f"{when}{' '.join(sorted(step.goals)) or '.'}{then}")
    return parts[0] if len(parts) == 1 else f"{{{' | '.join(parts)}}}"


def ordered(steps: Iterable[Step]) -> tuple[Step, ...]:
    """The steps in an order that says nothing."""
    return tuple(
        sorted(steps, key=lambda s: (sorted(s.when), sorted(s.goals), s.name, str(s.then)))
    )


def _parts(goal: Formula, world: World) -> Iterator[Formula]:
    if isinstance(goal, And):
        for part in goal.parts:
            yield from _parts(part, world)
    elif isinstance(goal, Quantified) and goal.quantifier == "forall":
        for body in instances_of(goal, world):
            yield from _parts(body, world)
    elif isinstance(goal, Imply):
        conditions = _conditions(goal.condition)
        kinds = [c for c in conditions if isinstance(c, Literal) and c.predicate == KIND]
        if all(world.is_kind(*k.args) is k.positive for k in kinds):
            rest = sorted(str(c) for c in conditions if c not in kinds)
            for part in _parts(goal.conclusion, world):
                yield parse_formula(f"(imply (and {' '.join(rest)}) {part})") if rest else part
    else:
        yield goal


def _conditions(formula: Formula) -> list[Formula]:
    if isinstance(formula, And):
        return [c for part in formula.parts for c in _conditions(part)]
    return [formula]
