"""From a program to ISL."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from polaris_nl.automaton.automaton import START, Automaton, Checkpoint, Transition
from polaris_nl.interchange.isl_syntax import INIT, RESERVED, WORD
from polaris_nl.model.domain import Action, Domain, conjuncts
from polaris_nl.model.formula import And, Formula, Literal, Quantified, When
from polaris_nl.model.text import listed


@dataclass(frozen=True, slots=True)
class Export:
    """A program as ISL.

    Attributes:
        text: the ISL text; "" where something has no form in it.
        missing: what has no form in ISL, a sentence each.
        notes: what reads differently when it is read back, a sentence each.
    """

    text: str
    missing: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()


def export_isl(automaton: Automaton, domain: Domain) -> Export:
    """A program as ISL, or what of it can't be said there."""
    missing = tuple(_missing(automaton))
    if missing:
        return Export("", missing)
    named = _named(automaton)
    numbers = _numbers(automaton)
    guards = _guards(automaton, named)
    labels = [
        f"    {named[c.id]}: [{_content(c)}]"
        for c in automaton.checkpoints.values()
        if c.id != START
    ]
    labels += [f"    {name}: [{_literals(when)}]" for when, name in guards.items()]
    states = ", ".join(f"{numbers[c]}: {named[c]}" for c in automaton.checkpoints)
    lines = [f"import pddl.{domain.name}", "labels"]
    lines += [",\n".join(labels)] if labels else []
    lines += ["endlabels", "module", f"    st: [{states}];"]
    if guards:
        listing = ", ".join(f"{number}: {name}" for number, name in enumerate(guards.values()))
        lines.append(f"    guard: [{listing}];")
    places = {when: number for number, when in enumerate(guards)}
    for t in automaton.transitions.values():
        guard = _guard(automaton, t, places)
        lines.append(f"    [] {numbers[t.source]}{guard} -> {numbers[t.target]};")
    lines.append("endmodule")
    if any(_has_when(operator.effect) for operator in domain.operators.values()):
        lines += ["options", "    conditional_effects;", "endoptions"]
    return Export("\n".join(lines) + "\n", (), tuple(_renamed(automaton, named)))


def _missing(automaton: Automaton) -> Iterator[str]:
    for checkpoint in automaton.checkpoints.values():
        name = checkpoint.name
        if checkpoint.id == START and (checkpoint.goals or checkpoint.action):
            yield "The start has goals, and ISL's init has none; move them to a checkpoint."
        for goal in checkpoint.goals:
            for part in conjuncts(goal):
                if not isinstance(part, Literal):
                    yield f'In "{name}", {part} has no form in ISL, whose goals are single facts.'
                else:
                    yield from _unsayable(f'In "{name}"', part.predicate, part.args)
        if checkpoint.action is not None:
            action = checkpoint.action
            yield from _unsayable(f'In "{name}"', action.operator, action.args)
    for transition in automaton.transitions.values():
        where = f"In the transition {transition.id}"
        for end in (transition.source, transition.target):
            if end not in automaton.checkpoints:
                yield f"{where}, {end} isn't there; remove the transition."
        if transition.when and transition.on:
            when = listed([str(x) for x in transition.when])
            yield (
                f"{where}, ISL can't ask for {when} and for {transition.on} at once; it has one "
                "guard for each transition."
            )
        for literal in transition.when:
            yield from _unsayable(where, literal.predicate, literal.args)


def _unsayable(where: str, head: str, args: Iterable[str]) -> Iterator[str]:
    for name in (head, *args):
        if not WORD.fullmatch(name):
            yield f"{where}, the name {name} can't be written in ISL; rename it."


# Names and numbers


def _named(automaton: Automaton) -> dict[str, str]:
    """The label of each checkpoint: its name with underscores, all of them different."""
    found = {START: INIT}
    for checkpoint in automaton.checkpoints.values():
        if checkpoint.id != START:
            found[checkpoint.id] = _fresh(_word(checkpoint.name), found.values())
    return found


def _word(name: str) -> str:
    word = re.sub(r"[^\w\-.]+", "_", name.strip())
    word = re.sub(r"^[.\-]+|[.\-]+$", "", word)
    return word or "checkpoint"


def _fresh(wanted: str, taken: Iterable[str]) -> str:
    known = {*taken, *RESERVED}
    if wanted not in known:
        return wanted
    return next(w for n in range(2, len(known) + 3) if (w := f"{wanted}_{n}") not in known)


def _renamed(automaton: Automaton, named: dict[str, str]) -> Iterator[str]:
    for checkpoint in automaton.checkpoints.values():
        back = "start" if checkpoint.id == START else named[checkpoint.id].replace("_", " ")
        if back != checkpoint.name:
            yield f'The name "{checkpoint.name}" reads "{back}" in ISL.'


def _numbers(automaton: Automaton) -> dict[str, int]:
    """The number of each state: that of the checkpoint's id where it has one, else the next free one."""
    found = {START: 0}
    for checkpoint in automaton.checkpoints:
        match = re.fullmatch(r"c([1-9][0-9]{0,8})", checkpoint)
        if match:
            found[checkpoint] = int(match[1])
    free = max(found.values()) + 1
    for checkpoint in automaton.checkpoints:
        if checkpoint not in found:
            found[checkpoint] = free
            free += 1
    return found


# Parts


def _guards(automaton: Automaton, named: dict[str, str]) -> dict[tuple[Literal, ...], str]:
    """The label of each conditional, in the order of the transitions."""
    found: dict[tuple[Literal, ...], str] = {}
    for transition in automaton.transitions.values():
        if transition.when and transition.when not in found:
            wanted = f"if_{named[transition.target]}"
            found[transition.when] = _fresh(wanted, (*named.values(), *found.values()))
    return found


def _guard(
    automaton: Automaton, transition: Transition, places: dict[tuple[Literal, ...], int]
) -> str:
    if transition.when:
        return f" & guard={places[transition.when]}"
    if transition.on:
        return f" & guard={transition.on.upper()}"
    beside = automaton.outgoing(transition.source)
    return " & guard=default" if any(t.when or t.on for t in beside) else ""


def _content(checkpoint: Checkpoint) -> str:
    if checkpoint.action is not None:
        return _action(checkpoint.action)
    return _literals([x for g in checkpoint.goals for x in conjuncts(g) if isinstance(x, Literal)])


def _literals(literals: Sequence[Literal]) -> str:
    return " & ".join(
        f"{'' if x.positive else 'not '}predicate: {x.predicate}, params: [{', '.join(x.args)}]"
        for x in literals
    )


def _action(action: Action) -> str:
    return f"action: {action.operator}, params: [{', '.join(action.args)}]"


def _has_when(effect: Formula) -> bool:
    if isinstance(effect, And):
        return any(map(_has_when, effect.parts))
    return isinstance(effect, When) or (isinstance(effect, Quantified) and _has_when(effect.body))
