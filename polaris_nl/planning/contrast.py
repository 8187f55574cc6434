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

from polaris_nl.automaton.automaton import START, Automaton, Checkpoint, Transition
from polaris_nl.model.domain import Action
from polaris_nl.model.evaluate import after
from polaris_nl.model.formula import Literal
from polaris_nl.model.state import State
from polaris_nl.model.world import World
from polaris_nl.planning.barred import REACHED, barred, unmarked
from polaris_nl.planning.budget import never
from polaris_nl.planning.foils import Contrast, Foil
from polaris_nl.planning.insisting import along, insisting, only_in
from polaris_nl.planning.planner import Planner
from polaris_nl.planning.reasons import Step
from polaris_nl.planning.result import BranchingPlan
from polaris_nl.planning.segments import BUDGET_S, SegmentResult, Segments


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
        whole = self._ordered(step)
        prefix = whole.actions if whole else result.actions
        exact = whole is not None and whole.optimal
        return self._compared(segment.source, step.checkpoint, prefix, exact)

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
        whole = self._ordered(step, ever=False)
        if whole is not None:
            return self._compared(segment.source, step.checkpoint, whole.actions)
        whole = self._ordered(step)
        prefix = whole.actions if whole else result.actions
        exact = whole is not None and whole.optimal
        found = self._compared(segment.source, step.checkpoint, prefix, exact)
        return replace(found, still=True)

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

    def _last(self, step: Step) -> Literal:
        """The one of the plan's facts that comes last, with the action at `step`."""
        segment = self.plan.segments[step.checkpoint]
        state = segment.before
        for action in segment.actions[: step.at]:
            operator = self.planner.world.domain.operators[action.operator]
            state = after(action, operator, state, self.planner.world)
        return next(f for f in self.foil.fact if not state.holds(f))

    def _without(self, step: Step, state: State, goals: Sequence[Literal]) -> SegmentResult | None:
        """A plan on which the plan's facts don't come about, or None where that can't be planned."""
        return self._in(barred(self.planner.world, self._last(step)), state, goals)

    def _ordered(self, step: Step, ever: bool = True) -> SegmentResult | None:
        """A shortest way to the checkpoint on which the wanted fact comes first, or None.

        Args:
            step: the place of the plan's facts.
            ever: whether they may come about afterwards.
        """
        segment, wanted = self.plan.segments[step.checkpoint], self.foil.wanted
        if len(wanted) != 1 or self.automaton.checkpoints[step.checkpoint].action is not None:
            return None
        world = barred(self.planner.world, self._last(step), wanted[0], ever)
        result = self._in(world, segment.before, (*segment.goals, REACHED))
        if result is None or result.status != "solved":
            return None
        return replace(result, actions=unmarked(result.actions))

    def _in(
        self, world: World | None, state: State, goals: Sequence[Literal]
    ) -> SegmentResult | None:
        """A plan in a changed world."""
        if world is None:
            return None
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

    def _compared(
        self, source: str, target: str | None, prefix: tuple[Action, ...], exact: bool = True
    ) -> Contrast:
        trial = insisting(self.automaton, source, target, prefix)
        plan = self.planner.compile(trial, self.cancelled)
        if self.cancelled() or plan.status == "undecided":
            return Contrast("undecided", target)
        lost = tuple(c for c in self.plan.segments if c not in plan.segments)
        leaf = self._most_different(trial, plan, target or source)
        if leaf is None:
            return Contrast("possible", target, prefix, lost=lost, exact=exact)
        ours, theirs = along(self.automaton, self.plan, leaf), along(trial, plan, leaf)
        extra = len(theirs) - len(ours)
        more, less = only_in(theirs, ours), only_in(ours, theirs)
        offered = not lost and extra <= 0 and self._offered(source, target, leaf, len(theirs))
        return Contrast(
            "possible", target, prefix, extra, more, less, lost=lost, exact=exact, offered=offered
        )

    def _most_different(self, trial: Automaton, plan: BranchingPlan, below: str) -> str | None:
        """The end of the branch whose length changes most; of several, the one that gets longest."""
        planned = (c for c in self.automaton.subtree(below) if not self.automaton.outgoing(c))
        leaves = [c for c in planned if c in plan.segments and c in self.plan.segments]

        def change(leaf: str) -> tuple[int, int]:
            ours, theirs = along(self.automaton, self.plan, leaf), along(trial, plan, leaf)
            return abs(len(theirs) - len(ours)), len(theirs) - len(ours)

        return max(leaves, key=change, default=None)

    def _offered(self, source: str, target: str | None, leaf: str, length: int) -> bool:
        """Whether a step of its own with the wanted facts gives a plan like the foil."""
        trial = insisting(self.automaton, source, target, [self.foil.wanted])
        plan = self.planner.compile(trial, self.cancelled)
        made = next(c for c in trial.checkpoints if c not in self.automaton.checkpoints)
        if plan.status != "ok" or len(along(trial, plan, leaf)) != length:
            return False
        step, fact = plan.segments[made], self.foil.fact
        return not fact or self._reach(step.before, step.actions, fact) is None

    def _reach(
        self, state: State, actions: Sequence[Action], facts: Sequence[Literal]
    ) -> int | None:
        return _reached(self.planner, state, actions, facts)
