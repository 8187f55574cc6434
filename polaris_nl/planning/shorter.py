"""Where a checkpoint and what follows it take fewer actions together (DESIGN section 5 point 6).

Among equally short ways to a checkpoint the one that helps what follows is taken. Where the help would
make the way to the checkpoint longer (fetching the tray before the alert), it is offered: as a goal to
be added to the checkpoint, which has been tried.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

from polaris_nl.automaton.automaton import Automaton, Checkpoint
from polaris_nl.automaton.edits import SetGoals
from polaris_nl.model.domain import Action
from polaris_nl.model.formula import Literal
from polaris_nl.model.state import Mutexes, State
from polaris_nl.model.text import listed, sentence
from polaris_nl.model.wording import Wording
from polaris_nl.planning.ahead import Ahead, Stage
from polaris_nl.planning.memory import Memory
from polaris_nl.planning.result import Repair, Segment, Warning
from polaris_nl.planning.segments import Segments

JOINT_S = 0.5
"""How long a checkpoint is planned together with the next, in seconds."""
MOST_FACTS = 6
"""Facts that are tried one by one as what the way to a checkpoint could see to."""
MOST_REMEMBERED = 5_000

Key = tuple[object, ...]


@dataclass(frozen=True, slots=True)
class Shortcut:
    """Another way to a checkpoint, after which what follows takes fewer actions.

    Attributes:
        extra: what holds at the checkpoint then, besides its goals.
        actions: the way to the checkpoint.
        longer: how many actions more the way itself takes; 0 for an equally short one.
        saved: how many actions are saved in all.
    """

    extra: tuple[Literal, ...]
    actions: tuple[Action, ...]
    longer: int
    saved: int


class Shortcuts:
    """Finds shortcuts in one world, and remembers them."""

    def __init__(
        self, mutexes: Mutexes, segments: Segments, ahead: Ahead, wording: Wording
    ) -> None:
        self._mutexes = mutexes
        self._segments = segments
        self._ahead = ahead
        self._wording = wording
        self._known: Memory[Key, tuple[Shortcut, ...]] = Memory(MOST_REMEMBERED)

    def at(
        self,
        segment: Segment,
        onward: Sequence[tuple[Segment, bool]],
        cancelled: Callable[[], bool],
    ) -> Shortcut | None:
        """The best shortcut at a checkpoint, or None.

        Args:
            segment: the segment to the checkpoint.
            onward: the segments after it, each with whether its end matters to anything.
            cancelled: asked now and then; True ends the work, and only what is remembered is found.
        """
        if not segment.actions or not segment.optimal or not segment.goals:
            return None
        if all(len(s.actions) < 2 for s, _ in onward):
            return None  # With one action to do there, nothing that could be done before is saved.
        key: Key = (
            segment.before,
            segment.actions,
            segment.goals,
            tuple((s.when, s.goals, goes_on) for s, goes_on in onward),
        )
        known = self._known.get(key)
        if known is None:
            if cancelled():
                return None
            found = list(self._found(segment, onward, cancelled))
            found.sort(key=lambda s: (-s.saved, s.longer, len(s.extra), s.extra))
            known = tuple(found[:1])
            if not cancelled():
                self._known.put(key, known)
        return known[0] if known else None

    def _found(
        self,
        segment: Segment,
        onward: Sequence[tuple[Segment, bool]],
        cancelled: Callable[[], bool],
    ) -> Iterator[Shortcut]:
        tried: set[tuple[Literal, ...]] = set()
        for following, _ in onward:
            apart = len(segment.actions) + len(following.actions)
            stages = (Stage(segment.goals, following.when), Stage(following.goals))
            ways = self._ahead.ways(segment.before, stages, JOINT_S, cancelled)
            if ways is None or len(ways[0]) + len(ways[1]) >= apart:
                continue
            steps = self._segments.steps(segment.before, segment.goals, ways[0])
            if not steps:
                continue
            _, gained = segment.after.difference(steps[-1].state)
            for extra in (*((fact,) for fact in gained[:MOST_FACTS]), gained):
                if extra and extra not in tried and not cancelled():
                    tried.add(extra)
                    yield from self._tried(segment, onward, extra, cancelled)

    def _tried(
        self,
        segment: Segment,
        onward: Sequence[tuple[Segment, bool]],
        extra: tuple[Literal, ...],
        cancelled: Callable[[], bool],
    ) -> Iterator[Shortcut]:
        way = self._segments.solve(segment.before, (*segment.goals, *extra), JOINT_S, cancelled)
        if way.status != "solved" or not way.steps:
            return
        longer = len(way.actions) - len(segment.actions)
        saved = -longer
        for following, goes_on in onward:
            state = self._before(way.steps[-1].state, following)
            then = self._segments.solve(state, following.goals, JOINT_S, cancelled)
            end = then.steps[-1].state if then.steps else state
            # What comes later still takes as long as before only from the same state.
            if then.status != "solved" or (goes_on and end != following.after):
                return
            saved += len(following.actions) - len(then.actions)
        if saved > 0:
            yield Shortcut(extra, way.actions, longer, saved)

    def _before(self, state: State, segment: Segment) -> State:
        return state.after_event(segment.when, self._mutexes) if segment.when else state

    def taken(self, automaton: Automaton, segment: Segment, shortcut: Shortcut) -> Warning:
        """What is said where an equally short way was taken."""
        name = automaton.checkpoints[segment.target].name
        text = f"On the way to {name} I plan ahead, which saves {_actions(shortcut.saved)} later"
        return Warning(sentence(text), segment.transition)

    def offered(self, automaton: Automaton, segment: Segment, shortcut: Shortcut) -> Warning | None:
        """The offer to add to a checkpoint's goals; None where they aren't plain facts."""
        checkpoint: Checkpoint = automaton.checkpoints[segment.target]
        if set(checkpoint.goals) != set(segment.goals):
            return None
        following = (automaton.checkpoints[t.target] for t in automaton.outgoing(checkpoint.id))
        seen_to = next((c.name for c in following if set(c.goals) == set(shortcut.extra)), "")
        asked = f"for all of the step {seen_to}"  # Said aloud, its goals would take ten seconds.
        if not seen_to:
            asked = f"that {listed([self._wording.fact(fact) for fact in shortcut.extra])}"
        saves = f"would save {_actions(shortcut.saved)}"
        text = f"If the step {checkpoint.name} also asked {asked}, that {saves}"
        edit = SetGoals(checkpoint.id, (*checkpoint.goals, *shortcut.extra))
        repair = Repair(f"also ask in {checkpoint.name} {asked}", (edit,))
        return Warning(sentence(text), segment.transition, (repair,))


def _actions(count: int) -> str:
    return "1 action" if count == 1 else f"{count} actions"
