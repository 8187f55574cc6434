"""Going through a branch of the plan step by step, and from one branch to another. Pure functions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from polaris_nl.automaton.automaton import START, Automaton
from polaris_nl.planning.result import BranchingPlan
from polaris_nl.render.timeline import Stop


@dataclass(frozen=True, slots=True)
class Steps:
    """Where the user is.

    Attributes:
        leaf: the last checkpoint of the branch.
        at: the place of the stop that is picked.
    """

    leaf: str = START
    at: int = 0


def first_leaf(automaton: Automaton, checkpoint: str) -> str:
    """The leaf that is met first below a checkpoint; the else branch comes last."""
    seen: set[str] = set()
    while checkpoint not in seen:
        seen.add(checkpoint)
        ways = sorted(automaton.outgoing(checkpoint), key=lambda t: not t.when)
        if not ways:
            break
        checkpoint = ways[0].target
    return checkpoint


def kept(steps: Steps, automaton: Automaton, plan: BranchingPlan | None) -> Steps:
    """The same place in a program that may have changed: a branch that is there."""
    if steps.leaf in automaton.checkpoints and not automaton.outgoing(steps.leaf):
        return steps
    start = steps.leaf if steps.leaf in automaton.checkpoints else START
    return Steps(first_leaf(automaton, start), steps.at)


def moved(steps: Steps, stops: Sequence[Stop], by: int) -> Steps:
    """Some stops on, or back."""
    return Steps(steps.leaf, max(0, min(steps.at + by, len(stops) - 1)))


def other_way(steps: Steps, stops: Sequence[Stop], automaton: Automaton, by: int) -> Steps:
    """Another way where ways part: at this stop or the next such one, else at the last one before."""
    parting = [n for n, stop in enumerate(stops) if len(stop.ways) > 1]
    at = next((n for n in parting if n >= steps.at), parting[-1] if parting else None)
    if at is None:
        return steps
    ways = stops[at].ways
    way = ways[(ways.index(stops[at].checkpoint) + by) % len(ways)]
    return Steps(first_leaf(automaton, way), at)


def at_action(
    automaton: Automaton, checkpoint: str, stops_of: Sequence[Stop], number: int | None
) -> Steps:
    """The stop of an action, or of a checkpoint's end, on the first branch through it."""
    leaf = first_leaf(automaton, checkpoint)
    for at, stop in enumerate(stops_of):
        if stop.checkpoint == checkpoint and (
            stop.number == number if number is not None else stop.kind == "checkpoint"
        ):
            return Steps(leaf, at)
    return Steps(leaf, 0)


def beside(automaton: Automaton, checkpoint: str, direction: str) -> str:
    """The checkpoint left, right, above or below another one in a drawn tree; itself where there is none."""
    if checkpoint not in automaton.checkpoints:
        return START
    if direction == "left":
        return automaton.parent(checkpoint) or checkpoint
    if direction == "right":
        ways = sorted(automaton.outgoing(checkpoint), key=lambda t: not t.when)
        return ways[0].target if ways else checkpoint
    by = -1 if direction == "up" else 1
    here = checkpoint
    while (parent := automaton.parent(here)) is not None and parent != here:
        ways = sorted(automaton.outgoing(parent), key=lambda t: not t.when)
        at = [t.target for t in ways].index(here) + by
        if 0 <= at < len(ways):
            return ways[at].target
        here = parent
    return checkpoint
