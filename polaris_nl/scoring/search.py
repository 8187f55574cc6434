"""Every way that people can act while a program runs, the fewest actions first: an exact search."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from polaris_nl.model.domain import Action
from polaris_nl.model.evaluate import holds
from polaris_nl.model.state import Mutexes
from polaris_nl.scoring.people import Act, Hands, useful
from polaris_nl.scoring.play import Moment, Play

MOST_MOMENTS = 60_000
"""Moments that are looked at before the search gives up and says so."""


@dataclass(frozen=True, slots=True)
class Done:
    """A person's action in a run.

    Attributes:
        during: what the robot was doing, or None where it waited.
        checkpoint: the checkpoint that was reached last.
        step: how many actions were done since then.
    """

    act: Act
    during: Action | None
    checkpoint: str
    step: int


@dataclass(frozen=True, slots=True)
class Best:
    """The run in which the most objectives are met, and of those one with the fewest human actions.

    Attributes:
        met: for each objective, in the world's order, whether it is met at the run's end.
        chosen: what people do, in order.
        settled: every way was looked at, or nothing better is possible; otherwise there were too many
            ways, and more may be possible.
        tried: human actions such that every way with so many was looked at.
    """

    met: tuple[bool, ...]
    chosen: tuple[Done, ...]
    settled: bool
    tried: int

    @property
    def count(self) -> int:
        """How many objectives are met."""
        return sum(self.met)


@dataclass(frozen=True, slots=True)
class _Visit:
    """A moment, the one before it, and what a person did between them, or None where the robot went on."""

    moment: Moment
    before: Moment | None = None
    act: Act | None = None


def best_run(
    play: Play,
    acts: Sequence[Act],
    hands: Hands,
    mutexes: Mutexes,
    most: int = MOST_MOMENTS,
) -> Best:
    """Looks at every run that people can make of a program, those with fewest human actions first.

    People act while the robot moves or waits; what it decides, it decides at once. A run ends when
    the program does, or when it waits and nobody acts.

    Args:
        play: the program in its world.
        acts: what people may do, each as often as they like.
        hands: says which things people can reach.
        mutexes: what displaces what.
        most: moments to look at, at most.
    """
    seen: dict[Moment, _Visit] = {}
    met: tuple[bool, ...] = ()
    end = play.start
    layer, actions = [_Visit(play.start)], 0
    while layer:
        later: list[_Visit] = []
        waiting = layer[::-1]
        while waiting:
            visit = waiting.pop()
            moment = visit.moment
            if moment in seen:
                continue
            if len(seen) >= most:
                found = met or (False,) * len(play.world.scenario.objectives)
                return Best(found, _chosen(play, end, seen), False, actions - 1)
            seen[moment] = visit
            step = None if moment.over else play.next(moment)
            if step is None:
                ended = _met(play, moment)
                if not met or sum(ended) > sum(met):
                    met, end = ended, moment
                if all(met):
                    return Best(met, _chosen(play, end, seen), True, actions)
            else:
                waiting.append(_Visit(step.moment, moment))
            if not moment.over and (step is None or step.moves):
                for act in useful(acts, moment.state, hands):
                    state = moment.state.after_event(act.effect, mutexes)
                    changed = Moment(state, moment.checkpoint, moment.segment, moment.done)
                    later.append(_Visit(changed, moment, act))
        layer, actions = later, actions + 1
    return Best(met, _chosen(play, end, seen), True, actions - 1)


def _met(play: Play, moment: Moment) -> tuple[bool, ...]:
    world = play.world
    return tuple(holds(o.goal, moment.state, world) for o in world.scenario.objectives)


def _chosen(play: Play, end: Moment, seen: dict[Moment, _Visit]) -> tuple[Done, ...]:
    found = []
    visit = seen.get(end)
    while visit is not None and visit.before is not None:
        before = visit.before
        if visit.act is not None:
            during = play.doing(before) if play.next(before) is not None else None
            found.append(Done(visit.act, during, before.checkpoint, before.done))
        visit = seen[before]
    return tuple(reversed(found))
