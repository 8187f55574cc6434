"""The executor's core, whatever is perceived, reported and commanded, in whatever order."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace

import pytest
from hypothesis import given, settings

from polaris_nl.execution.events import (
    CheckpointReached,
    CommandGiven,
    Deviated,
    GoalConfirmed,
    Halted,
    Recovered,
    Replanned,
    RunEnded,
    Skipped,
    TransitionTaken,
    Waiting,
)
from polaris_nl.execution.executor import step
from tests.execution.monitor import Monitor
from tests.execution.programs import (
    PROGRAMS,
)
from tests.execution.story import Case
from tests.execution.surroundings import HISTORIES, Moment, surroundings


@pytest.mark.parametrize("name", PROGRAMS)
def test_the_rules_hold_whatever_happens(programs: dict[str, Case], name: str) -> None:
    met: Counter[str] = Counter()

    @settings(max_examples=400, deadline=None, derandomize=True, database=None)
    @given(HISTORIES)
    def hold(history: list[Moment]) -> None:
        around = surroundings(programs[name], wait_s=20.0)
        monitor = Monitor(around)
        for moment in history:
            before = around.state
            inputs, commands, events = around.pass_by(moment)
            monitor.check(before, inputs, commands, events)
            met.update(type(e).__name__ for e in events)
            met.update(e.outcome for e in events if isinstance(e, RunEnded))

    hold()
    # The histories lead into every corner.
    kinds = (
        GoalConfirmed,
        CheckpointReached,
        TransitionTaken,
        Deviated,
        Recovered,
        Halted,
        Skipped,
    )
    corners = {k.__name__ for k in (*kinds, CommandGiven, Replanned)} | {
        "done",
        "halted",
        "stopped",
    }
    corners |= {Waiting.__name__} if name == "labelled" else set()
    assert corners <= set(met)


@pytest.mark.parametrize("name", PROGRAMS)
def test_the_core_is_pure(programs: dict[str, Case], name: str) -> None:
    @settings(max_examples=100, deadline=None, derandomize=True, database=None)
    @given(HISTORIES)
    def pure(history: list[Moment]) -> None:
        around = surroundings(programs[name])
        for moment in history:
            before, kept = around.state, replace(around.state)
            inputs, commands, events = around.pass_by(moment)
            again = step(around.run, before, around.now, inputs)
            assert again == (around.state, commands, events)
            assert before == kept

    pure()
