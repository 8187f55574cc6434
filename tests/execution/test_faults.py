"""What goes wrong on purpose: each fault of the simulated world, and people who move things, stop and pause."""

from __future__ import annotations

import pytest

from polaris_nl.execution.backend import CancelGoal, SendGoal, StopRobot
from polaris_nl.execution.events import (
    CheckpointReached,
    Deviated,
    GoalConfirmed,
    GoalSent,
    Halted,
    Recovered,
    RobotReported,
    TransitionTaken,
)
from polaris_nl.execution.faults import Fault
from polaris_nl.execution.settings import RunSettings
from polaris_nl.execution.state import HumanCommand
from polaris_nl.planning.planner import Planner
from tests.execution.story import T0, Case, Commands, Told, carry_out, case, literal, literals

GRACE_S = RunSettings().grace_s
TICK_S = RunSettings().tick_s
SERVING_S = 30.0
"""Longer than the shortest run takes; `test_the_moments_cover_the_run` checks that."""
MOMENTS = [round(n * TICK_S, 1) for n in range(int(SERVING_S / TICK_S))]


def moved(at: float, *texts: str) -> Fault:
    return Fault(at, "event", literals=literals(*texts))


def at_moments(**moments: float) -> Commands:
    """Each kind of command once, at the first tick from its moment on."""
    left = dict(moments)

    def commands(seconds: float) -> list[HumanCommand]:
        due = [kind for kind, at in left.items() if seconds >= at - 1e-6]
        for kind in due:
            del left[kind]
        return [HumanCommand(kind) for kind in due]

    return commands


def halted(told: Told) -> Halted:
    assert told.result.outcome == "halted"
    kinds = [type(command) for _, command in told.robot.commanded]
    assert kinds[-1] is StopRobot
    assert told.robot.stopped
    return told.one(Halted)


# The robot


def test_a_rejected_goal_halts_and_gives_the_robots_reason(serve: Case) -> None:
    told = carry_out(serve, Fault(2.0, "reject"))
    halt = halted(told)
    assert "it is in the wrong mode" in halt.reason
    # The goal that was rejected is the second, and no other follows.
    assert told.robot.sent == ["(move home hall)", "(move hall cafeteria)"]
    assert told.of(RobotReported)[-1].report == "rejected"


def test_a_goal_that_never_ends_halts_after_the_limit_and_says_what_was_expected(
    serve: Case,
) -> None:
    told = carry_out(serve, Fault(2.0, "never"), goal_s=40.0)
    halt = halted(told)
    assert halt.expected == ["(not (robot-at hall))", "(robot-at cafeteria)"]
    assert halt.observed == ["(robot-at hall)"]
    assert halt.time - told.of(GoalSent)[-1].time == pytest.approx(40.0, abs=0.3)
    assert isinstance(told.robot.commanded[-3][1], CancelGoal)


def test_a_lie_is_not_believed(serve: Case) -> None:
    told = carry_out(serve, Fault(2.0, "lie"), replans=False)
    halt = halted(told)
    reports = [r.report for r in told.of(RobotReported) if r.goal == 2]
    assert reports == ["accepted", "succeeded"]
    assert [c.goal for c in told.of(GoalConfirmed)] == [1]
    assert told.one(Deviated).expected == ["(not (robot-at hall))", "(robot-at cafeteria)"]
    assert halt.time - told.one(Deviated).time == pytest.approx(GRACE_S, abs=0.2)


def test_a_lie_that_somebody_makes_true_in_the_grace_time_is_recovered(serve: Case) -> None:
    push = moved(13.0, "(not (robot-at hall))", "(robot-at cafeteria)")
    told = carry_out(serve, Fault(2.0, "lie"), push, replans=False)
    assert told.result.outcome == "done"
    assert told.one(Recovered).time == pytest.approx(T0 + 13.0, abs=0.2)
    # It was so already when its turn came again: it isn't sent twice.
    assert told.robot.sent.count("(move hall cafeteria)") == 1


