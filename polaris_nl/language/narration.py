"""A program told branch by branch, each sentence where hearers put it without being told where.

The teller keeps the program that a hearer has built from the sentences so far, by the rules that the
parser has (`structure.Builder`), and tries the plainest words first: "once ...", then "then once
...", and at last "after alerted, once ...", which names the place.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from polaris_nl.automaton.automaton import START, Automaton, Checkpoint, Transition
from polaris_nl.language.naming import Names
from polaris_nl.language.scope import Misfit
from polaris_nl.language.structure import Builder, Step
from polaris_nl.language.telling import Teller, Told
from polaris_nl.language.wording import GrammarWording
from polaris_nl.model.formula import Goal, Literal


def narrated(program: Automaton, wording: GrammarWording) -> str:
    """A program in sentences; "" for an empty one."""
    return Narration(program, wording).text


class Narration:
    """A program as it is told.

    Attributes:
        text: the sentences.
        ids: the checkpoints that a hearer has made for those of the program.
    """

    def __init__(self, program: Automaton, wording: GrammarWording) -> None:
        self._program = program
        self._teller = Teller(wording)
        self._phrasing = wording.phrasing
        names = Names(wording.world, wording.grammar)
        self._heard = Builder(wording.world, names, Automaton(), START)
        self.ids = {START: START}
        self._after(START)
        self.text = self._teller.text

    @property
    def heard(self) -> Automaton:
        """The program that a hearer has made of it."""
        return self._heard.program

    def _after(self, at: str) -> None:
        """Tells all that comes after a checkpoint."""
        waiting = [at]
        while waiting:
            at = self._straight(waiting.pop())
            waiting.extend(reversed(self._ways(at)))

    def _straight(self, at: str) -> str:
        """Tells what follows without a condition; returns where that ends."""
        seen = {at}
        while True:
            outgoing = self._program.outgoing(at)
            if len(outgoing) != 1 or outgoing[0].when or outgoing[0].target in seen:
                return at
            self._next(outgoing[0])
            at = outgoing[0].target
            seen.add(at)

    def _ways(self, at: str) -> list[str]:
        """Tells the ways on from a checkpoint as far as they must be told at once.

        Returns:
            The checkpoints after which there is more to tell, in order.
        """
        outgoing = [t for t in self._program.outgoing(at) if t.target not in self.ids]
        labelled = [t for t in outgoing if t.when]
        plain = [t for t in outgoing if not t.when]
        if len(labelled) == 1 and len(plain) == 1 and self._unless(labelled[0], plain[0]):
            return [plain[0].target]
        labelled.sort(key=self._is_branching)  # A place that was left has to be named.
        if not plain:
            return list(self._one_by_one(labelled, len(outgoing) > 1))
        tips = []
        for number, transition in enumerate(labelled):
            self._condition(transition, number == 0, asked=True)
            tips.append(self._straight(transition.target))
        for transition in plain:
            self._otherwise(transition)
            tips.insert(0, self._straight(transition.target))
        return tips

    def _one_by_one(self, labelled: Sequence[Transition], several: bool) -> Iterator[str]:
        for number, transition in enumerate(labelled):
            self._condition(transition, number == 0, asked=False)
            if number == len(labelled) - 1:
                yield transition.target
            else:
                self._after(transition.target)

    def _is_branching(self, transition: Transition) -> bool:
        inside = self._program.subtree(transition.target)
        return any(len(self._program.outgoing(c)) > 1 or self._waits(c) for c in inside)

    def _waits(self, checkpoint: str) -> bool:
        return any(t.when for t in self._program.outgoing(checkpoint))

    # Each way to tell a step, and what a hearer makes of it

    def _next(self, transition: Transition) -> None:
        step = Step(self._goals(transition))
        if self._lands(transition, step):
            self._teller.then(self._told(transition))
        else:
            self._named(transition, "")

    def _condition(self, transition: Transition, first: bool, asked: bool) -> None:
        """A step that waits for something.

        Args:
            transition: leads to the step.
            first: no way from the same place was told before.
            asked: there is an "otherwise": it is looked at once, and not waited for.
        """
        goals, when = self._goals(transition), transition.when
        alone = len(self._program.outgoing(transition.source)) == 1
        empty = not goals and self._checkpoint(transition).action is None
        waited = Step((), when, "condition", sequel=True)
        if empty and alone and self._here(transition) and self._lands(transition, waited):
            opening = "then wait until " if transition.source != START else "wait until "
            self._teller.sentence("", opening, self._told(transition), alone=True)
            return
        opening = "once " if first and not asked else "if "
        if self._lands(transition, Step(goals, when, "condition")):
            self._teller.sentence("", opening, self._told(transition))
        elif self._here(transition) and self._lands(
            transition, Step(goals, when, "condition", sequel=True)
        ):
            self._teller.sentence("", f"then {opening}", self._told(transition))
        else:
            self._named(transition, opening)

    def _otherwise(self, transition: Transition) -> None:
        if self._lands(transition, Step(self._goals(transition), (), "else")):
            self._teller.sentence("", "otherwise ", self._told(transition))
        else:
            self._named(transition, "otherwise ")

    def _unless(self, labelled: Transition, other: Transition) -> bool:
        """`unless the fridge is open, open it`: what is done on the one condition is nothing."""
        checkpoint = self._checkpoint(labelled)
        if checkpoint.goals or checkpoint.action or self._program.outgoing(labelled.target):
            return False
        before = self._heard
        goals = self._goals(other)
        one = self._lands(labelled, Step((), labelled.when, "condition"))
        if not (goals and one and self._lands(other, Step(goals, (), "else"))):
            self._heard = before
            self.ids.pop(labelled.target, None)
            return False
        told = self._told(other)
        step = Told(told.goals, labelled.when, told.action, self._addressees(labelled))
        self._teller.sentence("", "unless ", step)
        return True

    def _named(self, transition: Transition, opening: str) -> None:
        """A step after one that is named."""
        place = self.ids.get(transition.source, START)
        heard = self._heard
        checkpoint = Checkpoint(heard.program.fresh_checkpoint_id(), "", self._goals(transition))
        arrow = Transition(
            heard.program.fresh_transition_id(), place, checkpoint.id, transition.when
        )
        name = heard.names.checkpoint(checkpoint.goals, transition.when, heard.program)
        checkpoint = Checkpoint(checkpoint.id, name, checkpoint.goals)
        program = heard.program.with_checkpoint(checkpoint).with_transition(arrow)
        self._heard = Builder(heard.world, heard.names, program, checkpoint.id, heard.anchor)
        self.ids[transition.target] = checkpoint.id
        source = self._program.checkpoints[transition.source]
        where = "the start" if source.id == START else source.name
        self._teller.sentence(f"after {where}, ", opening, self._told(transition), alone=True)

    def _lands(self, transition: Transition, step: Step) -> bool:
        """Whether a hearer puts a step where the program has it; if so, it is heard."""
        heard = self._heard
        trial = Builder(heard.world, heard.names, heard.program, heard.here, heard.anchor)
        if trial.anchor is None:
            path = reversed(trial.program.path(trial.here))
            trial.anchor = next((t.source for t in path if t.when), None)
        try:
            trial.add(step)
        except Misfit:
            return False
        new = trial.here
        arrow = trial.program.incoming(new)
        place = self.ids.get(transition.source)
        if new in heard.program.checkpoints or arrow is None or arrow.source != place:
            return False
        if arrow.when != transition.when or trial.program.outgoing(new):
            return False
        self._heard = trial
        self.ids[transition.target] = new
        return True

    def _here(self, transition: Transition) -> bool:
        """Whether the way goes on from where the telling is."""
        return self._heard.here == self.ids.get(transition.source)

    def _goals(self, transition: Transition) -> tuple[Goal, ...]:
        return self._phrasing.in_order(self._checkpoint(transition).goals)

    def _checkpoint(self, transition: Transition) -> Checkpoint:
        return self._program.checkpoints[transition.target]

    def _told(self, transition: Transition) -> Told:
        checkpoint = self._checkpoint(transition)
        return Told(
            checkpoint.goals, transition.when, checkpoint.action, self._addressees(transition)
        )

    def _addressees(self, transition: Transition) -> dict[str, str]:
        """Whom the messages of a condition were told on the way to it."""
        found: dict[str, str] = {}
        for earlier in self._program.path(transition.target):
            for goal in self._checkpoint(earlier).goals if earlier != transition else ():
                if isinstance(goal, Literal) and goal.predicate == "alerted-to" and goal.positive:
                    found[goal.args[-1]] = goal.args[0]
        return found
