"""The paper's smallest tidying solution, typed in six wordings: it runs to four of four objectives."""

from __future__ import annotations

from pathlib import Path

import pytest

from polaris_nl.execution.runner import objectives_met
from polaris_nl.model.world_file import load_world
from polaris_nl.planning.up_model import is_valid
from polaris_nl.runs import RunOrder, run_simulated
from polaris_nl.session import Session

WORDINGS = {
    "plain": (
        "Put the cup and the plate on the countertop.",
        "Wait until both are on the drying rack.",
        "Open the cupboard, then put both dishes in the cupboard.",
    ),
    "at once": (
        "Bring the cup and the plate to the counter. Once the cup and the plate are on the drying "
        "rack, open the cupboard and put them in the cupboard.",
    ),
    "polite": (
        "Could you please take the plate and the cup to the countertop?",
        "When both of them are on the drying rack, please open the cupboard and put them in it.",
    ),
    "no punctuation": (
        "bring the cup and plate to the countertop then wait until the cup and plate are on the "
        "drying rack then open the cupboard and put the cup and plate in the cupboard",
    ),
    "condition behind": (
        "Place the cup and the plate on the countertop.",
        "Open the cupboard and put the cup and the plate in the cupboard once they are on the drying rack.",
    ),
    "step by step": (
        "Bring the cup to the countertop and bring the plate to the countertop.",
        "As soon as the cup is on the drying rack and the plate is on the drying rack, open the cupboard.",
        "Then put the cup in the cupboard and the plate in the cupboard.",
    ),
}


@pytest.mark.parametrize("wording", WORDINGS)
def test_six_wordings_run_to_all_objectives(wording: str, tmp_path: Path) -> None:
    world = load_world("dinner-party")
    with Session(world) as session:
        for sentence in WORDINGS[wording]:
            answer = session.say(sentence)
            assert answer.interpretation.outcome == "applied", answer.say
        snapshot = session.wait()
        assert snapshot.plan is not None
        assert snapshot.plan.status == "ok", snapshot.plan.problems
        for segment in snapshot.plan.segments.values():
            assert segment.optimal
            assert is_valid(world, segment.before, segment.goals, segment.actions)
        order = RunOrder(
            snapshot.automaton, snapshot.plan, session.planner, log=tmp_path / "x.mcap"
        )
        report = run_simulated(order, confirmed=True)
    assert report.result.outcome == "done"
    assert [ok for _, ok in objectives_met(world, report.result.beliefs)] == [True] * 4


def test_without_the_wait_it_halts_and_says_what_it_expected_and_saw(tmp_path: Path) -> None:
    with Session(load_world("dinner-party")) as session:
        session.say("Put the cup and the plate on the countertop.")
        session.say("Then open the cupboard.")
        snapshot = session.say("Then put the cup and the plate in the cupboard.").snapshot
        assert snapshot.plan is not None
        order = RunOrder(
            snapshot.automaton, snapshot.plan, session.planner, log=tmp_path / "x.mcap"
        )
        result = run_simulated(order, confirmed=True).result
    assert result.outcome == "halted"
    assert "on the countertop" in result.reason
    assert "on the drying rack" in result.reason
