"""From cut utterances to edits: where checkpoints go, and when (DESIGN section 5 point 10)."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from polaris_nl.automaton.automaton import Automaton, Checkpoint, Transition
from polaris_nl.automaton.edits import (
    AddCheckpoint,
    Edit,
    InsertCheckpoint,
    RenameCheckpoint,
    SetGoals,
    apply,
    apply_all,
)
from polaris_nl.language.naming import Names
from polaris_nl.language.reordering import put_in_order
from polaris_nl.language.scope import Misfit
from polaris_nl.language.subjects import subjects
from polaris_nl.model.formula import Goal, Literal, literals_in
from polaris_nl.model.world import World


@dataclass(frozen=True, slots=True)
class Step:
    """Goals that belong to one checkpoint, or a wait without goals.

    Attributes:
        role: `then` goes after the step before; `condition` starts a branch; `else` is taken if the
            others can't be.
        sequel: the condition is waited for after the step before ("then once ..."), and starts no
            branch further up.
        done: it is spoken of as done by then ("once you have filled it, ..."), so it is no new step
            where the program has come to it already.
        forbidden: what "do not" was said of, where the goals are its opposite.
    """

    goals: tuple[Goal, ...] = ()
    when: tuple[Literal, ...] = ()
    role: str = "then"
    sequel: bool = False
    done: bool = False
    forbidden: tuple[Goal, ...] = ()


@dataclass
class Builder:
    """Builds edits step by step.

    Attributes:
        here: the checkpoint that was edited last, after which the next step goes.
        anchor: the checkpoint at which the latest branch began, for "otherwise".
        changed: what became of what is there, in words, where nothing was added.
        reordered: what is there was put in another order, and nothing added.
        anew: what is there may be asked for a second time: "again" is said, or "if" rather than "once".
    """

    world: World
    names: Names
    program: Automaton
    here: str
    anchor: str | None = None
    edits: list[Edit] = field(default_factory=list)
    touched: list[str] = field(default_factory=list)
    changed: str = ""
    reordered: bool = False
    anew: bool = False

    def add(self, step: Step) -> None:
        """Puts a step into the program.

        Raises:
            Misfit: it is a second "otherwise".
        """
        there = self._there_already(step)
        if there is not None:
            self.here = there
            return
        asked = self.program.checkpoints[self.here].goals
        again = step.done or (step.role == "then" and bool(step.goals) and not step.when)
        if again and set(step.goals) <= set(asked):
            return
        if step.role == "else":
            self._otherwise(step)
        elif step.role == "condition":
            self._branch(step)
        else:
            self._next(step)

    def _there_already(self, step: Step) -> str | None:
        """Where what is spoken of as done is done, or what is to come of it, if that is in one place."""
        doing = step.goals if step.done else step.when
        found = [c.id for c in self.program.checkpoints.values() if set(doing) <= set(c.goals)]
        if not doing or len(found) != 1 or step.sequel:
            return None
        if step.done:
            return found[0]
        if self.anew:
            return None
        # "Go home once she has it", where it is handed over on the way home.
        onward = (c for c in self.program.subtree(found[0])[1:] if step.goals)
        return next((c for c in onward if set(step.goals) == set(self._goals(c))), None)

    def _goals(self, checkpoint: str) -> Sequence[Goal]:
        return self.program.checkpoints[checkpoint].goals

    def put_in_front(self, steps: Sequence[Step], other: str) -> None:
        """Puts steps in front of a checkpoint, behind what was waited for there, and goes on after that one."""
        for step in steps:
            incoming = self.program.incoming(other)
            if incoming is not None:
                checkpoint = self._checkpoint(step.goals, ())
                onward = self.program.fresh_transition_id()
                self._edited(InsertCheckpoint(checkpoint, incoming.id, onward), checkpoint.id)
        self.here = other

    def put_in_order(self, order: Sequence[str]) -> None:
        """Puts checkpoints that are there in another order, and goes on after the last of them."""
        for edit in put_in_order(self.program, order):
            self._edited(edit, order[-1])
        self.touched = [c for c in order if self.edits]
        self.reordered = True

    def change(self, edits: Sequence[Edit], say: str, touched: Sequence[str]) -> None:
        """Changes checkpoints that are there; what is said next goes on where it would have gone on."""
        self.program = apply_all(self.program, edits)
        self.edits += edits
        self.touched = [*touched]
        self.changed = say

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
                if not set(step.goals) <= set(self.program.checkpoints[self.here].goals):
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
        about = subjects(when)
        for transition in reversed(self.program.path(self.here)):
            ways = self.program.outgoing(transition.source)
            if about & {s for way in ways for s in subjects(way.when)}:
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
