"""Edits: the changes that can be made to a goal automaton, as values.

`apply(automaton, edit)` makes the changed automaton. Edits name checkpoints and transitions by id,
and bring the ids of what they make (`Automaton.fresh_checkpoint_id`), so that a list of edits can
build on itself, be logged, and be applied again.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from typing import Any

from polaris_nl.automaton.automaton import START, Automaton, Checkpoint, Transition
from polaris_nl.model.domain import Action
from polaris_nl.model.errors import EditError
from polaris_nl.model.formula import Goal, Literal


@dataclass(frozen=True, slots=True)
class AddCheckpoint:
    """A new checkpoint after another, joined by a new transition."""

    checkpoint: Checkpoint
    transition: Transition


@dataclass(frozen=True, slots=True)
class InsertCheckpoint:
    """A new checkpoint on a transition.

    `on` ends at the new checkpoint and keeps its conditional; a transition with id `onward` leads
    on to where it ended before, under the conditional `when`.
    """

    checkpoint: Checkpoint
    on: str
    onward: str
    when: tuple[Literal, ...] = ()


@dataclass(frozen=True, slots=True)
class RemoveCheckpoint:
    """Removes a checkpoint with all that come after it, or alone: then what came after moves up."""

    checkpoint: str
    subtree: bool = False


@dataclass(frozen=True, slots=True)
class RenameCheckpoint:
    """Gives a checkpoint another name."""

    checkpoint: str
    name: str


@dataclass(frozen=True, slots=True)
class SetGoals:
    """Replaces a checkpoint's goals (and the action it insisted on)."""

    checkpoint: str
    goals: tuple[Goal, ...]
    action: Action | None = None


@dataclass(frozen=True, slots=True)
class SetConditional:
    """Replaces a transition's conditional; an empty one makes it unconditional."""

    transition: str
    when: tuple[Literal, ...]


@dataclass(frozen=True, slots=True)
class MoveCheckpoint:
    """Moves a checkpoint with all that come after it below another one."""

    checkpoint: str
    to: str
    when: tuple[Literal, ...] = ()


@dataclass(frozen=True, slots=True)
class Connect:
    """A new transition between two checkpoints that are there (a loose one, in a tree)."""

    transition: Transition


@dataclass(frozen=True, slots=True)
class Disconnect:
    """Removes a transition; what it led to stays in the program, unconnected."""

    transition: str


@dataclass(frozen=True, slots=True)
class ReplaceProgram:
    """Puts another program in the place of this one (`new`, `load`)."""

    program: Automaton


Edit = (
    AddCheckpoint
    | InsertCheckpoint
    | RemoveCheckpoint
    | RenameCheckpoint
    | SetGoals
    | SetConditional
    | MoveCheckpoint
    | Connect
    | Disconnect
    | ReplaceProgram
)


def apply(automaton: Automaton, edit: Edit) -> Automaton:
    """Makes the automaton that an edit leads to; the given one stays as it is.

    Raises:
        EditError: the edit doesn't fit the automaton; the text names what is wrong.
    """
    changed = _APPLY[type(edit)](automaton, edit)
    if START not in changed.checkpoints:
        raise EditError("The start can't be removed; remove what comes after it instead.")
    return changed


def apply_all(automaton: Automaton, edits: Iterable[Edit]) -> Automaton:
    """Applies edits in order; all or none.

    Raises:
        EditError: one of them doesn't fit.
    """
    for edit in edits:
        automaton = apply(automaton, edit)
    return automaton


def _add(automaton: Automaton, edit: AddCheckpoint) -> Automaton:
    if edit.transition.target != edit.checkpoint.id:
        raise EditError(
            f"The transition {edit.transition.id} has to lead to the new checkpoint {edit.checkpoint.id}."
        )
    automaton.checkpoint(edit.transition.source)
    _new(automaton, edit.checkpoint, edit.transition.id)
    return automaton.with_checkpoint(edit.checkpoint).with_transition(edit.transition)


def _insert(automaton: Automaton, edit: InsertCheckpoint) -> Automaton:
    old = automaton.transition(edit.on)
    _new(automaton, edit.checkpoint, edit.onward)
    return (
        automaton.with_checkpoint(edit.checkpoint)
        .with_transition(replace(old, target=edit.checkpoint.id))
        .with_transition(Transition(edit.onward, edit.checkpoint.id, old.target, edit.when))
    )


