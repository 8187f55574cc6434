"""The program as an outline, alone or with its plan's actions in place.

A sequence goes straight down and only branches are indented, so that a long program fits 80 columns:

    ○ start
    ● alerted: tell the resident that lunch is ready  ✓ 3 actions
    ├─ ◇ once lunch is acknowledged
    │  ● home: go home  ✓ 2 actions
    └─ ◇ once lunch is dismissed
       ● cancelled: go home  ✗ no plan
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from polaris_nl.automaton.automaton import START, Automaton, Checkpoint, Transition
from polaris_nl.model.wording import Wording
from polaris_nl.planning.result import BranchingPlan, Segment
from polaris_nl.render.glyphs import Glyphs
from polaris_nl.render.layout import NO_BREAK, Row, Tone, wrapped

EMPTY = "Nothing yet. Say what the robot should achieve."
_NO_PLAN = {
    "conflict": "goals in conflict",
    "unreachable": "can't be reached",
    "invalid": "not valid",
    "undecided": "not decided in time",
    "inside": "left out",
    "underspecified": "underspecified",
    "structure": "not connected",
}


def program_rows(
    automaton: Automaton,
    plan: BranchingPlan | None,
    wording: Wording,
    glyphs: Glyphs,
    width: int,
    actions: bool = False,
    numbers: Mapping[str, int] | None = None,
) -> list[Row]:
    """The outline of a program.

    Args:
        automaton: the program.
        plan: its plan, or None while it is being made.
        wording: words for goals and actions.
        glyphs: the signs to draw with.
        width: characters in a row.
        actions: also show the actions of the plan, numbered as `why --action` counts them.
        numbers: the number of each segment's first action, where the plan is part of another one.
    """
    drawer = _Drawer(automaton, plan, wording, glyphs, width, actions, numbers)
    return list(drawer.rows())


class _Drawer:
    def __init__(
        self,
        automaton: Automaton,
        plan: BranchingPlan | None,
        wording: Wording,
        glyphs: Glyphs,
        width: int,
        actions: bool,
        numbers: Mapping[str, int] | None,
    ) -> None:
        self._automaton = automaton
        self._plan = plan
        self._wording = wording
        self._glyphs = glyphs
        self._width = width
        self._actions = actions
        self._first = numbers or (first_numbers(plan) if plan else {})

    def rows(self) -> Iterator[Row]:
        yield Row(f"{self._glyphs.start} start", "strong", START)
        if len(self._automaton.checkpoints) == 1:
            yield from wrapped(EMPTY, self._width, "  ", tone="faint")
            return
        waiting: list[tuple[Transition, str, str]] = []
        self._push(waiting, START, "")
        seen: set[str] = set()
        while waiting:
            transition, first, rest = waiting.pop()
            if (
                transition.target in seen
            ):  # a program that isn't a tree is drawn as far as it is one
                continue
            seen.add(transition.target)
            yield from self._transition(transition, first, rest)
            yield from self._checkpoint(transition.target, rest)
            self._push(waiting, transition.target, rest)
        yield from self._loose(seen)

    def _push(self, waiting: list[tuple[Transition, str, str]], source: str, rest: str) -> None:
        outgoing = self._automaton.outgoing(source)
        if len(outgoing) == 1:
            waiting.append((outgoing[0], rest, rest))
            return
        ordered = sorted(outgoing, key=lambda t: not t.when)  # the else branch comes last
        for number, transition in enumerate(reversed(ordered)):
            last = number == 0
            sign = self._glyphs.elbow if last else self._glyphs.tee
            below = " " * len(self._glyphs.bar) if last else self._glyphs.bar
            waiting.append((transition, rest + sign, rest + below))

    def _transition(self, transition: Transition, first: str, rest: str) -> Iterator[Row]:
        branches = len(first) > len(rest) or first != rest
        if not transition.when and not branches:
            return
        text = f"once {self._wording.events(transition.when)}" if transition.when else "otherwise"
        lead = f"{first}{self._glyphs.wait} "
        yield from wrapped(text, self._width, lead, rest + "  ", checkpoint=transition.target)

    def _checkpoint(self, checkpoint: str, rest: str) -> Iterator[Row]:
        here = self._automaton.checkpoints[checkpoint]
        segment = self._plan.segments.get(checkpoint) if self._plan else None
        if self._actions and segment is not None:
            yield from self._steps(segment, rest)
        status, tone = self._status(checkpoint, segment)
        text = f"{here.name}: {self._goals(here)}  {status.replace(' ', NO_BREAK)}"
        lead = f"{rest}{self._glyphs.checkpoint} "
        yield from wrapped(text, self._width, lead, rest + "  ", tone, checkpoint)

    def _steps(self, segment: Segment, rest: str) -> Iterator[Row]:
        for number, action in enumerate(segment.actions, self._first[segment.target]):
            lead = f"{rest}  {number:>2} "
            yield from wrapped(
                self._wording.action(action),
                self._width,
                lead,
                checkpoint=segment.target,
                action=number,
            )

    def _status(self, checkpoint: str, segment: Segment | None) -> tuple[str, Tone]:
        glyphs = self._glyphs
        if self._plan is None:
            return f"{glyphs.open} planning", "faint"
        if segment is not None:
            count = len(segment.actions)
            done = (
                "nothing to do" if not count else "1 action" if count == 1 else f"{count} actions"
            )
            return f"{glyphs.good} {done}", ""
        problem = self._plan.problem_at(checkpoint)
        if problem is None:
            return f"{glyphs.left_out} left out", "faint"
        sign = glyphs.left_out if problem.cause == "inside" else glyphs.bad
        return f"{sign} {_NO_PLAN[problem.cause]}", "bad"

    def _goals(self, checkpoint: Checkpoint) -> str:
        if checkpoint.action is not None:
            return self._wording.action(checkpoint.action)
        return self._wording.goals(checkpoint.goals) or "no goal"

    def _loose(self, seen: set[str]) -> Iterator[Row]:
        """Checkpoints that nothing leads to; a program that is being edited may have some."""
        for checkpoint in self._automaton.checkpoints:
            if checkpoint != START and checkpoint not in seen:
                yield from self._checkpoint(checkpoint, "")


def first_numbers(plan: BranchingPlan) -> Mapping[str, int]:
    """The number of the first action of each segment; actions are counted from 1 in the outline's order."""
    numbers: dict[str, int] = {}
    count = 1
    for checkpoint in _outline_order(plan):
        numbers[checkpoint] = count
        count += len(plan.segments[checkpoint].actions)
    return numbers


def numbered(plan: BranchingPlan, number: int) -> tuple[str, int] | None:
    """The action of a number: the checkpoint that its segment ends at, and its place there, from 0."""
    for checkpoint, first in first_numbers(plan).items():
        if first <= number < first + len(plan.segments[checkpoint].actions):
            return checkpoint, number - first
    return None


def _outline_order(plan: BranchingPlan) -> Iterator[str]:
    children: dict[str, list[Segment]] = {}
    for segment in plan.segments.values():
        children.setdefault(segment.source, []).append(segment)
    waiting = [START]
    while waiting:
        at = waiting.pop()
        if at != START:
            yield at
        ways = sorted(children.get(at, ()), key=lambda s: not s.when)
        waiting.extend(s.target for s in reversed(ways))
