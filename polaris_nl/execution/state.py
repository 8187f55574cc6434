"""What the executor is given and what it remembers: values only."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal as OneOf

from polaris_nl.automaton.automaton import START, Automaton
from polaris_nl.execution.backend import Observation, Report
from polaris_nl.execution.settings import RunSettings
from polaris_nl.model.formula import Literal
from polaris_nl.model.wording import Wording
from polaris_nl.model.world import World
from polaris_nl.planning.result import BranchingPlan

Phase = OneOf[
    "idle", "sending", "pursuing", "confirming", "waiting", "deviating", "paused", "halted", "done"
]
TERMINAL: tuple[Phase, ...] = ("halted", "done")


@dataclass(frozen=True, slots=True)
class HumanCommand:
    """What a person tells the run: `stop`, `pause`, `resume`, or `happened` with literals."""

    kind: OneOf["stop", "pause", "resume", "happened"]
    literals: tuple[Literal, ...] = ()
    source: str = "keyboard"


@dataclass(frozen=True, slots=True)
class Inputs:
    """What a step sees."""

    observation: Observation
    reports: tuple[Report, ...] = ()
    commands: tuple[HumanCommand, ...] = ()


@dataclass(frozen=True)
class RunPlan:
    """What is carried out, and how: constant during a run."""

    automaton: Automaton
    plan: BranchingPlan
    world: World
    wording: Wording
    settings: RunSettings = RunSettings()


@dataclass(frozen=True, slots=True)
class ExecutorState:
    """All that the executor remembers.

    Attributes:
        checkpoint: the last one reached.
        segment: the checkpoint that is aimed for, or "".
        done_actions: the actions of the segment that are done.
        goal: the number of the current goal; numbers are never used twice.
        since: when the phase began.
        holding_since: since when what is waited for has been perceived, or None.
        held: the transition that `holding_since` is about.
        reported_at: when the robot reported success, or None.
        told: literals of conditionals that a person said came true.
        expected: what a deviation misses.
    """

    phase: Phase = "idle"
    checkpoint: str = START
    segment: str = ""
    done_actions: int = 0
    goal: int = 0
    goal_literals: tuple[Literal, ...] = ()
    since: float = 0.0
    holding_since: float | None = None
    held: str = ""
    reported_at: float | None = None
    retries: int = 0
    told: frozenset[Literal] = frozenset()
    expected: tuple[Literal, ...] = ()
    reached: tuple[str, ...] = ()
    sent_at: float = 0.0
