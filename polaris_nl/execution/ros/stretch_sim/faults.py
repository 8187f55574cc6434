"""What can be made to go wrong, and how it is asked for: JSON on `/polaris/sim/fault`.

Faults of goals wait for the next goals (`times`, and `of` for one kind of them); the others strike at once.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from polaris_nl.model.errors import PolarisError, UsageError, did_you_mean
from polaris_nl.model.formula import Literal, parse_literal

GOAL_FAULTS = ("reject", "never", "lie", "fail", "ignore-cancel", "slow-cancel")
STATE_FAULTS = (
    "event", "move", "remove", "add", "blind", "stale", "silent", "unhomed", "homed", "battery", "runstop",
    "clock-jump", "clear",
)  # fmt: skip
GOAL_KINDS = ("navigate", "trajectory", "skill", "say", "trigger")


@dataclass(frozen=True, slots=True)
class Fault:
    """One fault.

    Attributes:
        kind: one of `GOAL_FAULTS` and `STATE_FAULTS`.
        times: how many goals it strikes.
        of: the kind of goals; "" for any.
        seconds: how long it lasts (or how late a cancel is).
        object: the entity that is moved, removed or added.
        to: the surface, container or person where it goes.
        value: the battery's voltage, or whether the run-stop is pressed (0 or 1).
        literals: what an event makes true.
    """

    kind: str
    times: int = 1
    of: str = ""
    seconds: float = 0.0
    object: str = ""
    to: str = ""
    value: float = 1.0
    literals: tuple[Literal, ...] = ()


def parse_fault(text: str) -> Fault:
    """Reads a fault.

    Raises:
        UsageError: it isn't one; the sentence says what is.
    """
    try:
        given = json.loads(text)
    except ValueError as error:
        raise UsageError(
            f"A fault is a JSON object, such as {EXAMPLE}; not {text[:60]!r}."
        ) from error
    if not isinstance(given, dict):
        raise UsageError(f"A fault is a JSON object, such as {EXAMPLE}.")
    kind = str(given.pop("fault", ""))
    if kind not in (*GOAL_FAULTS, *STATE_FAULTS):
        raise UsageError(f"There is no fault {kind!r}.{_hint(kind)}")
    literals = given.pop("literals", [])
    fields = {name for name in Fault.__slots__ if name not in ("kind", "literals")}
    for name in given:
        if name not in fields:
            raise UsageError(f"A fault has no {name!r}.{did_you_mean(name, fields)}")
    try:
        return _fault(kind, given, tuple(parse_literal(x) for x in literals))
    except (PolarisError, TypeError, ValueError) as error:
        raise UsageError(f"The fault {kind} can't be read: {error}") from error


EXAMPLE = '{"fault": "reject", "times": 1, "of": "navigate"}'


def _hint(kind: str) -> str:
    return did_you_mean(kind, (*GOAL_FAULTS, *STATE_FAULTS)) or f" For example: {EXAMPLE}"


def _fault(kind: str, given: Mapping[str, Any], literals: tuple[Literal, ...]) -> Fault:
    of = str(given.get("of", ""))
    if of and of not in GOAL_KINDS:
        raise ValueError(f"there are no goals of kind {of}.{did_you_mean(of, GOAL_KINDS)}")
    return Fault(
        kind,
        int(given.get("times", 1)),
        of,
        float(given.get("seconds", 0.0)),
        str(given.get("object", "")),
        str(given.get("to", "")),
        float(given.get("value", 1.0)),
        literals,
    )


@dataclass(slots=True)
class Mishaps:
    """The faults that wait for goals, and how long perception and topics are off.

    Attributes:
        blind_until, stale_until, silent_until: times until which nothing is seen, stamps stand still, and
            the driver publishes nothing.
        clock_s: what is added to every stamp.
    """

    blind_until: float = 0.0
    stale_until: float = 0.0
    silent_until: float = 0.0
    clock_s: float = 0.0
    _waiting: list[Fault] = field(default_factory=list)

    def add(self, fault: Fault) -> None:
        """Lets a fault wait for goals."""
        self._waiting += [fault] * fault.times

    def take(self, kind: str, of: str) -> Fault | None:
        """The fault that strikes a goal now, if there is one; it is used up."""
        for at, fault in enumerate(self._waiting):
            if fault.kind == kind and fault.of in ("", of):
                return self._waiting.pop(at)
        return None

    def strike(self, fault: Fault, now: float) -> bool:
        """Lets a fault of senses or clock begin; False if it is none of those."""
        until = now + fault.seconds
        match fault.kind:
            case "blind":
                self.blind_until = until
            case "stale":
                self.stale_until = until
            case "silent":
                self.silent_until = until
            case "clock-jump":
                self.clock_s += fault.seconds
            case "clear":
                self.clear()
            case _:
                return False
        return True

    def clear(self) -> None:
        """Nothing goes wrong any more."""
        self._waiting.clear()
        self.blind_until = self.stale_until = self.silent_until = self.clock_s = 0.0
