"""`score`: what a program achieves of its scenario's objectives, with simulated people."""

from __future__ import annotations

import tempfile
from argparse import Namespace
from pathlib import Path

from polaris_nl.commands.common import opened, print_json, print_text
from polaris_nl.execution.runner import objectives_met
from polaris_nl.model.errors import RunError
from polaris_nl.runs import RunOrder, run_simulated
from polaris_nl.session import Session

LATER = (
    "This counts the objectives of one simulated run; the paper's feasibility score and human effort come in a "
    "later version."
)


def run(arguments: Namespace) -> int:
    """Runs the program in the simulated world and counts objectives; 1 where one is missed."""
    program, world = opened(arguments)
    if not world.scenario.objectives:
        raise RunError(
            f"The world {world.name} has no objectives to count; add a scenario with objectives to its file."
        )
    with Session(world, program.automaton) as session, tempfile.TemporaryDirectory() as folder:
        plan = session.planner.compile(program.automaton)
        order = RunOrder(program.automaton, plan, session.planner, log=Path(folder) / "score.mcap")
        report = run_simulated(order, confirmed=True)
    met = objectives_met(world, report.result.beliefs)
    count = sum(ok for _, ok in met)
    if arguments.json:
        rows = [{"name": o.name, "met": ok} for o, ok in met]
        value = {"objectives": rows, "met": count, "of": len(met), "outcome": report.result.outcome}
        print_json({**value, "reason": report.result.reason, "feasibility": None, "note": LATER})
    else:
        for objective, ok in met:
            print(f"{'yes' if ok else 'no ':<4}{objective.name}")
        print_text(f"{count} of {len(met)} objectives. {report.result.reason}")
        print_text(LATER)
    return 0 if count == len(met) else 1
