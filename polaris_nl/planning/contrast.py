"""What a plan would be like if it went another way: contrastive explanation by planning.

"Why don't you do B before A?" names a foil, the plan that the user has in mind. As in Fox, Long and
Magazzeni, "Explainable Planning" (IJCAI Workshop on XAI, 2017), the foil is made a constraint, the
planner plans again, and the two plans are compared. The start of the foil is planned with A made
impossible (so B truly comes before it) and then insisted on, action by action, in a copy of the
program; what comes after it is compiled like any other program. Nothing is changed or guessed: what
the program would have to forgo is what the foil's own plan leaves out.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Literal as OneOf

from polaris_nl.automaton.automaton import START, Automaton, Checkpoint, Transition
from polaris_nl.model.domain import Action
from polaris_nl.model.evaluate import after, ground_goals
from polaris_nl.model.formula import Goal, Literal
from polaris_nl.model.state import State
from polaris_nl.planning.barred import barred
from polaris_nl.planning.insisting import along, insisting, only_in
from polaris_nl.planning.planner import Planner
from polaris_nl.planning.reasons import Step
from polaris_nl.planning.result import BranchingPlan
from polaris_nl.planning.segments import BUDGET_S, SegmentResult, Segments, never

Way = OneOf["first", "before", "instead"]
Outcome = OneOf[
    "possible", "already", "holds", "needed", "impossible", "asked", "absent", "undecided"
]


@dataclass(frozen=True, slots=True)
class Foil:
    """What the user has in mind.

    Attributes:
        way: `first`: the wanted facts before all else; `before`: before the plan's facts; `instead`:
            the wanted facts, and the plan's never on the way to that checkpoint's goals.
        wanted: the facts that the foil reaches.
        fact: the facts of the plan that they are held against; none for `first`.
    """

    way: Way
    wanted: tuple[Literal, ...]
    fact: tuple[Literal, ...] = ()


@dataclass(frozen=True, slots=True)
class Contrast:
    """The plan beside its foil.

    Attributes:
        outcome: `possible`; `already`: the plan does it so; `holds`: the wanted facts are true then
            anyway; `needed`: they can't be reached without the plan's facts; `impossible`: they
            can't be reached there at all; `asked`: the plan's facts are what the user asked for;
            `absent`: the plan doesn't bring its own facts about; `undecided`: not found out in time.
        checkpoint: the checkpoint on the way to which the plan would change, or None.
        prefix: what the robot would do first, in the foil.
        extra: how many actions more the foil has, on the branch where they differ most; negative
            where it has fewer.
        more, less: the actions that only the foil has, and only the plan, on that branch.
        still: for `instead`: the plan's facts come about all the same.
        lost: the checkpoints that the foil would leave out.
        reason: for `impossible`, why, in a sentence.
    """

    outcome: Outcome
    checkpoint: str | None = None
    prefix: tuple[Action, ...] = ()
    extra: int = 0
    more: tuple[Action, ...] = ()
    less: tuple[Action, ...] = ()
    still: bool = False
    lost: tuple[str, ...] = ()
    reason: str = ""


def contrast(
    planner: Planner,
    automaton: Automaton,
    plan: BranchingPlan,
    foil: Foil,
    cancelled: Callable[[], bool] = never,
) -> Contrast:
    """Plans the foil and compares.

    Args:
        planner: of the program's world.
        automaton: the program.
        plan: its plan.
        foil: what to try.
        cancelled: asked now and then; True ends the work as `undecided`.
    """
    return _Trial(planner, automaton, plan, foil, cancelled).contrast()


def achieved(
    planner: Planner, automaton: Automaton, plan: BranchingPlan, facts: Sequence[Literal]
) -> Step | None:
    """The first action of a plan after which facts hold that did not hold before it."""
    for target in automaton.subtree(START):
        segment = plan.segments.get(target)
        if segment is None:
            continue
        at = _reached(planner, segment.before, segment.actions, facts)
        if at is not None and at >= 0:
            return Step(target, at)
    return None


def _reached(
    planner: Planner, state: State, actions: Sequence[Action], facts: Sequence[Literal]
) -> int | None:
    """The place of the action after which all facts hold, -1 where they hold from the start."""
    for at, action in enumerate((None, *actions), -1):
        if action is not None:
            operator = planner.world.domain.operators[action.operator]
            state = after(action, operator, state, planner.world)
        if all(map(state.holds, facts)):
            return at
    return None


def earlier_place(
    planner: Planner, automaton: Automaton, plan: BranchingPlan, goals: Sequence[Goal], last: str
) -> Contrast | None:
    """The latest checkpoint before `last` after which goals can be met, and what that would forgo.

    For goals that can't be met after `last`: an earlier step may have used up what they need. After
    Eifler, Cashmore, Hoffmann, Magazzeni and Steinmetz, "A New Approach to Plan-Space Explanation"
    (AAAI 2020): to have one thing, others are forgone.

    Returns:
        A contrast with the checkpoint, the actions there in `prefix`, and `lost`; None where there
        is no such place.
    """
    path = [START, *(t.target for t in automaton.path(last))]
    for checkpoint in reversed(path[:-1]):
        segment = plan.segments.get(checkpoint)
        if segment is None and checkpoint != START:
            continue
        state = segment.after if segment else planner.world.initial
        wanted = ground_goals(goals, state, planner.world)
        found = planner.segment(state, wanted)
        if found.status == "solved":
            trial = planner.compile(insisting(automaton, checkpoint, None, found.actions))
            lost = tuple(c for c in plan.segments if c not in trial.segments)
            return Contrast("possible", checkpoint, found.actions, len(found.actions), lost=lost)
    return None


@dataclass(frozen=True)
class _Trial:
    planner: Planner
    automaton: Automaton
    plan: BranchingPlan
    foil: Foil
    cancelled: Callable[[], bool]

    def contrast(self) -> Contrast:
        if self.foil.way == "first":
            return self._first()
        step = achieved(self.planner, self.automaton, self.plan, self.foil.fact)
        if step is None:
            return Contrast("absent")
        if self.foil.way == "before":
            return self._before(step)
        return self._instead(step)

    # The three ways

    def _first(self) -> Contrast:
        start, wanted = self.planner.world.initial, self.foil.wanted
        if all(map(start.holds, wanted)):
            return Contrast("holds")
        result = self._solve(start, wanted)
        if result.status != "solved":
            return self._failed(result, START, None)
        ways = [self.plan.segments.get(c) for c in self.automaton.children(START)]
        begun = [
            s is not None and self._reach(s.before, s.actions, wanted) == len(result.actions) - 1
            for s in ways
        ]
        if begun and all(begun):
            return Contrast("already")
        return self._compared(START, None, result.actions)

    def _before(self, step: Step) -> Contrast:
        segment, wanted = self.plan.segments[step.checkpoint], self.foil.wanted
        if all(map(segment.before.holds, wanted)):
            return Contrast("holds", step.checkpoint)
        own = self._reach(segment.before, segment.actions, wanted)
        if (own is not None and own < step.at) or self._earlier(step.checkpoint):
            return Contrast("already", step.checkpoint)
        result = self._without(step, segment.before, wanted)
        if result is None:
            return Contrast("undecided", step.checkpoint)
        if result.status != "solved":
            return self._failed(result, segment.source, step)
        return self._compared(segment.source, step.checkpoint, result.actions)

    def _instead(self, step: Step) -> Contrast:
        segment, wanted = self.plan.segments[step.checkpoint], self.foil.wanted
        if set(self.foil.fact) <= set(segment.goals):
            return Contrast("asked", step.checkpoint)
        if all(map(segment.before.holds, wanted)):
            return Contrast("holds", step.checkpoint)
        result = self._without(step, segment.before, wanted)
        if result is None:
            return Contrast("undecided", step.checkpoint)
        if result.status != "solved":
            return self._failed(result, segment.source, step)
        there = self._after(segment.before, result.actions)
        rest = self._without(step, there, segment.goals)
        if rest is None or rest.status not in ("solved", "unsolvable"):
            return Contrast("undecided", step.checkpoint)
        still = rest.status == "unsolvable"
        prefix = result.actions if still else (*result.actions, *rest.actions)
        return replace(self._compared(segment.source, step.checkpoint, prefix), still=still)

    def _earlier(self, checkpoint: str) -> bool:
        """Whether a segment before this one brings the wanted facts about."""
        above = [t.target for t in self.automaton.path(checkpoint)][:-1]
        segments = [self.plan.segments[c] for c in above if c in self.plan.segments]
        reached = (self._reach(s.before, s.actions, self.foil.wanted) for s in segments)
        return any(at is not None and at >= 0 for at in reached)

    # Planning

    def _solve(self, state: State, goals: Sequence[Literal]) -> SegmentResult:
        if all(map(state.holds, goals)):
            return SegmentResult("solved", (), True)
        return self.planner.segment(state, goals)

    def _without(self, step: Step, state: State, goals: Sequence[Literal]) -> SegmentResult | None:
        """A plan on which the plan's facts don't come about, or None where that can't be planned."""
        segment = self.plan.segments[step.checkpoint]
        start = self._after(segment.before, segment.actions[: step.at])
        last = next(f for f in self.foil.fact if not start.holds(f))
        world = barred(self.planner.world, last)
        if world is None:
            return None
        if all(map(state.holds, goals)):
            return SegmentResult("solved", (), True)
        marked = State(state.facts | (world.facts - self.planner.world.facts))
        segments = Segments(world, self.planner.mutexes)
        return segments.solve(marked, goals, BUDGET_S, self.cancelled)

    def _failed(self, result: SegmentResult, source: str, step: Step | None) -> Contrast:
        """Why the wanted facts can't come there: because of the plan's facts, or anyway."""
        here = step.checkpoint if step else None
        if result.status != "unsolvable":
            return Contrast("undecided", here)
        before = self.plan.segments[here].before if here else self.planner.world.initial
        if step is not None:
            free = self._solve(before, self.foil.wanted)
            if free.status != "unsolvable":
                return Contrast("needed" if free.status == "solved" else "undecided", here)
        return Contrast("impossible", here, reason=self._reason(source, here))

    def _reason(self, source: str, target: str | None) -> str:
        """What the planning side says of a checkpoint with the wanted facts there."""
        name = self.planner.wording.goals(self.foil.wanted)
        asked = Checkpoint(self.automaton.fresh_checkpoint_id(), name, self.foil.wanted)
        path = {t.target for t in self.automaton.path(source)}
        trial = self.automaton.without(
            frozenset(self.automaton.checkpoints) - {START, *path}, frozenset()
        )
        incoming = self.automaton.incoming(target) if target else None
        when = incoming.when if incoming else ()
        onward = Transition(self.automaton.fresh_transition_id(), source, asked.id, when)
        trial = trial.with_checkpoint(asked).with_transition(onward)
        problem = self.planner.compile(trial, self.cancelled).problem_at(asked.id)
        return problem.text if problem else ""

    # The foil as a program

    def _compared(self, source: str, target: str | None, prefix: tuple[Action, ...]) -> Contrast:
        trial = insisting(self.automaton, source, target, prefix)
        plan = self.planner.compile(trial, self.cancelled)
        if self.cancelled() or plan.status == "undecided":
            return Contrast("undecided", target)
        lost = tuple(c for c in self.plan.segments if c not in plan.segments)
        extra = 0
        more: tuple[Action, ...] = ()
        less: tuple[Action, ...] = ()
        changed = self.automaton.subtree(target or source)
        for leaf in (c for c in changed if not self.automaton.outgoing(c)):
            if leaf not in plan.segments or leaf not in self.plan.segments:
                continue
            ours = along(self.automaton, self.plan, leaf)
            theirs = along(trial, plan, leaf)
            if abs(len(theirs) - len(ours)) >= abs(extra):
                extra = len(theirs) - len(ours)
                more, less = only_in(theirs, ours), only_in(ours, theirs)
        return Contrast("possible", target, prefix, extra, more, less, lost=lost)

    def _reach(
        self, state: State, actions: Sequence[Action], facts: Sequence[Literal]
    ) -> int | None:
        return _reached(self.planner, state, actions, facts)

    def _after(self, state: State, actions: Sequence[Action]) -> State:
        for action in actions:
            operator = self.planner.world.domain.operators[action.operator]
            state = after(action, operator, state, self.planner.world)
        return state
