"""How the simulated world behaves."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from polaris_nl.execution.goals import GoalLimits
from polaris_nl.model.domain import Action


@dataclass(frozen=True, slots=True)
class SimulationSettings:
    """How the simulated world behaves.

    Attributes:
        action_s: how long an action takes, by operator; `default` for the others.
        human_s: the shortest and longest time that a person takes to act, in seconds.
        people: names of human actions that people prefer, or None for whatever the world lists
            first.
        seed: makes the same run again.
        unable: operators that the robot has no skill for.
        limits: how far the robot goes by itself for one goal.
    """

    action_s: Mapping[str, float] = field(default_factory=lambda: {"default": 2.0, "move": 4.0})
    human_s: tuple[float, float] = (1.0, 3.0)
    people: tuple[str, ...] | None = None
    seed: int = 0
    unable: tuple[str, ...] = ()
    limits: GoalLimits = field(default_factory=GoalLimits)

    def duration(self, action: Action | None) -> float:
        """How long an action takes, in seconds."""
        default = self.action_s.get("default", 1.0)
        return self.action_s.get(action.operator, default) if action else default
