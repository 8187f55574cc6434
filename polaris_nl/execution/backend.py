"""What a robot looks like to the executor."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal as OneOf
from typing import Protocol

from polaris_nl.model.domain import Action
from polaris_nl.model.formula import Literal
from polaris_nl.model.state import State

ReportKind = OneOf["accepted", "rejected", "succeeded", "failed", "cancelled"]


@dataclass(frozen=True, slots=True)
class Report:
    """What the robot says about a goal. It is never believed alone."""

    goal: int
    kind: ReportKind
    reason: str = ""


@dataclass(frozen=True, slots=True)
class SendGoal:
    """Ask the robot to make literals true: the effects of `action`, by whatever way it finds."""

    goal: int
    action: Action
    literals: tuple[Literal, ...]


@dataclass(frozen=True, slots=True)
class CancelGoal:
    """Ask the robot to give a goal up."""

    goal: int


@dataclass(frozen=True, slots=True)
class StopRobot:
    """Stop all motion, now."""


Command = SendGoal | CancelGoal | StopRobot


@dataclass(frozen=True, slots=True)
class Observation:
    """What is perceived.

    Attributes:
        state: the facts that are perceived to hold; what is neither here nor unknown is false.
        unknown: atoms about which nothing is known just now (out of sight, too old); never taken for false.
    """

    state: State
    unknown: frozenset[Literal] = frozenset()

    def holds(self, literal: Literal) -> bool:
        """Whether a literal is known to be true."""
        return literal.atom not in self.unknown and self.state.holds(literal)


class Robot(Protocol):
    """A robot, or its stand-in."""

    name: str

    def advance(self, now: float) -> None:
        """Lets time pass until `now` (simulations act here)."""
        ...

    def command(self, command: Command) -> None:
        """Gives a command; returns at once."""
        ...

    def observe(self) -> Observation:
        """What is perceived now."""
        ...

    def reports(self) -> Sequence[Report]:
        """The reports since the last call."""
        ...

    def close(self) -> None:
        """Lets the robot go; it stands still."""
        ...
