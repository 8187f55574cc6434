"""What is edited by keys, and how a fact is put together: the paper's parameterisation menu.

A predicate is picked first, then for each of its parameters an entity of a type that fits (Porfirio,
Roberts and Hiatt, HRI 2024, section 3.3). Pure functions.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial

from polaris_nl.automaton.automaton import START, Automaton, Checkpoint
from polaris_nl.automaton.edits import RenameCheckpoint
from polaris_nl.model.domain import Predicate
from polaris_nl.model.formula import Goal, Literal, Variable
from polaris_nl.model.text import sentence
from polaris_nl.model.wording import Wording
from polaris_nl.model.world import World
from polaris_tui.menus import Menu, Note, Option, Step

NameOf = Callable[[Sequence[Goal], Sequence[Literal], Automaton], str]
"""The automatic name of a checkpoint: from its goals and the condition before it."""

Renamed = Callable[[Automaton, str, Sequence[Goal], Sequence[Literal]], Iterable[RenameCheckpoint]]


@dataclass(frozen=True)
class Desk:
    """What is edited, and with which words.

    Attributes:
        checkpoint: the id of the checkpoint that is picked.
        name: makes names for new checkpoints.
        renamed: gives a checkpoint a new name with its new goals, unless the user has named it.
    """

    world: World
    wording: Wording
    automaton: Automaton
    checkpoint: str
    name: NameOf
    renamed: Renamed

    @property
    def here(self) -> Checkpoint:
        """The checkpoint that is picked."""
        return self.automaton.checkpoints.get(self.checkpoint) or self.automaton.checkpoints[START]


def literal_menu(
    desk: Desk, title: str, then: Callable[[Literal], Step], people_first: bool = False
) -> Menu:
    """Asks for a fact: a predicate, then an entity for each parameter.

    Args:
        desk: what is edited.
        title: what the fact is for.
        then: what comes of it.
        people_first: begin with what people bring about, which is what robots wait for.
    """
    domain = desk.world.domain
    known = [p for p in domain.predicates.values() if not p.internal]
    changing = [p for p in known if domain.robot_can_change(p.name)]
    exogenous = [p for p in known if p not in changing and domain.people_can_change(p.name)]
    ordered = [*exogenous, *changing] if people_first else [*changing, *exogenous]
    return Menu(
        title, tuple(o for p in ordered for o in _predicate(desk, title, p, then, people_first))
    )


def _predicate(
    desk: Desk, title: str, predicate: Predicate, then: Callable[[Literal], Step], event: bool
) -> Iterator[Option]:
    words = desk.wording.fact if event else desk.wording.goal
    blank = Literal(predicate.name, tuple(_blank(v) for v in predicate.parameters))
    whose = (
        "" if desk.world.domain.robot_can_change(predicate.name) else "only people bring it about"
    )
    for literal in (blank, blank.negation):
        yield Option(words(literal), partial(_filled, desk, title, literal, 0, then, event), whose)


def _blank(parameter: Variable) -> str:
    return f"some {' or '.join(parameter.types) or 'thing'}"


def _filled(
    desk: Desk, title: str, literal: Literal, at: int, then: Callable[[Literal], Step], event: bool
) -> Step:
    """Asks for the entity of a parameter, and so on; the fact where all are known."""
    parameters = desk.world.domain.predicates[literal.predicate].parameters
    if at == len(parameters):
        return then(literal)
    words = desk.wording.fact if event else desk.wording.goal
    options = []
    for entity in desk.world.entities.values():
        if desk.world.domain.fits(entity.type, parameters[at]) and entity.name not in literal.args:
            args = (*literal.args[:at], entity.name, *literal.args[at + 1 :])
            filled = replace(literal, args=args)
            options.append(
                Option(
                    desk.wording.entity(entity.name),
                    partial(_filled, desk, title, filled, at + 1, then, event),
                    _place(desk, entity.name),
                )
            )
    kind = " or ".join(parameters[at].types) or "thing"
    if not options:
        return Note(f"There is no {kind} for that in this world.")
    return Menu(f"{sentence(words(literal))[:-1]}: which {kind}?", tuple(options))


def _place(desk: Desk, entity: str) -> str:
    """Where something is at the start, so that two of a kind can be told apart."""
    world = desk.world
    place = world.place_of(entity, world.initial)
    return f"in {desk.wording.entity(place)}" if place and place != entity else ""
