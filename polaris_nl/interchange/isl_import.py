"""From ISL to a program."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from polaris_nl.automaton.automaton import START, Automaton, Checkpoint, Transition
from polaris_nl.interchange.isl_syntax import INIT, Isl, Label, Step, parse_isl
from polaris_nl.model.check import action_faults, literal_faults
from polaris_nl.model.errors import FormatError, ProgramError
from polaris_nl.model.files import read_small_text
from polaris_nl.model.world import World

_NOT_KEPT = {
    "maintenance_goals": "goals that are to hold all the time can't be asked for yet",
    "uncertain_item_locations": "every thing's place is taken to be known",
}


def read_isl(path: Path) -> Isl:
    """Reads an ISL file.

    Raises:
        FileError: it can't be read.
        ProgramError: it is no ISL; what is wrong is named with its line.
    """
    text = read_small_text(path, "ISL file", ProgramError)
    try:
        return parse_isl(text)
    except FormatError as error:
        raise ProgramError(error.reason, path, error.line) from error


def automaton_of(isl: Isl) -> Automaton:
    """The program that an ISL text says, whatever its shape (see `polaris_nl.interchange.properties`).

    A state's number becomes the id of its checkpoint and its label the name, underscores as spaces;
    where states share a label, names are numbered. A guard that leaves nothing to wait for, `default`
    and none at all become a transition without a conditional.
    """
    ids = _ids(isl)
    automaton = Automaton()
    for number, name in isl.states.items():
        if name == INIT:
            continue
        label = isl.labels[name]
        called = automaton.fresh_name(name.replace("_", " "))
        goals = tuple(dict.fromkeys(label.literals))
        automaton = automaton.with_checkpoint(Checkpoint(ids[number], called, goals, label.action))
    for count, step in enumerate(isl.steps, 1):
        automaton = automaton.with_transition(_transition(f"t{count}", step, isl, ids))
    return automaton


def faults(isl: Isl, world: World) -> Iterator[FormatError]:
    """What of an ISL text doesn't fit a world, with its line: names, types, guards that are actions."""
    if isl.domain != world.domain.name:
        yield FormatError(
            f"The program is for the domain {isl.domain}, but the world {world.name} is of "
            f"{world.domain.name}; name another with --world.",
            line=1,
        )
        return
    types = {**world.domain.constants, **{e.name: e.type for e in world.entities.values()}}
    for label in isl.labels.values():
        where = f"In the label {label.name}"
        for literal, line in zip(label.literals, label.lines, strict=False):
            for text in literal_faults(literal, world.domain, types):
                yield FormatError(f"{where}: {text}", line=line)
        if label.action is not None:
            for text in action_faults(label.action, world.domain, types):
                yield FormatError(f"{where}: {text}", line=label.lines[0])
    for label in _guards(isl):
        if label.action is not None:
            yield FormatError(
                f"The guard {label.name} is an action, and a condition is made of predicates; for "
                "what comes of an action, guard by SUCCESS or FAILURE.",
                line=label.line,
            )


def notes(isl: Isl) -> tuple[str, ...]:
    """What of an ISL text the program doesn't say, a sentence each."""
    found = [
        f"The option {option} is left out: {_NOT_KEPT[option]}."
        for option in isl.options
        if option in _NOT_KEPT
    ]
    used = {*isl.states.values(), *isl.guards.values()}
    idle = [name for name in isl.labels if name not in used]
    found += [f"The label {name} is left out: no state and no guard has it." for name in idle]
    guarding = {step.guard for step in isl.steps}
    found += [
        f"The guard {number} ({name}) is left out: no transition has it."
        for number, name in isl.guards.items()
        if number not in guarding
    ]
    found += [
        f"The guard {label.name} asks for nothing, so its transition waits for nothing."
        for label in _guards(isl)
        if not label.literals and label.action is None
    ]
    return tuple(found)


def _ids(isl: Isl) -> dict[int, str]:
    """The checkpoint of each state: its number, but for the start and a state that has the start's."""
    free = max(isl.states, default=0) + 1
    return {
        number: START if name == INIT else f"c{number or free}"
        for number, name in isl.states.items()
    }


def _guards(isl: Isl) -> Iterator[Label]:
    """The labels of the guards that transitions have, each once."""
    numbers = (step.guard for step in isl.steps if isinstance(step.guard, int))
    for name in dict.fromkeys(isl.guards[number] for number in numbers):
        yield isl.labels[name]


def _transition(name: str, step: Step, isl: Isl, ids: dict[int, str]) -> Transition:
    source, target = ids[step.source], ids[step.target]
    if isinstance(step.guard, int):
        when = tuple(dict.fromkeys(isl.labels[isl.guards[step.guard]].literals))
        return Transition(name, source, target, when)
    if step.guard == "success":
        return Transition(name, source, target, on="success")
    if step.guard == "failure":
        return Transition(name, source, target, on="failure")
    return Transition(name, source, target)