def _remove(automaton: Automaton, edit: RemoveCheckpoint) -> Automaton:
    _not_start(automaton, edit.checkpoint, "removed")
    if edit.subtree:
        return automaton.without(frozenset(automaton.subtree(edit.checkpoint)), frozenset())
    incoming = automaton.incoming(edit.checkpoint)
    moved = automaton
    if incoming is not None:
        for transition in automaton.outgoing(edit.checkpoint):
            # The conditional to get here and the one to go on would both have held.
            when = tuple(dict.fromkeys((*incoming.when, *transition.when)))
            moved = moved.with_transition(replace(transition, source=incoming.source, when=when))
    return moved.without(frozenset({edit.checkpoint}), frozenset())


def _rename(automaton: Automaton, edit: RenameCheckpoint) -> Automaton:
    _not_start(automaton, edit.checkpoint, "renamed")
    name = edit.name.strip()
    other = automaton.named(name)
    if not name:
        raise EditError("A checkpoint needs a name.")
    if other is not None and other.id != edit.checkpoint:
        raise EditError(f"Another checkpoint is called {name} already; choose another name.")
    return automaton.with_checkpoint(replace(automaton.checkpoints[edit.checkpoint], name=name))


def _set_goals(automaton: Automaton, edit: SetGoals) -> Automaton:
    _not_start(automaton, edit.checkpoint, "given goals")
    goals = tuple(dict.fromkeys(edit.goals))
    if goals and edit.action is not None:
        raise EditError("A checkpoint has goals or insists on an action, not both.")
    return automaton.with_checkpoint(
        replace(automaton.checkpoints[edit.checkpoint], goals=goals, action=edit.action)
    )


def _set_conditional(automaton: Automaton, edit: SetConditional) -> Automaton:
    old = automaton.transition(edit.transition)
    return automaton.with_transition(replace(old, when=tuple(dict.fromkeys(edit.when))))


def _move(automaton: Automaton, edit: MoveCheckpoint) -> Automaton:
    _not_start(automaton, edit.checkpoint, "moved")
    automaton.checkpoint(edit.to)
    if edit.to in automaton.subtree(edit.checkpoint):
        name, to = automaton.checkpoints[edit.checkpoint].name, automaton.checkpoints[edit.to].name
        raise EditError(
            f"{name} can't come after {to}, which comes after it; move {to} away first."
        )
    old = automaton.incoming(edit.checkpoint)
    new = Transition(
        old.id if old else automaton.fresh_transition_id(), edit.to, edit.checkpoint, edit.when
    )
    return automaton.with_transition(new)


def _connect(automaton: Automaton, edit: Connect) -> Automaton:
    automaton.checkpoint(edit.transition.source)
    _not_start(automaton, edit.transition.target, "led back to")
    if edit.transition.id in automaton.transitions:
        raise EditError(f"There is a transition {edit.transition.id} already.")
    if automaton.incoming(edit.transition.target) is not None:
        name = automaton.checkpoints[edit.transition.target].name
        raise EditError(
            f"Something leads to {name} already; move it instead, or add a second checkpoint."
        )
    if edit.transition.source in automaton.subtree(edit.transition.target):
        raise EditError("That would close a loop, and programs can't loop yet.")
    return automaton.with_transition(edit.transition)


def _disconnect(automaton: Automaton, edit: Disconnect) -> Automaton:
    automaton.transition(edit.transition)
    return automaton.without(frozenset(), frozenset({edit.transition}))


def _replace_program(_: Automaton, edit: ReplaceProgram) -> Automaton:
    return edit.program


_APPLY: dict[type, Callable[[Automaton, Any], Automaton]] = {
    AddCheckpoint: _add,
    InsertCheckpoint: _insert,
    RemoveCheckpoint: _remove,
    RenameCheckpoint: _rename,
    SetGoals: _set_goals,
    SetConditional: _set_conditional,
    MoveCheckpoint: _move,
    Connect: _connect,
    Disconnect: _disconnect,
    ReplaceProgram: _replace_program,
}


def _new(automaton: Automaton, checkpoint: Checkpoint, transition: str) -> None:
    if checkpoint.id in automaton.checkpoints:
        raise EditError(f"There is a checkpoint {checkpoint.id} already.")
    if transition in automaton.transitions:
        raise EditError(f"There is a transition {transition} already.")
    if automaton.named(checkpoint.name) is not None:
        raise EditError(
            f"Another checkpoint is called {checkpoint.name} already; choose another name."
        )


def _not_start(automaton: Automaton, checkpoint: str, done: str) -> None:
    automaton.checkpoint(checkpoint)
    if checkpoint == START:
        raise EditError(f"The start can't be {done}; it is where every program begins.")
