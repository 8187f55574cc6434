"""`plan`: the branching plan of a program, and its explanation."""

from __future__ import annotations

from argparse import Namespace

from polaris_nl.automaton.automaton import Automaton
from polaris_nl.commands.common import opened, print_json, print_rows, print_text, width
from polaris_nl.model.wording import Wording
from polaris_nl.planning.plan_json import plan_json
from polaris_nl.planning.result import BranchingPlan
from polaris_nl.render.explanation import branches_in_words, problem_rows
from polaris_nl.render.glyphs import glyphs_for
from polaris_nl.render.program import program_rows
from polaris_nl.session import Session


def run(arguments: Namespace) -> int:
    """Plans a program file; 1 where any of it has no plan."""
    program, world = opened(arguments)
    with Session(world, program.automaton) as session:
        plan = session.planner.compile(program.automaton)
        if arguments.json:
            print_json(plan_json(plan, program.automaton))
        else:
            show(program.automaton, plan, session.wording)
    return 0 if plan.status == "ok" else 1


def show(automaton: Automaton, plan: BranchingPlan, wording: Wording) -> None:
    """The outline with actions, each branch in words, then problems and warnings."""
    print_rows(program_rows(automaton, plan, wording, glyphs_for(), width(), actions=True))
    if plan.segments:
        print()
        for text in branches_in_words(automaton, plan, wording):
            print_text(text)
    rows = problem_rows(plan, automaton, width())
    if rows:
        print()
        print_rows(rows)
