"""Edits that change the shape of a program: merge, split, swap, move, remove what comes after."""

from __future__ import annotations

from collections.abc import Sequence

from polaris_nl.automaton.automaton import START, Automaton, Checkpoint, Transition
from polaris_nl.automaton.edits import (
    AddCheckpoint,
    Edit,
    InsertCheckpoint,
    MoveCheckpoint,
    RemoveCheckpoint,
    RenameCheckpoint,
    SetConditional,
    SetGoals,
    apply_all,
)
from polaris_nl.language.naming import Names
from polaris_nl.language.subjects import subjects
from polaris_nl.model.errors import EditError
from polaris_nl.model.formula import Literal, literals_in
from polaris_nl.model.text import listed

Reshaped = tuple[list[Edit], str, list[str]]
"""The edits, what to say, and the checkpoints they touch."""


def merged(program: Automaton, one: str, two: str) -> Reshaped:
    """The goals of two checkpoints, one after the other, in one.

    Raises:
        EditError: they don't follow each other, something is waited for between them, or they undo each other.
    """
    if any(t.source == two and t.target == one for t in program.transitions.values()):
        one, two = two, one
    first, second = program.checkpoints[one], program.checkpoints[two]
    between = next((t for t in program.outgoing(one) if t.target == two), None)
    if between is None:
        raise EditError(
            f"{first.name} and {second.name} don't follow each other; move one behind the other first."
        )
    if between.when:
        raise EditError(
            f"Between {first.name} and {second.name} something is waited for, so they can't be one; make "
            f"{second.name} unconditional first."
        )
    if len(program.outgoing(one)) > 1:
        raise EditError(
            f"{first.name} has several ways on, so {second.name} can't be part of it; remove the others first."
        )
    if any(goal.negation in first.goals for goal in second.goals if isinstance(goal, Literal)):
        raise EditError(
            f"{first.name} and {second.name} undo each other, so they can't be one; name two others."
        )
    edits: list[Edit] = [
        RemoveCheckpoint(two),
        SetGoals(one, tuple(dict.fromkeys((*first.goals, *second.goals)))),
    ]
    return edits, f"{first.name} and {second.name} are one now", [one]


def merged_all(program: Automaton) -> Reshaped:
    """All checkpoints in one.

    Raises:
        EditError: there is a choice or a condition between them, or only one.
    """
    made = program.children(START)
    if len(made) != 1 or not program.children(made[0]):
        raise EditError("There are no steps in a row to make one of; name two.")
    first, edits, changed = made[0], list[Edit](), program
    while following := changed.children(first):
        if len(following) > 1:
            raise EditError("There is a choice between the steps, so they can't be one; name two.")
        edits += merged(changed, first, following[0])[0]
        changed = apply_all(program, edits)
    return edits, "all of it is one step now", [first]


def split(program: Automaton, this: str, names: Names) -> Reshaped:
    """A checkpoint's first goal in a checkpoint of its own, before the others.

    Raises:
        EditError: there is only one goal.
    """
    checkpoint, incoming = program.checkpoints[this], program.incoming(this)
    if len(checkpoint.goals) < 2 or incoming is None:
        raise EditError(
            f"{checkpoint.name} has only one goal, so there is nothing to split; name another step."
        )
    first = checkpoint.goals[:1]
    new = Checkpoint(program.fresh_checkpoint_id(), names.checkpoint(first, (), program), first)
    edits: list[Edit] = [
        InsertCheckpoint(new, incoming.id, program.fresh_transition_id()),
        SetGoals(this, checkpoint.goals[1:]),
    ]
    return (
        edits,
        f"{checkpoint.name} is two steps now, {new.name} and {checkpoint.name}",
        [new.id, this],
    )


def swapped(program: Automaton, one: str, two: str) -> Reshaped:
    """Two checkpoints the other way round: each with its goals in the other's place.

    Raises:
        EditError: it is the same one twice.
    """
    if one == two:
        raise EditError(
            f"{program.checkpoints[one].name} can't change places with itself; name another step."
        )
    if program.parent(one) == two:
        one, two = two, one
    first, second = program.checkpoints[one], program.checkpoints[two]
    direct = program.parent(two) == one
    say = (
        f"{second.name} comes before {first.name} now"
        if direct
        else (f"{first.name} and {second.name} have changed places")
    )
    incoming = program.incoming(two)
    if direct and incoming is not None and not incoming.when and len(program.outgoing(one)) == 1:
        return moved_behind(program, one, two)[0], say, [one]
    edits: list[Edit] = [
        RenameCheckpoint(one, program.fresh_name(f"{first.name} before")),
        RenameCheckpoint(two, first.name),
        RenameCheckpoint(one, second.name),
        SetGoals(one, second.goals, second.action),
        SetGoals(two, first.goals, first.action),
    ]
    return edits, say, [one, two]


