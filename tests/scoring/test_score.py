"""The scores of docs/score.md: each figure that is worked out there by hand, and what they promise."""

from __future__ import annotations

import dataclasses

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from polaris_nl.automaton.automaton import Automaton
from polaris_nl.execution.backend import Command, SendGoal
from polaris_nl.execution.clock import VirtualClock
from polaris_nl.execution.events import Event, Observed, PersonActed, RunStarted
from polaris_nl.execution.runner import RunResult, objectives_met, run
from polaris_nl.execution.simulation import SimulatedRobot
from polaris_nl.execution.simulation_settings import SimulationSettings
from polaris_nl.execution.state import RunPlan
from polaris_nl.model.domain import Action
from polaris_nl.model.formula import parse_literal
from polaris_nl.model.world import HumanAction, Objective, Scenario
from polaris_nl.model.world_file import load_world
from polaris_nl.planning.planner import Planner
from polaris_nl.planning.result import BranchingPlan
from polaris_nl.scoring.people import Act, Hands, listed_acts, useful
from polaris_nl.scoring.play import Moment, Play
from polaris_nl.scoring.score import final_beliefs, runtime_score, score
from polaris_nl.scoring.search import Done, best_run
from tests.planning.conftest import program

RACKED = "[(at cup drying-rack)(at plate drying-rack)]"
COUNTER = "fetched: (at cup countertop)(at plate countertop)"
AWAY = "away: (in cup cupboard)(in plate cupboard)"

# Program; feasibility; people's actions in the best run; human effort. docs/score.md says why.
BY_HAND = {
    "the whole solution": ([COUNTER, f"opened {RACKED}: (open cupboard)", AWAY], 4, 2, 2),
    "the opening left to the robot": ([COUNTER, f"away {RACKED}: {AWAY[6:]}"], 4, 2, 2),
    "without the wait": ([COUNTER, "opened: (open cupboard)", AWAY], 2, 2, 4),
    "without one dish": (
        [
            "fetched: (at cup countertop)",
            "opened [(at cup drying-rack)]: (open cupboard)",
            "away: (in cup cupboard)",
        ],
        2, 1, 4,
    ),
    "one dish isn't put away": (
        [COUNTER, f"opened {RACKED}: (open cupboard)", "away: (in cup cupboard)"], 3, 2, 3,
    ),
    "without the cupboard": ([COUNTER, f"washed {RACKED}:"], 2, 2, 5),
    "the dishes are only fetched": ([COUNTER], 1, 1, 6),
    "the robot only goes to the hall": (["there: (robot-at hall)"], 0, 0, 7),
}  # fmt: skip


@pytest.fixture(scope="module")
def dinner() -> Planner:
    return Planner(load_world("dinner-party"))


@pytest.fixture(scope="module")
def care() -> Planner:
    return Planner(load_world("care-home"))


@pytest.mark.parametrize("name", BY_HAND)
def test_the_figures_worked_out_by_hand(dinner: Planner, name: str) -> None:
    lines, feasibility, helped, effort = BY_HAND[name]
    automaton = program(*lines)
    plan = dinner.compile(automaton)
    found = score(automaton, plan, dinner)
    assert plan.status == "ok"
    assert found.feasible.settled
    assert (found.feasible.count, len(found.feasible.chosen)) == (feasibility, helped)
    assert found.least.settled
    assert found.human_effort == effort
    assert not any(done.act.by_hand for done in found.feasible.chosen)


@pytest.mark.parametrize("name", BY_HAND)
def test_the_real_executor_meets_what_the_best_runs_promise(dinner: Planner, name: str) -> None:
    automaton = program(*BY_HAND[name][0])
    plan = dinner.compile(automaton)
    found = score(automaton, plan, dinner)
    play = Play(automaton, plan, dinner.world, dinner.segment)
    for best in (found.feasible, found.least):
        robot = Helped(dinner, play, best.chosen)
        result = carried_out(dinner, automaton, plan, robot)
        met = objectives_met(dinner.world, result.beliefs)
        assert not robot.pending
        assert tuple(ok for _, ok in met) == best.met


def test_lunch_needs_one_answer(care: Planner) -> None:
    automaton = program(
        "alerted: (alerted-to resident lunchtime)",
        "fetched [(acknowledged lunchtime)]: (at tray table)(is-full tray)",
        "home: (robot-at home)",
        "alerted -> cancelled [(dismissed lunchtime)]: (robot-at home)",
    )
    found = score(automaton, care.compile(automaton), care)
    assert (found.feasible.count, found.human_effort) == (3, 1)
    assert [done.act.name for done in found.feasible.chosen] == ["acknowledge"]


