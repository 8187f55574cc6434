"""Small edits that may lead out of a problem, in the order a person would choose. None is tried here."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from polaris_nl.automaton.automaton import START, Checkpoint
from polaris_nl.automaton.edits import (
    Edit,
    InsertCheckpoint,
    RemoveCheckpoint,
    SetConditional,
    SetGoals,
    apply,
)
from polaris_nl.model.formula import Goal, Literal
from polaris_nl.model.text import listed
from polaris_nl.model.wording import Wording
from polaris_nl.model.world import World
from polaris_nl.planning.causes import OutOfReach
from polaris_nl.planning.place import Place
from polaris_nl.planning.portions import Portions, near, with_entity
from polaris_nl.planning.result import Repair

MOST_CORRECTIONS = 4
"""Sets of goals to give up or to put off that are proposed."""
MOST_OTHERS = 3
"""Other things that are proposed in the place of one."""
MOST_LISTED = 5
"""Goals to leave out that are named one by one."""
MOST_STEPS = 5
"""Steps that a checkpoint is split in at most."""


@dataclass(frozen=True, slots=True)
class Trouble:
    """What was found out about a checkpoint that has no plan.

    Attributes:
        alone: the goals that can't be met by themselves.
        cores: minimal sets of two goals and more that can't be met together.
        corrections: minimal sets of goals without which the rest can be met.
        contradictory: whether one thing is wanted in two places at once, which is rather a slip than
            a matter of order.
        used_up: the checkpoint before, whose segment takes away what is needed here, or None.
    """

    place: Place
    alone: tuple[OutOfReach, ...] = ()
    cores: tuple[tuple[Literal, ...], ...] = ()
    corrections: tuple[tuple[Literal, ...], ...] = ()
    contradictory: bool = False
    used_up: str | None = None


class Proposals:
    """What may be proposed for one checkpoint."""

    def __init__(self, trouble: Trouble, world: World, wording: Wording) -> None:
        place = trouble.place
        self._trouble = trouble
        self._world = world
        self._wording = wording
        self._program = place.automaton
        self._here = place.checkpoint
        self._portions = Portions.of(place.checkpoint.goals, place.goals, place.state, world)
        self._hopeless = {x.goal for x in trouble.alone}
        self._stuck = tuple(x.goal for x in trouble.alone if not x.awaited)
        rest = (tuple(g for g in c if g not in self._hopeless) for c in trouble.corrections)
        self._put_off = tuple(dict.fromkeys(rest))[:MOST_CORRECTIONS]

    def __iter__(self) -> Iterator[Repair]:
        """All proposals, the best first."""
        yield from self._reordered()
        if self._trouble.contradictory:
            yield from self._waits()
            yield from self._drops()
            yield from self._changes()
            yield from self._splits()
        else:
            yield from self._changes()
            yield from self._waits()
            yield from self._splits()
            yield from self._drops()

    def in_single_steps(self) -> Iterator[Repair]:
        """Every goal a step of its own, where all at once are too much to think through."""
        if 1 < len(self._trouble.place.goals) <= MOST_STEPS:
            yield self._in_steps([(goal,) for goal in self._trouble.place.goals], ())

    def _waits(self) -> Iterator[Repair]:
        for given_up in self._given_up():
            left = [x for x in self._trouble.alone if x.goal not in given_up]
            awaited = tuple(dict.fromkeys(y for x in left for y in x.awaited))
            stuck = (*(x.goal for x in left if not x.awaited), *given_up)
            if not awaited:
                return
            setup = self._setup(awaited)
            for put_off in self._put_off or ((),):
                if setup:
                    yield self._wait(awaited, setup, (*stuck, *put_off))
                yield self._wait(awaited, (), (*stuck, *put_off))

    def _given_up(self) -> Iterator[tuple[Literal, ...]]:
        """Goals to leave out so that people aren't waited for to do what excludes itself."""
        exclusive = [c for c in self._trouble.cores if self._hopeless.issuperset(c)]
        ways = itertools.product(*(core[::-1] for core in exclusive))
        for way in itertools.islice(ways, MOST_CORRECTIONS):
            yield tuple(dict.fromkeys(way))

    def _setup(self, awaited: Sequence[Literal]) -> tuple[Literal, ...]:
        """What the robot has to do before people can do what is awaited, as the world's file says."""
        state = self._trouble.place.state
        found: list[Literal] = []
        for literal in awaited:
            for action in self._world.scenario.human_actions:
                if literal in action.effect:
                    found.extend(x for x in action.when if not state.holds(x))
                    break
        return tuple(dict.fromkeys(x for x in found if x not in awaited))

    def _wait(
        self, awaited: tuple[Literal, ...], setup: Sequence[Literal], dropped: Sequence[Literal]
    ) -> Repair:
        transition = self._trouble.place.transition
        edits: list[Edit] = []
        if dropped:
            edits.append(SetGoals(self._here.id, self._without(dropped)))
        if setup or transition.when or len(self._program.outgoing(transition.source)) > 1:
            # Other ways that part here have to stay open while the robot waits.
            lead = "before" if setup else "waiting for"
            name = self._program.fresh_name(f"{lead} {self._here.name}")
            fresh = Checkpoint(self._program.fresh_checkpoint_id(), name, tuple(setup))
            onward = self._program.fresh_transition_id()
            edits.append(InsertCheckpoint(fresh, transition.id, onward, awaited))
        else:
            edits.append(SetConditional(transition.id, awaited))
        steps = [self._wording.goals(setup)] if setup else []
        steps.append(f"wait until {self._wording.events(awaited)}")
        if dropped:
            steps.append(f"leave out {self._that(dropped)}")
        text = steps[0] if len(steps) == 1 else f"{', '.join(steps[:-1])}, and {steps[-1]}"
        return Repair(text, tuple(edits), "wait")

    def _splits(self) -> Iterator[Repair]:
        if not self._trouble.cores:
            return
        dropped = tuple(g for g in self._trouble.place.goals if g in self._hopeless)
        goals = [g for g in self._trouble.place.goals if g not in self._hopeless]
        for last in self._put_off:
            first = tuple(g for g in goals if g not in last)
            if first and last:
                yield self._in_steps([first, last], dropped)
                yield self._in_steps([last, first], dropped)
        steps = self._apart(goals)
        if (2 if self._put_off else 1) < len(steps) <= MOST_STEPS:
            yield self._in_steps(steps, dropped)

    def _apart(self, goals: Sequence[Literal]) -> list[tuple[Literal, ...]]:
        """Goals in steps, in their order, none of which holds a whole conflict."""
        steps: list[tuple[Literal, ...]] = [()]
        for goal in goals:
            together = {*steps[-1], goal}
            if any(together.issuperset(core) for core in self._trouble.cores):
                steps.append(())
            steps[-1] = (*steps[-1], goal)
        return steps

    def _in_steps(self, steps: Sequence[Sequence[Literal]], dropped: Sequence[Literal]) -> Repair:
        program, on = self._program, self._trouble.place.transition.id
        edits: list[Edit] = []
        for step in steps[:-1]:
            name = program.fresh_name(f"before {self._here.name}")
            fresh = Checkpoint(program.fresh_checkpoint_id(), name, self._portions.only(step))
            edit = InsertCheckpoint(fresh, on, program.fresh_transition_id())
            edits.append(edit)
            program, on = apply(program, edit), edit.onward
        edits.append(SetGoals(self._here.id, self._portions.only(steps[-1])))
        said = [self._wording.goals(self._portions.said(step)) for step in steps]
        middle = "".join(f", then {words}" for words in said[1:-1])
        text = f"{said[0]} first{middle}, and then {said[-1]}"
        return Repair(self._and_leave_out(text, dropped), tuple(edits), "split")

    def _drops(self) -> Iterator[Repair]:
        for dropped in self._trouble.corrections[:MOST_CORRECTIONS]:
            goals = self._without(dropped)
            if goals and len(dropped) < len(self._trouble.place.goals):
                text = f"leave out {self._that(dropped)}"
                yield Repair(text, (SetGoals(self._here.id, goals),), "drop")

    def _changes(self) -> Iterator[Repair]:
        """The same with another thing or at another place: where one is out of reach, or meant twice."""
        for reason in self._trouble.alone:
            if self._world.domain.achievers(reason.goal) and (reason.advice or not reason.awaited):
                for name in reason.goal.args:
                    yield from self._with_another(reason.goal, name)
        first = self._trouble.cores[0] if self._trouble.contradictory else ()
        if first and first[0] != first[1].negation:
            for goal in reversed(first):
                for name in first[0].args:
                    if name in first[1].args:
                        yield from self._with_another(goal, name)

    def _with_another(self, goal: Literal, name: str) -> Iterator[Repair]:
        others = near(name, self._world, self._trouble.place.state)
        for other in itertools.islice(others, MOST_OTHERS):
            new = with_entity(goal, name, other)
            goals = self._portions.changed(goal, new)
            if goals is not None:
                text = f"{self._wording.goal(new)} instead"
                yield Repair(text, (SetGoals(self._here.id, goals),), "change")

    def _reordered(self) -> Iterator[Repair]:
        """This step before the one that takes away what it needs."""
        blamed = self._trouble.used_up
        step: str | None = self._here.id
        while step is not None and step not in (blamed, START):
            incoming = self._program.incoming(step)
            if (
                incoming is None
                or incoming.when
                or len(self._program.outgoing(incoming.source)) > 1
            ):
                return
            step = incoming.source
        earlier = self._program.incoming(step) if step == blamed and step else None
        if earlier is None:
            return
        removed: Edit = RemoveCheckpoint(self._here.id)
        onward = apply(self._program, removed).fresh_transition_id()
        edits = (removed, InsertCheckpoint(self._here, earlier.id, onward))
        name = self._program.checkpoints[earlier.target].name
        yield Repair(f'do "{self._here.name}" before "{name}"', edits, "reorder")

    def emptied(self) -> Iterator[Repair]:
        """Nothing to be done in this step, for when there is no other way out and there are other steps."""
        if len(self._program.checkpoints) > 2:
            text = f'leave out what is asked for in "{self._here.name}"'
            yield Repair(text, (SetGoals(self._here.id, ()),), "drop")

    def _without(self, dropped: Sequence[Literal]) -> tuple[Goal, ...]:
        return self._portions.only([g for g in self._trouble.place.goals if g not in dropped])

    def _and_leave_out(self, text: str, dropped: Sequence[Literal]) -> str:
        return f"{text}, and leave out {self._that(dropped)}" if dropped else text

    def _that(self, dropped: Sequence[Literal]) -> str:
        kept = [g for g in self._trouble.place.goals if g not in dropped]
        if len(dropped) > MOST_LISTED and len(kept) > MOST_LISTED:
            return f"{len(dropped)} of the things that are asked for"
        if len(dropped) > MOST_LISTED:
            return f"all but that {self._wording.events(kept)}"
        return listed([f"that {self._wording.fact(x)}" for x in dropped])
