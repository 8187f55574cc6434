"""Ways out of a problem, each tried before it is offered: edits after which the checkpoint has a plan."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable

from polaris_nl.automaton.edits import SetGoals
from polaris_nl.model.domain import Action
from polaris_nl.model.evaluate import effects
from polaris_nl.model.formula import Goal
from polaris_nl.model.state import Mutexes
from polaris_nl.model.wording import Wording
from polaris_nl.model.world import World
from polaris_nl.planning.budget import within
from polaris_nl.planning.place import Place
from polaris_nl.planning.proposals import Proposals, Trouble
from polaris_nl.planning.result import Repair
from polaris_nl.planning.segments import Segments
from polaris_nl.planning.trial import Trial

MOST = 4
"""Ways out that are offered at most."""
MOST_OF_A_KIND = 2
"""Ways out of one kind that are offered at most, so that others are, too."""
BUDGET_S = 2.0
"""How long ways out of one problem are looked for, in seconds."""


class Repairs:
    """Finds and tries ways out in one world."""

    def __init__(
        self, world: World, mutexes: Mutexes, segments: Segments, wording: Wording
    ) -> None:
        self._world = world
        self._wording = wording
        self._trial = Trial(world, mutexes, segments)

    def of(self, trouble: Trouble, cancelled: Callable[[], bool]) -> tuple[Repair, ...]:
        """What leads out of a problem, the best first."""
        found = Proposals(trouble, self._world, self._wording)
        tried = self._tried(found, trouble.place, cancelled)
        return tried or self._tried(found.emptied(), trouble.place, cancelled)

    def of_undecided(self, place: Place, cancelled: Callable[[], bool]) -> tuple[Repair, ...]:
        """What can be decided where all goals at once can't."""
        found = Proposals(Trouble(place), self._world, self._wording)
        return self._tried(found.in_single_steps(), place, cancelled)

    def of_choice(
        self, place: Place, goal: Goal, cancelled: Callable[[], bool]
    ) -> tuple[Repair, ...]:
        """What leads out of asking for one of a kind of which there is none: leaving that out."""
        kept = tuple(g for g in place.checkpoint.goals if g != goal)
        if not kept:
            emptied = Proposals(Trouble(place), self._world, self._wording).emptied()
            return self._tried(emptied, place, cancelled)
        text = f"leave that out and only {self._wording.goals(kept)}"
        return self._tried(
            [Repair(text, (SetGoals(place.checkpoint.id, kept),), "drop")], place, cancelled
        )

    def of_action(
        self, place: Place, action: Action, cancelled: Callable[[], bool]
    ) -> tuple[Repair, ...]:
        """What leads out of insisting on an action that can't be done: what it brings about, as goals."""
        operator = self._world.domain.operators[action.operator]
        made = effects(action, operator, place.state, self._world)
        wanted = tuple(x for x in made if x.positive and x.args)
        text = self._wording.goals(wanted)
        goals = Repair(text, (SetGoals(place.checkpoint.id, wanted),), "change")
        return self._tried([goals] if wanted else [], place, cancelled)

    def _tried(
        self, proposals: Iterable[Repair], place: Place, cancelled: Callable[[], bool]
    ) -> tuple[Repair, ...]:
        over = within(BUDGET_S, cancelled)
        found: list[tuple[int, Repair]] = []
        kinds: Counter[str] = Counter()

        for repair in proposals:
            if over() or len(found) == MOST:
                break
            if kinds[repair.kind] < MOST_OF_A_KIND:
                failed = self._failed(repair, place, over)
                if failed is not None:
                    kinds[repair.kind] += 1
                    found.append((failed, repair))
        # What comes after a step that had no plan may have problems of its own, but none of the edit's.
        least = min((failed for failed, _ in found), default=0)
        return tuple(repair for failed, repair in found if failed == least)

    def _failed(self, repair: Repair, place: Place, over: Callable[[], bool]) -> int | None:
        """How many steps have no plan after an edit; None where it doesn't help, or breaks another step."""
        outcome = self._trial.of(place.automaton, repair.edits, place.known, over)
        if outcome is None or outcome.faults:
            return None
        before = place.automaton.checkpoints
        fresh = {c for c in outcome.program.checkpoints if c not in before}
        if outcome.failed & {place.checkpoint.id, *fresh, *place.known}:
            return None
        return len(outcome.failed)
