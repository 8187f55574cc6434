"""Runs with their logs, whole and with something that goes wrong."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from polaris_nl.runs import RunOrder, run_simulated
from tests.execution.conftest import (  # noqa: F401 # fixtures
    care,
    contract_cases,
    dinner,
    dishes,
    hasty_dishes,
    lunch,
    put_away,
    serve,
)
from tests.execution.contract import SCENARIOS
from tests.execution.story import Case
from tests.execution.world_harness import WorldHarness

Carrying = Callable[[str, Path], Path]


@pytest.fixture(scope="session")
def scenario_log(contract_cases: dict[str, Case]) -> Carrying:  # noqa: F811
    """Carries out a scenario of the contract suite by name; returns its (first) log."""

    def carry_out(name: str, folder: Path) -> Path:
        (scenario,) = (s for s in SCENARIOS if s.name == name)
        WorldHarness().carry_out(scenario, contract_cases[scenario.program], folder)
        return folder / "run-1.mcap"

    return carry_out


@pytest.fixture
def lunch_log(lunch: Case, tmp_path: Path) -> Path:  # noqa: F811
    """A run of the caregiving program in which all goes well."""
    order = RunOrder(lunch.automaton, lunch.plan, lunch.planner, log=tmp_path / "lunch.mcap")
    return run_simulated(order, confirmed=True).log
