"""From cut utterances to edits: where checkpoints go, and when (DESIGN section 5 point 10)."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

from polaris_nl.automaton.automaton import Automaton, Checkpoint, Transition
from polaris_nl.automaton.edits import (
    AddCheckpoint,
    Edit,
    InsertCheckpoint,
    RenameCheckpoint,
    SetGoals,
    apply,
)
from polaris_nl.language.naming import Names
from polaris_nl.language.resolve import Misfit, Resolver, Scope
from polaris_nl.language.segment import Cut, Item
from polaris_nl.model.formula import Formula, Goal, Literal, literals_in
from polaris_nl.model.world import World

SEPARATE = ("robot-at", "alerted-to", "person-in", "holding", "has")
"""Goals that are steps of their own when joined by "and": where the robot is, and what happens to people."""


_SEQUELS = ("then", "and then", "after that", "and after that", "afterwards", "and afterwards")
"""Words in front of a condition that keep it where the program has come to."""
_GOING_ON = (*_SEQUELS[1:], "and finally", "and next", "finally", "after this")
"""Words after a condition that stands behind its goal: "bring it once she acknowledges, and then ..."."""


@dataclass(frozen=True, slots=True)
class Step:
    """Goals that belong to one checkpoint, or a wait without goals.

    Attributes:
        role: `then` goes after the step before; `condition` starts a branch; `else` is taken if the
            others can't be.
        sequel: the condition is waited for after the step before ("then once ..."), and starts no
            branch further up.
    """

    goals: tuple[Goal, ...] = ()
    when: tuple[Literal, ...] = ()
    role: str = "then"
    sequel: bool = False


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
        """Puts a step into the program.

        Raises:
            Misfit: it is a second "otherwise".
        """
        if step.role == "else":
            self._otherwise(step)
        elif step.role == "condition":
            self._branch(step)
        else:
            self._next(step)

    def _otherwise(self, step: Step) -> None:
        source = self.anchor if self.anchor is not None else self.here
        if any(not t.when for t in self.program.outgoing(source)):
            raise Misfit(
                'There is an "otherwise" already; say what it should be instead, or remove it first.'
            )
        self._add(step.goals, (), source)

    def _branch(self, step: Step) -> None:
        """Adds a branch; one that is there already goes on at its end."""
        source = self._fitting_place(step)
        self.anchor = source
        for transition in self.program.outgoing(source):
            if transition.conditional == set(step.when):
                self.here = self._end(transition.target)
                if step.goals:
                    self._next(Step(step.goals))
                return
        self._add(step.goals, step.when, source)

    def _next(self, step: Step) -> None:
        """Goes on after the latest checkpoint: in front of what follows it, never beside it."""
        waiting = self.program.checkpoints[self.here]
        outgoing = self.program.outgoing(self.here)
        if len(outgoing) == 1 and not outgoing[0].when:
            checkpoint = self._checkpoint(step.goals, ())
            onward = self.program.fresh_transition_id()
            self._edited(InsertCheckpoint(checkpoint, outgoing[0].id, onward), checkpoint.id)
        elif outgoing:
            self._add(step.goals, (), self._end(self.here))
        elif self._only_waits(waiting):
            self._fill(waiting, step.goals)
        else:
            self._add(step.goals, (), self.here)

    def _only_waits(self, checkpoint: Checkpoint) -> bool:
        """Whether a checkpoint is a "wait until" that nothing followed yet."""
        incoming = self.program.incoming(checkpoint.id)
        if checkpoint.goals or checkpoint.action is not None or incoming is None:
            return False
        beside = self.program.outgoing(incoming.source)
        return bool(incoming.when) and all(t.when for t in beside)

    def _fill(self, checkpoint: Checkpoint, goals: tuple[Goal, ...]) -> None:
        """What follows a wait becomes what is waited for."""
        incoming = self.program.incoming(checkpoint.id)
        when = incoming.when if incoming is not None else ()
        name = self.names.checkpoint(goals, when, self.program)
        self._edited(SetGoals(checkpoint.id, goals), checkpoint.id)
        self._edited(RenameCheckpoint(checkpoint.id, name), checkpoint.id)

    def _add(self, goals: tuple[Goal, ...], when: tuple[Literal, ...], source: str) -> None:
        checkpoint = self._checkpoint(goals, when)
        transition = Transition(self.program.fresh_transition_id(), source, checkpoint.id, when)
        self._edited(AddCheckpoint(checkpoint, transition), checkpoint.id)

    def _checkpoint(self, goals: tuple[Goal, ...], when: tuple[Literal, ...]) -> Checkpoint:
        name = self.names.checkpoint(goals, when, self.program)
        return Checkpoint(self.program.fresh_checkpoint_id(), name, goals)

    def _edited(self, edit: Edit, checkpoint: str) -> None:
        self.program = apply(self.program, edit)
        self.edits.append(edit)
        if checkpoint not in self.touched:
            self.touched.append(checkpoint)
        self.here = checkpoint

    def _end(self, checkpoint: str) -> str:
        """The leaf that the latest way on from a checkpoint comes to."""
        while outgoing := self.program.outgoing(checkpoint):
            checkpoint = outgoing[-1].target
        return checkpoint

    def _fitting_place(self, step: Step) -> str:
        """The checkpoint that a condition belongs to: its alert's, its object's, or the latest one."""
        messages = {
            x.args[0] for x in step.when if x.predicate in ("acknowledged", "dismissed") and x.args
        }
        sibling = self._sibling(step.when)
        if step.sequel and not (messages and sibling):
            return self.here
        alerting = self._latest(
            lambda goal: goal.predicate == "alerted-to" and goal.args[-1] in messages
        )
        if alerting is not None and not self._goes_straight_on(alerting):
            return alerting
        if any(t.when for t in self.program.outgoing(self.here)):
            return self.here
        return sibling or self.here

    def _goes_straight_on(self, checkpoint: str) -> bool:
        outgoing = self.program.outgoing(checkpoint)
        return bool(outgoing) and not any(t.when for t in outgoing)

    def _sibling(self, when: Sequence[Literal]) -> str | None:
        """Where the way to here branched on a condition about the same things."""
        about = {arg for x in when for arg in x.args}
        for transition in reversed(self.program.path(self.here)):
            labels = {arg for x in transition.when for arg in x.args}
            if transition.when and about & labels:
                return transition.source
        return None

    def _latest(self, fits: Callable[[Literal], bool]) -> str | None:
        path = [self.here, *reversed([t.source for t in self.program.path(self.here)])]
        rest = [c for c in reversed(list(self.program.checkpoints)) if c not in path]
        for checkpoint in (*path, *rest):
            goals = self.program.checkpoints[checkpoint].goals
            if any(fits(x) for goal in goals for x in literals_in(goal)):
                return checkpoint
        return None


def steps_of(
    cut: Cut, resolver: Resolver, scope: Scope, branched: bool = False
) -> tuple[list[Step], Scope]:
    """The steps that a cut utterance asks for, in order.

    Args:
        cut: the utterance, cut into clauses.
        resolver: finds the entities that are meant.
        scope: what has been mentioned before.
        branched: there is a branch already that "otherwise" can belong to.

    Returns:
        They, and the scope after them.

    Raises:
        Unclear: a question has to be asked.
        Misfit: the reading can't be.
    """
    reader = _Reader(cut.items, resolver, scope, branched)
    while reader.at < len(reader.items):
        reader.read()
    reader.finish()
    return reader.steps, reader.scope


class _Reader:
    """Walks over items with the conditions that wait for their goals."""

    def __init__(
        self, items: Sequence[Item], resolver: Resolver, scope: Scope, branched: bool
    ) -> None:
        self._branched = branched
        self._sequel = False
        self.items = list(items)
        self.resolver = resolver
        self.scope = scope
        self.at = 0
        self.steps: list[Step] = []
        self._when: tuple[Literal, ...] = ()
        self._how = ""
        self._waits = False
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
        elif item.role == "goal":
            self._goal(item)

    def finish(self) -> None:
        """A wait that nothing follows becomes an empty checkpoint."""
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
        elif (
            mark == "until"
            and all(not x.positive for x in _flat(previous.goals))
            and previous.goals
        ):
            # "Don't open it until she comes" is "when she comes, open it".
            goals = tuple(x.negation for x in _flat(previous.goals))
            self.steps[-1] = Step(goals, when, "condition")
        elif mark == "until":
            self._when, self._how, self._waits = when, mark, True
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
            self.steps.append(Step(goals, self._when, "condition", self._waits))
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
