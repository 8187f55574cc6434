"""Puts entities in the place of others in the goals and conditions of checkpoints."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from polaris_nl.automaton.automaton import START, Automaton
from polaris_nl.automaton.edits import Edit, SetConditional, SetGoals
from polaris_nl.language.naming import Names
from polaris_nl.model.formula import Goal, Imply, Literal, Quantified, bind, literals_in
from polaris_nl.model.world import World

_PLACES = (("at", (0, 1)), ("in", (0, 1)), ("has", (1, 0)))
"""Predicates for where a thing is: which argument is the thing, which the place."""


KIND = "kind"
"""The predicate of "everything of a kind"."""


def used_in(program: Automaton, where: Sequence[str] | set[str]) -> list[str]:
    """The entities in some checkpoints' goals and conditions, the last checkpoint's first, each once."""
    found: dict[str, None] = {}
    for checkpoint in reversed(list(where)):
        for goal in program.checkpoints[checkpoint].goals:
            for literal in literals_in(goal):
                args = literal.args[:1] if literal.predicate == KIND else literal.args
                found.update(dict.fromkeys(args))
        incoming = program.incoming(checkpoint)
        for literal in incoming.when if incoming else ():
            found.update(dict.fromkeys(literal.args))
    return list(found)


def kinds_in(program: Automaton, where: Sequence[str]) -> list[str]:
    """The kinds in goals for everything of a kind: "cup" in "all the cups"."""
    goals = [g for c in reversed(list(where)) for g in program.checkpoints[c].goals]
    literals = [x for goal in goals for x in literals_in(goal)]
    return list(dict.fromkeys(x.args[1] for x in literals if x.predicate == KIND))


def exchanged(
    program: Automaton,
    where: Sequence[str],
    old: str,
    new: Sequence[str],
    every: object,
    world: World,
    names: Names,
) -> Iterator[Edit]:
    """The edits that put entities, or everything of a kind, in another's place."""
    for checkpoint in where:
        if checkpoint == START:
            continue
        goals = program.checkpoints[checkpoint].goals
        changed = tuple(
            dict.fromkeys(n for g in goals for n in _new_goals(g, old, new, every, world))
        )
        incoming = program.incoming(checkpoint)
        when = incoming.when if incoming else ()
        if len(new) == 1:
            when = tuple(x.bind({old: new[0]}) for x in when)
        if changed != goals:
            yield SetGoals(checkpoint, changed)
        if incoming is not None and when != incoming.when:
            yield SetConditional(incoming.id, when)
        if changed != goals:
            yield from names.renamed(program, checkpoint, changed, when)


def _new_goals(
    goal: Goal, old: str, new: Sequence[str], every: object, world: World
) -> Iterator[Goal]:
    if not any(old in literal.args for literal in literals_in(goal)):
        yield goal
    elif isinstance(goal, Quantified) and isinstance(goal.body, Imply) and _is_kind(goal, old):
        for name in new:
            yield bind(goal.body.conclusion, {v.name: name for v in goal.variables})
    elif isinstance(every, Quantified) and isinstance(goal, Literal):
        literal = goal.bind({old: every.variables[0].name})
        yield Quantified("forall", every.variables, Imply(every.body, literal))
    else:
        for name in new:
            yield _placed(goal, old, name, world)


def _is_kind(goal: Goal, word: str) -> bool:
    about = [x for x in literals_in(goal) if word in x.args]
    return all(x.predicate == KIND and x.args[1] == word for x in about)


def _placed(goal: Goal, old: str, new: str, world: World) -> Goal:
    """A goal with another entity; another predicate where that is another sort of place."""
    types = world.entities
    if isinstance(goal, Literal) and old in types and types[old].type != types[new].type:
        order = dict(_PLACES).get(goal.predicate)
        if order is not None and goal.args[order[1]] == old:
            thing = goal.args[order[0]]
            for predicate, (first, second) in _PLACES:
                known = world.domain.predicates.get(predicate)
                if known and world.domain.is_a(types[new].type, known.parameters[second].types[0]):
                    args = (thing, new) if first == 0 else (new, thing)
                    return Literal(predicate, args, goal.positive)
    return bind(goal, {old: new})


def without(goals: Sequence[Goal], entities: Sequence[str]) -> tuple[Goal, ...]:
    """Goals but for those about some entities."""
    return tuple(g for g in goals if not any(e in x.args for x in literals_in(g) for e in entities))
