"""From cut utterances to steps: which goals belong together, in which order, under which conditions."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace

from polaris_nl.language.goal_relations import (
    SEPARATE,
    SOUGHT,
    flat,
    one_at_a_time,
    says_a_place,
    superseded,
    thing_placed,
)
from polaris_nl.language.mention import Mention
from polaris_nl.language.resolve import Resolver
from polaris_nl.language.scope import Misfit, Scope, Unclear
from polaris_nl.language.segment import Cut, Item
from polaris_nl.language.structure import Step
from polaris_nl.model.formula import Goal, Literal

VIA = "via"
"""The slot of a wording for what is passed on the way."""
_FIRST = ("first", "first of all", "beforehand", "before that", "before")
_SEQUELS = ("then", "and then", "after that", "and after that", "afterwards", "and afterwards")
"""Words in front of a condition that keep it where the program has come to."""
_GOING_ON = (*_SEQUELS[1:], "and finally", "and next", "finally", "after this")
"""Words after a condition that stands behind its goal: "bring it once she acknowledges, and then ..."."""


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
    return reader.steps, reader.scope


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
        self.latest = latest
        self._sequel = False
        self.items = list(items)
        self.resolver = resolver
        self.scope = scope
        self.at = 0
        self.steps: list[Step] = []
        self._when: tuple[Literal, ...] = ()
        self._how = ""
        self._how_said = ""
        self._waits = False
        self._else_next = False
        self._new_step = True
        self._negate = False
        self._unless: tuple[Literal, ...] = ()
        self._deferred: tuple[Goal, ...] = ()
        self._sentence = 0
        self._postposed = _all_postposed(self.items)

    def read(self) -> None:
        """Takes one item."""
        item = self.items[self.at]
        self.at += 1
        if item.mark in ("if", "until", "unless"):
            self._how_said = item.text
            self._condition(item.mark)
        elif item.mark in ("before", "done"):
            self._ordered(item.mark)
        elif item.mark == "then" and item.text in _FIRST and self._at_an_end():
            self._first()
        elif item.mark in ("then", "break"):
            if item.mark == "break":
                self._sentence = len(self.steps)
            self._flush()
            self._new_step = True
            self._sequel = item.mark == "then" and item.text in _SEQUELS
        elif item.mark == "else":
            if self._how == "until":
                self.finish()
            if not self.steps and not self._branched:
                raise Misfit(
                    '"Otherwise" needs a condition before it: say "if ..., ... otherwise ...".'
                )
            self._else_next, self._new_step = True, True
        elif item.mark == "not":
            self._negate = True
        elif item.mark == "nothing":
            self._nothing()
        elif item.mark == "or":
            self._either()
        elif item.role == "goal":
            self._goal(item)
        elif item.role == "again":
            self._again(item)
        elif item.role == "except":
            self._except(item)
        elif item.role == "fact":
            self._told(item)
        elif item.role == "topic" and item.mention is not None:
            self._named(item.mention)

    def _nothing(self) -> None:
        """`do nothing`: a way on that ends there, without goals."""
        if self._else_next:
            self.steps.append(Step((), (), "else"))
            self._else_next = False
        elif self._when:
            self.steps.append(Step((), self._when, "condition", self._waits))
        else:
            self.steps.append(Step())
        self._when, self._how, self._new_step = (), "", False

    def finish(self) -> None:
        """A wait that nothing follows becomes an empty checkpoint.

        Raises:
            Misfit: something is missing.
        """
        self._flush()
        if any(step == Step() for step in self.steps):
            raise Misfit("Then there is nothing to do; say what the robot should achieve, or undo.")
        if self._how in ("until", "if") and self._when:
            if self._how == "if":
                raise Misfit(
                    "What should I do then? Say the condition and what to do, in one sentence."
                )
            self.steps.append(Step((), self._when, "condition", self._waits))
        if self._unless:
            raise Misfit('"Unless" needs something to do: say "unless ..., ...".')
        self._when, self._how = (), ""

    def _condition(self, mark: str) -> None:
        literals: list[Literal] = []
        while self.at < len(self.items):
            item = self.items[self.at]
            if item.role == "condition":
                literals.extend(self._literals(item, condition=True))
            elif not (item.mark in ("and", "comma") and self._condition_follows()):
                break
            self.at += 1
        when = tuple(dict.fromkeys(literals))
        previous = self.steps[-1] if self.steps else None
        if previous is not None and not self._new_step and self._belongs_to_previous():
            self._attach(previous, when, mark)
        elif mark == "unless":
            self._unless = when
        else:
            self.finish()
            self._when, self._how = when, mark
            self._waits = self._sequel or mark == "until"
        self._new_step, self._sequel = True, False

    # "Open it or close it", "..., but open it first"

    def _either(self) -> None:
        """A choice between two goals, which only the user can make.

        Raises:
            Unclear: it has not been made yet.
            Misfit: it is a choice between something else.
        """
        following = self.items[self.at] if self.at < len(self.items) else None
        if not self.steps or following is None or following.role != "goal":
            raise Misfit("One or the other? Say which.")
        self.at += 1
        other = self._literals(following, condition=False)
        options = {self.resolver.said(g): g for g in (self.steps[-1].goals, other)}
        phrase = f"or {following.text}"
        chosen = self.scope.choices.get(phrase, ())
        if not chosen or chosen[0] not in options:
            raise Unclear("Which of the two should I do?", tuple(options), phrase)
        self.steps[-1] = replace(self.steps[-1], goals=options[chosen[0]])

    def _at_an_end(self) -> bool:
        """Whether no goal follows at once: "first" is said of what came before it."""
        return bool(self.steps) and (
            self.at == len(self.items)
            or self.items[self.at].mark in ("break", "comma", "then", "if")
        )

    def _first(self) -> None:
        """The latest step comes before the others of its sentence."""
        *before, last = self.steps
        self.steps = [*before[: self._sentence], last, *before[self._sentence :]]
        self._new_step = True

    # "Before going home, ...", "once you have filled it, ..."

    def _ordered(self, mark: str) -> None:
        """A goal whose place in time is said: before or after the goals beside it.

        Raises:
            Misfit: no goal follows.
        """
        while self.at < len(self.items) and self.items[self.at].mark == "comma":
            self.at += 1
        item = self.items[self.at] if self.at < len(self.items) else None
        if item is None or item.role != "goal":
            raise Misfit("Before or after what? Say it in one sentence.")
        self.at += 1
        goals = self._literals(item, condition=False)
        if self.at < len(self.items) and self.items[self.at].text in _FIRST:
            self.at += 1
        behind = bool(self.steps) and not self._new_step
        late = self.items[self.at - 2].text.split() if self.at > 1 else []
        if mark == "before" and behind and (self.steps[-1].forbidden or "not" in late):
            # "Don't go home before you have filled it" is "fill it, then go home".
            last = self.steps.pop()
            later = replace(last, goals=last.forbidden or last.goals, forbidden=())
            self._in_front(goals, later)
        elif mark == "before" and _without(self.items[self.at - 2]):
            raise Misfit("I can only leave something out before I do something else.")
        elif mark == "before" and not behind:
            self._deferred = goals
        elif mark == "before":
            self.steps.append(Step(goals))
        elif behind:
            last = self.steps[-1]
            self.steps[-1:] = [replace(last, goals=goals), Step(last.goals)]
        elif not any(set(goals) <= set(step.goals) for step in self.steps):
            self.steps.append(Step(goals, done=True))
        self._new_step = not behind

    def _in_front(self, goals: tuple[Goal, ...], later: Step) -> None:
        """Puts goals right in front of a step, wherever that is said to come already."""
        at = next((i for i, s in enumerate(self.steps) if s.goals == later.goals), len(self.steps))
        first = [Step((g,)) for g in goals] if one_at_a_time(goals) else [Step(goals)]
        if at == len(self.steps):
            self.steps.append(later)
        self.steps[at:at] = [s for s in first if s.goals not in [x.goals for x in self.steps[:at]]]

    def _flush(self) -> None:
        """What is to come after the goals of a sentence that starts with "before" comes now."""
        if self._deferred:
            self.steps.append(Step(self._deferred))
        self._deferred = ()

    def _told(self, item: Item) -> None:
        """What is told in passing asks for nothing, but can be meant by "it" afterwards."""
        assert item.clause is not None
        try:
            _, self.scope = self.resolver.literals(item.clause, self.scope, condition=True)
        except (Misfit, Unclear):
            return

    def _named(self, mention: Mention) -> None:
        """What is only named can be meant by "it" afterwards."""
        for named in (*mention.parts, mention):
            with suppress(Misfit, Unclear):
                self.scope = self.scope.after(self.resolver.meant(named, (), self.scope).entities)

    def _again(self, item: Item) -> None:
        """The goals of the step before, for another thing.

        Raises:
            Misfit: there is nothing before, or nothing in it that the thing could stand for.
        """
        assert item.mention is not None
        before = self.steps[-1].goals if self.steps else self.latest
        goals, self.scope = self.resolver.instead(before, item.mention, self.scope)
        if not goals:
            raise Misfit(f"The same for {item.mention.text}? Say what I should do with it.")
        if self._else_next:
            self.steps.append(Step(goals, (), "else"))
            self._else_next = False
            return
        if self.steps and not self._separate(goals):
            last = self.steps[-1]
            self.steps[-1] = replace(last, goals=tuple(dict.fromkeys((*last.goals, *goals))))
        else:
            self.steps.append(Step(goals))
        self._new_step = False

    def _except(self, item: Item) -> None:
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

    def _condition_follows(self) -> bool:
        following = self.items[self.at + 1 :]
        return bool(following) and following[0].role == "condition"

    def _belongs_to_previous(self) -> bool:
        """Whether a condition stands behind what it is for: "go home if she dismisses it"."""
        rest = [i for i in self.items[self.at :] if i.mark != "comma"]
        if not rest or rest[0].mark in ("break", "else", "if", "until", "unless"):
            return True
        goes_on = rest[0].mark == "then" and rest[0].text in _GOING_ON
        return goes_on or self._postposed

    def _attach(self, previous: Step, when: tuple[Literal, ...], mark: str) -> None:
        if mark == "unless":
            self.steps[-1:] = [Step((), when, "condition"), replace(previous, role="else")]
        elif mark == "until" and previous.forbidden:
            # "Don't open it until she comes" is "when she comes, open it".
            self.steps[-1] = Step(previous.forbidden, when, "condition")
        elif mark == "until" and "not" in self._how_said.split() and one_at_a_time(when):
            # "Go home, but not until you have been to the kitchen" is an order of the robot's own acts.
            self._in_front(when, self.steps.pop())
        elif mark == "until" and "not" in self._how_said.split():
            self.steps[-1] = replace(previous, when=when, role="condition")
        elif mark == "until" and self._how_said == "before":
            raise Misfit("I can't know beforehand when that will be; say what should come first.")
        elif mark == "until":
            self._when, self._how, self._waits = when, mark, True
        else:
            self.steps[-1] = replace(previous, when=when, role="condition")

    def _goal(self, item: Item) -> None:
        goals = self._literals(item, condition=False)
        if item.clause is not None and item.clause.kind == "ellipsis":
            self._check_places(goals)
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
        elif self._is_hint(item, goals):
            return
        elif self.steps and not self._when and self._supersedes(goals):
            self.steps.pop()
            self._new_step = True
        if self._unless:
            self.steps.append(Step((), self._unless, "condition"))
            self.steps.append(Step(goals, (), "else"))
            self._unless = ()
        elif self._else_next:
            self.steps.append(Step(goals, (), "else"))
            self._else_next = False
        elif self._when:
            self.steps.append(Step(goals, self._when, "condition", self._waits))
            self._when, self._how = (), ""
        elif len(goals) > 1 and one_at_a_time(goals) and not forbidden:
            self.steps.extend(Step((goal,)) for goal in goals)
        elif self._new_step or self._separate(goals) or forbidden:
            self.steps.append(Step(goals, forbidden=forbidden))
        else:
            last = self.steps[-1]
            self.steps[-1] = replace(last, goals=tuple(dict.fromkeys((*last.goals, *goals))))
        self._new_step = False

    def _check_places(self, goals: Sequence[Goal]) -> None:
        """Looks for a second place in one breath: "bring the cup on the table to the sink".

        Raises:
            Misfit: there is one.
        """
        before = [] if self._new_step else flat(self.steps[-1].goals)
        there = {thing_placed(x): x for x in before if x.positive and says_a_place(x)}
        if any(says_a_place(x) and there.get(thing_placed(x), x) != x for x in flat(goals)):
            raise Misfit(
                "One thing can't be in two places at once; say for each where it should go."
            )

    def _is_hint(self, item: Item, goals: Sequence[Goal]) -> bool:
        """Whether a wish only says where to look: "find the pen, it should be on the nightstand"."""
        sought = (
            {x.args for x in flat(self.steps[-1].goals) if x.predicate in SOUGHT}
            if self.steps
            else set()
        )
        wished = item.clause is not None and item.clause.kind == "wish"
        return wished and bool(sought) and all(x.args[:1] in sought for x in flat(goals))

    def _by_way_of(self, item: Item, goals: Sequence[Goal]) -> None:
        """`go to the kitchen via the hall`: the hall is a step before."""
        assert item.clause is not None
        for name, mention in item.clause.bindings:
            if name == VIA and len(goals) == 1 and isinstance(goals[0], Literal):
                way = self.resolver.meant(mention, (), self.scope).entities
                first = replace(goals[0], args=(*goals[0].args[:-1], way[0]))
                self.steps.append(Step((first,), self._when, "condition" if self._when else "then"))
                self._when, self._how, self._new_step = (), "", True

    def _supersedes(self, goals: Sequence[Goal]) -> bool:
        """Whether the latest step was only the way to goals said in the same breath."""
        last = self.steps[-1]
        return superseded(last, goals) and (not self._new_step or bool(last.forbidden))

    def _separate(self, goals: Sequence[Goal]) -> bool:
        """Whether goals joined by "and" are a step of their own."""
        if not self.steps:
            return True
        both = (*flat(self.steps[-1].goals), *flat(goals))
        return any(x.predicate in SEPARATE for x in both)

    def _literals(self, item: Item, condition: bool) -> tuple[Literal, ...]:
        assert item.clause is not None
        found, self.scope = self.resolver.literals(item.clause, self.scope, condition)
        return found  # type: ignore[return-value]


def _without(item: Item) -> bool:
    return item.mark == "before" and item.text.startswith("without")


def _all_postposed(items: Sequence[Item]) -> bool:
    """Whether goals and conditions alternate and a condition ends: "A if x and B if y"."""
    roles = [i.role for i in items if i.role in ("goal", "condition")]
    marks = [i.mark for i in items]
    if len(roles) < 4 or "until" in marks or "then" in marks:
        return False
    return (
        roles[0] == "goal"
        and roles[-1] == "condition"
        and roles == ["goal", "condition"] * (len(roles) // 2)
    )