def test_after_a_lie_the_goal_is_sent_again_a_few_times(serve: Case) -> None:
    once = carry_out(serve, Fault(2.0, "lie"))
    assert once.result.outcome == "done"
    assert once.robot.sent.count("(move hall cafeteria)") == 2
    always = carry_out(serve, Fault(2.0, "lie", times=99))
    assert always.robot.sent.count("(move hall cafeteria)") == 1 + RunSettings().retries
    assert halted(always).expected == ["(not (robot-at hall))", "(robot-at cafeteria)"]


@pytest.mark.parametrize("times", [1, 2])
def test_a_goal_that_fails_is_sent_again(serve: Case, times: int) -> None:
    told = carry_out(serve, Fault(2.0, "fail", times=times))
    assert told.result.outcome == "done"
    assert told.robot.sent.count("(move hall cafeteria)") == 1 + times
    numbers = [e.goal for e in told.of(GoalSent)]
    assert numbers == sorted(set(numbers))


def test_late_news_of_a_goal_that_is_over_is_none_of_the_next(serve: Case) -> None:
    told = carry_out(serve, Fault(2.0, "late"), report_s=0.5)
    assert told.result.outcome == "done"
    assert told.of(Deviated) == []
    assert [r.goal for r in told.of(RobotReported) if r.report == "failed"] == [2]
    assert [r for r in told.of(RobotReported) if (r.goal, r.report) == (2, "succeeded")] == []


def test_a_goal_that_fails_too_often_halts(serve: Case) -> None:
    told = carry_out(serve, Fault(2.0, "fail", times=3))
    assert "something slipped" in halted(told).reason
    assert told.robot.sent.count("(move hall cafeteria)") == 3


def test_the_patience_is_each_goals_own(serve: Case) -> None:
    told = carry_out(
        serve, Fault(0.0, "fail", times=2), Fault(5.0, "fail", times=2), Fault(9.5, "fail", times=2)
    )
    assert told.result.outcome == "done"
    assert [r.report for r in told.of(RobotReported)].count("failed") == 6


def test_while_blind_nothing_is_confirmed_and_afterwards_it_goes_on(serve: Case) -> None:
    told = carry_out(serve, Fault(3.0, "blind", seconds=4.0))
    assert told.result.outcome == "done"
    first = told.of(GoalConfirmed)[0]
    # The robot was there after 4 s, unseen.
    assert told.robot.motions[0][0] == pytest.approx(T0 + 4.0, abs=0.2)
    assert first.time == pytest.approx(T0 + 7.0 + RunSettings().confirm_s, abs=0.25)


def test_blind_for_too_long_halts_and_claims_to_have_seen_nothing(serve: Case) -> None:
    told = carry_out(serve, Fault(3.0, "blind", seconds=300.0))
    halt = halted(told)
    assert told.of(GoalConfirmed) == []
    assert "(not (robot-at home))" in halt.expected
    assert halt.observed == []
    assert told.one(Deviated).observed == []


def test_an_answer_that_is_given_while_blind_counts_once_it_is_seen(lunch: Case) -> None:
    told = carry_out(lunch, Fault(11.2, "blind", seconds=30.0))
    answered = next(e for e in told.of(TransitionTaken) if e.when)
    assert answered.time >= T0 + 41.2
    assert told.result.checkpoints == ("alerted", "fetched", "home")


def test_a_pause_holds_even_where_the_robot_ignores_the_cancelling(serve: Case) -> None:
    told = carry_out(
        serve, Fault(0.0, "ignore-cancel", times=9), commands=at_moments(pause=2.0, resume=20.0)
    )
    assert told.result.outcome == "done"
    assert min(at for at, _ in told.robot.motions) >= T0 + 20.0


def test_a_stop_holds_even_where_the_robot_ignores_the_cancelling(serve: Case) -> None:
    told = carry_out(serve, Fault(0.0, "ignore-cancel", times=9), commands=at_moments(stop=2.0))
    assert told.result.outcome == "stopped"
    told.robot.advance(T0 + 100.0)
    assert told.robot.motions == []


