"""What a robot looks like to the executor: the protocol that every back end implements.

Facts are perceived, never assumed: an `Observation` says what is seen to hold, what is unknown just
now, when and by what each fact was last seen, how the robot itself is, and whether it moves.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Literal as OneOf
from typing import Protocol

from polaris_nl.model.domain import Action
from polaris_nl.model.formula import Literal
from polaris_nl.model.state import State

ReportKind = OneOf["accepted", "rejected", "succeeded", "failed", "cancelled", "replanned"]


@dataclass(frozen=True, slots=True)
class Report:
    """What the robot says about a goal. It is never believed alone.

    Attributes:
        goal: the number that the goal was sent with.
        kind: `replanned` says that the robot goes another way to the goal than it meant to before.
        reason: a clause for a person, in lower case and without full stop, to go after "because".
        before, after: for `replanned`, the actions that were left of the old way, and the new way.
    """

    goal: int
    kind: ReportKind
    reason: str = ""
    before: tuple[Action, ...] = ()
    after: tuple[Action, ...] = ()


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
class ZeroVelocity:
    """Command a velocity of zero to the base and all joints, and keep to it until the next goal."""


@dataclass(frozen=True, slots=True)
class StopRobot:
    """Stop all motion, now, by the robot's own way of stopping; goals in progress are given up."""


@dataclass(frozen=True, slots=True)
class RunStop:
    """The last resort: the robot's run-stop. Only a person lets it go again."""


Command = SendGoal | CancelGoal | ZeroVelocity | StopRobot | RunStop

HALTING = (CancelGoal, ZeroVelocity, StopRobot, RunStop)
"""The commands that end motion; all others may begin it."""

HealthKind = OneOf[
    "ready",
    "silent",  # no heartbeat: the driver is dead or frozen, or the network is gone
    "runstopped",
    "unhomed",
    "battery",
    "mode",  # it is in a mode in which it can't be commanded, and can't be brought out of it
    "duplicate",  # two servers answer on one name
    "clock",  # its clock jumped, so that the age of what is seen is not known
    "fault",  # whatever else a back end finds; `text` says what
]

HEALTH_WORDS: Mapping[HealthKind, str] = MappingProxyType(
    {
        "ready": "the robot is ready",
        "silent": "the robot has gone silent; see whether it is switched on and in reach",
        "runstopped": "the robot's run-stop button is pressed; release it when all is safe",
        "unhomed": "the robot doesn't know the position of its arm yet; home it first",
        "battery": "the robot's battery is low; charge it first",
        "mode": "the robot is in a mode in which it takes no commands; switch it back first",
        "duplicate": "two programs speak for the robot at once; end one of them",
        "clock": "the robot's clock jumped, so that I can't tell how old is what it sees",
        "fault": "the robot reports a fault",
    }
)


@dataclass(frozen=True, slots=True)
class Health:
    """How the robot itself is. Anything but `ready` keeps a run from starting, and halts one at once.

    Back ends debounce: they report a problem when they are sure of it (a heartbeat is missing for
    more than 0.5 s), and the executor reacts in the same step.

    Attributes:
        kind: what is the matter.
        text: a clause for a person, in lower case and without full stop; the usual one where empty.
    """

    kind: HealthKind = "ready"
    text: str = ""

    @property
    def ready(self) -> bool:
        """Whether goals can be sent."""
        return self.kind == "ready"

    @property
    def words(self) -> str:
        """What is the matter, as a clause with a way out."""
        return self.text or HEALTH_WORDS[self.kind]


READY = Health()


@dataclass(frozen=True, slots=True)
class Sighting:
    """When and by what the truth of an atom was last perceived.

    Attributes:
        at: the run's time, in seconds.
        source: such as `camera`, `odometry`, `speech`, `gripper`, or `assumed` (the world file).
    """

    at: float
    source: str


@dataclass(frozen=True, slots=True)
class Observation:
    """What is perceived.

    Attributes:
        state: the facts that are believed to hold, stale ones included; of an atom that is neither
            here nor unknown it is believed that it is false.
        unknown: atoms about which nothing is known just now (out of sight for too long, contradicted,
            never seen); never taken for true or for false. `state` may still hold the last belief.
        blind: predicates about whose atoms nothing at all is known just now, such as all that a
            camera sees, when it has failed.
        seen: when and by what atoms were last seen to be true or false; back ends that see
            everything all the time may leave it out.
        health: how the robot is.
        moving: whether it moves, by odometry and joint velocities (not by what was commanded); None
            where that isn't known.
    """

    state: State
    unknown: frozenset[Literal] = frozenset()
    blind: frozenset[str] = frozenset()
    seen: Mapping[Literal, Sighting] = field(default_factory=dict, compare=False)
    health: Health = READY
    moving: bool | None = False

    def knows(self, literal: Literal) -> bool:
        """Whether it is known if a literal is true or false."""
        return literal.predicate not in self.blind and literal.atom not in self.unknown

    def holds(self, literal: Literal) -> bool:
        """Whether a literal is known to be true."""
        return self.knows(literal) and self.state.holds(literal)

    @property
    def certain(self) -> frozenset[Literal]:
        """The facts that are known to hold."""
        certain = self.state.facts - self.unknown
        if self.blind:
            certain = frozenset(x for x in certain if x.predicate not in self.blind)
        return certain


class Robot(Protocol):
    """A robot, or its stand-in.

    The runner calls `missing` and `observe` before the run, then at each tick `advance`, `observe`,
    `reports`, and `command` for what the executor decides, and `close` never: that is for whoever
    made the robot. All calls come from one thread and are to return within a few milliseconds;
    what takes longer is done elsewhere and reported.

    A goal is answered with `accepted` or `rejected`, then at most one of `succeeded`, `failed` and
    `cancelled`. A back end plans its own way to the goal's literals from what is perceived
    (`polaris_nl.execution.goals`), and sends nothing to the hardware when its health isn't `ready`.
    """

    name: str

    def missing(self, actions: Iterable[Action]) -> tuple[str, ...]:
        """The operators among some actions that it has no skill for, each once, in their order."""
        ...

    def advance(self, now: float) -> None:
        """Lets time pass until `now` (simulations act here, real back ends take their messages in)."""
        ...

    def command(self, command: Command) -> None:
        """Gives a command; returns at once."""
        ...

    def observe(self) -> Observation:
        """What is perceived now."""
        ...

    def reports(self) -> Sequence[Report]:
        """The reports since the last call, in the order in which they came."""
        ...

    def close(self) -> None:
        """Lets the robot go; it stands still."""
        ...
