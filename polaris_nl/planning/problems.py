"""Why a checkpoint has no plan, in words, with ways out (DESIGN section 5 point 4).

Cheapest first: goals that exclude each other by a mutex group, then each goal alone, then all minimal
sets of goals. What isn't decided in its time is said to be undecided, and never called a conflict.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence

from polaris_nl.model.domain import Action
from polaris_nl.model.formula import Literal
from polaris_nl.model.goals import leaves_a_choice
from polaris_nl.model.state import Mutexes
from polaris_nl.model.text import in_words, listed, sentence, supposed
from polaris_nl.model.wording import Wording
from polaris_nl.model.world import World
from polaris_nl.planning.budget import within
from polaris_nl.planning.causes import Causes, OutOfReach
from polaris_nl.planning.cores import Conflicts, Meets, alike, conflicts
from polaris_nl.planning.kinds import none_of
from polaris_nl.planning.place import Place
from polaris_nl.planning.proposals import Trouble
from polaris_nl.planning.repairs import Repairs
from polaris_nl.planning.result import Problem, Repair
from polaris_nl.planning.segments import SegmentResult, Segments
from polaris_nl.planning.witnesses import hopeless, nothing_to_choose

CORE_BUDGET_S = 3.0
"""How long minimal conflicting sets of one checkpoint are looked for, in seconds."""
REASONS_S = 2.0
"""How long the reasons for them are looked for, in seconds."""
SOLVE_S = 1.0
"""How long one set of goals may take, in seconds."""
LARGEST_CORE_SEARCH = 8
"""Of more goals than this, one conflicting set is looked for beside those by a rule, not all."""
SMALL = 3
"""Where it isn't decided if all goals can be met, sets of up to so many are tried."""
MOST_ANALYSED = 24
"""Of more goals than this, conflicts are found by rules alone, where there are such."""
MOST_PAIRS = 300
"""Pairs of goals that exclude each other by a rule that are told."""
MOST_REASONS = 30
"""Conflicting sets for which a reason is looked for."""
MOST_SAID = 3
"""Conflicts that are put into words; of more, only that there are more."""


