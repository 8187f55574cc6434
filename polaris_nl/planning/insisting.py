"""A program whose plan goes a given way at one place, and what that changes."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace

from polaris_nl.automaton.automaton import Automaton, Checkpoint, Transition
from polaris_nl.model.domain import Action
from polaris_nl.planning.result import BranchingPlan


def insisting(
    automaton: Automaton, source: str, target: str | None, prefix: Sequence[Action]
) -> Automaton:
    """The program with actions insisted on before a checkpoint, or before all that follows `source`."""
    moved = [t for t in automaton.outgoing(source) if target in (None, t.target)]
    first = moved[0] if target is not None else None
    trial, at = automaton, source
    for number, action in enumerate(prefix):
        made = Checkpoint(trial.fresh_checkpoint_id(), trial.fresh_name("meanwhile"), action=action)
        when = first.when if first is not None and not number else ()
        onward = Transition(trial.fresh_transition_id(), at, made.id, when)
        trial, at = trial.with_checkpoint(made).with_transition(onward), made.id
    if not prefix:
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
