"""The steps of an utterance as far as it was read, and what was spoken of in it."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace

from polaris_nl.language.goal_relations import (
    ROBOT_AT,
    SEPARATE,
    SOUGHT,
    flat,
    one_at_a_time,
    placed_all,
    says_a_place,
    superseded,
    thing_placed,
)
from polaris_nl.language.mention import Mention
from polaris_nl.language.resolve import Resolver
from polaris_nl.language.scope import Misfit, Scope, Unclear
from polaris_nl.language.segment import Item
from polaris_nl.language.structure import Step
from polaris_nl.model.formula import Goal, Literal


@dataclass
class StepsSoFar:
    """Steps in order, to which the next item adds or which it changes.

    Attributes:
        resolver: finds the entities that are meant.
        scope: what was mentioned.
        latest: the goals that the program came to before the utterance, for "the same for ...".
        steps: the steps.
        new_step: what comes next is a step of its own.
        otherwise: what comes next is what happens otherwise.
        sentence: the number of steps before the sentence that is being read.
        deferred: goals that come after those of the sentence: "before you go home, ...".
        sought: the latest goals were only to find a thing.
    """

    resolver: Resolver
    scope: Scope
    latest: tuple[Goal, ...] = ()
    steps: list[Step] = field(default_factory=list)
    new_step: bool = True
    otherwise: bool = False
    sentence: int = 0
    deferred: tuple[Goal, ...] = ()
    sought: bool = False
    _joined: tuple[Goal, ...] = ()

    def move_to_front(self) -> None:
        """The latest step comes before the others of its sentence."""
        *before, last = self.steps
        if last.role == "else":
            return  # "Otherwise wash it first and then ...": nothing of that branch comes before it.
        self.steps = [*before[: self.sentence], last, *before[self.sentence :]]
        self.new_step = True

    def put_off(self) -> None:
        """The goals that were added last are a step of their own, after the others."""
        last = self.steps[-1]
        earlier = tuple(g for g in last.goals if g not in self._joined)
        if self._joined and earlier:
            self.steps[-1:] = [replace(last, goals=earlier), Step(self._joined)]
        self.new_step = True

    def join(self, goals: tuple[Goal, ...]) -> None:
        """Adds goals to the latest step."""
        last = self.steps[-1]
        self._joined = goals
        self.steps[-1] = replace(last, goals=tuple(dict.fromkeys((*last.goals, *goals))))

    def flush(self) -> None:
        """What is to come after the goals of a sentence that starts with "before" comes now."""
        if self.deferred:
            self.steps.append(Step(self.deferred))
        self.deferred = ()

    def choose(self, item: Item) -> None:
        """A choice between the latest goals and another, which only the user can make.

        Raises:
            Unclear: it has not been made yet.
        """
        other = self.literals(item, condition=False)
        options = {self.resolver.said(g): g for g in (self.steps[-1].goals, other)}
        phrase = f"or {item.text}"
        chosen = self.scope.choices.get(phrase, ())
        if not chosen or chosen[0] not in options:
            raise Unclear("Which of the two should I do?", tuple(options), phrase)
        self.steps[-1] = replace(self.steps[-1], goals=options[chosen[0]])

    def on_the_way(self, mention: Mention, goal: Literal) -> Literal:
        """The goal that is passed on the way to another: the hall in "go to the kitchen via the hall"."""
        way = self.resolver.meant(mention, (), self.scope).entities
        return replace(goal, args=(*goal.args[:-1], way[0]))

    def put_in_front(self, goals: tuple[Goal, ...], later: Step) -> None:
        """Puts goals right in front of a step, wherever that is said to come already."""
        at = next((i for i, s in enumerate(self.steps) if s.goals == later.goals), len(self.steps))
        first = [Step((g,)) for g in goals] if one_at_a_time(goals) else [Step(goals)]
        if at == len(self.steps):
            self.steps.append(later)
        self.steps[at:at] = [s for s in first if s.goals not in [x.goals for x in self.steps[:at]]]

    def hear_fact(self, item: Item) -> None:
        """What is told in passing asks for nothing, but can be meant by "it" afterwards."""
        assert item.clause is not None
        try:
            _, self.scope = self.resolver.literals(item.clause, self.scope, condition=True)
        except (Misfit, Unclear):
            return

    def hear_named(self, mention: Mention) -> None:
        """What is only named can be meant by "it" afterwards."""
        things: list[str] = []
        for named in (*mention.parts, mention):
            with suppress(Misfit, Unclear):
                self.scope = self.scope.after(self.resolver.meant(named, (), self.scope).entities)
                things.extend(self.resolver.meant(named, ("object",), self.scope).entities)
        if (
            len(things) > 1
        ):  # "... asked for a magazine and for juice, so take both of them to her."
            self.scope = self.scope.after(tuple(dict.fromkeys(things)))

    def repeat_for(self, item: Item) -> None:
        """The goals of the step before, for another thing.

        Raises:
            Misfit: there is nothing before, or nothing in it that the thing could stand for.
        """
        assert item.mention is not None
        before = self.steps[-1].goals if self.steps else self.latest
        goals, self.scope = self.resolver.instead(before, item.mention, self.scope)
        if not goals and self.new_step:
            goals = self._there(item.mention)
        if not goals:
            raise Misfit(f"The same for {item.mention.text}? Say what I should do with it.")
        if self.otherwise:
            self.steps.append(Step(goals, (), "else"))
            self.otherwise = False
            return
        if self.steps and not self.new_step and not self.are_separate(goals):
            self.join(goals)
        else:
            self.steps.append(Step(goals))
        self.new_step = False

    def _there(self, mention: Mention) -> tuple[Goal, ...]:
        """Being at a place that is only named: "the cup to the counter, then the laundry room"."""
        with suppress(Misfit, Unclear):
            places = self.resolver.meant(mention, ("region",), self.scope).entities
            return tuple(Literal(ROBOT_AT, (place,)) for place in places[:1])
        return ()

    def leave_out(self, item: Item) -> None:
        """Leaves things out of the latest goals: "... all the cups to the desk except the red one".

        Raises:
            Misfit: they are not among them.
        """
        assert item.mention is not None
        goals = self.steps[-1].goals if self.steps else ()
        kept, self.scope = self.resolver.without(goals, item.mention, self.scope)
        if kept == goals:
            raise Misfit(f"{item.mention.text} is not among what was asked for.")
        self.steps[-1] = replace(self.steps[-1], goals=kept)

    def go_with(self, goals: tuple[Goal, ...], text: str) -> None:
        """Holding something where the robot goes: "be in the kitchen with the cup in your hand".

        Raises:
            Misfit: the robot was not to go anywhere.
        """
        before = flat(self.steps[-1].goals) if self.steps and not self.new_step else []
        if not any(x.predicate == ROBOT_AT for x in before):
            raise Misfit(f'What should I do "{text}"? Say it with "and", as a goal of its own.')
        self.join(goals)

    def check_places(self, goals: Sequence[Goal]) -> None:
        """Looks for a second place in one breath: "bring the cup on the table to the sink".

        Raises:
            Misfit: there is one.
        """
        before = [] if self.new_step else flat(self.steps[-1].goals)
        there = {thing_placed(x): x for x in before if x.positive and says_a_place(x)}
        if any(says_a_place(x) and there.get(thing_placed(x), x) != x for x in flat(goals)):
            raise Misfit(
                "One thing can't be in two places at once; say for each where it should go."
            )

    def is_hint(self, item: Item, goals: Sequence[Goal]) -> bool:
        """Whether a wish only says where to look: "find the pen, it should be on the nightstand"."""
        sought = (
            {x.args for x in flat(self.steps[-1].goals) if x.predicate in SOUGHT or self.sought}
            if self.steps
            else set()
        )
        wished = item.clause is not None and item.clause.kind == "wish"
        return wished and bool(sought) and all(x.args[:1] in sought for x in flat(goals))

    def supersedes(self, goals: Sequence[Goal]) -> bool:
        """Whether the latest step was only the way to goals said in the same breath."""
        last = self.steps[-1]
        return superseded(last, goals) and (not self.new_step or bool(last.forbidden))

    def place_all(self, item: Item, goals: Sequence[Goal]) -> bool:
        """Wants "them" somewhere, where all of them were only to be picked up; whether it is so."""
        taken_up = any(m.pronoun for _, m in item.clause.bindings) if item.clause else False
        every = placed_all(self.steps[-1], goals) if taken_up and self.steps else None
        if every is not None:
            self.steps[-1] = replace(self.steps[-1], goals=(every,))
            self.new_step = self.sought = False
        return every is not None

    def was_found_for(self, goals: Sequence[Goal]) -> bool:
        """Whether a thing was only to be found for these goals: "if it's lost, find it and bring it to her"."""
        last = replace(self.steps[-1], when=(), role="then")
        return self.sought and not self.new_step and superseded(last, goals)

    def are_separate(self, goals: Sequence[Goal]) -> bool:
        """Whether goals joined by "and" are a step of their own."""
        if not self.steps:
            return True
        old, new = flat(self.steps[-1].goals), flat(goals)
        undone = any(x.negation in old for x in new)  # "Open it, fill it and close it."
        return undone or any(x.predicate in SEPARATE for x in (*old, *new))

    def literals(self, item: Item, condition: bool) -> tuple[Literal, ...]:
        """The goals, or the literals of a condition, that an item asks for.

        Raises:
            Unclear: a question has to be asked.
            Misfit: nothing that is known fits.
        """
        assert item.clause is not None
        found, self.scope = self.resolver.literals(item.clause, self.scope, condition)
        return found  # type: ignore[return-value] # none is None here
