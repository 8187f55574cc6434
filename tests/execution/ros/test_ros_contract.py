"""The contract suite on the robot back end: real messages, a driver in a process of its own, real kills."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.execution.contract import SCENARIOS, Scenario, check
from tests.execution.ros.ros_harness import RosHarness
from tests.execution.story import Case


@pytest.mark.parametrize("scenario", SCENARIOS, ids=lambda s: s.name.replace(" ", "-"))
def test_the_contract(scenario: Scenario, contract_cases: dict[str, Case], tmp_path: Path) -> None:
    check(scenario, RosHarness().carry_out(scenario, contract_cases[scenario.program], tmp_path))
