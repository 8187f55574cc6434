"""`score`: how good a program is by its scenario, and how a logged run of it went."""

from __future__ import annotations

import json
import tempfile
from argparse import Namespace
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from polaris_nl.automaton.automaton import Automaton
from polaris_nl.automaton.program import program_of, read_program
from polaris_nl.commands.common import print_json, print_text, world_for
from polaris_nl.execution.runner import objectives_met
from polaris_nl.logs.reader import Log, read_log
from polaris_nl.logs.review import summary
from polaris_nl.model.errors import FormatError, LogError, RunError
from polaris_nl.model.text import listed
from polaris_nl.model.wording import Wording
from polaris_nl.model.world import Objective, World
from polaris_nl.model.world_file import load_world, world_of_texts
from polaris_nl.planning.planner import Planner
from polaris_nl.planning.result import BranchingPlan
from polaris_nl.render.glyphs import plain
from polaris_nl.runs import RunOrder, run_simulated
from polaris_nl.scoring.score import Score, runtime_score, score
from polaris_nl.scoring.search import Best, Done
from polaris_nl.session import Session

LOG = ".mcap"
UNSETTLED = (
    "There are too many ways for people to act to look at all of them, so more objectives may be "
    "within reach, or fewer human actions enough."
)


@dataclass(frozen=True, slots=True)
class _Run:
    """A run that is scored: which objectives were met at its end, and how it ended."""

    met: tuple[tuple[Objective, bool], ...]
    outcome: str
    reason: str


def run(arguments: Namespace) -> int:
    """Scores a program, with one simulated run of it, or a log; 1 where the run missed an objective."""
    log = read_log(arguments.program) if arguments.program.suffix == LOG else None
    automaton, world = _of_log(log, arguments) if log else _of_program(arguments)
    if not world.scenario.objectives:
        raise RunError(
            f"The world {world.name} has no objectives to count; add a scenario with objectives to its file."
        )
    with Session(world, automaton) as session:
        planner = session.planner
        plan = planner.compile(automaton)
        done = _logged(log, world) if log else _simulated(automaton, plan, planner)
        found = score(automaton, plan, planner)
        if arguments.json:
            print_json({**_as_json(done, found), **({"log": str(log.path)} if log else {})})
        else:
            _print(done, found, planner.wording, automaton, plain(log.path.name) if log else "")
    return 0 if all(ok for _, ok in done.met) else 1


def _of_program(arguments: Namespace) -> tuple[Automaton, World]:
    program = read_program(arguments.program)
    return program.automaton, world_for(arguments.world, program, arguments.program)


def _of_log(log: Log, arguments: Namespace) -> tuple[Automaton, World]:
    """The program and the world that a log holds; another world where one is named."""
    texts = log.attachments
    try:
        program = program_of(json.loads(texts["program.polaris.json"]))
        if arguments.world is not None:
            return program.automaton, load_world(arguments.world)
        return program.automaton, world_of_texts(texts["world.yaml"], texts["domain.pddl"])
    except KeyError as error:
        raise LogError(
            f"{log.path} holds no {error.args[0]}, so it can't be scored; take the log of a run."
        ) from error
    except (FormatError, ValueError) as error:
        raise LogError(f"What {log.path} holds can't be read: {error}") from error


def _simulated(automaton: Automaton, plan: BranchingPlan, planner: Planner) -> _Run:
    with tempfile.TemporaryDirectory() as folder:
        order = RunOrder(automaton, plan, planner, log=Path(folder) / f"score{LOG}")
        result = run_simulated(order, confirmed=True).result
    return _Run(objectives_met(planner.world, result.beliefs), result.outcome, result.reason)


def _logged(log: Log, world: World) -> _Run:
    met = runtime_score(log.events, world)
    if met is None:
        raise LogError(f"{log.path} holds no run to score; take the log of a run.")
    short = summary(log.events)
    return _Run(met, short.outcome or "cut off", short.reason)


def _as_json(done: _Run, found: Score) -> dict[str, Any]:
    feasible, least = found.feasible, found.least
    settled = feasible.settled and least.settled
    effort = found.human_effort
    return {
        "objectives": [
            {"name": o.name, "goal": str(o.goal), "met": ok, "feasible": could}
            for (o, ok), could in zip(done.met, feasible.met, strict=True)
        ],
        "met": sum(ok for _, ok in done.met),
        "of": len(done.met),
        "outcome": done.outcome,
        "reason": done.reason,
        "feasibility": feasible.count,
        "feasibility_actions": [_done_json(d) for d in feasible.chosen],
        "human_effort": effort,
        "effort_actions": [] if effort is None else [_done_json(d) for d in least.chosen],
        "settled": settled,
        "note": "" if settled else UNSETTLED,
    }


def _done_json(done: Done) -> dict[str, Any]:
    return {
        "name": done.act.name,
        "effect": [str(x) for x in done.act.effect],
        "by_hand": done.act.by_hand,
        "checkpoint": done.checkpoint,
        "step": done.step,
        "during": None if done.during is None else str(done.during),
    }


def _print(done: _Run, found: Score, wording: Wording, automaton: Automaton, log: str) -> None:
    count, of = sum(ok for _, ok in done.met), len(done.met)
    print("could  was met")
    for (objective, met), could in zip(done.met, found.feasible.met, strict=True):
        print(f"{_yes(could):<7}{_yes(met):<5}{plain(objective.name)}")
    least = "" if found.feasible.settled else "at least "
    by = _by(found.feasible, wording, automaton)
    print_text(
        f"{least}{found.feasible.count} of {of} objectives could be met{by}", "Feasibility: "
    )
    print_text(_effort(found, wording, automaton), "Human effort: ")
    where = f"the run of {log}" if log else "a simulated run"
    print_text(f"{count} of {of} were met in {where}. {plain(done.reason)}", "Runtime: ")
    if not (found.feasible.settled and found.least.settled):
        print_text(UNSETTLED)


def _yes(ok: bool) -> str:
    return "yes" if ok else "no"


def _effort(found: Score, wording: Wording, automaton: Automaton) -> str:
    effort = found.human_effort
    if effort is not None:
        actions = f"{effort or 'no'} human action{'' if effort == 1 else 's'}"
        same = effort and found.least.chosen == found.feasible.chosen
        by = ", the same." if same else _by(found.least, wording, automaton)
        return f"{actions} at the least for all objectives{by}"
    if not found.least.settled:
        return (
            f"more than {found.least.tried} human actions for all objectives, if they can be met."
        )
    return "whatever people do, this program doesn't lead to all objectives."


def _by(best: Best, wording: Wording, automaton: Automaton) -> str:
    """The end of a sentence: what people do for it, each thing with its moment."""
    texts = []
    for done in best.chosen:
        name = done.act.name
        if done.act.by_hand:
            name = f"see to it that {wording.fact(done.act.effect[0])}"
        if done.during is None:
            moment = f'while I wait at "{automaton.checkpoints[done.checkpoint].name}"'
        else:
            moment = f"while I {wording.action(done.during)}"
        texts.append(plain(f"{name} ({moment})"))
    return f", if people {listed(texts)}." if texts else "."
