"""How patient a run is."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class RunSettings:
    """Times of a run, in seconds.

    Attributes:
        confirm_s: how long a goal's literals must be perceived before it counts as done.
        condition_s: how long a conditional must be perceived before its transition is taken.
        accept_s: how long the robot may take to accept a goal.
        goal_s: how long the robot may pursue one goal.
        report_s: how long after the robot reports success its effect may take to be perceived.
        grace_s: how long a deviation may last before the run halts.
        wait_s: how long to wait for a conditional before the run halts; None waits for ever.
        retries: how often a goal that the robot gave up is sent again.
        tick_s: how often the executor looks.
    """

    confirm_s: float = 0.3
    condition_s: float = 0.3
    accept_s: float = 2.0
    goal_s: float = 120.0
    report_s: float = 3.0
    grace_s: float = 8.0
    wait_s: float | None = 600.0
    retries: int = 2
    tick_s: float = 0.1
