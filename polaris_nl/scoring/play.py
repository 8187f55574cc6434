"""A program carried out in thought: what the robot does next, as the executor would have it do.

The rules are those of `polaris_nl.execution.executor` without its clock: what is perceived is what is
so, and whoever acts is quick enough. But for one: where people have moved a thing that the program
hasn't spoken of yet, the executor plans the rest of a segment anew, and here the robot waits for it to be
put back. So what is promised here is what can be met at least.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

from polaris_nl.automaton.automaton import START, Automaton
from polaris_nl.execution.expectations import kept_goals, needed_places
from polaris_nl.execution.goals import GoalLimits
from polaris_nl.model.domain import Action
from polaris_nl.model.evaluate import effects
from polaris_nl.model.formula import Literal
from polaris_nl.model.state import State
from polaris_nl.model.world import World
from polaris_nl.planning.result import BranchingPlan
from polaris_nl.planning.segments import SegmentResult
from polaris_nl.planning.simulate import Simulator


@dataclass(frozen=True, slots=True)
class Moment:
    """Where a run is, and what is so.

    Attributes:
        checkpoint: the last one reached.
        segment: the checkpoint that is aimed for, or "".
        done: how many actions of the segment are done.
        over: the run has ended.
    """

    state: State
    checkpoint: str = START
    segment: str = ""
    done: int = 0
    over: bool = False


@dataclass(frozen=True, slots=True)
class Next:
    """What comes next without people: `moves`, as that takes time, in which people can act."""

    moment: Moment
    moves: bool = False


class Play:
    """A program with its plan in a world.

    Args:
        automaton: the program.
        plan: its branching plan.
        world: the world, at its start.
        way: plans the robot's own way to the effects of an action, where it can't just do it.
    """

    def __init__(
        self,
        automaton: Automaton,
        plan: BranchingPlan,
        world: World,
        way: Callable[[State, Sequence[Literal]], SegmentResult],
    ) -> None:
        self.automaton = automaton
        self.plan = plan
        self.world = world
        self._way = way
        self._simulator = Simulator(world)

    @cached_property
    def start(self) -> Moment:
        """The moment before anything is done."""
        return Moment(self.world.initial)

    @cached_property
    def _kept(self) -> dict[str, tuple[Literal, ...]]:
        return {c: kept_goals(s, self.world) for c, s in self.plan.segments.items()}

    def doing(self, moment: Moment) -> Action | None:
        """The action that comes next in the plan at a moment, or None."""
        segment = self.plan.segments.get(moment.segment)
        if segment is None or moment.done >= len(segment.actions):
            return None
        return segment.actions[moment.done]

    def next(self, moment: Moment) -> Next | None:
        """What the robot does next; None where it waits for somebody to change something.

        It waits for a condition to hold, or for what it needs to be back in its place.
        """
        if not moment.segment:
            return self._decided(moment)
        action = self.doing(moment)
        if action is not None:
            return self._acted(moment, action)
        if not all(map(moment.state.holds, self._kept[moment.segment])):
            return None
        return Next(Moment(moment.state, moment.segment))

    def _decided(self, moment: Moment) -> Next | None:
        outgoing = self.automaton.outgoing(moment.checkpoint)
        if not outgoing:
            return Next(replace(moment, over=True))
        holding = (t for t in outgoing if t.when and all(map(moment.state.holds, t.when)))
        otherwise = (t for t in outgoing if not t.when)
        taken = next(holding, None) or next(otherwise, None)
        if taken is None:
            return None
        if taken.target not in self.plan.segments:
            return Next(replace(moment, over=True))  # What has no plan halts the run.
        return Next(replace(moment, segment=taken.target, done=0))

    def _acted(self, moment: Moment, action: Action) -> Next | None:
        operator = self.world.domain.operators[action.operator]
        wanted = effects(action, operator, moment.state, self.world)
        after = replace(moment, done=moment.done + 1)
        if all(map(moment.state.holds, wanted)):
            return Next(after)
        if not all(map(moment.state.holds, needed_places(action, operator))):
            return None
        steps = self._simulator.run(moment.state, (action,))
        if steps is None:
            way = self._way(moment.state, wanted)
            if way.status == "solved" and len(way.actions) <= GoalLimits().actions:
                steps = self._simulator.run(moment.state, way.actions)
        if not steps:
            return Next(replace(moment, over=True))  # The robot finds no way, and the run halts.
        return Next(replace(after, state=steps[-1].state), moves=True)