class Diagnosis:
    """Finds out why goals can't be met in one world."""

    def __init__(
        self, world: World, mutexes: Mutexes, segments: Segments, wording: Wording
    ) -> None:
        self._world = world
        self._mutexes = mutexes
        self._segments = segments
        self._wording = wording
        self._causes = Causes(world, mutexes, segments, wording)
        self._repairs = Repairs(world, mutexes, segments, wording)

    def conflict(self, place: Place, cancelled: Callable[[], bool]) -> Problem | None:
        """The problem of goals that exclude each other by a rule of the domain, or None.

        So is the problem of goals that ask for one of a kind of which there is none.
        """
        if nothing_to_choose(place.checkpoint.goals, place.state, self._world):
            return self._nothing_there(place, cancelled)
        if not self._by_rule(place) or not self._without_choice(place, cancelled):
            return None
        return self._explained(place, cancelled)

    def failure(
        self, place: Place, result: SegmentResult, cancelled: Callable[[], bool]
    ) -> Problem:
        """The problem of goals for which no plan was found."""
        if not self._without_choice(place, cancelled):
            return self._undecided(place, "", cancelled)
        if result.status == "unsolvable":
            return self._explained(place, cancelled)
        core = self._small_core(place, cancelled) if result.status == "undecided" else ()
        if core:
            return self._explained(place, cancelled, (core,))
        return self._undecided(place, result.reason, cancelled)

    def insisted(
        self,
        place: Place,
        action: Action,
        result: SegmentResult,
        cancelled: Callable[[], bool],
    ) -> Problem:
        """The problem of an action that the user insists on and that can't be done there."""
        if result.status != "unsolvable":
            return self._undecided(place, result.reason, cancelled)
        repairs = self._repairs.of_action(place, action, cancelled)
        text = f"there is no way to {self._wording.action(action)} then"
        text = sentence(f'I can\'t do "{place.checkpoint.name}": {text}')
        ways = "Say what it is for instead."
        if repairs:
            ways = sentence(f"you could say what it is for: {repairs[0].text}")
        at = (place.checkpoint.id, place.transition.id)
        return Problem("unreachable", f"{text} {ways}", *at, repairs=repairs)

    def _explained(
        self,
        place: Place,
        cancelled: Callable[[], bool],
        known: Sequence[tuple[Literal, ...]] = (),
    ) -> Problem:
        found = self._conflicts(place, cancelled, known)
        if found is None:
            return self._undecided(place, "", cancelled)
        alone = tuple(core[0] for core in found.cores if len(core) == 1)
        # That all of them can't be met is certain, even if there was no time to say which.
        said = self._said(place, found.cores) or (place.goals,)
        cores = tuple(core for core in said if len(core) > 1)
        over = within(REASONS_S, cancelled)
        reasons = self._causes.alone(place, alone, over)
        trouble = Trouble(
            place,
            reasons,
            cores,
            found.corrections,
            bool(cores) and self._causes.same_thing_in_two_places(cores[0]),
            self._causes.used_up(place, said[0], over),
        )
        why = self._why(place, reasons, cores, over)
        repairs = self._repairs.of(trouble, cancelled)
        text = sentence(f'I can\'t do "{place.checkpoint.name}": {why}')
        start = tuple(dict.fromkeys(x for reason in reasons for x in reason.start))
        return Problem(
            "conflict" if cores else "unreachable",
            f"{text} {self._way_out(repairs, reasons, bool(cores))}",
            place.checkpoint.id,
            place.transition.id,
            said,
            repairs,
            start,
        )

    def _said(
        self, place: Place, cores: Sequence[tuple[Literal, ...]]
    ) -> tuple[tuple[Literal, ...], ...]:
        """The conflicting sets as they are told: goals of a pair that a rule excludes aren't told alone.

        That lunch can't be acknowledged and dismissed at once is the better reason than that only a
        person does either.
        """
        by_rule = self._by_rule(place)
        paired = {goal for pair in by_rule for goal in pair}
        others = (c for c in cores if c not in by_rule and not (len(c) == 1 and c[0] in paired))
        return tuple(sorted((*by_rule, *others), key=len))

    def _conflicts(
        self,
        place: Place,
        cancelled: Callable[[], bool],
        known: Sequence[tuple[Literal, ...]] = (),
    ) -> Conflicts[Literal] | None:
        """All conflicting sets, as far as they are found in time; None where the work was cancelled."""
        many = self._many(place)
        if many is not None:
            return many
        over = within(CORE_BUDGET_S, cancelled)
        # A goal that can't be met by itself makes every set with it a conflict that says nothing new.
        alone: list[tuple[Literal, ...]] = []
        for goal in place.goals:
            if not place.state.holds(goal) and not over():
                status = self._segments.solve(place.state, (goal,), SOLVE_S, cancelled).status
                if status == "cancelled":
                    return None
                if status == "unsolvable":
                    alone.append((goal,))
        single = {goal for (goal,) in alone}
        pairs = (c for c in (*known, *self._by_rule(place)) if single.isdisjoint(c))
        limit = 0 if known else 1 if len(place.goals) > LARGEST_CORE_SEARCH else None
        surely = [*alone, *dict.fromkeys(pairs)]
        return conflicts(place.goals, self._meets(place, over), surely, limit, over)

    def _small_core(self, place: Place, cancelled: Callable[[], bool]) -> tuple[Literal, ...]:
        """A conflict of few goals, where it is too hard to say if all can be met; nothing if none is found."""
        over = within(CORE_BUDGET_S, cancelled)
        meets = self._meets(place, over)
        if len(place.goals) > LARGEST_CORE_SEARCH:
            return ()
        for size in range(1, SMALL + 1):
            for some in itertools.combinations(place.goals, size):
                answer = None if over() else meets(some)
                if answer is False:
                    return some
                if answer is None and size == 1:
                    return ()
        return ()

    def _meets(self, place: Place, cancelled: Callable[[], bool]) -> Meets[Literal]:
        def meets(goals: Sequence[Literal]) -> bool | None:
            status = self._segments.solve(place.state, goals, SOLVE_S, cancelled).status
            return {"solved": True, "unsolvable": False}.get(status)

        return meets

    def _by_rule(self, place: Place) -> list[tuple[Literal, ...]]:
        """Pairs of goals that exclude each other by a rule, or are each other's opposite."""
        wanted = set(place.goals)
        pairs = self._mutexes.pairs(place.goals)
        found: list[tuple[Literal, ...]] = list(itertools.islice(pairs, MOST_PAIRS))
        found.extend((g, g.negation) for g in place.goals if g.positive and g.negation in wanted)
        return found

    def _many(self, place: Place) -> Conflicts[Literal] | None:
        """The conflicts of very many goals by a rule alone, without planning; None where there are none."""
        pairs = self._by_rule(place)
        if not pairs or len(place.goals) <= MOST_ANALYSED:
            return None
        return Conflicts(tuple(pairs), (self._causes.excluded(place.goals),), complete=False)

    def _without_choice(self, place: Place, cancelled: Callable[[], bool]) -> bool:
        """Whether it is certain that no other choice of things would do."""
        goals = place.checkpoint.goals
        if not any(map(leaves_a_choice, goals)):
            return True
        return hopeless(goals, place.state, self._world, self._segments, cancelled)

    def _why(
        self,
        place: Place,
        reasons: Sequence[OutOfReach],
        cores: Sequence[tuple[Literal, ...]],
        cancelled: Callable[[], bool],
    ) -> str:
        because = {c: self._causes.together(place, c, cancelled) for c in cores[:MOST_REASONS]}
        said = [self._together(goals, size, why) for goals, size, why in alike(because)[:MOST_SAID]]
        if len(cores) > len(because) or len(alike(because)) > MOST_SAID:
            said.append("and that isn't all of it")
        people = [reason.goal for reason in reasons if reason.only_people]
        if people:
            facts = self._wording.events(people)
            lead = next(r.lead for r in reasons if r.only_people)
            said.append(f"{lead}only a person can bring it about that {facts}")
        said.extend(dict.fromkeys(r.why for r in reasons if not r.only_people))
        if any(map(leaves_a_choice, place.checkpoint.goals)):
            said[0] = f"it doesn't work, whichever I take. For example, {said[0]}"
        return ". Besides, ".join(said)

    def _together(self, goals: Sequence[Literal], size: int, why: str) -> str:
        """That some goals can't be met at once, or no more than some of them."""
        at_once = "at once" if len(goals) == 2 else "all at once"
        nor = f", nor any {in_words(size)} of these" if size < len(goals) else ""
        return f"it can't be that {self._wording.events(goals)} {at_once}{nor}{why}"

    def _nothing_there(self, place: Place, cancelled: Callable[[], bool]) -> Problem:
        asked = place.checkpoint.goals
        missing = next(g for g in asked if nothing_to_choose((g,), place.state, self._world))
        none = none_of(missing, self._wording)
        repairs = self._repairs.of_choice(place, missing, cancelled)
        text = f'I can\'t do "{place.checkpoint.name}": {none}'
        way = self._way_out(repairs, (), False)
        return Problem(
            "unreachable",
            f"{sentence(text)} {way}",
            place.checkpoint.id,
            place.transition.id,
            repairs=repairs,
        )

    def _undecided(self, place: Place, reason: str, cancelled: Callable[[], bool]) -> Problem:
        """The problem of not knowing in time whether there is a plan."""
        repairs = self._repairs.of_undecided(place, cancelled) if reason else ()
        text = f"For {place.checkpoint.name}: {reason or 'The planning was broken off.'}"
        if repairs:
            text += f" {sentence(f'you could {repairs[0].text}')}"
        elif "again" not in text:
            text += " Ask for less at once, or let me try again."
        at = (place.checkpoint.id, place.transition.id)
        return Problem("undecided", text, *at, repairs=repairs)

    def _way_out(
        self, repairs: Sequence[Repair], reasons: Sequence[OutOfReach], several: bool
    ) -> str:
        advice = [sentence(reason.advice) for reason in reasons if reason.advice][:1]
        advice.extend(
            sentence(
                f"I could if {listed([supposed(self._wording.fact(x)) for x in reason.start])}"
            )
            for reason in reasons
            if reason.start and reason.goal not in reason.start
        )
        if repairs:
            ways = [sentence(f"you could {repairs[0].text}")]
        elif several:
            ways = ["Ask for less in one step."]
        elif any(reason.awaited for reason in reasons):
            ways = ["Ask for something else, or let a person do it."]
        else:
            ways = [] if advice else ["Ask for something else, or leave it out."]
        return " ".join([*advice, *ways])
