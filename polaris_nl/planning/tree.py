"""The branching plan as a tree of actions (the paper's section 3.3)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from polaris_nl.automaton.automaton import START, Automaton
from polaris_nl.model.domain import Action
from polaris_nl.model.formula import Literal
from polaris_nl.model.state import State
from polaris_nl.model.world import World
from polaris_nl.planning.result import PlanEdge, PlanNode, Segment


@dataclass(slots=True)
class _Draft:
    """A node whose children are not made yet."""

    action: Action | None
    state: State
    removed: tuple[Literal, ...] = ()
    added: tuple[Literal, ...] = ()
    checkpoint: str | None = None
    transition: str | None = None
    when: tuple[Literal, ...] = ()
    children: list[_Draft] = field(default_factory=list)


def plan_tree(automaton: Automaton, segments: Mapping[str, Segment], world: World) -> PlanNode:
    """The tree of all segments, its nodes numbered in reading order.

    Every checkpoint has a node of its own, even if it costs no action (the map f_m is injective).
    Built without recursion, since a branch may have thousands of actions.
    """
    root = _Draft(None, world.initial, checkpoint=START)
    waiting = [root]
    while waiting:
        here = waiting.pop()
        for transition in automaton.outgoing(str(here.checkpoint)):
            segment = segments.get(transition.target)
            if segment is not None:
                waiting.append(_add_segment(here, segment))
    return _finished(root)


def _add_segment(start: _Draft, segment: Segment) -> _Draft:
    """Hangs a segment's nodes below the checkpoint it starts from and returns its last one."""
    # The first node's difference includes what the conditional changed.
    before = start.state if segment.when else None
    node = start
    for action, step in zip(segment.actions, segment.steps, strict=True):
        last = _Draft(action, step.state, step.removed, step.added)
        if before is not None:
            last.removed, last.added = before.difference(step.state)
            before = None
        node.children.append(last)
        node = last
    if not segment.actions:
        removed, added = before.difference(segment.before) if before is not None else ((), ())
        node = _Draft(None, segment.before, removed, added)
        start.children.append(node)
    node.checkpoint = segment.target
    first = start.children[-1]
    first.transition, first.when = segment.transition, segment.when
    return node


def _finished(root: _Draft) -> PlanNode:
    order: list[_Draft] = []
    waiting = [root]
    while waiting:
        draft = waiting.pop()
        order.append(draft)
        waiting.extend(reversed(draft.children))
    numbers = {id(draft): number for number, draft in enumerate(order)}
    made: dict[int, PlanNode] = {}
    for draft in reversed(order):
        made[id(draft)] = PlanNode(
            id=f"a{numbers[id(draft)]}",
            action=draft.action,
            checkpoint=draft.checkpoint,
            state=draft.state,
            removed=draft.removed,
            added=draft.added,
            children=tuple(PlanEdge(made[id(c)], c.transition, c.when) for c in draft.children),
        )
    return made[id(root)]
