"""Editing by keys: menus of typed predicates and fitting entities that end in edits.

The paper's parameterisation menu (Porfirio, Roberts and Hiatt, HRI 2024, section 3.3): a predicate is
picked first, then for each of its parameters an entity of a type that fits. Pure functions.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

from polaris_nl.automaton.automaton import START, Automaton, Checkpoint, Transition
from polaris_nl.automaton.edits import (
    AddCheckpoint,
    Connect,
    Disconnect,
    Edit,
    InsertCheckpoint,
    MoveCheckpoint,
    RemoveCheckpoint,
    RenameCheckpoint,
    SetConditional,
    SetGoals,
)
from polaris_nl.model.domain import Predicate
from polaris_nl.model.formula import Goal, Literal, Variable
from polaris_nl.model.text import listed, sentence
from polaris_nl.model.wording import Wording
from polaris_nl.model.world import World
from polaris_tui.menus import Ask, Change, Menu, Note, Option, Perform, Step

MOST_LOGS = 30
"""Logs that are offered to be opened; others can be named."""

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


def steps(desk: Desk) -> dict[str, Callable[[], Step]]:
    """The first step of each action that edits the program, by the action's id."""
    return {
        "add": lambda: _add(desk),
        "insert": lambda: _insert(desk),
        "goals": lambda: _goals(desk, desk.here.goals),
        "condition": lambda: _condition(desk),
        "rename": lambda: _rename(desk),
        "delete": lambda: _delete(desk),
        "move": lambda: _move(desk),
        "connect": lambda: _connect(desk),
        "disconnect": lambda: _disconnect(desk),
    }


# Literals, by predicate and parameters


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


# The actions


def _add(desk: Desk) -> Step:
    after = desk.here

    def with_goal(goals: tuple[Goal, ...]) -> Step:
        said = sentence(desk.wording.goals(goals)) if goals else "No goal: it only waits."
        return Menu(
            f"After {after.name}: {said}",
            (
                Option("add it", lambda: _added(desk, goals, ())),
                Option("and another goal", lambda: literal_menu(
                    desk, "And what else?", lambda x: with_goal((*goals, x)))),
                Option("only once something has happened", lambda: _conditioned(desk, goals, ())),
            ),
        )  # fmt: skip

    asked = literal_menu(desk, f"What should be so after {after.name}?", lambda x: with_goal((x,)))
    wait = Option(
        "wait until something has happened",
        lambda: _conditioned(desk, (), ()),
        "no goal of its own",
    )
    return replace(asked, options=(*asked.options, wait))


def _conditioned(desk: Desk, goals: tuple[Goal, ...], when: tuple[Literal, ...]) -> Step:
    def more(literal: Literal) -> Step:
        now = (*when, literal)
        return Menu(
            f"Once {desk.wording.events(now)}:",
            (
                Option("add it", lambda: _added(desk, goals, now)),
                Option(
                    "and only if something else holds, too", lambda: _conditioned(desk, goals, now)
                ),
            ),
        )

    return literal_menu(desk, "Once what has happened?", more, people_first=True)


def _added(desk: Desk, goals: tuple[Goal, ...], when: tuple[Literal, ...]) -> Change:
    program = desk.automaton
    new = Checkpoint(program.fresh_checkpoint_id(), desk.name(goals, when, program), goals)
    way = Transition(program.fresh_transition_id(), desk.here.id, new.id, when)
    return Change(f"add {new.name}", (AddCheckpoint(new, way),), new.id)


def _insert(desk: Desk) -> Step:
    def inserted(goal: Literal) -> Step:
        program = desk.automaton
        before = program.incoming(desk.checkpoint)
        if before is None:
            return Note(f"Nothing leads to {desk.here.name} yet; connect it first.")
        new = Checkpoint(program.fresh_checkpoint_id(), desk.name((goal,), (), program), (goal,))
        edit = InsertCheckpoint(new, before.id, program.fresh_transition_id())
        return Change(f"insert {new.name}", (edit,), new.id)

    return literal_menu(desk, f"What should be so before {desk.here.name}?", inserted)