def moved_behind(program: Automaton, this: str, other: str) -> Reshaped:
    """A checkpoint right behind another one, with all that comes after it unless the other does.

    Raises:
        EditError: it can't be.
    """
    name, after = program.checkpoints[this].name, program.checkpoints[other].name
    say = f"{name} comes after {after} now"
    if this == other:
        raise EditError(f"{name} can't come after itself; name another step.")
    if other not in program.subtree(this):
        return [MoveCheckpoint(this, other)], say, [this]
    alone: list[Edit] = [RemoveCheckpoint(this)]
    without = apply_all(program, alone)
    return [*alone, *put_after(without, program.checkpoints[this], other)], say, [this]


def moved_before(program: Automaton, this: str, other: str) -> Reshaped:
    """A checkpoint, alone, right in front of another one.

    Raises:
        EditError: it can't be.
    """
    name, before = program.checkpoints[this].name, program.checkpoints[other].name
    if START in (this, other) or this == other:
        raise EditError(f"{name} can't come before {before}; name another step.")
    alone: list[Edit] = [RemoveCheckpoint(this)]
    without = apply_all(program, alone)
    incoming = without.incoming(other)
    if incoming is None:
        raise EditError(f"Nothing leads to {before}; name another step.")
    checkpoint = program.checkpoints[this]
    edits: list[Edit] = [*alone]
    if incoming.source == START and incoming.when:
        # What comes first of all doesn't wait for what the next step waits for.
        edits += put_after(without, checkpoint, START)
    else:
        edits.append(InsertCheckpoint(checkpoint, incoming.id, without.fresh_transition_id()))
    return edits, f"{name} comes before {before} now", [this]


def cut_after(program: Automaton, this: str) -> Reshaped:
    """Without everything that comes after a checkpoint.

    Raises:
        EditError: nothing comes after it.
    """
    name = program.checkpoints[this].name
    following = program.outgoing(this)
    if not following:
        raise EditError(
            f"Nothing comes after {name}, so there is nothing to remove; name an earlier step."
        )
    edits: list[Edit] = [RemoveCheckpoint(t.target, subtree=True) for t in following]
    return edits, f"nothing comes after {name} any more", [this]


def removed_with_rest(program: Automaton, this: str) -> Reshaped:
    """Without a checkpoint and all that comes after it."""
    name = program.checkpoints[this].name
    return [RemoveCheckpoint(this, subtree=True)], f"{name} and what comes after it are gone", []


def removed_latest(program: Automaton, number: int, here: str) -> Reshaped:
    """Without the latest checkpoints on the way to one.

    Raises:
        EditError: there are not so many.
    """
    way = [here, *(t.source for t in reversed(program.path(here)))]
    chosen = [c for c in way if c != START][:number]
    if len(chosen) < number:
        raise EditError(f"There are only {len(chosen)} steps here; say which to remove.")
    names = [program.checkpoints[c].name for c in chosen]
    edits: list[Edit] = [RemoveCheckpoint(c) for c in chosen]
    return edits, f"{' and '.join(reversed(names))} are gone", []


# Where a new checkpoint goes


def put_after(
    program: Automaton, new: Checkpoint, this: str, when: tuple[Literal, ...] = ()
) -> list[Edit]:
    """A new checkpoint right after another one, in front of all that came after it."""
    arrow = program.fresh_transition_id()
    outgoing = program.outgoing(this)
    if when or not outgoing:
        return [AddCheckpoint(new, Transition(arrow, this, new.id, when))]
    if len(outgoing) == 1 and not outgoing[0].when:
        return [InsertCheckpoint(new, outgoing[0].id, arrow)]
    moved = [MoveCheckpoint(t.target, new.id, t.when) for t in outgoing]
    return [AddCheckpoint(new, Transition(arrow, this, new.id)), *moved]


