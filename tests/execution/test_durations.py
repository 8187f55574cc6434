"""Durations: learned from goals that went as planned, bounded, kept, shown and forgotten."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from polaris_nl.execution.clock import RealClock
from polaris_nl.execution.durations import MOST_ACTIONS, MOST_S, Duration, Durations
from polaris_nl.execution.durations_file import (
    SWITCH,
    durations_path,
    forget,
    learn,
    learned,
    read_durations,
)
from polaris_nl.execution.events import Event, GoalConfirmed, GoalSent, Replanned
from polaris_nl.execution.settings import RunSettings
from polaris_nl.execution.simulation import SimulatedRobot
from polaris_nl.execution.simulation_settings import SimulationSettings
from polaris_nl.model.errors import FormatError
from polaris_nl.model.formula import Literal
from polaris_nl.model.world_file import load_world
from polaris_nl.planning.costs import MOST_EXTRA, UNIT, cost
from polaris_nl.planning.planner import Planner
from polaris_nl.runs import RunOrder, run_on
from tests.cli.conftest import Command, command
from tests.execution.story import Case, carry_out, case, literals

__all__ = ["command"]

MOVE = "(move home hall)"


def went(seconds: float, action: str = MOVE, goal: int = 1) -> list[Event]:
    return [
        GoalSent(time=0.0, goal=goal, action=action, literals=[], checkpoint="c1"),
        GoalConfirmed(time=seconds, goal=goal, action=action, seconds=seconds),
    ]


@pytest.fixture
def learning(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    monkeypatch.delenv(SWITCH, raising=False)
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    return tmp_path


def test_a_run_teaches_how_long_its_actions_took(serve: Case) -> None:
    known = Durations().after(carry_out(serve).events).known
    assert list(known) == [str(a) for a in serve.plan.segments["c1"].actions]
    assert known[MOVE].seconds == pytest.approx(4.3, abs=0.3)
    assert known[MOVE].times == 1


def test_the_newest_runs_count_most_and_outliers_are_cut() -> None:
    known = Durations()
    for seconds in (10.0,) * 20 + (30.0,) * 12:
        known = known.after(went(seconds))
    assert known.known[MOVE].seconds == pytest.approx(30.0, abs=2.0)
    assert known.known[MOVE].times == 32
    assert Durations().after(went(1e9)).known[MOVE].seconds == MOST_S


def test_a_goal_that_went_another_way_teaches_nothing() -> None:
    sent, confirmed = went(50.0)
    other = Replanned(time=1.0, goal=1, before=[MOVE], after=[MOVE, MOVE])
    assert Durations().after([sent, other, confirmed]).known == {}
    assert Durations().after([confirmed]).known == {}


def test_no_more_than_so_many_actions_are_kept_the_latest_ones() -> None:
    many = [e for n in range(MOST_ACTIONS + 50) for e in went(3.0, f"(move a r{n})", n)]
    known = Durations().after(many).known
    assert len(known) == MOST_ACTIONS
    assert f"(move a r{MOST_ACTIONS + 49})" in known
    assert "(move a r0)" not in known


@given(st.dictionaries(st.sampled_from(["(move a b)", "(move a c)", "(pick x y)"]),
                       st.floats(0.0, MOST_S)))  # fmt: skip
def test_what_plans_make_of_it_is_bounded(seconds: dict[str, float]) -> None:
    known = Durations({a: Duration(s, 1) for a, s in seconds.items()})
    for name in ("move a b", "move a z", "pick x y", "place x y"):
        assert cost(name, known.extra) in (1, *range(UNIT, UNIT + MOST_EXTRA + 1))
    assert Durations.of_json(json.loads(json.dumps(known.to_json()))).known.keys() == seconds.keys()


def way(extra: dict[str, int], *doors: str) -> list[str]:
    """The rooms on the way from home to the kitchen, by doors "a to b"."""
    world = load_world("dinner-party")
    facts = {f for f in world.facts if f.predicate != "connected"}
    for door in doors:
        a, _, b = door.partition(" to ")
        facts |= {Literal("connected", (a, b)), Literal("connected", (b, a))}
    built = replace(world, facts=frozenset(facts))
    result = Planner(built, extra=extra).segment(built.initial, literals("(robot-at kitchen)"))
    assert result.optimal
    return [action.args[1] for action in result.actions]


def test_among_equally_short_plans_the_quicker_is_taken() -> None:
    doors = ("home to hall", "hall to kitchen", "home to pantry", "pantry to kitchen")
    assert way({"move home hall": 40, "move": 5}, *doors) == ["pantry", "kitchen"]
    assert way({"move home pantry": 40, "move": 5}, *doors) == ["hall", "kitchen"]
    assert way({"move pantry kitchen": 1000, "move": 5}, *doors) == ["hall", "kitchen"]


def test_a_longer_plan_is_never_taken_however_quick() -> None:
    slow = {"move home hall": 10**9, "move hall kitchen": 10**9, "move": 0}
    longer = ("home to pantry", "pantry to dining-area", "dining-area to kitchen")
    assert way(slow, "home to hall", "hall to kitchen", *longer) == ["hall", "kitchen"]


def test_it_is_kept_and_forgotten(learning: Path) -> None:
    world = load_world("care-home")
    assert read_durations(world).known == {}
    learn(world, went(12.0))
    assert durations_path(world).is_relative_to(learning)
    assert read_durations(world).known == {MOVE: Duration(12.0, 1)}
    assert learned(world) == {"move home hall": 10, "move": 10}
    assert forget(world)
    assert not forget(world)
    assert learned(world) == {}


def test_a_broken_file_harms_nothing_and_is_told(learning: Path) -> None:
    world = load_world("care-home")
    learn(world, went(12.0))
    for text in ("{", "[]", '{"schema": "polaris-durations/9", "actions": {}}'):
        durations_path(world).write_text(text)
        assert learned(world) == {}
        with pytest.raises(FormatError, match="--reset"):
            read_durations(world)
    learn(world, went(12.0))
    assert read_durations(world).known == {MOVE: Duration(12.0, 1)}


def test_switched_off_nothing_is_read_or_written(
    learning: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    world = load_world("care-home")
    learn(world, went(12.0))
    monkeypatch.setenv(SWITCH, "off")
    assert learned(world) == {}
    learn(world, went(99.0))
    monkeypatch.delenv(SWITCH)
    assert read_durations(world).known == {MOVE: Duration(12.0, 1)}


def test_runs_in_real_time_teach_and_those_in_virtual_time_do_not(
    learning: Path, care: Planner
) -> None:
    short = case(care, ("start", "there", (), ("(robot-at hall)",)))
    order = RunOrder(
        short.automaton, short.plan, care, log=learning / "x.mcap",
        settings=RunSettings(tick_s=0.01, confirm_s=0.02),
    )  # fmt: skip
    how = SimulationSettings(action_s={"default": 0.05})
    clock = RealClock()
    report = run_on(
        lambda log, sink, now: SimulatedRobot(
            care.world, care.mutexes, care.segment, how, start=now
        ),
        clock,
        order,
        confirmed=True,
    )
    assert report.result.outcome == "done"
    assert list(read_durations(care.world).known) == [MOVE]


def test_the_command_shows_and_resets(learning: Path, command: Command) -> None:
    nothing = command("durations", "--world", "care-home")
    assert nothing.out == ("Nothing has been learned yet of how long actions take in care-home.\n")
    learn(load_world("care-home"), [*went(12.0), *went(3.0, "(alert resident lunchtime hall)", 2)])
    shown = command("durations", "--world", "care-home").out.splitlines()
    assert shown[1:] == [
        "   12.0 s  go to the hall, once",
        "    3.0 s  tell the resident that lunch is ready, once",
    ]
    told = command("durations", "--world", "care-home", "--json").json
    assert told["actions"][0] == {"action": MOVE, "seconds": 12.0, "times": 1}
    assert command("durations", "--world", "care-home", "--reset").out == (
        "How long actions take in care-home is forgotten.\n"
    )
    assert command("durations", "--world", "care-home", "--json").json["actions"] == []
