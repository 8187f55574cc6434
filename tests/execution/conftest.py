"""The shipped worlds' planners, and the paper's programs."""

from __future__ import annotations

import pytest

from polaris_nl.model.world_file import load_world
from polaris_nl.planning.planner import Planner
from polaris_nl.session import Session
from tests.execution.programs import programs_of
from tests.execution.story import FULL_TRAY, Case, case

LUNCH = (
    "Tell the resident that lunch is ready.",
    "Once she acknowledges, bring a full tray to her table and then go home.",
    "If she dismisses it, just go home.",
)
DISHES = (
    "Put the cup and the plate on the countertop.",
    "Wait until the cup and the plate are on the drying rack.",
    "Then open the cupboard.",
    "Then put the cup and the plate in the cupboard.",
)


def said(world: str, utterances: tuple[str, ...]) -> Case:
    """The program that utterances make, understood and planned by a session."""
    with Session(load_world(world)) as session:
        for utterance in utterances:
            answer = session.say(utterance)
            assert answer.interpretation.outcome == "applied", answer.say
        snapshot = session.snapshot
        assert snapshot.plan is not None
        assert snapshot.plan.status == "ok"
        return Case(snapshot.automaton, snapshot.plan, session.planner)


@pytest.fixture(scope="session")
def care() -> Planner:
    return Planner(load_world("care-home"))


@pytest.fixture(scope="session")
def programs(care: Planner) -> dict[str, Case]:
    return programs_of(care)


@pytest.fixture(scope="session")
def dinner() -> Planner:
    return Planner(load_world("dinner-party"))


@pytest.fixture(scope="session")
def lunch() -> Case:
    """The paper's caregiving program, as it is said."""
    return said("care-home", LUNCH)


@pytest.fixture(scope="session")
def dishes() -> Case:
    """The paper's smallest tidying program, as it is said."""
    return said("dinner-party", DISHES)


@pytest.fixture(scope="session")
def hasty_dishes() -> Case:
    """The same without the wait."""
    return said("dinner-party", (DISHES[0], *DISHES[2:]))


@pytest.fixture(scope="session")
def serve(care: Planner) -> Case:
    """A short run: fetch a full tray."""
    return case(care, ("start", "fetched", (), FULL_TRAY))


@pytest.fixture(scope="session")
def put_away(dinner: Planner) -> Case:
    """A short run that needs an open cupboard."""
    return case(
        dinner,
        ("start", "opened", (), ("(open cupboard)",)),
        ("opened", "stowed", (), ("(in cup cupboard)",)),
    )


@pytest.fixture(scope="session")
def contract_cases(lunch: Case, hasty_dishes: Case) -> dict[str, Case]:
    """The programs of the contract suite's scenarios, by name, with the grammar's words."""
    tray = case(lunch.planner, ("start", "fetched", (), FULL_TRAY))
    return {"serve": tray, "lunch": lunch, "hasty": hasty_dishes}
