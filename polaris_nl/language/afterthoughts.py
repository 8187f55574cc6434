"""What limits or adds to a step that is there: "but only if she is in", "the plate along with it"."""

from __future__ import annotations

from collections.abc import Collection, Sequence

from polaris_nl.automaton.automaton import START, Automaton, Checkpoint, Transition
from polaris_nl.automaton.edits import AddCheckpoint, Edit, apply
from polaris_nl.language.goal_relations import flat, says_a_place, thing_placed
from polaris_nl.language.naming import Names
from polaris_nl.language.reshaping import Reshaped, conditional
from polaris_nl.language.scope import Misfit
from polaris_nl.model.errors import EditError
from polaris_nl.model.formula import Goal, Literal


def step_about(
    things: Sequence[Collection[str]],
    alike: Sequence[Goal],
    touched: Sequence[str],
    program: Automaton,
) -> str:
    """The step whose goals are about some things.

    Args:
        things: what may be meant, the likeliest first.
        alike: goals whose like must be done there, if any.
        touched: the steps of the latest edit, which come before the rest.
        program: the program.

    Raises:
        Misfit: there is none.
    """
    made = [c for c in program.checkpoints if c != START]
    predicates = {g.predicate for g in flat(alike)}
    for named in things:
        for checkpoint in (*reversed(touched), *reversed(made)):
            for goal in flat(program.checkpoints[checkpoint].goals):
                about = thing_placed(goal) if says_a_place(goal) else next(iter(goal.args), "")
                if about in named and (not predicates or goal.predicate in predicates):
                    return checkpoint
    raise Misfit("")


def narrowed(old: Sequence[Literal], new: Sequence[Literal]) -> tuple[Literal, ...]:
    """A condition with more to it; what can't be beside the new literals gives way to them."""

    def gives_way(literal: Literal) -> bool:
        return any(
            x.args == literal.args
            or (x.predicate == literal.predicate and x.args[:1] == literal.args[:1])
            for x in new
        )

    return (*(x for x in old if not gives_way(x)), *new)


def limited(program: Automaton, this: str, when: tuple[Literal, ...], words: str) -> Reshaped:
    """A step that waits for something, besides what it waits for already: "but only if she is in".

    Raises:
        EditError: it is what happens otherwise, or what happens then is said already.
    """
    incoming = program.incoming(this)
    if incoming is not None and program.is_else(incoming.id):
        name = program.checkpoints[this].name
        raise EditError(f"{name} is what happens otherwise; say the whole condition.")
    return conditional(program, this, when, words)


def spared(program: Automaton, this: str, when: tuple[Literal, ...], names: Names) -> Reshaped:
    """A step that is left out where something holds: "unless she has it already".

    Raises:
        EditError: what happens then is said already.
        Misfit: it waits for something, and what it is left out for are several things at once.
    """
    incoming = program.incoming(this)
    if incoming is None:
        raise Misfit("")
    name = program.checkpoints[this].name
    if incoming.when:
        if len(when) > 1:
            raise Misfit("")
        both = narrowed(incoming.when, (when[0].negation,))
        return conditional(program, this, both, f"{name} is left out then")
    if any(t.conditional == set(when) for t in program.outgoing(incoming.source)):
        raise EditError(f"What happens then is said already; change or remove {name}.")
    rest = _straight_on(program, this)
    if rest is None:
        rest, name = [()], f"{name} and what comes after it"
    edits: list[Edit] = []
    source, wait = incoming.source, when
    for goals in rest or [()]:
        new = Checkpoint(
            program.fresh_checkpoint_id(), names.checkpoint(goals, wait, program), tuple(goals)
        )
        arrow = Transition(program.fresh_transition_id(), source, new.id, wait)
        edits.append(AddCheckpoint(new, arrow))
        program, source, wait = apply(program, edits[-1]), new.id, ()
    left_out = "is" if name == program.checkpoints[this].name else "are"
    return edits, f"{name} {left_out} left out then", [this]


def _straight_on(program: Automaton, this: str) -> list[tuple[Goal, ...]] | None:
    """The goals of the steps that come after a step, in order; None where they part or wait."""
    found: list[tuple[Goal, ...]] = []
    while outgoing := program.outgoing(this):
        if len(outgoing) > 1 or outgoing[0].when:
            return None
        this = outgoing[0].target
        found.append(program.checkpoints[this].goals)
    return found
