"""How patient a run is."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class RunSettings:
    """Times of a run, in seconds, and budgets. docs/execution.md shows which state has which deadline.

    Attributes:
        confirm_s: how long a goal's literals must be perceived before it counts as done.
        condition_s: how long a conditional must be perceived before its transition is taken.
        accept_s: how long the robot may take to accept a goal.
        goal_s: how long the robot may pursue one goal.
        report_s: how long after the robot reports success its effect may take to be perceived.
        grace_s: how long a deviation may last before the run halts.
        wait_s: how long to wait for a conditional before the run halts; None waits for ever.
        pause_s: how long a pause may last before the run halts; None allows any.
        halt_s: how long the robot may take to stand still before its run-stop is used, and how long
            after that until the run ends anyway.
        settle_s: how long a deviation must stay the same before the way is planned anew.
        plan_s: how long planning the rest of a segment anew may take.
        retries: how often a goal that the robot gave up is sent again.
        replans: how often the rest of one segment may be planned anew.
        deviations: how often things may be out of place on the way to one checkpoint.
        tick_s: how often the executor looks.
    """

    confirm_s: float = 0.3
    condition_s: float = 0.3
    accept_s: float = 2.0
    goal_s: float = 120.0
    report_s: float = 3.0
    grace_s: float = 8.0
    wait_s: float | None = 600.0
    pause_s: float | None = 3600.0
    halt_s: float = 0.5
    settle_s: float = 1.0
    plan_s: float = 2.0
    retries: int = 2
    replans: int = 5
    deviations: int = 20
    tick_s: float = 0.1
