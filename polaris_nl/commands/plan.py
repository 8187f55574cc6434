"""`plan`: the branching plan of a program, in the form that is asked for."""

from __future__ import annotations

from argparse import Namespace
from collections.abc import Mapping
from typing import Any

from polaris_nl.automaton.automaton import START, Automaton
from polaris_nl.commands.common import opened, print_json, print_rows, print_text, width
from polaris_nl.model.errors import UsageError, did_you_mean
from polaris_nl.model.state import State
from polaris_nl.model.text import sentence
from polaris_nl.model.wording import Wording
from polaris_nl.planning.branch import only_branch
from polaris_nl.planning.plan_json import plan_json
from polaris_nl.planning.reasons import Reasons
from polaris_nl.planning.result import BranchingPlan
from polaris_nl.render.explanation import branches_in_words, problem_rows
from polaris_nl.render.forms import (
    case_in_words,
    full_rows,
    short_rows,
    state_in_words,
    state_rows_after,
)
from polaris_nl.render.glyphs import glyphs_for
from polaris_nl.render.program import first_numbers, numbered, program_rows
from polaris_nl.session import Session


def run(arguments: Namespace) -> int:
    """Plans a program file; 1 where any of it has no plan."""
    program, world = opened(arguments)
    automaton = program.automaton
    with Session(world, automaton) as session:
        plan = session.planner.compile(automaton)
        if arguments.state is not None:
            _show_state(arguments.state, arguments.json, automaton, plan, session)
            return 0
        numbers = first_numbers(plan)
        case = ""
        if arguments.branch is not None:
            checkpoint = checkpoint_of(arguments.branch, automaton)
            case = case_in_words(automaton, checkpoint, session.wording)
            automaton, plan = only_branch(automaton, plan, checkpoint, world)
        if arguments.json:
            print_json(plan_json(plan, automaton))
        else:
            if case:
                print_text(sentence(f"this happens {case}"))
            _show(arguments, automaton, plan, numbers, session)
    return 1 if plan.problems or plan.status not in ("ok", "partial") else 0


def _show(
    arguments: Namespace,
    automaton: Automaton,
    plan: BranchingPlan,
    numbers: Mapping[str, int],
    session: Session,
) -> None:
    if arguments.short:
        print_rows(short_rows(automaton, plan, session.wording, width()))
    elif arguments.full:
        reasons = Reasons(plan, automaton, session.world)
        mutexes = session.planner.mutexes
        print_rows(full_rows(reasons, session.wording, mutexes, width(), numbers))
        print_rows(problem_rows(plan, automaton, width()))
    else:
        show(automaton, plan, session.wording, numbers)


def show(
    automaton: Automaton,
    plan: BranchingPlan,
    wording: Wording,
    numbers: Mapping[str, int] | None = None,
) -> None:
    """The outline with actions, each branch in words, then problems and warnings."""
    rows = program_rows(automaton, plan, wording, glyphs_for(), width(), True, numbers)
    print_rows(rows)
    if plan.segments:
        print()
        for text in branches_in_words(automaton, plan, wording):
            print_text(text)
    rows = problem_rows(plan, automaton, width())
    if rows:
        print()
        print_rows(rows)


def _show_state(
    number: int, as_json: bool, automaton: Automaton, plan: BranchingPlan, session: Session
) -> None:
    """The state after an action of the plan; 0 is the start.

    Raises:
        UsageError: there is no such action.
    """
    world, wording, mutexes = session.world, session.wording, session.planner.mutexes
    action, state, title = "", world.initial, "At the start:"
    if number != 0:
        found = numbered(plan, number)
        if found is None:
            raise UsageError(
                f"There is no action {number}; the plan has {plan.action_count}, and 0 is the start. "
                "See them with: polaris-nl plan"
            )
        checkpoint, at = found
        done = plan.segments[checkpoint].actions[at]
        action = str(done)
        state = Reasons(plan, automaton, world).states[checkpoint][at + 1]
        case = case_in_words(automaton, checkpoint, wording)
        title = f"After action {number}, {wording.action(done)}{f' ({case})' if case else ''}:"
    if as_json:
        print_json(_state_json(number, action or None, state, session))
    else:
        print_rows(state_rows_after(title, state, world, wording, mutexes, width()))


def _state_json(number: int, action: str | None, state: State, session: Session) -> dict[str, Any]:
    removed, added = session.world.initial.difference(state)
    mutexes = session.planner.mutexes
    changed, same = state_in_words(state, session.world, session.wording, mutexes)
    return {
        "number": number,
        "action": action,
        "facts": [str(x) for x in sorted(state.facts)],
        "added": [str(x) for x in added],
        "removed": [str(x) for x in removed],
        "changed": changed,
        "same": same,
    }


def checkpoint_of(name: str, automaton: Automaton) -> str:
    """The id of the checkpoint of a name or an id.

    Raises:
        UsageError: there is none.
    """
    names = {c.name: c.id for c in automaton.checkpoints.values()}
    found = names.get(name, name)
    if found not in automaton.checkpoints:
        known = [n for n, c in names.items() if c != START]
        raise UsageError(f"There is no checkpoint {name}.{did_you_mean(name, known)}")
    return found
