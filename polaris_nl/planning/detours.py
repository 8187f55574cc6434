"""Planning around dead ends: other ways through earlier checkpoints (DESIGN section 5 point 6).

A shortest segment may use up what a later one needs. Where a checkpoint can't be reached, it is planned
together with those before it, the nearest first.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from polaris_nl.automaton.automaton import Automaton
from polaris_nl.model.domain import Action
from polaris_nl.model.world import World
from polaris_nl.planning.ahead import Ahead, Stage
from polaris_nl.planning.result import Segment, Warning
from polaris_nl.planning.segments import Segments
from polaris_nl.planning.walk import Errand, Walker, Work
from polaris_nl.planning.witnesses import grounded

MOST_DETOURS = 3
"""Dead ends of one program that are planned around."""
LOOK_BACK = 3
"""Segments before a failed one that may be planned another way."""
BUDGET_S = 2.0
"""Seconds for one attempt at a way around a dead end."""


class Detours:
    """Finds ways around dead ends in one world."""

    def __init__(self, world: World, walker: Walker, segments: Segments, ahead: Ahead) -> None:
        self._world = world
        self._walker = walker
        self._segments = segments
        self._ahead = ahead

    def around(self, errand: Errand, work: Work) -> Work:
        """The work with other ways through earlier segments, where they let later ones succeed."""
        for _ in range(MOST_DETOURS):
            better = self._detour(errand, work)
            if better is None:
                # A problem that planning ahead might have solved is none yet.
                work.cancelled = work.cancelled or (bool(work.problems) and errand.cancelled())
                break
            work = better
        return work

    def _detour(self, errand: Errand, work: Work) -> Work | None:
        for problem in work.problems:
            if problem.cause not in ("unreachable", "conflict") or problem.checkpoint is None:
                continue
            for earlier, ways in self._ways_to(errand, problem.checkpoint, work):
                trial = self._retried(errand, earlier, ways, work)
                if trial is not None:
                    failed = errand.automaton.checkpoints[problem.checkpoint]
                    trial.notes.append(_note(errand.automaton, earlier, failed.name))
                    return trial
        return None

    def _ways_to(
        self, errand: Errand, failed: str, work: Work
    ) -> Iterator[tuple[Segment, dict[str, tuple[Action, ...]]]]:
        """Ways through some segments before a failed one after which it can be reached."""
        automaton = errand.automaton
        transition = automaton.incoming(failed)
        parent = work.segments.get(automaton.parent(failed) or "")
        if transition is None or parent is None:
            return
        before = self._walker.before(parent.after, transition)
        asked = automaton.checkpoints[failed].goals
        goals = grounded(asked, before, self._world, self._segments, errand.cancelled)
        if goals is None:
            return
        stages, names, when = [Stage(goals)], [failed], transition.when
        earlier: Segment | None = parent
        for _ in range(LOOK_BACK):
            if earlier is None or automaton.checkpoints[earlier.target].action is not None:
                return
            stages.insert(0, Stage(earlier.goals, when))
            names.insert(0, earlier.target)
            when = earlier.when
            # Where it couldn't be reached from before either, the way is not to blame.
            state = self._walker.before(earlier.before, transition)
            alone = self._segments.solve(state, goals, BUDGET_S, errand.cancelled)
            if earlier.actions and alone.status == "solved":
                ways = self._ahead.ways(earlier.before, stages, BUDGET_S, errand.cancelled)
                if ways is not None:
                    yield earlier, dict(zip(names, ways, strict=True))
            earlier = work.segments.get(earlier.source)

    def _retried(
        self, errand: Errand, earlier: Segment, ways: dict[str, tuple[Action, ...]], work: Work
    ) -> Work | None:
        source = work.segments.get(earlier.source)
        state = source.after if source is not None else self._world.initial
        trial = self._walker.again(replace(errand, ways=ways), earlier.target, state, work)
        better = not trial.cancelled and trial.own_problems() < work.own_problems()
        return trial if better else None


def _note(automaton: Automaton, earlier: Segment, failed: str) -> Warning:
    text = (
        f"On the way to {automaton.checkpoints[earlier.target].name} I plan ahead: the first way that"
        f" I found would have kept me from {failed}."
    )
    return Warning(text, earlier.transition)
