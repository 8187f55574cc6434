"""People who move things and help: what is put right, gone around, left out, and what halts the run."""

from __future__ import annotations

import pytest

from polaris_nl.automaton.automaton import START, Automaton, Checkpoint, Transition
from polaris_nl.automaton.program import parse_action
from polaris_nl.execution.events import (
    CheckpointReached,
    Deviated,
    GoalSent,
    Halted,
    Recovered,
    Replanned,
    Skipped,
)
from polaris_nl.execution.goals import GoalLimits
from polaris_nl.execution.settings import RunSettings
from polaris_nl.planning.planner import Planner
from tests.execution.story import FULL_TRAY, T0, Case, Told, carry_out, case, literal
from tests.execution.test_faults import moved


def times(told: Told) -> list[str]:
    """The checkpoints reached, each as often as it was."""
    return [e.name for e in told.of(CheckpointReached)]


# Around what the world has changed


def test_an_object_moved_elsewhere_is_fetched_from_there(serve: Case) -> None:
    told = carry_out(serve, moved(5.0, "(at tray dining-table)"))
    assert (told.result.outcome, told.result.checkpoints) == ("done", ("fetched",))
    assert all(told.result.beliefs.holds(literal(x)) for x in FULL_TRAY)
    new, deviated = told.one(Replanned), told.one(Deviated)
    assert new.before[0] == "(pick tray empty-trays)"
    assert new.after[0] == "(pick tray dining-table)"
    assert new.segment == "c1"
    assert new.time - deviated.time == pytest.approx(RunSettings().settle_s, abs=0.25)
    assert "(pick tray empty-trays)" not in told.robot.sent


def test_the_sentence_says_what_is_seen_and_what_comes_next(lunch: Case) -> None:
    told = carry_out(lunch, moved(5.0, "(at tray desk)"))
    assert told.one(Replanned).text == (
        "I plan anew, since the tray is on the caregiver's desk: next I go to the hall, then 8 more actions."
    )
    assert told.one(Replanned).reason == (
        "I expected that the tray is on the empty trays, but I see that the tray is on the caregiver's desk."
    )
    assert told.result.checkpoints == ("alerted", "fetched", "home")


def test_where_a_thing_is_gone_altogether_the_run_halts(serve: Case) -> None:
    told = carry_out(serve, moved(5.0, "(not (at tray empty-trays))"))
    halt = told.one(Halted)
    assert halt.reason.endswith("but I see nothing of it.")
    assert told.of(Replanned) == []


def test_a_thing_that_never_stays_where_it_is_exhausts_the_patience(serve: Case) -> None:
    places = ("dining-table", "empty-trays")
    to_and_fro = [moved(5.0 + 1.7 * n, f"(at tray {places[n % 2]})") for n in range(400)]
    told = carry_out(serve, *to_and_fro)
    assert told.result.outcome in ("halted", "done")
    assert len([e for e in told.of(Replanned) if e.segment]) <= RunSettings().replans
    assert len(told.of(Deviated)) <= RunSettings().deviations


def test_a_robot_taken_elsewhere_finds_its_way_by_itself(serve: Case) -> None:
    # Somebody pushes it back home while it is on its way to the cafeteria.
    told = carry_out(serve, moved(5.0, "(not (robot-at hall))", "(robot-at home)"))
    assert told.result.outcome == "done"
    assert told.of(Deviated) == []


def test_what_the_robot_plans_anew_on_the_way_to_a_goal_is_told(put_away: Case) -> None:
    placing = next(at for at, a in carry_out(put_away).robot.motions if a.operator == "put-in")
    told = carry_out(put_away, moved(placing - T0 - 0.5, "(not (open cupboard))"))
    assert told.result.outcome == "done"
    assert told.of(Deviated) == []
    new = [e for e in told.of(Replanned) if not e.segment]
    assert [e.before for e in new] == [["(put-in cup cupboard)"]]
    assert "(open-container cupboard)" in new[0].after


def test_what_the_robot_can_not_put_right_by_itself_is_planned_anew(put_away: Case) -> None:
    # A robot that does nothing but the very action loses the cup on its way to the cupboard.
    by_itself = GoalLimits(actions=1)
    picked = next(at for at, a in carry_out(put_away).robot.motions if a.operator == "pick")
    lost = moved(picked - T0 + 1.0, "(at cup sideboard)")
    told = carry_out(put_away, lost, limits=by_itself)
    assert told.result.outcome == "done"
    assert told.one(Deviated).expected == ["(holding cup)"]
    assert "(pick cup sideboard)" in told.one(Replanned).after
    assert told.result.beliefs.holds(literal("(in cup cupboard)"))
    never = carry_out(put_away, lost, limits=by_itself, replans=False)
    assert never.one(Halted).observed == ["(at cup sideboard)"]


