"""A logged run carried out once more: what a log holds, put together for the executor's core."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from polaris_nl.automaton.program import program_of
from polaris_nl.execution.events import Event, RunStarted
from polaris_nl.execution.replaying import Difference, first_difference, plan_of, replay
from polaris_nl.execution.settings import RunSettings
from polaris_nl.execution.state import RunPlan
from polaris_nl.logs.reader import Log, read_log
from polaris_nl.logs.runs_in import runs_in
from polaris_nl.model.errors import LogError, PolarisError
from polaris_nl.model.wording import PlainWording, Wording
from polaris_nl.model.world import World
from polaris_nl.model.world_file import world_of_texts


@dataclass(frozen=True, slots=True)
class Replayed:
    """A run of a log beside its replay.

    Attributes:
        started: its first event.
        decisions: what the replay decided.
        difference: where the replay went another way first, or None.
    """

    started: RunStarted
    decisions: tuple[Event, ...]
    difference: Difference | None


def world_of(log: Log) -> World:
    """The world that a log holds.

    Raises:
        LogError: it holds none, or one that can't be read.
    """
    try:
        return world_of_texts(log.attachments["world.yaml"], log.attachments["domain.pddl"])
    except KeyError as error:
        raise LogError(f"{log.path} holds no {error.args[0]}; take the log of a run.") from error
    except PolarisError as error:
        raise LogError(f"The world in {log.path} can't be read: {error}") from error


def replayed(path: Path, wording: Wording | None = None) -> list[Replayed]:
    """Replays all runs of a log.

    Args:
        path: the log.
        wording: for the sentences of the replay; plain wording by default. Decisions don't depend
            on it.

    Raises:
        LogError: the file can't be read, or lacks what a replay needs.
    """
    log = read_log(path, inputs=True)
    runs = runs_in(log.events)
    if not runs:
        raise LogError(f"{path} holds no run to replay; take the log of a run.")
    world = world_of(log)
    return [_of_run(log, run, world, wording or PlainWording(world)) for run in runs]


def _of_run(log: Log, events: Sequence[Event], world: World, wording: Wording) -> Replayed:
    started = events[0]
    assert isinstance(started, RunStarted)
    try:
        automaton = program_of(started.program).automaton
        plan = plan_of(started.segments, automaton)
        run = RunPlan(automaton, plan, world, wording, settings_of(log))
        last = events[-1].time
        steps = [s for s in log.inputs if started.time <= s.time <= last]
        decisions = replay(run, started, steps)
    except (PolarisError, KeyError, TypeError, ValueError) as error:
        raise LogError(f"The run in {log.path} can't be replayed: {error}.") from error
    if not steps:
        raise LogError(
            f"{log.path} doesn't hold what the robot perceived step by step, so it can't be replayed;"
            " take a log of this version."
        )
    return Replayed(started, tuple(decisions), first_difference(events, decisions))


def settings_of(log: Log) -> RunSettings:
    """The settings of a log's run; the usual ones where it holds none."""
    text = log.attachments.get("settings.json")
    values = json.loads(text).get("run", {}) if text else {}
    known = {k: v for k, v in values.items() if k in RunSettings.__dataclass_fields__}
    return RunSettings(**known)
