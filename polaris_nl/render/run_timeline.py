"""One branch of a plan as a timeline: conditionals, actions and checkpoints in a row, left to right.

    [go to the hall]─▸[tell the resident ...]─▸[● alerted]─▸[◇ 1/2 lunch is acknowledged]─▸ ...

A row that is full goes on in the next one.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal as OneOf

from polaris_nl.automaton.automaton import Automaton, Transition
from polaris_nl.model.state import State
from polaris_nl.model.wording import Wording
from polaris_nl.planning.result import BranchingPlan
from polaris_nl.render.glyphs import Glyphs, cells
from polaris_nl.render.layout import Row, cut
from polaris_nl.render.program import first_numbers

LONGEST = 38
"""Columns that the text of a stop may take."""


@dataclass(frozen=True)
class Stop:
    """One place on a branch.

    Attributes:
        text: what is said of it.
        checkpoint: the checkpoint that its segment ends at.
        number: the action's number in the plan's outline; None for other kinds.
        at: the action's place in its segment, from 0; 0 for other kinds.
        before, after: the states around it, None where it has no plan.
        ways: the checkpoints of all ways that part here; for a conditional.
    """

    kind: OneOf["condition", "action", "checkpoint"]
    text: str
    checkpoint: str
    number: int | None = None
    at: int = 0
    before: State | None = None
    after: State | None = None
    ways: tuple[str, ...] = ()


def branch_stops(
    automaton: Automaton, plan: BranchingPlan, leaf: str, wording: Wording
) -> tuple[Stop, ...]:
    """The stops from the start to a checkpoint; one without a plan ends the row with its checkpoint."""
    numbers = first_numbers(plan)
    stops: list[Stop] = []
    for way in automaton.path(leaf):
        stops.extend(_segment_stops(automaton, plan, way, wording, numbers))
        if way.target not in plan.segments:
            break
    return tuple(stops)


def _segment_stops(
    automaton: Automaton,
    plan: BranchingPlan,
    way: Transition,
    wording: Wording,
    numbers: Mapping[str, int],
) -> Iterator[Stop]:
    target, segment = way.target, plan.segments.get(way.target)
    siblings = tuple(t.target for t in sorted_ways(automaton, way.source))
    before = segment.before if segment else None
    if way.when or len(siblings) > 1:
        text = f"once {wording.events(way.when)}" if way.when else "otherwise"
        came = plan.segments.get(way.source)
        yield Stop(
            "condition", text, target, None, 0, came.after if came else None, before, siblings
        )
    if segment is not None:
        states = [segment.before, *(step.state for step in segment.steps)]
        for at, action in enumerate(segment.actions):
            known = at + 1 < len(states)
            yield Stop(
                "action",
                wording.action(action),
                target,
                numbers[target] + at,
                at,
                states[at] if known else None,
                states[at + 1] if known else None,
            )
    end = segment.after if segment else None
    yield Stop("checkpoint", automaton.checkpoints[target].name, target, None, 0, end, end)


def sorted_ways(automaton: Automaton, source: str) -> list[Transition]:
    """The transitions from a checkpoint, the else last, as they are drawn everywhere."""
    return sorted(automaton.outgoing(source), key=lambda t: not t.when)


def timeline_rows(
    stops: Sequence[Stop],
    picked: int | None,
    glyphs: Glyphs,
    width: int,
    planned: frozenset[str],
    done: int = 0,
) -> list[Row]:
    """The stops as rows of boxes; the picked one has other brackets and is picked out.

    Args:
        stops: of one branch.
        picked: the place of a stop, or None.
        glyphs: the signs to draw with.
        width: columns in a row.
        planned: the checkpoints that have a plan.
        done: so many stops are behind a robot that is on its way; they get a tick.
    """
    rows: list[Row] = []
    line, span, checkpoint = "", None, None
    longest = min(LONGEST, max(width - 8, 4))
    for number, stop in enumerate(stops):
        here = number == picked
        left, right = (glyphs.picked[0], glyphs.picked[1]) if here else ("[", "]")
        sign = f"{glyphs.good} " if number < done else ""
        box = f"{left}{sign}{cut(_label(stop, glyphs, planned), longest, glyphs.more)}{right}"
        joint = glyphs.step if line else ""
        last = number == len(stops) - 1
        room = width - (0 if last else cells(glyphs.step))
        if line and cells(line + joint + box) > room:
            rows.append(Row(line + glyphs.step, "", checkpoint, None, span))
            line, span, joint = "  ", None, ""
        start = len(line) + len(joint)
        line += joint + box
        if here:
            span = (start, start + len(box))
        checkpoint = stop.checkpoint
    if line:
        rows.append(Row(line, "", checkpoint, None, span))
    return rows


def _label(stop: Stop, glyphs: Glyphs, planned: frozenset[str]) -> str:
    if stop.kind == "condition":
        several = len(stop.ways) > 1
        which = f"{stop.ways.index(stop.checkpoint) + 1}/{len(stop.ways)} " if several else ""
        return f"{glyphs.wait} {which}{stop.text}"
    if stop.kind == "checkpoint":
        sign = glyphs.checkpoint if stop.checkpoint in planned else glyphs.bad
        return f"{sign} {stop.text}"
    return stop.text
