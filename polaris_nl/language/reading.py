"""From cut utterances to steps: which goals belong together, in which order, under which conditions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from polaris_nl.language.clauses import Clause
from polaris_nl.language.goal_relations import flat, one_at_a_time
from polaris_nl.language.order_words import (
    BUT_FIRST,
    ENDING,
    FIRST,
    INSTEAD,
    LATER,
    SEQUELS,
    WITH,
    all_postposed,
    but_before,
    condition_follows,
    going_on,
    in_an_order,
    is_otherwise,
    says_only_names,
    stands_behind,
    without,
)
from polaris_nl.language.resolve import Resolver
from polaris_nl.language.scope import Misfit, Scope
from polaris_nl.language.segment import Cut, Item
from polaris_nl.language.steps_so_far import StepsSoFar
from polaris_nl.language.structure import Step
from polaris_nl.model.formula import Goal, Literal

VIA = "via"
"""The slot of a wording for what is passed on the way."""


def steps_of(
    cut: Cut,
    resolver: Resolver,
    scope: Scope,
    branched: bool = False,
    latest: tuple[Goal, ...] = (),
) -> tuple[list[Step], Scope]:
    """The steps that a cut utterance asks for, in order.

    Args:
        cut: the utterance, cut into clauses.
        resolver: finds the entities that are meant.
        scope: what has been mentioned before.
        branched: there is a branch already that "otherwise" can belong to.
        latest: the goals that the program came to last, for "the same for ...".

    Returns:
        They, and the scope after them.

    Raises:
        Unclear: a question has to be asked.
        Misfit: the reading can't be.
    """
    reader = _Reader(cut.items, resolver, scope, branched, latest)
    while reader.at < len(reader.items):
        reader.read()
    reader.finish()
    return reader.done.steps, reader.done.scope


MISSING_VERB = 'I miss a verb; say for example "bring" before it.'


class _Reader:
    """Walks over items with the conditions that wait for their goals."""

    def __init__(
        self,
        items: Sequence[Item],
        resolver: Resolver,
        scope: Scope,
        branched: bool,
        latest: tuple[Goal, ...],
    ) -> None:
        self._branched = branched
        self._latest = latest
        self.done = StepsSoFar(resolver, scope, latest)
        self._sequel = False
        self._first = False
        self.items = list(items)
        self.at = 0
        self._when: tuple[Literal, ...] = ()
        self._how = ""
        self._how_said = ""
        self._joined = False
        self._waits = False
        self._negate = False
        self._instead = False
        self._unless: tuple[Literal, ...] = ()
        self._postposed = all_postposed(self.items)

    def read(self) -> None:
        """Takes one item."""
        item = self.items[self.at]
        self.at += 1
        if item.mark in ("if", "until", "unless"):
            said = [i.mark for i in self.items[: self.at - 1] if i.mark != "comma"]
            if item.mark == "if" and said[-1:] == ["else"]:
                self.done.otherwise = False  # "Otherwise, so if it isn't clean, ..." says when.
            self._how_said = item.text
            before = self.items[self.at - 2 : self.at - 1]
            self._joined = "and" in (item.text.split()[0], *(i.mark for i in before))
            self._condition(item.mark)
        elif item.mark in ("before", "done"):
            self._ordered(item.mark)
        elif item.mark == "then" and item.text in FIRST and self._at_an_end():
            if but_before(self.items[: self.at - 1]):
                self.done.put_off()
            self.done.move_to_front()
        elif item.mark == "then" and item.text in LATER and self._at_an_end():
            self.done.put_off()
        elif item.mark == "then" and item.text.startswith(INSTEAD) and self._leaves_out():
            self._instead = True
        elif item.mark in ("then", "break"):
            self._instead = False
            if item.mark == "break":
                self.done.sentence = len(self.done.steps)
            if self.done.steps and not (self._how == "until" and self._when):
                self.done.flush()
            self.done.new_step = True
            self._sequel = item.mark == "then" and item.text in SEQUELS
            self._first = bool(self.done.steps) and item.text.split()[:1] == [BUT_FIRST]
        elif item.mark == "else" and is_otherwise(self.items) and self._postposed:
            self.done.steps[-1] = replace(self.done.steps[-1], role="else")
        elif item.mark == "else":
            if self._how == "until":
                self.finish()
            if not self.done.steps and not self._branched:
                raise Misfit(
                    '"Otherwise" needs a condition before it: say "if ..., ... otherwise ...".'
                )
            self.done.otherwise, self.done.new_step = True, True
        elif item.mark == "polite" and item.text.split()[0] in ENDING:
            self.done.new_step = True
        elif item.mark == "not":
            self._negate = True
        elif item.mark == "nothing":
            self._nothing()
        elif item.mark == "or":
            self._either()
        elif item.role == "goal":
            self._goal(item)
        elif item.role == "again":
            self.done.repeat_for(item)
        elif item.role == "except":
            self.done.leave_out(item)
        elif item.role == "fact":
            if in_an_order(self.items, self.at - 1):
                raise Misfit(
                    'Should that be waited for, or done? Say "once ...", or what the robot should do.'
                )
            if item.clause is not None and self._says_more(item.clause):
                raise Misfit('Should that be so, too? Join the two with "and".')
            if item.clause is not None and any(m.quantifier for _, m in item.clause.bindings):
                raise Misfit("Say what should be done with all of them, in one sentence.")
            self.done.hear_fact(item)
        elif item.role == "topic" and item.mention is not None:
            if in_an_order(self.items, self.at - 1) and self._at_an_end():
                raise Misfit(
                    f"I can't make a goal of {item.text}; say what the robot should do then."
                )
            self.done.hear_named(item.mention)

    def _says_more(self, told: Clause) -> bool:
        """Whether what seems told goes on with what is asked for: "fridge shut and closet open"."""
        before = (i for i in reversed(self.items[: self.at - 1]) if i.mark not in ("and", "comma"))
        last = next(before, None)
        asked = last.clause if last is not None and last.role == "goal" else None
        return asked is not None and asked.kind == "small" and asked.predicate == told.predicate

    def _nothing(self) -> None:
        """`do nothing`: a way on that ends there, without goals."""
        if self.done.otherwise:
            self.done.steps.append(Step((), (), "else"))
            self.done.otherwise = False
        elif self._when:
            self.done.steps.append(Step((), self._when, "condition", self._waits))
        else:
            self.done.steps.append(Step())
        self._when, self._how, self.done.new_step = (), "", False

    def finish(self) -> None:
        """A wait that nothing follows becomes an empty checkpoint.

        Raises:
            Misfit: something is missing.
        """
        if self._how == "until" and self._when and self.done.deferred:
            # "Before you go home, wait until she is in": going home waits for it.
            self.done.steps.append(Step(self.done.deferred, self._when, "condition", self._waits))
            self._when, self._how, self.done.deferred = (), "", ()
        if self.done.deferred and not self.done.steps:
            raise Misfit("What should come before that? Say it in one sentence.")
        self.done.flush()
        if any(step == Step() for step in self.done.steps):
            raise Misfit("Then there is nothing to do; say what the robot should achieve, or undo.")
        if self._how in ("until", "if") and self._when:
            if self._how == "if":
                raise Misfit(
                    "What should I do then? Say the condition and what to do, in one sentence."
                )
            self.done.steps.append(Step((), self._when, "condition", self._waits))
        if self._unless:
            raise Misfit('"Unless" needs something to do: say "unless ..., ...".')
        self._when, self._how = (), ""

    def _condition(self, mark: str) -> None:
        literals: list[Literal] = []
        while self.at < len(self.items):
            item = self.items[self.at]
            if item.role == "condition":
                literals.extend(self.done.literals(item, condition=True))
            elif not (
                item.mark in ("and", "comma") and condition_follows(self.items[self.at + 1 :])
            ):
                break
            self.at += 1
        when = tuple(dict.fromkeys(literals))
        previous = self.done.steps[-1] if self.done.steps else None
        if (
            previous is not None
            and not self.done.new_step
            and (
                stands_behind(
                    self.items[self.at :],
                    self._joined and "only" not in self._how_said.split(),
                    going_on(self.items, self.at, self._how_said, flat(previous.goals), when),
                )
                or self._postposed
            )
        ):
            self._attach(previous, when, mark)
        elif mark == "unless":
            self._unless = when
        elif self._how_said == "before" and one_at_a_time(when):
            # "Before you go to the kitchen, close it" is about the robot's own acts.
            self.done.deferred = when
        else:
            if not (mark == "until" and self.done.deferred):
                self.finish()
            self._when, self._how = when, mark
            self._waits = self._sequel or mark == "until"
        self.done.new_step, self._sequel = True, False

    # "Open it or close it", "..., but open it first"

    def _either(self) -> None:
        """A choice between two goals, which only the user can make.

        Raises:
            Unclear: it has not been made yet.
            Misfit: it is a choice between something else.
        """
        following = self.items[self.at] if self.at < len(self.items) else None
        if not self.done.steps or following is None or following.role != "goal":
            raise Misfit("One or the other? Say which.")
        self.at += 1
        self.done.choose(following)

    def _at_an_end(self) -> bool:
        """Whether no goal follows at once: "first" is said of what came before it."""
        return bool(self.done.steps) and (
            self.at == len(self.items)
            or self.items[self.at].mark in ("break", "comma", "then", "if")
        )

    # "Before going home, ...", "once you have filled it, ..."

    def _ordered(self, mark: str) -> None:
        """A goal whose place in time is said: before or after the goals beside it.

        Raises:
            Misfit: no goal follows.
        """
        said = self.items[self.at - 1]
        while self.at < len(self.items) and self.items[self.at].mark == "comma":
            self.at += 1
        item = self.items[self.at] if self.at < len(self.items) else None
        if item is None or item.role != "goal":
            raise Misfit("Before or after what? Say it in one sentence.")
        self.at += 1
        goals = (*self.done.literals(item, condition=False), *self._leaning())
        if self.at < len(self.items) and self.items[self.at].text in FIRST:
            self.at += 1
        behind = bool(self.done.steps) and not self.done.new_step
        late = said.text.split()
        if mark == "before" and self._how == "until" and self._when:
            # "Wait until she comes before you open it": the wait comes first.
            self.done.steps.append(Step(goals, self._when, "condition", self._waits))
            self._when, self._how = (), ""
        elif mark == "before" and behind and (self.done.steps[-1].forbidden or "not" in late):
            # "Don't go home before you have filled it" is "fill it, then go home".
            last = self.done.steps.pop()
            later = replace(last, goals=last.forbidden or last.goals, forbidden=())
            self.done.put_in_front(goals, later)
        elif mark == "before" and without(said):
            raise Misfit("I can only leave something out before I do something else.")
        elif mark == "before" and not behind:
            self.done.deferred = goals
        elif mark == "before":
            self.done.steps.append(Step(goals))
        elif behind:
            last = self.done.steps[-1]
            self.done.steps[-1:] = [replace(last, goals=goals), Step(last.goals)]
        elif not any(set(goals) <= set(step.goals) for step in self.done.steps):
            self.done.steps.append(Step(goals, done=True))
        self.done.new_step = not behind

    def _leaves_out(self) -> bool:
        """Whether a step stands last that is left out where something holds: "unless she has it"."""
        return len(self.done.steps) > 1 and self.done.steps[-1].role == "else"

    def _leaning(self) -> tuple[Goal, ...]:
        """Goals that lean on the one before: "before you've given her the book and him the glasses"."""
        goals: list[Goal] = []
        while self.at + 1 < len(self.items) and self.items[self.at].mark == "and":
            clause = self.items[self.at + 1].clause
            if clause is None or clause.kind != "ellipsis":
                break
            goals.extend(self.done.literals(self.items[self.at + 1], condition=False))
            self.at += 2
        return tuple(goals)

    def _attach(self, previous: Step, when: tuple[Literal, ...], mark: str) -> None:
        if mark == "unless" and previous.forbidden and not previous.when:
            # "Don't open it unless she comes" is "if she comes, open it".
            self.done.steps[-1] = Step(previous.forbidden, when, "condition")
        elif mark == "unless" and previous.when:
            # "When she comes, give it to her unless she has it."
            if len(when) > 1:
                raise Misfit("Say that in two sentences: what to wait for, and when not to do it.")
            self.done.steps[-1] = replace(previous, when=(*previous.when, when[0].negation))
        elif mark == "unless":
            self.done.steps[-1:] = [Step((), when, "condition"), replace(previous, role="else")]
        elif mark == "until" and previous.forbidden:
            # "Don't open it until she comes" is "when she comes, open it".
            self.done.steps[-1] = Step(previous.forbidden, when, "condition")
        elif mark == "until" and "not" in self._how_said.split() and one_at_a_time(when):
            # "Go home, but not until you have been to the kitchen" is an order of the robot's own acts.
            self.done.put_in_front(when, self.done.steps.pop())
        elif mark == "until" and "not" in self._how_said.split():
            self.done.steps[-1] = replace(previous, when=when, role="condition")
        elif mark == "until" and self._how_said == "before":
            raise Misfit("I can't know beforehand when that will be; say what should come first.")
        elif mark == "until":
            self._when, self._how, self._waits = when, mark, True
        else:
            self.done.steps[-1] = replace(previous, when=when, role="condition")

    def _goal(self, item: Item) -> None:
        leaning = item.clause is not None and item.clause.kind == "ellipsis"
        told = self.items[self.at - 2].mention if leaning and self.at > 1 else None
        if told is not None and not told.candidates:
            raise Misfit(MISSING_VERB)  # "Nobody likes the carpet in the hall" is only told.
        goals = self.done.literals(item, condition=False)
        if item.clause is not None and leaning:
            self.done.check_places(goals)
            leans = any(g.predicate == item.clause.predicate for g in flat(self._latest))
            if item is self.items[0] and says_only_names(item.clause) and not leans:
                raise Misfit(MISSING_VERB)
            if item.text.split()[0] in WITH:
                self.done.go_with(goals, item.text)
                return
        self._by_way_of(item, goals)
        forbidden: tuple[Goal, ...] = ()
        if self._negate:
            self._negate = False
            # "Until it is on the rack, don't open it" is "once it is on the rack, open it".
            if not (self._when and self._how == "until"):
                forbidden = goals
                goals = tuple(g.negation if isinstance(g, Literal) else g for g in goals)
        elif item.clause is not None and item.clause.kind == "wish" and not item.clause.positive:
            forbidden = tuple(x.negation for x in flat(goals))  # "The cup should not be there."
        elif self.done.is_hint(item, goals) or (
            not self._when and self.done.place_all(item, goals)
        ):
            return
        elif self.done.steps and not self._when and self.done.supersedes(goals):
            self.done.steps.pop()
            self.done.new_step = True
        elif self.done.steps and not self._when and self.done.was_found_for(goals):
            self.done.steps[-1] = replace(self.done.steps[-1], goals=goals)
            return
        if self._unless and self._when and len(self._unless) == 1:
            when = (*self._when, self._unless[0].negation)
            self.done.steps.append(Step(goals, when, "condition", self._waits))
            self._when, self._how, self._unless = (), "", ()
        elif self._unless:
            self.done.steps.append(Step((), self._unless, "condition"))
            self.done.steps.append(Step(goals, (), "else"))
            self._unless = ()
        elif self.done.otherwise:
            self.done.steps.append(Step(goals, (), "else"))
            self.done.otherwise = False
        elif self._instead:
            left_out = self.done.steps[-2]
            self.done.steps[-2] = replace(left_out, goals=(*left_out.goals, *goals))
        elif self._when:
            self.done.steps.append(Step(goals, self._when, "condition", self._waits))
            self._when, self._how = (), ""
        elif len(goals) > 1 and one_at_a_time(goals) and not forbidden:
            self.done.steps.extend(Step((goal,)) for goal in goals)
        elif self.done.new_step or self.done.are_separate(goals) or forbidden:
            self.done.steps.append(Step(goals, forbidden=forbidden))
        else:
            self.done.join(goals)
        if self._first:
            self.done.move_to_front()
        self.done.sought = item.clause is not None and item.clause.seeks
        self._first, self.done.new_step = False, False

    def _by_way_of(self, item: Item, goals: Sequence[Goal]) -> None:
        """`go to the kitchen via the hall`: the hall is a step before."""
        assert item.clause is not None
        for name, mention in item.clause.bindings:
            if name == VIA and len(goals) == 1 and isinstance(goals[0], Literal):
                first = self.done.on_the_way(mention, goals[0])
                self.done.steps.append(
                    Step((first,), self._when, "condition" if self._when else "then")
                )
                self._when, self._how, self.done.new_step = (), "", True
