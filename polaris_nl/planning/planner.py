"""The planning side's face: one planner for one world."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence

from polaris_nl.automaton.automaton import Automaton
from polaris_nl.model.formula import Formula, Literal
from polaris_nl.model.state import Mutexes, State
from polaris_nl.model.wording import PlainWording, Wording
from polaris_nl.model.world import World
from polaris_nl.planning.budget import never
from polaris_nl.planning.compile import Compiler, Draft
from polaris_nl.planning.costs import Extra
from polaris_nl.planning.mutexes import find_mutexes
from polaris_nl.planning.result import BranchingPlan, Segment
from polaris_nl.planning.segments import BUDGET_S, SegmentResult, Segments


class Planner:
    """Plans programs, and single segments for the executor, in one world.

    Safe to use from several threads. It keeps no process and no file between calls.

    Args:
        world: entities, and the facts at the start.
        wording: words for problems; plain ones where there is no grammar.
        extra: what decides between equally short plans.

    Raises:
        PlanningError: the planner can't use the world's domain.
    """

    def __init__(
        self, world: World, wording: Wording | None = None, extra: Extra | None = None
    ) -> None:
        self.world = world
        self.wording: Wording = wording or PlainWording(world)
        self.mutexes: Mutexes = find_mutexes(world)
        # What the domain only declares is not relied on.
        self._found = Mutexes(
            tuple(g for g in self.mutexes.groups if g not in world.domain.mutexes)
        )
        self._segments = Segments(world, self.mutexes, extra)
        self._compiler = Compiler(world, self.mutexes, self._segments, self.wording)
        self._edited = Automaton()
        self._shown: Mapping[str, Segment] = {}

    def compile(self, automaton: Automaton, cancelled: Callable[[], bool] = never) -> BranchingPlan:
        """The branching plan of a program, or the reasons why parts of it are missing.

        Args:
            automaton: the program.
            cancelled: asked now and then; True ends the work, and the result is to be thrown away.
        """
        return self._compiler.compile(automaton, cancelled)

    def drafts(
        self, automaton: Automaton, cancelled: Callable[[], bool] = never
    ) -> Iterator[Draft]:
        """The plan of a program that is being edited: what there is of it, then all, then a better one.

        What is shown of the last program is kept where it is as good, and what has changed since is
        planned first. For one thread at a time.

        Args:
            automaton: the program.
            cancelled: asked now and then; True ends the drafts.
        """
        before, self._edited = self._edited, automaton
        changed = frozenset(
            c.id
            for c in automaton.checkpoints.values()
            if before.checkpoints.get(c.id) is not c
            or before.incoming(c.id) != automaton.incoming(c.id)
        )
        for draft in self._compiler.drafts(automaton, cancelled, self._shown, changed):
            if draft.whole:
                self._shown = draft.shown
            yield draft

    def segment(
        self, state: State, goals: Sequence[Formula], budget_s: float = BUDGET_S
    ) -> SegmentResult:
        """A plan from a state to goals, as the robot needs it for one goal, or for what is left of a segment.

        An action's effects say much twice (it holds the tray; the tray isn't where it was; the hand
        isn't empty), and what is said in the negative makes everything matter that could be so
        instead. So what follows from the rest is left out.
        """
        positive = [g for g in goals if isinstance(g, Literal) and g.positive]
        needed = [
            g
            for g in goals
            if not isinstance(g, Literal)
            or g.positive
            or all(self._found.exclusive(g.atom, p) is None for p in positive)
        ]
        return self._segments.solve(state, needed, budget_s)