# People


def test_a_cupboard_that_somebody_closed_is_opened_again(put_away: Case) -> None:
    told = carry_out(put_away, moved(16.0, "(not (open cupboard))"))
    assert told.result.outcome == "done"
    opened = [at for at, a in told.robot.motions if a.operator == "open-container"]
    assert len(opened) == 2
    assert opened[0] < T0 + 16.0 < opened[1]
    assert told.robot.sent.count("(open-container cupboard)") == 1
    assert told.result.beliefs.holds(literal("(in cup cupboard)"))


def test_a_cupboard_closed_under_the_robots_hand_is_a_deviation(put_away: Case) -> None:
    opening = carry_out(put_away).robot.motions[2]
    assert opening[1].operator == "open-container"
    just_then = opening[0] - T0 + TICK_S
    told = carry_out(put_away, moved(just_then, "(not (open cupboard))"), replans=False)
    halt = halted(told)
    assert (halt.expected, told.result.checkpoints) == (["(open cupboard)"], ())
    again = carry_out(
        put_away,
        moved(just_then, "(not (open cupboard))"),
        moved(just_then + 6.0, "(open cupboard)"),
        replans=False,
    )
    assert again.one(Recovered).expected == ["(open cupboard)"]
    assert again.result.checkpoints == ("opened", "stowed")


def test_an_object_put_back_in_the_grace_time_is_a_recovery(serve: Case) -> None:
    told = carry_out(
        serve,
        moved(5.0, "(at tray dining-table)"),
        moved(12.0, "(at tray empty-trays)"),
        replans=False,
    )
    assert told.result.outcome == "done"
    deviated, recovered = told.one(Deviated), told.one(Recovered)
    assert deviated.expected == recovered.expected == ["(at tray empty-trays)"]
    assert deviated.observed == ["(at tray dining-table)"]
    assert recovered.seconds == pytest.approx(T0 + 12.0 - deviated.time, abs=0.2)
    assert told.of(Halted) == []


@pytest.mark.parametrize("late_s", [None, 0.5])
def test_an_object_not_put_back_or_too_late_halts(serve: Case, late_s: float | None) -> None:
    away = moved(5.0, "(at tray dining-table)")
    told = carry_out(serve, away, replans=False)
    deviated = told.one(Deviated)
    if late_s is not None:
        back = deviated.time - T0 + GRACE_S + late_s
        told = carry_out(serve, away, moved(back, "(at tray empty-trays)"), replans=False)
    halt = halted(told)
    assert halt.expected == ["(at tray empty-trays)"]
    assert halt.observed == ["(at tray dining-table)"]
    assert halt.time - deviated.time == pytest.approx(GRACE_S, abs=0.2)
    assert "(pick tray empty-trays)" not in told.robot.sent


def test_an_object_moved_while_the_robot_reaches_for_it_is_a_deviation(serve: Case) -> None:
    told = carry_out(serve, moved(10.0, "(at tray dining-table)"), replans=False)
    assert "(pick tray empty-trays)" in told.robot.sent
    assert told.of(RobotReported)[-1].report == "failed"
    assert halted(told).expected == ["(at tray empty-trays)"]


def test_a_goal_that_held_before_must_hold_still_when_its_checkpoint_is_reached(
    care: Planner,
) -> None:
    steps = case(
        care,
        ("start", "fetched", (), ("(at cup desk)",)),
        ("fetched", "home", (), ("(robot-at home)", "(at cup desk)")),
    )
    placed = carry_out(steps).of(CheckpointReached)[0].time - T0
    told = carry_out(steps, moved(placed + 1.0, "(at cup worktop)"))
    halt = halted(told)
    assert told.result.checkpoints == ("fetched",)
    assert (halt.expected, halt.observed) == (["(at cup desk)"], ["(at cup worktop)"])
    assert told.result.beliefs.holds(literal("(robot-at home)"))


