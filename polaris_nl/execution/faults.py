"""What can go wrong, as values: the same faults in the simulated world and on other back ends."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal as OneOf
from typing import get_args

from polaris_nl.execution.backend import Health, HealthKind
from polaris_nl.model.formula import Literal

FaultKind = OneOf[
    # The driver
    "vanish",  # it dies in the middle of whatever it does (SIGKILL)
    "freeze",  # it hangs for `seconds` and goes on then (SIGSTOP, SIGCONT)
    "mute",  # goals are neither accepted nor pursued, and nothing is said
    # Goals: for the next `times` of them
    "reject",
    "never",  # it is accepted and never ends
    "lie",  # success is reported, and nothing was done
    "fail",
    "late",  # it fails, and success is reported of it when it is over
    "ignore-cancel",  # the next `times` requests to cancel
    "slow-stop",  # from then on, cancelling and stopping take `seconds`
    "runaway",  # only the run-stop ends motion
    # The robot: for `seconds`, 0 = from then on
    "runstopped",
    "unhomed",
    "battery",
    "mode",
    "duplicate",
    "clock",
    # The world
    "event",  # somebody makes `literals` true: moves, removes, adds, puts right, helps
    # Perception
    "blind",  # nothing is seen for `seconds`
    "stale",  # what is seen arrives with old stamps for `seconds`
    "flicker",  # `literals` are seen to be true and false by turns for `seconds`
    "blink",  # `literals` are seen to be true for one tick
    "contradict",  # `literals` are seen to be true beside what they exclude, for `seconds`
]
FAULT_KINDS: tuple[FaultKind, ...] = get_args(FaultKind)
HEALTH_FAULTS: frozenset[str] = frozenset(get_args(HealthKind)) - {"ready", "silent", "fault"}
GOAL_FAULTS = frozenset({"mute", "reject", "never", "lie", "fail", "late", "ignore-cancel"})


@dataclass(frozen=True, slots=True)
class Fault:
    """Something that goes wrong at a time.

    Attributes:
        at: seconds after the start.
        kind: what.
        times: for how many goals or requests.
        seconds: for how long.
        literals: what it is about.
    """

    at: float
    kind: FaultKind
    times: int = 1
    seconds: float = 0.0
    literals: tuple[Literal, ...] = ()


class Troubles:
    """The faults that are due, and those that last, as time goes by.

    Args:
        faults: what will go wrong, counted from the start.
        start: the time of the start, in seconds.
    """

    def __init__(self, faults: Iterable[Fault], start: float) -> None:
        self._start = start
        self._waiting = sorted(faults, key=lambda f: f.at)
        self._lasting: list[tuple[float, Fault]] = []
        self._left: dict[str, int] = {}
        self._health: list[Health] = []

    def add(self, fault: Fault) -> None:
        """Adds a fault while time goes by; `at` counts from the start."""
        self._waiting = sorted([*self._waiting, fault], key=lambda f: f.at)

    def strike(self, now: float) -> list[Fault]:
        """The faults that are due now, each once."""
        due = [f for f in self._waiting if self._start + f.at <= now]
        self._waiting = self._waiting[len(due) :]
        for fault in due:
            if fault.kind in GOAL_FAULTS:
                self._left[fault.kind] = self._left.get(fault.kind, 0) + fault.times
            elif fault.kind != "event":
                forever = fault.kind == "slow-stop" or (
                    fault.seconds <= 0.0 and fault.kind != "blink"
                )
                until = float("inf") if forever else now + fault.seconds
                self._lasting.append((until, fault))
        self._lasting = [(until, f) for until, f in self._lasting if now < until or f in due]
        return due

    def take(self, kind: FaultKind) -> bool:
        """Whether the next goal or request suffers a fault; it is used up by that."""
        left = self._left.get(kind, 0)
        if left:
            self._left[kind] = left - 1
        return left > 0

    def lasting(self, *kinds: str) -> list[Fault]:
        """The faults of some kinds that go on just now."""
        return [f for _, f in self._lasting if f.kind in kinds] if self._lasting else []

    @property
    def health(self) -> HealthKind:
        """What is the matter with the robot, `ready` where nothing is."""
        found = self.lasting(*HEALTH_FAULTS)
        return found[0].kind if found else "ready"  # type: ignore[return-value] # kinds of health are faults, too
