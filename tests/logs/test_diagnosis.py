"""Logs of runs with something injected, diagnosed from `review` alone and compared with what was injected."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from polaris_nl.cli import main
from polaris_nl.logs.diagnosis import diagnoses
from polaris_nl.logs.reader import read_log
from tests.logs.conftest import Carrying

INJECTED = {
    "driver killed": ("robot", "silent", False),
    "run-stop pressed": ("robot", "runstopped", False),
    "battery low": ("robot", "battery", False),
    "goal rejected": ("refused", "", False),
    "goal never accepted": ("no-answer", "", False),
    "goal never ends": ("too-slow", "", False),
    "a lie": ("not-as-reported", "", True),
    "nothing but lies": ("not-as-reported", "", False),
    "nothing but failures": ("gave-up", "", False),
    "object moved elsewhere": ("moved", "", True),
    "object removed": ("moved", "", False),
    "forgotten wait": ("undone", "", False),
    "forgotten wait, put back in time": ("undone", "", True),
    "nothing seen any more": ("unseen", "", False),
    "nobody answers": ("nobody-came", "", False),
    "an answer for a moment only": ("too-short", "", False),
    "contradictory answers": ("doubtful", "", False),
    "paused and forgotten": ("nobody-resumed", "", False),
    "cancel ignored": ("stopped", "", False),
    "executor killed in the middle of a goal": ("no-end", "", False),
}
"""By scenario: what the review has to find, what is the matter with the robot, and whether it was mended."""


@pytest.mark.parametrize("name", INJECTED)
def test_what_was_injected_is_found(
    name: str, scenario_log: Carrying, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = scenario_log(name, tmp_path)
    main(["review", str(path), "--json"])
    found = json.loads(capsys.readouterr().out)["diagnoses"]
    kind, health, mended = INJECTED[name]
    assert (found[-1]["kind"], found[-1]["health"], found[-1]["mended"]) == (kind, health, mended)
    assert found[-1]["what"]
    others = {f["kind"] for f in found[:-1]}
    assert others <= {kind}, "nothing is found that wasn't injected"


@pytest.mark.parametrize(
    "name",
    ["driver hiccups", "help on the way", "paused and resumed", "an answer by word of mouth"],
)
def test_nothing_is_found_where_nothing_went_wrong(
    name: str, scenario_log: Carrying, tmp_path: Path
) -> None:
    assert diagnoses(read_log(scenario_log(name, tmp_path)).events) == []


def test_a_run_without_trouble_has_no_diagnosis(lunch_log: Path) -> None:
    assert diagnoses(read_log(lunch_log).events) == []
