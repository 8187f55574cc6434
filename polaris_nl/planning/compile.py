"""From a goal automaton to a branching plan (DESIGN section 5 points 1 to 7)."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace

from polaris_nl.automaton.automaton import START, Automaton
from polaris_nl.automaton.validation import validate
from polaris_nl.model.state import Mutexes
from polaris_nl.model.wording import Wording
from polaris_nl.model.world import World
from polaris_nl.planning.ahead import Ahead
from polaris_nl.planning.detours import Detours
from polaris_nl.planning.faults import Faults
from polaris_nl.planning.result import BranchingPlan, Segment, Status
from polaris_nl.planning.segments import Segments
from polaris_nl.planning.shortening import Shortening
from polaris_nl.planning.shorter import Shortcuts
from polaris_nl.planning.tree import plan_tree
from polaris_nl.planning.walk import Errand, Walker, Work
from polaris_nl.planning.warnings import warnings_of

STREAM_S = 0.3
"""Seconds after which what there is of a plan is shown, and shown again."""


@dataclass(frozen=True, slots=True)
class Draft:
    """A plan on its way.

    Attributes:
        whole: all checkpoints have been tried; a later draft can only be better.
        shown: the segments to be kept in the next plan where they are as good then.
    """

    plan: BranchingPlan
    whole: bool
    shown: Mapping[str, Segment] = field(default_factory=dict, repr=False)


class Compiler:
    """Compiles the programs of one world.

    Args:
        world: the world, whose facts are the state at the start.
        mutexes: what excludes what in it.
        segments: plans single segments, and remembers them.
        wording: words for problems and warnings.
    """

    def __init__(
        self, world: World, mutexes: Mutexes, segments: Segments, wording: Wording
    ) -> None:
        self._world = world
        self._mutexes = mutexes
        self._wording = wording
        ahead = Ahead(world, mutexes)
        self._faults = Faults(world, mutexes, segments, wording)
        self._walker = Walker(world, mutexes, segments, wording)
        self._detours = Detours(world, self._walker, segments, ahead)
        shortcuts = Shortcuts(mutexes, segments, ahead, wording)
        self._shortening = Shortening(world, self._walker, shortcuts)

    def compile(self, automaton: Automaton, cancelled: Callable[[], bool]) -> BranchingPlan:
        """Plans every checkpoint that can be planned: a pure function of the program.

        A cancelled compile returns what it has, with status `undecided`.
        """
        started = time.perf_counter()
        broken = self._broken(automaton, cancelled, started)
        if broken is not None:
            return broken
        errand = Errand(automaton, cancelled)
        work = Work()
        for _ in self._walk(errand, work):
            pass
        return self._plan(automaton, self._looked_ahead(errand, work), started)

    def drafts(
        self,
        automaton: Automaton,
        cancelled: Callable[[], bool],
        shown: Mapping[str, Segment],
        changed: frozenset[str],
    ) -> Iterator[Draft]:
        """Plans as `compile` does, and gives what there is as soon as there is any.

        At first any plan will do where a shortest one takes long; better ones come after.

        Args:
            automaton: the program.
            cancelled: asked now and then; True ends the drafts.
            shown: the segments that are shown now; they are kept where they are as good.
            changed: the checkpoints that are planned first, with all on the way to them.
        """
        started = last = time.perf_counter()
        broken = self._broken(automaton, cancelled, started)
        if broken is not None:
            yield Draft(broken, True, shown)
            return
        first = frozenset(
            t.target for c in changed if c in automaton.checkpoints for t in automaton.path(c)
        )
        errand = Errand(automaton, cancelled, True, first, shown)
        work = Work()
        for _ in self._walk(errand, work):
            if time.perf_counter() - last > STREAM_S:
                part = self._plan(automaton, replace(work, cancelled=True), started)
                yield Draft(part, False, shown)
                last = time.perf_counter()
        work = self._looked_ahead(errand, work)
        quick = self._plan(automaton, work, started)
        if work.cancelled:
            return
        yield Draft(quick, True, work.plain())
        errand = replace(errand, quick=False, kept=work.plain())
        better = Work()
        for _ in self._walk(errand, better):
            pass
        better = self._looked_ahead(errand, better)
        plan = self._plan(automaton, better, started)
        # No screen is drawn again for an offer alone: it is known now, and comes with the next plan.
        same = plan.segments == quick.segments and plan.problems == quick.problems
        if not better.cancelled and not cancelled() and not same:
            yield Draft(plan, True, better.plain())

    def _walk(self, errand: Errand, work: Work) -> Iterator[None]:
        start = errand.automaton.outgoing(START)
        return self._walker.walk(errand, [(t, self._world.initial) for t in start], work)

    def _looked_ahead(self, errand: Errand, work: Work) -> Work:
        return self._shortening.shortened(errand, self._detours.around(errand, work))

    def _broken(
        self, automaton: Automaton, cancelled: Callable[[], bool], started: float
    ) -> BranchingPlan | None:
        """The plan of a program that nothing can be compiled of."""
        faults = validate(automaton, self._world)
        if not faults:
            return None
        problems = self._faults.problems(automaton, faults, cancelled)
        # Names and shape come first: until they are right, the same conditional may not be the same.
        only_under = all(f.cause == "underspecified" for f in faults)
        status: Status = "underspecified" if only_under else "invalid"
        return BranchingPlan(status, {}, None, problems, (), _ms(started))

    def _plan(self, automaton: Automaton, work: Work, started: float) -> BranchingPlan:
        place = {c: n for n, c in enumerate(automaton.subtree(START))}
        segments = {c: work.segments[c] for c in place if c in work.segments}
        problems = sorted(work.problems, key=lambda p: place.get(p.checkpoint or "", 0))
        states = {START: self._world.initial, **{k: s.after for k, s in segments.items()}}
        warnings = warnings_of(automaton, states, self._mutexes, self._world, self._wording)
        return BranchingPlan(
            _status(work),
            segments,
            plan_tree(automaton, segments, self._world),
            tuple(problems),
            (*work.notes, *warnings),
            _ms(started),
        )


def _status(work: Work) -> Status:
    if work.cancelled:
        return "undecided"
    if not work.problems:
        return "ok"
    own = [p for p in work.problems if p.cause != "inside"]
    if not work.segments and all(p.cause == "undecided" for p in own):
        return "undecided"
    return "partial"


def _ms(started: float) -> float:
    return (time.perf_counter() - started) * 1000