def _goals(desk: Desk, goals: tuple[Goal, ...]) -> Step:
    def done(now: tuple[Goal, ...]) -> Step:
        way = desk.automaton.incoming(desk.checkpoint)
        names = desk.renamed(desk.automaton, desk.checkpoint, now, way.when if way else ())
        edits: tuple[Edit, ...] = (SetGoals(desk.checkpoint, now), *names)
        said = desk.wording.goals(now) or "no goal"
        return Change(f"{desk.here.name}: {said}", edits, desk.checkpoint)

    def without(goal: Goal) -> tuple[Goal, ...]:
        return tuple(g for g in goals if g != goal)

    def more() -> Step:
        title = f"What else should be so at {desk.here.name}?"
        return literal_menu(desk, title, lambda x: done((*goals, x)))

    def instead_of(goal: Goal) -> Step:
        title = f"What instead of: {desk.wording.goal(goal)}?"
        return literal_menu(desk, title, lambda x: done((*without(goal), x)))

    options = [Option("add a goal", more)]
    for goal in goals:
        said = desk.wording.goal(goal)
        options += [
            Option(f"leave out: {said}", done(without(goal))),
            Option(f"something else instead of: {said}", partial(instead_of, goal)),
        ]
        if isinstance(goal, Literal):
            options.append(
                Option(
                    f"the opposite: {desk.wording.goal(goal.negation)}",
                    done((*without(goal), goal.negation)),
                )
            )
    return Menu(f"Goals of {desk.here.name}", tuple(options))


def _condition(desk: Desk) -> Step:
    way = desk.automaton.incoming(desk.checkpoint)
    if way is None:
        return Note(f"Nothing leads to {desk.here.name}; connect it first.")

    def set_to(when: tuple[Literal, ...]) -> Step:
        said = f"once {desk.wording.events(when)}" if when else "without condition"
        return Change(f"{desk.here.name} {said}", (SetConditional(way.id, when),), desk.checkpoint)

    def once(rest: tuple[Literal, ...]) -> Step:
        title = "Once what has happened?"
        return literal_menu(desk, title, lambda x: set_to((*rest, x)), people_first=True)

    more = "and something else has happened" if way.when else "once something has happened"
    options = [Option(more, partial(once, way.when))]
    for literal in way.when:
        rest = tuple(x for x in way.when if x != literal)
        said = desk.wording.event(literal)
        options.append(Option(f"something else instead of: {said}", partial(once, rest)))
        options.append(Option(f"not: {said}", set_to((*rest, literal.negation))))
        if len(way.when) > 1:
            options.append(Option(f"leave out: {said}", set_to(rest)))
    if way.when:
        others = [t for t in desk.automaton.outgoing(way.source) if t.id != way.id and t.when]
        plain = "otherwise: if nothing else applies" if others else "no condition: go on at once"
        options.append(Option(plain, set_to(())))
    return Menu(f"When {desk.here.name} is reached", tuple(options))


def _rename(desk: Desk) -> Step:
    def renamed(name: str) -> Step:
        edit = RenameCheckpoint(desk.checkpoint, name)
        return Change(f"{desk.here.name} is now {name.strip()}", (edit,), desk.checkpoint)

    return Ask(f"New name of {desk.here.name}", renamed, desk.here.name)


def _delete(desk: Desk) -> Step:
    here, program = desk.here, desk.automaton
    after = [program.checkpoints[c].name for c in program.subtree(here.id)[1:]]
    parent = program.parent(here.id) or START

    def removed(subtree: bool) -> Step:
        return Change(f"delete {here.name}", (RemoveCheckpoint(here.id, subtree),), parent)

    options = [Option(f"delete {here.name}", removed(False))]
    if after:
        options = [
            Option(f"delete {here.name} alone", removed(False), "what comes after it moves up"),
            Option(f"delete {here.name} and {listed(after)}", removed(True)),
        ]
    return Menu(f"Delete {here.name}?", (*options, Option("keep it", Note("Nothing is deleted."))))


