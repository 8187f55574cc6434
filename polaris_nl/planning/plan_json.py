"""The object that `plan --json` prints (DESIGN section 6)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from polaris_nl.automaton.automaton import START, Automaton
from polaris_nl.automaton.edit_json import edit_json
from polaris_nl.planning.result import (
    BranchingPlan,
    PlanEdge,
    PlanNode,
    Problem,
    Repair,
    Segment,
    Warning,
)


def plan_json(plan: BranchingPlan, automaton: Automaton) -> dict[str, Any]:
    """The JSON value of a branching plan."""
    return {
        "status": plan.status,
        "ms": round(plan.ms),
        "segments": [_segment(segment) for segment in plan.segments.values()],
        "branches": branches_json(plan, automaton),
        "tree": None if plan.root is None else _node(plan.root),
        "problems": [_problem(problem) for problem in plan.problems],
        "warnings": [_warning(warning) for warning in plan.warnings],
    }


def branches_json(plan: BranchingPlan, automaton: Automaton) -> list[dict[str, Any]]:
    """From the start to each last checkpoint that has a plan: the checkpoints and the number of actions."""
    found = []
    waiting: list[tuple[str, ...]] = [(START,)] if plan.root is not None else []
    while waiting:
        path = waiting.pop()
        onward = [c for c in automaton.children(path[-1]) if c in plan.segments]
        waiting.extend((*path, c) for c in reversed(onward))
        if not onward:
            actions = sum(len(plan.segments[c].actions) for c in path[1:])
            found.append({"checkpoints": list(path), "actions": actions})
    return found


def _segment(segment: Segment) -> dict[str, Any]:
    return {
        "transition": segment.transition,
        "from": segment.source,
        "to": segment.target,
        "when": [str(x) for x in segment.when],
        "optimal": segment.optimal,
        "actions": [str(a) for a in segment.actions],
    }


def _node(root: PlanNode) -> dict[str, Any]:
    """The tree as nested values, built without recursion: a branch may have thousands of actions."""
    values: dict[str, dict[str, Any]] = {}
    order = [root]
    for node in order:
        order.extend(edge.node for edge in node.children)
    for node in reversed(order):
        value: dict[str, Any] = {"id": node.id, "action": str(node.action) if node.action else None}
        if node.checkpoint is not None:
            value["checkpoint"] = node.checkpoint
        value["added"] = [str(x) for x in node.added]
        value["removed"] = [str(x) for x in node.removed]
        value["children"] = [_edge(edge, values[edge.node.id]) for edge in node.children]
        values[node.id] = value
    return values[root.id]


def _edge(edge: PlanEdge, node: dict[str, Any]) -> dict[str, Any]:
    return {"transition": edge.transition, "when": [str(x) for x in edge.when], "node": node}


def _problem(problem: Problem) -> dict[str, Any]:
    return {
        "checkpoint": problem.checkpoint,
        "transition": problem.transition,
        "cause": problem.cause,
        "text": problem.text,
        "cores": [[str(x) for x in core] for core in problem.cores],
        "repairs": _repairs(problem.repairs),
    }


def _warning(warning: Warning) -> dict[str, Any]:
    value: dict[str, Any] = {"transition": warning.transition, "text": warning.text}
    if warning.repairs:
        value["repairs"] = _repairs(warning.repairs)
    return value


def _repairs(repairs: Sequence[Repair]) -> list[dict[str, Any]]:
    return [{"text": r.text, "edits": [edit_json(e) for e in r.edits]} for r in repairs]