def put_before(
    program: Automaton, new: Checkpoint, this: str, when: tuple[Literal, ...] = ()
) -> list[Edit]:
    """A new checkpoint right in front of another one.

    Raises:
        EditError: nothing leads there.
    """
    incoming = program.incoming(this)
    if incoming is None:
        name = program.checkpoints[this].name
        raise EditError(f"Nothing can come before {name}; say what comes after it.")
    return [InsertCheckpoint(new, incoming.id, program.fresh_transition_id(), when)]


def put_between(program: Automaton, new: Checkpoint, one: str, two: str) -> list[Edit]:
    """A new checkpoint between two others that follow each other, in either order.

    Raises:
        EditError: they don't follow each other.
    """
    if program.parent(one) == two:
        one, two = two, one
    if program.parent(two) != one:
        names = [program.checkpoints[c].name for c in (one, two)]
        raise EditError(
            f"{names[1]} doesn't come right after {names[0]}; say which step it should come after."
        )
    return put_before(program, new, two)


# Conditions


def otherwise(program: Automaton, this: str) -> Reshaped:
    """A checkpoint as what happens where no condition beside it holds.

    Raises:
        EditError: there is no condition, or something happens otherwise already.
    """
    name = program.checkpoints[this].name
    way = program.path(this)
    sources = [t.source for t in reversed(way)]
    branching = next(
        (s for s in sources if any(t.when and t.target != this for t in program.outgoing(s))), None
    )
    if branching is None:
        raise EditError(
            f"There is no condition beside {name}, so it can't happen otherwise; say a condition first."
        )
    there = next((t for t in program.outgoing(branching) if not t.when and t.target != this), None)
    if there is not None:
        other = program.checkpoints[there.target].name
        raise EditError(f"{other} happens otherwise already; remove or move it first.")
    say = f"{name} is what happens otherwise"
    if way[-1].source == branching:
        return [SetConditional(way[-1].id, ())], say, [this]
    return [MoveCheckpoint(this, branching)], say, [this]


def unconditional(program: Automaton, this: str) -> Reshaped:
    """A checkpoint that is not waited for.

    Raises:
        EditError: nothing leads to it.
    """
    name, incoming = program.checkpoints[this].name, program.incoming(this)
    if incoming is None:
        raise EditError(f"Nothing is waited for before {name}.")
    return (
        [SetConditional(incoming.id, ())],
        f"nothing is waited for before {name} any more",
        [this],
    )


def conditional(program: Automaton, this: str, when: tuple[Literal, ...], words: str) -> Reshaped:
    """A checkpoint that waits for a condition.

    Raises:
        EditError: nothing leads to it, or what happens then is said already.
    """
    name, incoming = program.checkpoints[this].name, program.incoming(this)
    if incoming is None:
        raise EditError(f"{name} can't wait for anything; name a step.")
    for beside in program.outgoing(incoming.source):
        if beside.id != incoming.id and beside.conditional == set(when):
            other = program.checkpoints[beside.target].name
            raise EditError(
                f"{other} is what happens then already; change or remove {other} first."
            )
    return [SetConditional(incoming.id, when)], words, [this]


def several_removed(program: Automaton, these: Sequence[str]) -> Reshaped:
    """Without some checkpoints; what came after them moves up."""
    these = list(dict.fromkeys(these))
    names = [program.checkpoints[c].name for c in these]
    say = f"{listed(names)} {'is' if len(names) == 1 else 'are'} gone"
    edits: list[Edit] = []
    for checkpoint in these:
        edits += removed(apply_all(program, edits), checkpoint)
    return edits, say, []


def removed(program: Automaton, this: str) -> list[Edit]:
    """Without a checkpoint, and without its condition where that is about what was to be done there.

    After "if the fridge is open close it, then go home", nothing waits for the fridge that isn't closed;
    after "once she acknowledges it fill the tray, then bring it", bringing it does.
    """
    incoming = program.incoming(this)
    beside = program.outgoing(incoming.source) if incoming is not None else ()
    done = [x for goal in program.checkpoints[this].goals for x in literals_in(goal)]
    guards = incoming is not None and bool(incoming.when) and len(beside) == 1
    if incoming is not None and guards and subjects(incoming.when) <= subjects(done):
        return [SetConditional(incoming.id, ()), RemoveCheckpoint(this)]
    return [RemoveCheckpoint(this)]
