"""What planning returns: the branching plan, or the reasons why parts of it are missing.

A missing plan is a value here, never an error (DESIGN section 5 point 4).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Literal as OneOf

from polaris_nl.automaton.edits import Edit
from polaris_nl.model.domain import Action
from polaris_nl.model.formula import Literal
from polaris_nl.model.state import State

Status = OneOf["ok", "partial", "underspecified", "invalid", "undecided"]
Cause = OneOf[
    "conflict", "unreachable", "invalid", "undecided", "inside", "underspecified", "structure"
]


@dataclass(frozen=True, slots=True)
class PlanNode:
    """A node of the branching plan.

    Attributes:
        id: `a0` for the root, counted from there.
        action: what the robot does to get here; None for the root and for a checkpoint that costs
            nothing.
        checkpoint: the checkpoint that is reached here (the inverse of the paper's f_m), or None.
        state: the world after the action, the paper's L_a.
        removed, added: how the state differs from the node before (the conditional's facts
            included).
        children: what can come next, with the transition and its conditional where a branch begins.
    """

    id: str
    action: Action | None
    checkpoint: str | None
    state: State
    removed: tuple[Literal, ...] = ()
    added: tuple[Literal, ...] = ()
    children: tuple[PlanEdge, ...] = ()


@dataclass(frozen=True, slots=True)
class PlanEdge:
    """From a plan node to the next; `transition` is None inside a segment."""

    node: PlanNode
    transition: str | None = None
    when: tuple[Literal, ...] = ()


@dataclass(frozen=True, slots=True)
class Step:
    """What one action leads to: the state after it, and how that differs from the one before."""

    state: State
    removed: tuple[Literal, ...]
    added: tuple[Literal, ...]


@dataclass(frozen=True, slots=True)
class Segment:
    """The actions between a checkpoint and the next.

    Attributes:
        goals: the ground literals that the segment achieves (quantifiers expanded).
        optimal: whether no plan with fewer actions exists from `before` to the goals.
        before: the state that the segment starts from, its conditional already true.
        after: the state at its end.
        steps: what each action leads to; follows from the rest.
    """

    transition: str
    source: str
    target: str
    when: tuple[Literal, ...]
    goals: tuple[Literal, ...]
    actions: tuple[Action, ...]
    optimal: bool
    before: State
    after: State
    steps: tuple[Step, ...] = field(default=(), compare=False, repr=False)


RepairKind = OneOf["split", "drop", "wait", "reorder", "change", "condition", "shape"]
"""What a way out does: splits a checkpoint in steps, drops goals, waits for a person, changes the order
of steps, asks for another thing, gives a way another condition, mends the program's shape."""


@dataclass(frozen=True, slots=True)
class Repair:
    """A way out that has been tried: applying `edits` makes the problem go away.

    Attributes:
        text: an imperative, to go after "you could".
        edits: applied together, by `polaris_nl.automaton.edits.apply_all`.
        kind: what the edits do, the chief one where they do several things.
    """

    text: str
    edits: tuple[Edit, ...]
    kind: RepairKind = "drop"


@dataclass(frozen=True, slots=True)
class Problem:
    """Why a checkpoint has no plan.

    Attributes:
        text: a sentence that a person understands, with a way out.
        cores: the minimal sets of goals that can't be met together, the smallest first; of one
            goal each where goals are out of reach by themselves.
        repairs: verified ways out, the best first.
        start: facts with which there would be no problem, and which no edit of the program brings
            about: somebody has to change the world, or tell the robot of it.
    """

    cause: Cause
    text: str
    checkpoint: str | None = None
    transition: str | None = None
    cores: tuple[tuple[Literal, ...], ...] = ()
    repairs: tuple[Repair, ...] = ()
    start: tuple[Literal, ...] = ()


@dataclass(frozen=True, slots=True)
class Warning:
    """Something legal that may not be meant, such as a conditional that holds already.

    Attributes:
        repairs: changes that would mend it, each tried, the best first.
    """

    text: str
    transition: str | None = None
    repairs: tuple[Repair, ...] = ()


@dataclass(frozen=True)
class BranchingPlan:
    """A program's plan.

    Attributes:
        segments: by the id of the checkpoint that they end at, parents before children.
        root: the tree of actions, None where nothing compiles.
        ms: how long it took, in milliseconds.
    """

    status: Status
    segments: Mapping[str, Segment]
    # Follows from the rest, and is too deep for Python's own comparing and printing.
    root: PlanNode | None = field(compare=False, repr=False)
    problems: tuple[Problem, ...] = ()
    warnings: tuple[Warning, ...] = ()
    ms: float = field(default=0.0, compare=False)

    @property
    def omitted(self) -> tuple[str, ...]:
        """The checkpoints that have no plan because of a problem at or above them."""
        return tuple(
            dict.fromkeys(
                p.checkpoint
                for p in self.problems
                if p.checkpoint and p.checkpoint not in self.segments
            )
        )

    @property
    def action_count(self) -> int:
        """All actions of all branches, each segment counted once."""
        return sum(len(s.actions) for s in self.segments.values())

    def nodes(self) -> Iterator[PlanNode]:
        """All nodes, parents before children."""
        waiting = [self.root] if self.root else []
        while waiting:
            node = waiting.pop()
            yield node
            waiting.extend(edge.node for edge in reversed(node.children))

    def problem_at(self, checkpoint: str) -> Problem | None:
        """The first problem of a checkpoint, or None."""
        return next((p for p in self.problems if p.checkpoint == checkpoint), None)