def _move(desk: Desk) -> Step:
    here, program = desk.here, desk.automaton
    below = set(program.subtree(here.id))
    way = program.incoming(here.id)
    options = [
        Option(
            f"after {c.name}",
            Change(
                f"move {here.name} after {c.name}",
                (MoveCheckpoint(here.id, c.id, way.when if way else ()),),
                here.id,
            ),
            "as now" if way and way.source == c.id else desk.wording.goals(c.goals),
            "It is there already." if way and way.source == c.id else "",
        )
        for c in program.checkpoints.values()
        if c.id not in below
    ]
    return Menu(f"Where should {here.name} go?", tuple(options))


def _connect(desk: Desk) -> Step:
    program = desk.automaton
    loose = [
        c for c in program.checkpoints.values() if c.id != START and not program.incoming(c.id)
    ]
    options = [
        Option(
            f"from {desk.here.name} to {c.name}",
            Change(
                f"lead from {desk.here.name} to {c.name}",
                (Connect(Transition(program.fresh_transition_id(), desk.here.id, c.id)),),
                c.id,
            ),
            desk.wording.goals(c.goals),
        )
        for c in loose
        if desk.here.id not in program.subtree(c.id)
    ]
    if not options:
        return Note("No unconnected checkpoint can come after this one; m moves this one instead.")
    return Menu("Lead where?", tuple(options))


def _disconnect(desk: Desk) -> Step:
    way = desk.automaton.incoming(desk.checkpoint)
    if way is None:
        return Note(f"Nothing leads to {desk.here.name} already.")
    return Change(f"unconnect {desk.here.name}", (Disconnect(way.id),), desk.checkpoint)


def pick_menu(desk: Desk) -> Step:
    """All checkpoints, to go to one."""
    return Menu(
        "Go to which checkpoint?",
        tuple(
            Option(c.name, Perform("pick", c.id), desk.wording.goals(c.goals))
            for c in desk.automaton.checkpoints.values()
        ),
    )


def mend_menu(offers: Sequence[tuple[str, str, tuple[Edit, ...]]]) -> Step:
    """The ways out of all problems, and the changes that warnings offer.

    Args:
        offers: what it mends, what it does, and the edits.
    """
    if not offers:
        return Note("The plan has no problem that has a way out.")
    return Menu(
        "Ways out",
        tuple(Option(t, Change(t, e), about) for about, t, e in offers),
    )


def tell_menu(waiting: Sequence[Sequence[Literal]], wording: Wording) -> Step:
    """The conditionals that a run waits for."""
    return Menu(
        "What has happened?",
        tuple(
            Option(wording.events(when), Perform("tell", str(n)))
            for n, when in enumerate(waiting, 1)
        ),
    )


def log_menu(folder: Path | None) -> Step:
    """The newest logs, and any other file."""
    from polaris_nl.logs.paths import log_folder

    found = (folder or log_folder()).glob("*.mcap")
    paths = sorted(found, key=lambda p: p.name, reverse=True)[:MOST_LOGS]
    options = [Option(p.name, Perform("log", str(p))) for p in paths]
    other = Ask("Which file?", lambda x: Perform("log", x))
    return Menu("Which log?", (*options, Option("another file", other)))


def history_menu(undoable: Sequence[str], redoable: Sequence[str]) -> Step:
    """All steps of the program's history, the newest first, "you are here" among them."""
    if not undoable and not redoable:
        return Note("Nothing was changed yet.")
    options = [
        Option(f"after: {label}", Perform("redo", str(n)), f"redo {n}")
        for n, label in reversed(list(enumerate(reversed(redoable), 1)))
    ]
    here = undoable[-1] if undoable else "the beginning"
    options.append(Option(f"now: {here}", Note("You are there."), "you are here"))
    options += [
        Option(f"after: {label}", Perform("undo", str(n)), f"undo {n}")
        for n, label in enumerate(reversed(undoable[:-1]), 1)
    ]
    if undoable:
        count = len(undoable)
        options.append(Option("the beginning", Perform("undo", str(count)), f"undo {count}"))
    return Menu("Where to go back, or forward, to", tuple(options))
