"""What comes out for the corpora's sentences, and how right it is."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

from polaris_nl.automaton.automaton import START, Automaton
from polaris_nl.automaton.edits import apply_all
from polaris_nl.language.interpretation import Interpretation
from polaris_nl.language.understanding import Understanding
from polaris_nl.model.formula import And, Formula, Imply, Literal, Or, Quantified
from polaris_nl.model.world import World
from tests.language.corpora import (
    Annotated,
    Step,
    Wanted,
)

# What comes out


@dataclass(frozen=True)
class Found:
    """A goal of the program that came out.

    Attributes:
        depth: how many transitions lead to it.
        when: what is waited for on the way.
    """

    goal: Formula
    depth: int
    when: frozenset[Literal] = frozenset()


@dataclass(frozen=True)
class Reading:
    """What came out for a sentence.

    Attributes:
        outcome: `parse`, `clarify`, `refuse` or `command`, as annotated outcomes are called.
    """

    outcome: str
    meant: Interpretation
    goals: tuple[Found, ...]


_OUTCOMES = {"applied": "parse", "question": "clarify", "refused": "refuse", "answer": "refuse"}


def read(language: Understanding, text: str) -> Reading:
    """Reads a sentence into an empty program."""
    meant, _ = language.interpret(text, Automaton())
    program = apply_all(Automaton(), meant.edits)
    return Reading(_OUTCOMES.get(meant.outcome, meant.outcome), meant, tuple(_goals(program)))


def _goals(program: Automaton) -> Iterator[Found]:
    for checkpoint in program.checkpoints.values():
        path = program.path(checkpoint.id)
        when = frozenset(x for transition in path for x in transition.when)
        if checkpoint.id != START:
            for goal in checkpoint.goals:
                yield Found(goal, len(path), when)


# How right it is


@dataclass(frozen=True)
class Judgement:
    """How right what came out is.

    Attributes:
        outcome: parsed, asked or refused as it should be.
        right: goals that were wanted and came; lost: that did not; extra: that came and were not
            wanted.
        exact: the goals are just those that were wanted, or the choice that they leave was asked.
        order, conditions: whether they are right; None where there are none to get right.
        wrong: the program was changed though it should not be, or gets a goal that nobody wanted or
            that waits for something else.
    """

    outcome: bool
    right: int
    lost: int
    extra: int
    exact: bool
    order: bool | None
    conditions: bool | None
    wrong: bool


def judge(sentence: Annotated, world: World, reading: Reading) -> Judgement:
    """Compares what came out with what was annotated."""
    choices = [sentence.steps, *((Step(goals),) for goals in sentence.instead)]
    judged = [_judged(replace(sentence, steps=steps), world, reading) for steps in choices]
    return max(judged, key=lambda j: (j.outcome, j.exact, j.right - j.extra))


def _judged(sentence: Annotated, world: World, reading: Reading) -> Judgement:
    pairs = _pairs(sentence, world, reading.goals)
    used = {at for at, _ in pairs}
    unused = [at for at in range(len(reading.goals)) if at not in used]
    extra = sum(not _on_the_way(at, used, reading) for at in unused)
    lost = sum(not _is_there(goal, world, reading.goals) for goal in sentence.goals)
    told = _conditions_told(sentence, reading, pairs)
    if sentence.outcome != "parse":
        exact = not lost and not extra
        fine = reading.outcome == sentence.outcome or _as_good(sentence, reading, exact)
        kept = reading.goals and not (fine and exact)
        return Judgement(
            fine, 0, 0, len(reading.goals) if kept else 0, fine, None, None, bool(kept)
        )
    if _asks_the_choice(sentence, world, reading):
        return Judgement(True, len(sentence.goals), 0, 0, True, None, None, False)
    return Judgement(
        outcome=reading.outcome == "parse",
        right=len(sentence.goals) - lost,
        lost=lost,
        extra=extra,
        exact=not lost and not extra and told is not False,
        order=_order(sentence, reading, pairs),
        conditions=told,
        wrong=bool(reading.goals) and (extra > 0 or told is False),
    )


def _pairs(sentence: Annotated, world: World, goals: Sequence[Found]) -> list[tuple[int, int]]:
    """The goals that came and were wanted: (number of the goal, number of the step)."""
    return [
        (at, number)
        for at, found in enumerate(goals)
        for number, step in enumerate(sentence.steps)
        if any(_serves(found.goal, goal, world) for goal in step.goals)
    ]


def _serves(found: Formula, wanted: Wanted, world: World) -> bool:
    """Whether a goal is one that was wanted, or one of several that together are."""
    if not wanted.kind:
        alternatives = (wanted.literal, *wanted.others)
        parts = found.parts if isinstance(found, Or) else (found,)
        return all(any(_same(part, one, world) for one in alternatives) for part in parts)
    if isinstance(found, Quantified):
        body = found.body
        return (
            wanted.number == 0
            and isinstance(body, Imply)
            and _same(body.conclusion, wanted.literal, world)
            and any(x.args[-1:] == (wanted.kind,) for x in _parts(body.condition))
        )
    members = world.kinds.get(wanted.kind, frozenset())
    return any(_same(found, wanted.literal.bind({"?x": name}), world) for name in members)


def _is_there(wanted: Wanted, world: World, goals: Sequence[Found]) -> bool:
    serving = {str(f.goal): f.goal for f in goals if _serves(f.goal, wanted, world)}
    if not wanted.kind or any(isinstance(goal, Quantified) for goal in serving.values()):
        return bool(serving)
    number = wanted.number or len(world.kinds.get(wanted.kind, ()))
    return len(serving) == number


def _same(found: Formula, wanted: Literal, world: World) -> bool:
    """Equal; what holds things and has a top is said with "in" and with "on" for the same place."""
    if found == wanted:
        return True
    if not isinstance(found, Literal) or found.args != wanted.args:
        return False
    place = world.entities.get(wanted.args[-1]) if wanted.args else None
    either = {found.predicate, wanted.predicate} == {"at", "in"}
    return (
        either and place is not None and place.type == "unit" and found.positive == wanted.positive
    )


def _parts(formula: Formula) -> Iterator[Literal]:
    for part in formula.parts if isinstance(formula, And) else (formula,):
        if isinstance(part, Literal):
            yield part


def _on_the_way(at: int, used: Iterable[int], reading: Reading) -> bool:
    """Whether a goal only leads to another that was wanted: going there, finding it, taking it up."""
    goal = reading.goals[at]
    if not isinstance(goal.goal, Literal) or not goal.goal.positive:
        return False
    predicate, about = goal.goal.predicate, goal.goal.args[-1]
    # What was found stays found; a robot is elsewhere and holds nothing once it has gone on.
    first = goal.depth if predicate == "found" else goal.depth + 1
    later = [reading.goals[n].goal for n in used if reading.goals[n].depth >= first]
    after = [x for x in later if isinstance(x, Literal)]
    if predicate == "robot-at":
        return any(x.predicate != "robot-at" for x in after)
    return predicate in ("holding", "has", "found") and any(about in x.args for x in after)


def _conditions_told(
    sentence: Annotated, reading: Reading, pairs: Iterable[tuple[int, int]]
) -> bool | None:
    """Whether goals wait for what they should; None where nothing waits and nothing should."""
    wanted = [step.when for step in sentence.steps]
    if not any(wanted) and not any(f.when for f in reading.goals):
        return None
    told = [reading.goals[at].when == wanted[step] for at, step in pairs]
    return bool(told) and all(told)


def _order(sentence: Annotated, reading: Reading, pairs: Sequence[tuple[int, int]]) -> bool | None:
    """Whether steps come one after the other as they should."""
    if sentence.unordered or len(sentence.steps) < 2:
        return None
    depths: list[list[int]] = [[] for _ in sentence.steps]
    for at, step in pairs:
        depths[step].append(reading.goals[at].depth)
    return all(depths) and all(max(one) < min(two) for one, two in pairwise(depths))


def _asks_the_choice(sentence: Annotated, world: World, reading: Reading) -> bool:
    """Whether the question is the choice that the sentence leaves: which of a kind, which way."""
    question = reading.meant.question
    if question is None or not question.options:
        return False
    asked = set(question.options)
    for goal in sentence.goals:
        members = world.kinds.get(goal.kind, frozenset()) if goal.number else frozenset()
        ways = {x.args[-1] for x in (goal.literal, *goal.others)} if goal.others else set()
        if asked <= {world.entities[n].spoken for n in members | ways if n in world.entities}:
            return True
    return False


def _as_good(sentence: Annotated, reading: Reading, exact: bool) -> bool:
    """Outcomes that the notes allow besides the one that was annotated."""
    if sentence.outcome != "clarify":
        return False
    if reading.outcome == "parse":
        return exact and "may ask" in sentence.notes
    named = reading.meant.refusal is not None and bool(reading.meant.refusal.unknown)
    return named and "in most domains" in sentence.notes