def test_what_a_person_says_happened_is_no_perceived_goal(care: Planner) -> None:
    steps = case(
        care,
        ("start", "alerted", (), ("(alerted-to resident lunchtime)",)),
        ("alerted", "there", ("(at cup desk)",), ("(at cup desk)",)),
    )
    claim = HumanCommand("happened", literals("(at cup desk)"))
    told = carry_out(steps, commands=lambda seconds: [claim] if 3.0 <= seconds < 3.1 else [])
    assert told.of(TransitionTaken)[-1].when == ["(at cup desk)"]
    assert told.result.checkpoints == ("alerted",)
    assert halted(told).expected == ["(at cup desk)"]


def test_what_a_person_says_happened_serves_one_transition_only(care: Planner) -> None:
    cup = ("(at cup desk)",)
    steps = case(
        care,
        ("start", "alerted", (), ("(alerted-to resident lunchtime)",)),
        ("alerted", "hall", cup, ("(robot-at hall)",)),
        ("hall", "home", cup, ("(robot-at home)",)),
    )
    claim = HumanCommand("happened", literals(*cup))
    told = carry_out(
        steps,
        moved(60.0, *cup),
        commands=lambda seconds: [claim] if 3.0 <= seconds < 3.1 else [],
    )
    first, second = (t for t in told.of(TransitionTaken) if t.when)
    assert first.time < T0 + 20.0
    assert second.time == pytest.approx(T0 + 60.0, abs=1.0)
    assert told.result.outcome == "done"


# Stop and pause, at every moment


def test_the_moments_cover_the_run(serve: Case) -> None:
    told = carry_out(serve)
    assert told.result.outcome == "done"
    assert told.result.seconds < SERVING_S


def test_after_a_stop_at_any_moment_nothing_is_sent_and_nothing_moves(serve: Case) -> None:
    ended = carry_out(serve).result.seconds
    for moment in (m for m in MOMENTS if m < ended - TICK_S):
        told = carry_out(serve, commands=at_moments(stop=moment))
        assert told.result.outcome == "stopped", moment
        # One more look, to see that it stands still.
        assert told.result.seconds == pytest.approx(moment + TICK_S, abs=TICK_S / 2), moment
        sent = [at for at, c in told.robot.commanded if isinstance(c, SendGoal)]
        assert all(at < moment - 1e-6 for at in sent), moment
        assert isinstance(told.robot.commanded[-1][1], StopRobot), moment
        moves = len(told.robot.motions)
        told.robot.advance(T0 + 500.0)
        assert len(told.robot.motions) == moves, moment


def test_after_a_pause_at_any_moment_nothing_moves_until_it_is_resumed(serve: Case) -> None:
    plain = carry_out(serve)
    for moment in (m for m in MOMENTS if m < plain.result.seconds - TICK_S):
        until = moment + 7.0
        told = carry_out(serve, commands=at_moments(pause=moment, resume=until))
        still = [at for at, _ in told.robot.motions if moment + 0.01 < at - T0 < until - 0.01]
        sent = [at for at, c in told.robot.commanded if isinstance(c, SendGoal)]
        assert still == [], moment
        assert not any(moment - 1e-6 < at < until - 1e-6 for at in sent), moment
        assert told.result.outcome == "done", moment
        assert told.result.checkpoints == plain.result.checkpoints, moment
        assert told.result.beliefs == plain.result.beliefs, moment


def test_a_stop_while_paused_deviating_or_waiting_ends_the_run(serve: Case, lunch: Case) -> None:
    away = moved(5.0, "(at tray dining-table)")
    paused = carry_out(serve, commands=at_moments(pause=3.0, stop=9.0))
    deviating = carry_out(serve, away, commands=at_moments(stop=12.0))
    waiting = carry_out(lunch, people=(), commands=at_moments(stop=60.0))
    assert len(deviating.of(Deviated)) == 1
    for told, at in ((paused, 9.0), (deviating, 12.0), (waiting, 60.0)):
        assert told.result.outcome == "stopped"
        assert told.result.reason == "You stopped the run."
        assert told.result.seconds == pytest.approx(at + TICK_S, abs=TICK_S)
        assert told.robot.stopped
