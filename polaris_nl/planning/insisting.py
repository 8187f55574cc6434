"""A program whose plan goes a given way at one place, and what that changes."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace

from polaris_nl.automaton.automaton import Automaton, Checkpoint, Transition
from polaris_nl.model.domain import Action
from polaris_nl.model.formula import Literal
from polaris_nl.planning.result import BranchingPlan

Goals = tuple[Literal, ...]


def insisting(
    automaton: Automaton, source: str, target: str | None, steps: Sequence[Action | Goals]
) -> Automaton:
    """The program with more steps before a checkpoint, or before all that follows `source`.

    Args:
        automaton: the program.
        source: the checkpoint after which they come.
        target: the checkpoint right after it before which they come, its conditional in front of
            them; None stands for all that follow, with their conditionals behind.
        steps: actions that are insisted on, and sets of goals.
    """
    moved = [t for t in automaton.outgoing(source) if target in (None, t.target)]
    first = moved[0] if target is not None else None
    trial, at = automaton, source
    for number, step in enumerate(steps):
        goals, action = ((), step) if isinstance(step, Action) else (step, None)
        name = trial.fresh_name("meanwhile")
        made = Checkpoint(trial.fresh_checkpoint_id(), name, goals, action)
        when = first.when if first is not None and not number else ()
        onward = Transition(trial.fresh_transition_id(), at, made.id, when)
        trial, at = trial.with_checkpoint(made).with_transition(onward), made.id
    if not steps:
        return automaton
    for transition in moved:
        when = () if transition == first else transition.when
        trial = trial.with_transition(replace(transition, source=at, when=when))
    return trial


def along(automaton: Automaton, plan: BranchingPlan, leaf: str) -> list[Action]:
    """All actions of a plan from the start to a checkpoint."""
    path = (t.target for t in automaton.path(leaf))
    return [a for target in path for a in plan.segments[target].actions]


def only_in(these: Sequence[Action], those: Sequence[Action]) -> tuple[Action, ...]:
    """The actions that are in one list more often than in another, in order."""
    left = Counter(those)
    found = []
    for action in these:
        if left[action]:
            left[action] -= 1
        else:
            found.append(action)
    return tuple(found)