def test_what_is_decided_at_once_leaves_nobody_time_to_act(care: Planner) -> None:
    # With an otherwise the robot doesn't wait for the answer.
    automaton = program(
        "alerted: (alerted-to resident lunchtime)",
        "fetched [(acknowledged lunchtime)]: (at tray table)(is-full tray)",
        "alerted -> home: (robot-at home)",
    )
    assert score(automaton, care.compile(automaton), care).feasible.count == 2


def test_a_part_without_a_plan_halts_the_run(dinner: Planner) -> None:
    automaton = program("clean: (is-clean cup)", "away: (in cup cupboard)")
    plan = dinner.compile(automaton)
    assert plan.status == "partial"
    found = score(automaton, plan, dinner)
    assert (found.feasible.count, found.human_effort) == (0, None)


def test_without_people_nothing_is_added(dinner: Planner) -> None:
    goals = Scenario((Objective("there", parse_literal("(robot-at hall)")),))
    planner = Planner(dataclasses.replace(dinner.world, scenario=goals))
    automaton = program("there: (robot-at hall)")
    found = score(automaton, planner.compile(automaton), planner)
    assert (found.feasible.count, found.human_effort) == (1, 0)


def test_too_many_ways_are_said_not_to_be_settled(dinner: Planner) -> None:
    automaton = program(*BY_HAND["without the cupboard"][0])
    found = score(automaton, dinner.compile(automaton), dinner, most=100)
    assert not found.least.settled
    assert found.human_effort is None
    assert found.least.tried < 5


def test_people_open_a_cupboard_before_they_reach_into_it(dinner: Planner) -> None:
    hands = Hands(dinner.world, dinner.mutexes)
    automaton = program(*BY_HAND["without the cupboard"][0])
    acts = hands.acts(Play(automaton, dinner.compile(automaton), dinner.world, dinner.segment))
    at_first = {str(act.effect[0]) for act in useful(acts, dinner.world.initial, hands)}
    assert "(open cupboard)" in at_first
    assert "(at cup countertop)" in at_first
    assert "(in cup cupboard)" not in at_first
    inside = dinner.world.initial.after_event((parse_literal("(in cup cupboard)"),), dinner.mutexes)
    then = {str(act.effect[0]) for act in useful(acts, inside, hands)}
    assert "(at cup countertop)" not in then
    assert not any(act.effect[0].predicate in ("is-clean", "robot-at") for act in acts)


# A log


def test_runtime_score_counts_what_was_perceived_last(dinner: Planner) -> None:
    beliefs = [str(f) for f in dinner.world.facts]
    events: list[Event] = [
        RunStarted(time=0.0, robot="world", beliefs=beliefs),
        Observed(time=1.0, added=["(is-clean cup)", "(in cup cupboard)"], removed=[]),
        Observed(time=2.0, added=["(at cup sink)"], removed=["(in cup cupboard)"]),
    ]
    met = runtime_score(events, dinner.world)
    assert met is not None
    assert [ok for _, ok in met] == [True, False, False, False]
    assert final_beliefs([]) is None


# Against other ways to find out

STEPS = st.sampled_from(
    [COUNTER, "cup: (at cup countertop)", "rack: (at plate drying-rack)", "open: (open cupboard)",
     AWAY, "cup in: (in cup cupboard)", "hall: (robot-at hall)", f"wait {RACKED}:",
     "plate washed [(is-clean plate)]:"]
)  # fmt: skip
PROGRAMS = st.lists(STEPS, min_size=1, max_size=4, unique=True)
WILLING = st.sampled_from([None, (), ("wash the cup",), ("wash the plate",)])


@given(PROGRAMS, WILLING, st.integers(0, 3))
@settings(max_examples=15)
def test_no_run_meets_more_than_feasible(
    dinner: Planner, lines: list[str], people: tuple[str, ...] | None, seed: int
) -> None:
    automaton = program(*lines)
    plan = dinner.compile(automaton)
    if not plan.segments:
        return
    seen: list[Event] = []
    robot = SimulatedRobot(
        dinner.world, dinner.mutexes, dinner.segment, SimulationSettings(people=people, seed=seed),
        sink=seen.append,
    )  # fmt: skip
    result = carried_out(dinner, automaton, plan, robot)
    met = sum(ok for _, ok in objectives_met(dinner.world, result.beliefs))
    found = score(automaton, plan, dinner)
    assert met <= found.feasible.count
    if met == 4:
        acted = sum(isinstance(event, PersonActed) for event in seen)
        assert found.human_effort is not None
        assert found.human_effort <= acted


