"""What the executor's steps were given, as records for the log, and back again.

With these a run can be carried out once more, step by step, without its robot: the executor's core is a pure
function of them (docs/logs.md).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from polaris_nl.automaton.program import parse_action
from polaris_nl.execution.backend import READY, Health, Observation, Report
from polaris_nl.execution.events import Stepped
from polaris_nl.execution.state import HumanCommand, Inputs, PlanAnswer
from polaris_nl.model.formula import Literal, parse_literal
from polaris_nl.model.state import State

_MOVING: Mapping[bool | None, str] = {True: "yes", False: "no", None: "unknown"}
_NOTHING = Observation(State(frozenset()))


class Differences:
    """Makes records of inputs, each with what differs from the one before.

    Args:
        state: what was perceived before the first step, as `RunStarted.beliefs` has it.
    """

    def __init__(self, state: State) -> None:
        self._before = Observation(state)

    def record(self, now: float, inputs: Inputs) -> Stepped:
        """The record of a step at a time, in seconds."""
        before, found = self._before, inputs.observation
        self._before = found
        removed, added = before.state.difference(found.state)
        health = found.health if found.health != before.health else None
        return Stepped(
            time=now,
            added=_texts(added),
            removed=_texts(removed),
            doubted=_texts(found.unknown - before.unknown),
            settled=_texts(before.unknown - found.unknown),
            blind=sorted(found.blind) if found.blind != before.blind else None,
            health=health.kind if health else None,
            health_text=health.text if health else None,
            moving=_MOVING[found.moving] if found.moving is not before.moving else None,
            reports=[_report_json(x) for x in inputs.reports],
            commands=[_command_json(x) for x in inputs.commands],
            plans=[_plan_json(x) for x in inputs.plans],
        )


class Inverse:
    """Makes inputs of records.

    Args:
        state: what was perceived before the first step.
    """

    def __init__(self, state: State) -> None:
        self._before = Observation(state)

    def inputs(self, record: Stepped) -> Inputs:
        """The inputs that a record was made of.

        Raises:
            ValueError, KeyError, TypeError, FormatError: the record is damaged.
        """
        before = self._before
        health = before.health
        if record.health is not None:
            health = Health(record.health, record.health_text or "")  # type: ignore[arg-type] # as it was logged
        moving = {text: value for value, text in _MOVING.items()}
        self._before = Observation(
            before.state.change(_literals(record.removed), _literals(record.added)),
            (before.unknown | set(_literals(record.doubted))) - set(_literals(record.settled)),
            before.blind if record.blind is None else frozenset(record.blind),
            health=health if health != READY else READY,
            moving=before.moving if record.moving is None else moving[record.moving],
        )
        return Inputs(
            self._before,
            tuple(map(_report, record.reports)),
            tuple(map(_command, record.commands)),
            tuple(map(_plan, record.plans)),
        )


def _report_json(report: Report) -> dict[str, Any]:
    return {
        "goal": report.goal,
        "kind": report.kind,
        "reason": report.reason,
        "before": [str(a) for a in report.before],
        "after": [str(a) for a in report.after],
    }


def _report(value: Mapping[str, Any]) -> Report:
    before, after = (tuple(map(parse_action, value[x])) for x in ("before", "after"))
    return Report(int(value["goal"]), value["kind"], str(value["reason"]), before, after)


def _command_json(command: HumanCommand) -> dict[str, Any]:
    return {
        "kind": command.kind,
        "literals": [str(x) for x in command.literals],
        "source": command.source,
    }


def _command(value: Mapping[str, Any]) -> HumanCommand:
    return HumanCommand(value["kind"], _literals(value["literals"]), str(value["source"]))


def _plan_json(answer: PlanAnswer) -> dict[str, Any]:
    actions = answer.actions
    return {
        "number": answer.number,
        "actions": None if actions is None else [str(a) for a in actions],
    }


def _plan(value: Mapping[str, Any]) -> PlanAnswer:
    actions = value["actions"]
    way = None if actions is None else tuple(map(parse_action, actions))
    return PlanAnswer(int(value["number"]), way)


def _texts(literals: Iterable[Literal]) -> list[str]:
    return [str(x) for x in sorted(literals)]


def _literals(texts: Iterable[str]) -> tuple[Literal, ...]:
    return tuple(map(parse_literal, texts))
