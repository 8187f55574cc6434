"""The reason for each set of goals that can't be met, in words (DESIGN section 5 point 4)."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from threading import Lock

from polaris_nl.automaton.automaton import Transition
from polaris_nl.model.domain import Operator, effect_literals
from polaris_nl.model.formula import Literal
from polaris_nl.model.state import ANY, Mutexes, MutexGroup, State
from polaris_nl.model.text import in_words, listed
from polaris_nl.model.wording import Wording
from polaris_nl.model.world import World
from polaris_nl.planning.place import Place
from polaris_nl.planning.projection import Projection
from polaris_nl.planning.relaxed import Lack, Relaxation
from polaris_nl.planning.result import Segment
from polaris_nl.planning.segments import Segments

BUDGET_S = 1.0
"""How long it may take to find out if goals could be met at one earlier point, in seconds."""
LOOK_BACK = 8
"""How many earlier points are looked at."""
MEMORY = 200
"""What goals lack that is remembered, since a problem is met again with every edit elsewhere."""

Blame = Transition | Segment


@dataclass(frozen=True, slots=True)
class OutOfReach:
    """Why one goal can't be met by itself.

    Attributes:
        why: a clause, "I can't get to the attic"; none where only people bring the goal about.
        awaited: what people may bring about, and the goal can be met with; nothing where they can't.
        start: what would have to be different in the world, and neither the robot nor people change.
        advice: what the user may do that no edit does, or "".
        only_people: whether no action of the robot brings the goal about; `lead` is what comes before that.
    """

    goal: Literal
    why: str = ""
    awaited: tuple[Literal, ...] = ()
    start: tuple[Literal, ...] = ()
    advice: str = ""
    only_people: bool = False
    lead: str = ""


class Causes:
    """Finds reasons in one world."""

    def __init__(
        self, world: World, mutexes: Mutexes, segments: Segments, wording: Wording
    ) -> None:
        self._world = world
        self._mutexes = mutexes
        self._segments = segments
        self._wording = wording
        self._projection = Projection(world, mutexes)
        self._lock = Lock()
        self._lacks: dict[tuple[State, Literal], Lack | None] = {}

    def alone(
        self, place: Place, goals: Sequence[Literal], cancelled: Callable[[], bool]
    ) -> tuple[OutOfReach, ...]:
        """The reason for each goal that can't be met by itself."""
        return tuple(self._alone(place, goal, cancelled) for goal in goals)

    def together(self, place: Place, core: Sequence[Literal], cancelled: Callable[[], bool]) -> str:
        """Why some goals can't be met together, to go after the clause that says so: ", as ..." or ""."""
        if len(core) == 2:
            if core[0] == core[1].negation:
                return ""
            group = self.exclusive(core[0], core[1])
            if group is not None:
                return self._by_rule(core, group)
        blame = self._blame(place, core, cancelled)
        if blame is not None:
            return f", because {self._happened(place, blame, core, cancelled)}"
        scarce = self._scarce(core)
        if scarce:
            return f", as {scarce}"
        if len(core) == 2:
            return ": I can do either, but not both"
        some, every = in_words(len(core) - 1), in_words(len(core))
        return f": I can do any {some} of them, but not all {every}"

    def used_up(
        self, place: Place, core: Sequence[Literal], cancelled: Callable[[], bool]
    ) -> str | None:
        """The checkpoint whose segment makes some goals impossible afterwards, or None."""
        blame = None if self._never(core) else self._blame(place, core, cancelled)
        return blame.target if isinstance(blame, Segment) else None

    def _never(self, core: Sequence[Literal]) -> bool:
        """Whether no state and no robot could meet some goals."""
        if len(core) == 1:
            return not self._world.domain.achievers(core[0])
        return any(
            a == b.negation or self.exclusive(a, b) is not None
            for a, b in itertools.combinations(core, 2)
        )

    def exclusive(self, a: Literal, b: Literal) -> MutexGroup | None:
        """The rule by which two goals exclude each other, or None."""
        return self._mutexes.exclusive(a, b) if a.positive and b.positive else None

    def excluded(self, goals: Sequence[Literal]) -> tuple[Literal, ...]:
        """The goals that an earlier one excludes by a rule."""
        kept: list[Literal] = []
        for goal in goals:
            if goal.negation not in kept and not any(self.exclusive(goal, k) for k in kept):
                kept.append(goal)
        return tuple(g for g in goals if g not in kept)

    def same_thing_in_two_places(self, core: Sequence[Literal]) -> bool:
        """Whether goals want one thing in two places, or something and its opposite."""
        if len(core) != 2:
            return False
        shared = set(core[0].args) & set(core[1].args)
        by_rule = core[0] == core[1].negation or self.exclusive(core[0], core[1]) is not None
        return bool(shared) and by_rule

    def _by_rule(self, core: Sequence[Literal], group: MutexGroup) -> str:
        held = any("hand" in p.predicate or p.predicate == "holding" for p in group.patterns)
        if held and any(not pattern.args for pattern in group.patterns):
            return ", as the robot has one hand"
        shared = [arg for arg in core[0].args if arg in core[1].args]
        if not any(ANY in pattern.args for pattern in group.patterns):
            return ", as one rules out the other"
        if shared:
            return f", as {self._wording.entity(shared[0])} is in one place at a time"
        if len(group.patterns) == 1 and len(group.patterns[0].args) == 1:
            return ", as the robot is in one place at a time"
        return ", as one rules out the other"

    def _scarce(self, core: Sequence[Literal]) -> str:
        """The words for goals each of which takes a thing for itself, of which there are too few."""
        world = self._world
        for kind in world.domain.types:
            count = sum(1 for _ in world.of_type(kind))
            operators = [op for goal in core for op in world.domain.achievers(goal)]
            fewer = 0 < count < len(core)
            if fewer and all(_takes(op, kind) for op in operators):
                there = "there is only one" if count == 1 else f"there are only {in_words(count)}"
                return f"each takes a {kind.replace('-', ' ')} of its own, and {there}"
        return ""

    def _alone(self, place: Place, goal: Literal, cancelled: Callable[[], bool]) -> OutOfReach:
        domain, fact = self._world.domain, self._wording.fact(goal)
        if not domain.achievers(goal):
            if domain.people_can_change(goal.predicate):
                lead = self._ruled_out(place, goal)
                return OutOfReach(goal, awaited=(goal,), only_people=True, lead=lead)
            return OutOfReach(goal, f"nothing can change whether {fact}", start=(goal,))
        blame = self._blame(place, (goal,), cancelled)
        because = f"because {self._happened(place, blame, (goal,), cancelled)}, " if blame else ""
        lack = self._lack(place.state, goal)
        people = domain.people_can_change
        awaited = lack.roots if lack and all(people(x.predicate) for x in lack.roots) else ()
        start = lack.roots if lack and not awaited and self._would_do(place, goal, lack) else ()
        lost = [a for a in goal.args if self._lost(a, place.state)]
        if lost:
            what = self._wording.entity(lost[0])
            advice = f"Tell me where {what} is once it is seen"
            if self._world.entities[lost[0]].type == "person":
                advice = f"Tell me where to find {what}"
            why = f"{because}I don't know where {what} is"
            return OutOfReach(goal, why, awaited, start, advice)
        return OutOfReach(
            goal, f"{because}{self._missing(goal, lack, bool(blame))}", awaited, start
        )

    def _would_do(self, place: Place, goal: Literal, lack: Lack) -> bool:
        """Whether a goal could be met if only what it lacks were so."""
        state = place.state.after_event(lack.roots, self._mutexes)
        return self._segments.solve(state, (goal,), BUDGET_S).status == "solved"

    def _missing(self, goal: Literal, lack: Lack | None, blamed: bool) -> str:
        fact = self._wording.fact(goal)
        if lack is None:
            if blamed:
                return f"I can no longer bring it about that {fact}"
            return f"I can't bring it about that {fact}: something I need for it is out of my reach"
        regions = [x.args[0] for x in (goal, *lack.through) if x.predicate == "robot-at" and x.args]
        if regions:
            return f"I can't get to {self._wording.entity(regions[0])}"
        needed = listed([self._wording.fact(x) for x in lack.roots])
        if all(self._world.domain.people_can_change(x.predicate) for x in lack.roots):
            return f"I can't bring it about that {fact} until {needed}, and only a person can see to that"
        return f"I could bring it about that {fact} only if {needed}"

    def _ruled_out(self, place: Place, goal: Literal) -> str:
        """What comes first where a conditional excludes the goal: "lunch has been dismissed there, and "."""
        for event, _ in place.back(self._world.initial):
            if isinstance(event, Transition):
                for literal in event.when:
                    excluded = self.exclusive(goal, literal) or literal == goal.negation
                    if excluded and literal != goal:
                        return f"{self._wording.fact(literal)} there, and "
        return ""

    def _lack(self, state: State, goal: Literal) -> Lack | None:
        key = (state, goal)
        with self._lock:
            if key in self._lacks:
                return self._lacks[key]
        world, facts = self._projection.of(state, (goal,))
        lack = Relaxation(world, facts).lack(goal)
        with self._lock:
            self._lacks[key] = lack
            while len(self._lacks) > MEMORY:
                del self._lacks[next(iter(self._lacks))]
        return lack

    def _lost(self, entity: str, state: State) -> bool:
        known = self._world.entities.get(entity)
        if known is None or known.type not in ("object", "person"):
            return False
        placed = any(p in self._world.domain.predicates for p in ("at", "in", "person-in"))
        return placed and self._world.place_of(entity, state) is None

    def _blame(
        self, place: Place, core: Sequence[Literal], cancelled: Callable[[], bool]
    ) -> Blame | None:
        """What happened last of all that has to be undone for some goals to be met; None for nothing."""
        for number, (event, before) in enumerate(place.back(self._world.initial)):
            if number >= LOOK_BACK or cancelled():
                return None
            if self._segments.solve(before, core, BUDGET_S, cancelled).status == "solved":
                return event
        return None

    def _happened(
        self, place: Place, blame: Blame, core: Sequence[Literal], cancelled: Callable[[], bool]
    ) -> str:
        if isinstance(blame, Segment):
            name = place.automaton.checkpoints[blame.target].name
            return f'of what I do for "{name}" before'
        before = next(b for event, b in place.back(self._world.initial) if event == blame)
        at_fault = [
            literal
            for literal in blame.when
            if self._reaches(before, blame.when, literal, core, cancelled)
        ]
        return listed([self._wording.fact(x) for x in at_fault or blame.when])

    def _reaches(
        self,
        before: State,
        when: Iterable[Literal],
        but: Literal,
        core: Sequence[Literal],
        cancelled: Callable[[], bool],
    ) -> bool:
        """Whether goals could be met if one fact of a conditional weren't so."""
        state = before.after_event([x for x in when if x != but], self._mutexes)
        return self._segments.solve(state, core, BUDGET_S, cancelled).status == "solved"


def _takes(operator: Operator, kind: str) -> bool:
    """Whether an operator uses up a fact about some entity of a type alone, such as a free hand."""
    own = {p.name for p in operator.parameters if p.types == (kind,)}
    return any(
        not e.positive and len(e.args) == 1 and e.args[0] in own
        for e in effect_literals(operator.effect)
    )
