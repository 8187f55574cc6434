"""Editing by keys: what each action asks, down to the edits that come of it. Pure functions."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial

from polaris_nl.automaton.automaton import START, Checkpoint, Transition
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
from polaris_nl.model.formula import Goal, Literal
from polaris_nl.model.text import listed, sentence
from polaris_tui.desk import Desk, literal_menu
from polaris_tui.menus import Ask, Change, Menu, Note, Option, Step


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