@pytest.fixture
def insisted(care: Planner) -> Case:
    """A program that says how: the tray is to be put on the table."""
    step = Checkpoint("c1", "served", (), parse_action("(place tray table)"))
    automaton = Automaton().with_checkpoint(step).with_transition(Transition("t1", START, "c1"))
    plan = care.compile(automaton)
    assert plan.status == "ok"
    return Case(automaton, plan, care)


def test_an_action_that_is_insisted_on_is_done_with_all_that_it_takes(insisted: Case) -> None:
    told = carry_out(insisted)
    assert told.result.outcome == "done"
    assert told.robot.sent == [str(a) for a in insisted.plan.segments["c1"].actions]
    assert told.robot.sent[-1] == "(place tray table)"


def test_an_action_that_is_insisted_on_is_part_of_every_new_plan(insisted: Case) -> None:
    told = carry_out(insisted, moved(5.0, "(at tray dining-table)"))
    assert told.result.outcome == "done"
    assert "(place tray table)" in told.one(Replanned).after
    assert told.robot.sent[-1] == "(place tray table)"


# People who help


def test_help_saves_work_and_is_said(serve: Case) -> None:
    plain = carry_out(serve)
    # Somebody fills the tray and puts it on the resident's table while the robot is on its way.
    told = carry_out(serve, moved(5.0, *FULL_TRAY))
    assert told.result.checkpoints == ("fetched",)
    assert told.result.seconds < plain.result.seconds / 2
    skipped = told.one(Skipped)
    assert skipped.actions == [
        str(a) for a in serve.plan.segments["c1"].actions[-len(skipped.actions) :]
    ]
    assert skipped.text.startswith("It is so already, so I needn't ")
    assert not any("pick" in x for x in told.robot.sent)


def test_help_with_a_part_of_the_work_saves_that_part(serve: Case) -> None:
    told = carry_out(serve, moved(5.0, "(is-full tray)"))
    assert told.result.outcome == "done"
    assert "(pick tray empty-trays)" in told.robot.sent
    assert not any("fill" in x for x in told.robot.sent)


def test_help_that_is_taken_back_at_once_decides_nothing(serve: Case) -> None:
    turn = next(e.time - T0 for e in carry_out(serve).of(GoalSent) if "fill" in e.action)
    glimpse = (moved(turn - 0.05, "(is-full tray)"), moved(turn + 0.05, "(not (is-full tray))"))
    told = carry_out(serve, *glimpse)
    assert told.of(Skipped) == []
    assert any("fill" in x for x in told.robot.sent)


# Against the author's word


def test_the_forgotten_wait_halts_with_expected_beside_observed(hasty_dishes: Case) -> None:
    told = carry_out(hasty_dishes)
    halt = told.one(Halted)
    assert told.of(Replanned) == []
    assert (halt.expected, halt.observed) == (["(at cup countertop)"], ["(at cup drying-rack)"])
    assert told.result.reason == (
        "I expected that the cup is on the countertop, but I see that the cup is on the drying rack."
        " Put that right and resume the run, or let the program wait until the cup is on the drying rack."
    )


def test_the_forgotten_wait_goes_on_when_the_dish_is_put_back_in_time(hasty_dishes: Case) -> None:
    deviated = carry_out(hasty_dishes).one(Deviated)
    back = deviated.time - T0 + RunSettings().grace_s - 1.0
    told = carry_out(hasty_dishes, moved(back, "(at cup countertop)", "(at plate countertop)"))
    assert told.of(Recovered)[0].expected == ["(at cup countertop)"]
    assert told.result.outcome == "done"
    assert told.result.beliefs.holds(literal("(in cup cupboard)"))


def test_what_a_transition_waited_for_is_not_gone_around_either(dishes: Case) -> None:
    taken = next(e.time for e in carry_out(dishes).events if getattr(e, "when", None))
    told = carry_out(dishes, moved(taken - T0 + 1.0, "(at cup dining-table)"))
    assert told.of(Replanned) == []
    assert told.one(Halted).expected == ["(at cup drying-rack)"]


def test_completed_goals_are_not_repeated_after_a_new_plan(care: Planner) -> None:
    steps = case(
        care,
        ("start", "lunch", (), ("(at tray table)",)),
        ("lunch", "cup", (), ("(at cup desk)",)),
    )
    reached = carry_out(steps).of(CheckpointReached)[0].time - T0
    told = carry_out(steps, moved(reached + 0.5, "(at cup food-station)"))
    assert told.result.outcome == "done"
    assert times(told) == ["lunch", "cup"]
    assert [e.action for e in told.of(GoalSent)].count("(place tray table)") == 1
