"""One branch of a program and of its plan."""

from __future__ import annotations

from dataclasses import replace

from polaris_nl.automaton.automaton import START, Automaton
from polaris_nl.model.world import World
from polaris_nl.planning.result import BranchingPlan
from polaris_nl.planning.tree import plan_tree


def only_branch(
    automaton: Automaton, plan: BranchingPlan, checkpoint: str, world: World
) -> tuple[Automaton, BranchingPlan]:
    """The way from the start over a checkpoint, with all that comes after it.

    Args:
        automaton: the program.
        plan: its plan.
        checkpoint: the id of a checkpoint of the program.
        world: the world it is planned in.
    """
    way = {t.target for t in automaton.path(checkpoint)}
    kept = {START, *way, *automaton.subtree(checkpoint)}
    gone = frozenset(automaton.checkpoints) - kept
    part = automaton.without(gone, frozenset())
    segments = {c: s for c, s in plan.segments.items() if c in kept}
    problems = tuple(p for p in plan.problems if p.checkpoint is None or p.checkpoint in kept)
    warnings = tuple(
        w for w in plan.warnings if w.transition is None or w.transition in part.transitions
    )
    root = None if plan.root is None else plan_tree(part, segments, world)
    return part, replace(plan, segments=segments, root=root, problems=problems, warnings=warnings)
