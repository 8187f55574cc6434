"""From cut utterances to edits: where checkpoints go, and when (DESIGN section 5 point 10)."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

from polaris_nl.automaton.automaton import START, Automaton, Checkpoint, Transition
from polaris_nl.automaton.edits import AddCheckpoint, Edit, apply
from polaris_nl.language.naming import Names
from polaris_nl.language.resolve import Misfit, Resolver, Scope
from polaris_nl.language.segment import Cut, Item
from polaris_nl.model.formula import Formula, Goal, Literal, literals_in
from polaris_nl.model.world import World

SEPARATE = ("robot-at", "alerted-to", "person-in", "holding", "has")
"""Goals that are steps of their own when joined by "and": where the robot is, and what happens to people."""


@dataclass(frozen=True, slots=True)
class Step:
    """Goals that belong to one checkpoint, or a wait without goals.

    Attributes:
        role: `then` goes after the step before; `condition` starts a branch; `else` is taken if the
            others can't be.
    """

    goals: tuple[Goal, ...] = ()
    when: tuple[Literal, ...] = ()
    role: str = "then"


@dataclass
class Builder:
    """Builds edits step by step.

    Attributes:
        here: the checkpoint that was edited last, after which the next step goes.
        anchor: the checkpoint at which the latest branch began, for "otherwise".
    """

    world: World
    names: Names
    program: Automaton
    here: str
    anchor: str | None = None
    edits: list[Edit] = field(default_factory=list)
    touched: list[str] = field(default_factory=list)

    def add(self, step: Step) -> None:
        """Puts a step into the program."""
        if step.role == "else" and self.anchor is not None:
            source = self.anchor
        elif step.role == "condition":
            source = self._fitting_place(step.when)
            self.anchor = source
        else:
            source = self.here
        name = self.names.checkpoint(step.goals, step.when, self.program)
        checkpoint = Checkpoint(self.program.fresh_checkpoint_id(), name, step.goals)
        transition = Transition(
            self.program.fresh_transition_id(), source, checkpoint.id, step.when
        )
        edit = AddCheckpoint(checkpoint, transition)
        self.program = apply(self.program, edit)
        self.edits.append(edit)
        self.touched.append(checkpoint.id)
        self.here = checkpoint.id

    def _fitting_place(self, when: Sequence[Literal]) -> str:
        """The checkpoint that a condition belongs to: its alert's, its object's, or the latest one."""
        messages = {
            x.args[0] for x in when if x.predicate in ("acknowledged", "dismissed") and x.args
        }
        alerting = self._latest(
            lambda goal: goal.predicate == "alerted-to" and goal.args[-1] in messages
        )
        if alerting is not None:
            return alerting
        if messages or self.here == START:
            return self.here
        if any(t.when for t in self.program.outgoing(self.here)) or not self._branches_above():
            return self.here
        # A sibling of the branch we are in: its condition is about the same things.
        about = {arg for x in when for arg in x.args}
        for transition in reversed(self.program.path(self.here)):
            labels = {arg for x in transition.when for arg in x.args}
            if transition.when and about & labels and set(when) != transition.conditional:
                return transition.source
        return self.here

    def _branches_above(self) -> bool:
        return any(t.when for t in self.program.path(self.here))

    def _latest(self, fits: Callable[[Literal], bool]) -> str | None:
        path = [self.here, *reversed([t.source for t in self.program.path(self.here)])]
        rest = [c for c in reversed(list(self.program.checkpoints)) if c not in path]
        for checkpoint in (*path, *rest):
            goals = self.program.checkpoints[checkpoint].goals
            if any(fits(x) for goal in goals for x in literals_in(goal)):
                return checkpoint
        return None


def steps_of(cut: Cut, resolver: Resolver, scope: Scope) -> tuple[list[Step], Scope]:
    """The steps that a cut utterance asks for, in order.

    Returns:
        They, and the scope after them.

    Raises:
        Unclear: a question has to be asked.
        Misfit: the reading can't be.
    """
    reader = _Reader(cut.items, resolver, scope)
    while reader.at < len(reader.items):
        reader.read()
    reader.finish()
    return reader.steps, reader.scope


class _Reader:
    """Walks over items with the conditions that wait for their goals."""

    def __init__(self, items: Sequence[Item], resolver: Resolver, scope: Scope) -> None:
        self.items = list(items)
        self.resolver = resolver
        self.scope = scope
        self.at = 0
        self.steps: list[Step] = []
        self._when: tuple[Literal, ...] = ()
        self._how = ""
        self._else_next = False
        self._new_step = True
        self._negate = False
        self._unless: tuple[Literal, ...] = ()
        self._postposed = _all_postposed(self.items)

    def read(self) -> None:
        """Takes one item."""
        item = self.items[self.at]
        self.at += 1
        if item.mark in ("if", "until", "unless"):
            self._condition(item.mark)
        elif item.mark in ("then", "break"):
            self._new_step = True
            if item.mark == "break" and self._how == "until":
                self.finish()
        elif item.mark == "else":
            if not self.steps:
                raise Misfit(
                    '"Otherwise" needs a condition before it: say "if ..., ... otherwise ...".'
                )
            self._else_next, self._new_step = True, True
        elif item.mark == "not":
            self._negate = True
        elif item.role == "goal":
            self._goal(item)

    def finish(self) -> None:
        """A wait that nothing follows becomes an empty checkpoint."""
        if self._how in ("until", "if") and self._when:
            if self._how == "if":
                raise Misfit(
                    "What should I do then? Say the condition and what to do, in one sentence."
                )
            self.steps.append(Step((), self._when, "condition"))
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
        self._new_step = True

    def _condition_follows(self) -> bool:
        following = self.items[self.at + 1 :]
        return bool(following) and following[0].role == "condition"

    def _belongs_to_previous(self) -> bool:
        """Whether a condition stands behind what it is for: "go home if she dismisses it"."""
        rest = [i for i in self.items[self.at :] if i.mark != "comma"]
        if not rest or rest[0].mark in ("break", "else", "if", "until", "unless"):
            return True
        return self._postposed

    def _attach(self, previous: Step, when: tuple[Literal, ...], mark: str) -> None:
        if mark == "unless":
            self.steps[-1:] = [Step((), when, "condition"), replace(previous, role="else")]
        elif (
            mark == "until"
            and all(not x.positive for x in _flat(previous.goals))
            and previous.goals
        ):
            # "Don't open it until she comes" is "when she comes, open it".
            goals = tuple(x.negation for x in _flat(previous.goals))
            self.steps[-1] = Step(goals, when, "condition")
        elif mark == "until":
            self._when, self._how = when, mark
        else:
            self.steps[-1] = replace(previous, when=when, role="condition")

    def _goal(self, item: Item) -> None:
        goals = self._literals(item, condition=False)
        if self._negate:
            goals = tuple(g.negation if isinstance(g, Literal) else g for g in goals)
            self._negate = False
        if self._unless:
            self.steps.append(Step((), self._unless, "condition"))
            self.steps.append(Step(goals, (), "else"))
            self._unless = ()
        elif self._else_next:
            self.steps.append(Step(goals, (), "else"))
            self._else_next = False
        elif self._when:
            self.steps.append(Step(goals, self._when, "condition"))
            self._when, self._how = (), ""
        elif self._new_step or self._separate(goals):
            self.steps.append(Step(goals))
        else:
            last = self.steps[-1]
            self.steps[-1] = replace(last, goals=tuple(dict.fromkeys((*last.goals, *goals))))
        self._new_step = False

    def _separate(self, goals: Sequence[Goal]) -> bool:
        """Whether goals joined by "and" are a step of their own."""
        if not self.steps:
            return True
        both = (*_flat(self.steps[-1].goals), *_flat(goals))
        return any(x.predicate in SEPARATE for x in both)

    def _literals(self, item: Item, condition: bool) -> tuple[Literal, ...]:
        assert item.clause is not None
        found, self.scope = self.resolver.literals(item.clause, self.scope, condition)
        return found  # type: ignore[return-value]


def _flat(goals: Sequence[Formula]) -> tuple[Literal, ...]:
    return tuple(goal for goal in goals if isinstance(goal, Literal))


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
