"""The contract suite on the robot back end: real messages, a driver in a process of its own, real kills.

The scenarios of `DAILY` are every fault once. All of the suite, which takes a quarter of an hour, is run with
`POLARIS_NL_ALL_SCENARIOS=1`.
"""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from tests.execution.contract import SCENARIOS, Scenario, check
from tests.execution.ros.ros_harness import RosHarness
from tests.execution.story import Case

DAILY = (
    "driver killed",
    "driver frozen, then goes on",
    "run-stop pressed",
    "goal rejected",
    "goal never accepted",
    "goal never ends",
    "a lie",
    "late success after a failure",
    "object moved elsewhere",
    "nothing seen for a while",
    "only the run-stop stops it",
    "contradictory answers",
    "executor killed in the middle of a goal",
    "not homed, before the start",
    "battery low",
    "two servers on one name",
    "clock jump",
)
BY_NAME = {s.name: s for s in SCENARIOS}
CHOSEN = (
    SCENARIOS
    if os.environ.get("POLARIS_NL_ALL_SCENARIOS")
    else tuple(BY_NAME[name] for name in DAILY)
)


@pytest.mark.parametrize("scenario", CHOSEN, ids=lambda s: s.name.replace(" ", "-"))
def test_the_contract(
    scenario: Scenario,
    contract_cases: dict[str, Case],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    monkeypatch.setenv("ROS_DOMAIN_ID", "0")  # The harness sets its own; this puts it back.
    check(scenario, RosHarness().carry_out(scenario, contract_cases[scenario.program], tmp_path))
