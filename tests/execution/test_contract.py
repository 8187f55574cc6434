"""The contract suite on the in-process world."""

from __future__ import annotations

from pathlib import Path

import pytest

from polaris_nl.execution.faults import FAULT_KINDS
from tests.execution.contract import DISK_FULL, RESTART, SCENARIOS, Scenario, check
from tests.execution.story import Case
from tests.execution.world_harness import WorldHarness


@pytest.mark.parametrize("scenario", SCENARIOS, ids=lambda s: s.name.replace(" ", "-"))
def test_the_contract(scenario: Scenario, contract_cases: dict[str, Case], tmp_path: Path) -> None:
    check(scenario, WorldHarness().carry_out(scenario, contract_cases[scenario.program], tmp_path))


def test_every_kind_of_fault_is_in_the_suite() -> None:
    injected = {kind for scenario in SCENARIOS for kind in scenario.kinds}
    assert injected == {*FAULT_KINDS, DISK_FULL, RESTART}
    assert len({s.name for s in SCENARIOS}) == len(SCENARIOS)
