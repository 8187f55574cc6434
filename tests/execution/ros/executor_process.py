"""An executor in a process of its own, so that it can be killed: prints its events, a line each."""

from __future__ import annotations

import json
import sys
from dataclasses import asdict, replace
from pathlib import Path

from polaris_nl.automaton.automaton import START, Automaton, Checkpoint, Transition
from polaris_nl.execution.clock import RealClock
from polaris_nl.execution.events import Event
from polaris_nl.execution.ros.profile import profile_for
from polaris_nl.execution.settings import RunSettings
from polaris_nl.model.formula import parse_formula
from polaris_nl.model.world_file import load_world
from polaris_nl.robot_runs import connection
from polaris_nl.runs import RunOrder, resumable, run_on
from polaris_nl.session import Session


def show(event: Event) -> None:
    print(json.dumps({"topic": event.topic, "event": asdict(event)}), flush=True)


def main() -> None:
    given = json.loads(sys.argv[1])
    automaton = Automaton()
    for name, label, goals in given["checkpoints"]:
        if name != START:
            automaton = automaton.with_checkpoint(
                Checkpoint(name, label, tuple(map(parse_formula, goals)))
            )
    for name, source, target, when in given["transitions"]:
        conditional = tuple(map(parse_formula, when))
        automaton = automaton.with_transition(Transition(name, source, target, conditional))
    with Session(load_world(given["world"])) as session:
        planner = session.planner
        plan = planner.compile(automaton)
        settings = replace(RunSettings(), **given["settings"])
        order = RunOrder(automaton, plan, planner, settings=settings, log=Path(given["log"]))
        if given["resume"]:
            order = replace(
                order, resume=resumable(Path(given["resume"]), automaton, plan, planner)
            )
        clock = RealClock()
        profile = profile_for("stretch-sim")
        safety = replace(profile.safety, heartbeat_s=given["heartbeat_s"])
        connect = connection(replace(profile, safety=safety), order, clock)
        run_on(connect, clock, order, confirmed=True, show=show)


if __name__ == "__main__":
    main()
