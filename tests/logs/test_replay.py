"""Logged runs carried out once more, from what the executor was given."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from polaris_nl.execution.backend import READY, Health, Observation, Report
from polaris_nl.execution.events import GoalSent, RunEnded, StateChanged
from polaris_nl.execution.inputs import Differences, Inverse
from polaris_nl.execution.replaying import first_difference
from polaris_nl.execution.state import HumanCommand, Inputs, PlanAnswer
from polaris_nl.logs.reader import read_log
from polaris_nl.logs.schema import event_json, event_of
from polaris_nl.logs.writer import LogWriter, attachments_of
from polaris_nl.model.domain import Action
from polaris_nl.model.errors import LogError
from polaris_nl.model.formula import parse_literal
from polaris_nl.model.state import State
from polaris_nl.replays import replayed
from polaris_nl.runs import RunOrder, run_simulated
from tests.execution.story import Case
from tests.logs.conftest import Carrying


def test_a_replay_makes_the_same_decisions(lunch_log: Path) -> None:
    (found,) = replayed(lunch_log)
    assert found.difference is None
    logged = [e.action for e in read_log(lunch_log).events if isinstance(e, GoalSent)]
    assert [e.action for e in found.decisions if isinstance(e, GoalSent)] == logged
    assert isinstance(found.decisions[-2], RunEnded)


@pytest.mark.parametrize(
    "name",
    [
        "object moved elsewhere",
        "nothing seen any more",
        "contradictory answers",
        "an answer by word of mouth",
        "executor killed in the middle of a goal",
        "paused and resumed",
    ],
)
def test_replays_of_runs_in_which_something_goes_wrong(
    name: str, scenario_log: Carrying, tmp_path: Path
) -> None:
    scenario_log(name, tmp_path)
    for path in tmp_path.glob("*.mcap"):
        assert [r.difference for r in replayed(path)] == [None]


def test_a_replay_in_real_time(serve: Case, tmp_path: Path) -> None:
    """The steps come when they come; the replay takes their times from the log."""
    path = tmp_path / "live.mcap"
    order = RunOrder(serve.automaton, serve.plan, serve.planner, log=path, live=True)
    stop = [HumanCommand("stop")]
    events: list[object] = []

    def commands() -> list[HumanCommand]:
        return stop if any(isinstance(e, StateChanged) for e in events) else []

    run_simulated(order, confirmed=True, show=events.append, commands=commands)
    (found,) = replayed(path)
    assert found.difference is None
    assert [e.outcome for e in found.decisions if isinstance(e, RunEnded)] == ["stopped"]


def test_another_decision_is_found(lunch_log: Path) -> None:
    (found,) = replayed(lunch_log)
    events = read_log(lunch_log).events
    at = next(n for n, e in enumerate(found.decisions) if isinstance(e, GoalSent))
    wrong = list(found.decisions)
    wrong[at] = replace(wrong[at], action="(move home attic)")
    difference = first_difference(events, wrong)
    assert difference is not None
    assert isinstance(difference.logged, GoalSent)
    assert difference.number == difference.logged.id
    shorter = first_difference(events, found.decisions[:-3])
    assert shorter is not None
    assert shorter.replayed is None


def test_what_the_executor_was_given_comes_back_as_it_was() -> None:
    a, b, c = (parse_literal(x) for x in ("(robot-at home)", "(open box)", "(at cup desk)"))
    move = Action("move", ("home", "hall"))
    steps = [
        Inputs(Observation(State(frozenset({a})), moving=None)),
        Inputs(
            Observation(
                State(frozenset({a, b})), frozenset({c}), frozenset({"open"}),
                health=Health("battery", "low"), moving=True,
            ),
            (Report(1, "replanned", "so", (move,), (move, move)),),
            (HumanCommand("happened", (b.negation, a), "voice"),),
            (PlanAnswer(3, None), PlanAnswer(4, (move,))),
        ),
        Inputs(Observation(State(frozenset({b})), moving=False, health=READY)),
    ]  # fmt: skip
    differences = Differences(State(frozenset({a})))
    inverse = Inverse(State(frozenset({a})))
    for time, inputs in enumerate(steps):
        record = differences.record(float(time), inputs)
        read = event_of(record.topic, event_json(record))
        assert inverse.inputs(read) == inputs


def test_logs_that_cannot_be_replayed_say_why(tmp_path: Path) -> None:
    path = tmp_path / "none.mcap"
    LogWriter(path, attachments_of({}, "(define)", "")).close()
    with pytest.raises(LogError, match="no run to replay"):
        replayed(path)
