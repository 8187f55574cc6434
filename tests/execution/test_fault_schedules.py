"""A thousand random schedules of faults and commands: every run ends, and in stillness."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from polaris_nl.execution.events import Halted, Recovered, Replanned, RunEnded, Skipped
from polaris_nl.execution.faults import FAULT_KINDS, Fault
from polaris_nl.execution.state import TERMINAL, HumanCommand
from tests.execution.contract import WATCH_S, Ran, check_always
from tests.execution.story import T0, Case, Told, carry_out, literals

SCHEDULES = 1000
PATIENCE = {"wait_s": 12.0, "goal_s": 15.0, "pause_s": 8.0, "grace_s": 4.0, "tick_s": 0.2}
LITERALS = literals(
    "(at tray dining-table)",
    "(at tray empty-trays)",
    "(not (at tray empty-trays))",
    "(at tray table)",
    "(is-full tray)",
    "(acknowledged lunchtime)",
    "(dismissed lunchtime)",
    "(not (alerted-to resident lunchtime))",
    "(robot-at home)",
)
FAULTS = st.builds(
    Fault,
    at=st.integers(0, 45).map(float),
    kind=st.sampled_from(FAULT_KINDS),
    times=st.sampled_from([1, 1, 2, 9]),
    seconds=st.sampled_from([0.0, 0.3, 1.0, 3.0, 8.0]),
    literals=st.lists(st.sampled_from(LITERALS), min_size=1, max_size=2, unique=True).map(tuple),
)
COMMANDS = st.tuples(
    st.integers(0, 45),
    st.sampled_from(
        [
            HumanCommand("pause"),
            HumanCommand("resume"),
            HumanCommand("resume"),
            HumanCommand("stop"),
            HumanCommand("happened", literals("(dismissed lunchtime)")),
        ]
    ),
)


def seen_from_outside(told: Told) -> Ran:
    robot = told.robot
    end = T0 + told.result.seconds
    for tick in range(1, round(WATCH_S / 0.2) + 1):
        robot.advance(end + tick * 0.2)
        robot.observe()
    commands = [(T0 + at, command) for at, command in robot.commanded]
    result = told.result
    return Ran(result.outcome, result.reason, told.events, [], commands, robot.moved_at)


@pytest.mark.parametrize("program", ["serve", "lunch"])
def test_every_run_ends_in_stillness_and_repeats_nothing(
    program: str, contract_cases: dict[str, Case]
) -> None:
    case, met = contract_cases[program], Counter[str]()

    @settings(max_examples=SCHEDULES // 2, deadline=None, derandomize=True, database=None)
    @given(st.lists(FAULTS, max_size=4), st.lists(COMMANDS, max_size=2), st.integers(0, 3))
    def ends(faults: list[Fault], said: list[tuple[int, HumanCommand]], seed: int) -> None:
        left = list(said)

        def commands(seconds: float) -> list[HumanCommand]:
            due = [x for x in left if x[0] <= seconds]
            left[:] = [x for x in left if x[0] > seconds]
            return [command for _, command in due]

        # What is wrong from the beginning keeps a run from starting, which the contract suite tests.
        late = [replace(f, at=f.at + 0.1) for f in faults]
        told = carry_out(case, *late, commands=commands, seed=seed, **PATIENCE)
        assert told.result.outcome in ("done", "halted", "stopped")
        check_always(seen_from_outside(told))
        assert told.phases[-1] in TERMINAL
        met.update({type(e).__name__ for e in told.events} | {told.one(RunEnded).outcome})
        met.update(["run"])

    ends()
    assert met["run"] >= SCHEDULES // 2
    corners = {k.__name__ for k in (Halted, Recovered, Replanned, Skipped)}
    assert corners | {"done", "halted", "stopped"} <= set(met)