@given(PROGRAMS)
@settings(max_examples=25)
def test_the_search_finds_what_trying_everything_finds(dinner: Planner, lines: list[str]) -> None:
    # One objective and one more human action, so that everything can be tried.
    clean_away = dinner.world.scenario.objectives[2]
    fetch = HumanAction("bring the cup", (parse_literal("(at cup countertop)"),))
    scenario = Scenario((clean_away,), (dinner.world.scenario.human_actions[0], fetch))
    world = dataclasses.replace(dinner.world, scenario=scenario)
    automaton = program(*lines)
    play = Play(automaton, dinner.compile(automaton), world, dinner.segment)
    hands = Hands(world, dinner.mutexes)
    acts = listed_acts(world)
    fewest = everything(play, play.start, acts, hands, dinner, 3)
    best = best_run(play, acts, hands, dinner.mutexes)
    assert best.settled
    assert (len(best.chosen) if best.count else None) == fewest


def everything(
    play: Play, moment: Moment, acts: tuple[Act, ...], hands: Hands, planner: Planner, left: int
) -> int | None:
    """The fewest human actions that meet all, by trying everything; None where `left` aren't enough."""
    step = None if moment.over else play.next(moment)
    found: list[int] = []
    if step is None:
        if all(ok for _, ok in objectives_met(play.world, moment.state)):
            found.append(0)
    else:
        after = everything(play, step.moment, acts, hands, planner, left)
        found += [] if after is None else [after]
    if left and not moment.over and (step is None or step.moves):
        for act in useful(acts, moment.state, hands):
            state = moment.state.after_event(act.effect, planner.mutexes)
            changed = dataclasses.replace(moment, state=state)
            after = everything(play, changed, acts, hands, planner, left - 1)
            found += [] if after is None else [after + 1]
    return min(found, default=None)


class Helped(SimulatedRobot):
    """A robot beside people who do certain things, each at its moment."""

    def __init__(self, planner: Planner, play: Play, chosen: tuple[Done, ...]) -> None:
        nobody = SimulationSettings(people=())
        super().__init__(planner.world, planner.mutexes, planner.segment, nobody)
        self.pending = timed(play, chosen, planner)
        self._busy = 0.0
        self._sent: list[Action] = []

    def command(self, command: Command) -> None:
        if isinstance(command, SendGoal):
            if self._sent[-1:] != [command.action]:  # Otherwise it is sent again.
                self._sent.append(command.action)
            moment = (command.action, self._sent.count(command.action))
            while self.pending and self.pending[0][1] == moment:
                self._make_true(self.pending.pop(0)[0].effect)
        super().command(command)

    def advance(self, now: float) -> None:
        super().advance(now)
        self._busy = now if self._task is not None else self._busy
        while self.pending and self.pending[0][1] is None and now - self._busy > 2.0:
            self._make_true(self.pending.pop(0)[0].effect)
            self._busy = now


def timed(
    play: Play, chosen: tuple[Done, ...], planner: Planner
) -> list[tuple[Act, tuple[Action, int] | None]]:
    """Each act with what the robot does meanwhile, and how many times it has done that by then."""
    found: list[tuple[Act, tuple[Action, int] | None]] = []
    moved: list[Action | None] = []
    left, moment = list(chosen), play.start
    while left:
        done, doing, step = left[0], play.doing(moment), play.next(moment)
        during = doing if step is not None and step.moves else None
        here = (moment.checkpoint, moment.done, during) == (done.checkpoint, done.step, done.during)
        if here and (step is None or step.moves):
            left.pop(0)
            found.append((done.act, (during, moved.count(during) + 1) if during else None))
            state = moment.state.after_event(done.act.effect, planner.mutexes)
            moment = dataclasses.replace(moment, state=state)
            continue
        assert step is not None
        moved += [doing] if step.moves else []
        moment = step.moment
    return found


def carried_out(
    planner: Planner, automaton: Automaton, plan: BranchingPlan, robot: SimulatedRobot
) -> RunResult:
    order = RunPlan(automaton, plan, planner.world, planner.wording)
    return run(order, robot, VirtualClock(0.0), confirmed=True, sink=lambda event: None)
