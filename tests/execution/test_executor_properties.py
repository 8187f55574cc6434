"""The executor's core, whatever is perceived, reported and commanded, in whatever order."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field, replace
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from polaris_nl.automaton.program import parse_action
from polaris_nl.execution.backend import (
    READY,
    CancelGoal,
    Command,
    Health,
    Observation,
    Report,
    RunStop,
    SendGoal,
    StopRobot,
    ZeroVelocity,
)
from polaris_nl.execution.events import (
    CheckpointReached,
    CommandGiven,
    Deviated,
    Event,
    GoalConfirmed,
    GoalSent,
    Halted,
    Recovered,
    Replanned,
    RunEnded,
    Skipped,
    TransitionTaken,
    Waiting,
)
from polaris_nl.execution.executor import step
from polaris_nl.execution.expectations import needed_places
from polaris_nl.execution.settings import RunSettings
from polaris_nl.execution.state import (
    TERMINAL,
    ExecutorState,
    HumanCommand,
    Inputs,
    PlanAnswer,
    RunPlan,
)
from polaris_nl.model.domain import Action
from polaris_nl.model.evaluate import after, applicable, effects
from polaris_nl.model.formula import Literal
from polaris_nl.planning.planner import Planner
from tests.execution.story import FULL_TRAY, Case, case, literal, literals

ACKNOWLEDGED, DISMISSED = literals("(acknowledged lunchtime)", "(dismissed lunchtime)")
ALERT = ("start", "alerted", (), ("(alerted-to resident lunchtime)",))
SERVE = ("alerted", "served", (str(ACKNOWLEDGED),), FULL_TRAY)
HOME = ("served", "home", (), ("(robot-at home)", "(at tray table)"))
CANCEL = ("alerted", "cancelled", (str(DISMISSED),), ("(robot-at home)",))
GIVE_UP = ("alerted", "left", (), ("(robot-at home)",))
PROGRAMS = ("labelled", "otherwise")
EPSILON = 1e-6


@pytest.fixture(scope="module")
def programs(care: Planner) -> dict[str, Case]:
    return {
        "labelled": case(care, ALERT, SERVE, HOME, CANCEL),
        "otherwise": case(care, ALERT, SERVE, HOME, GIVE_UP),
    }


# Random surroundings


@dataclass(frozen=True)
class Moment:
    """What happens before a step.

    Attributes:
        dt: seconds since the step before.
        obeys: the robot has made its goal true.
        change: somebody makes this true.
        lost: atoms of which nothing is known; None = everything, and `()` = all is seen.
        reports: what the robot says, with the goal's number counted from the present one.
        commands: what people say.
        moving, health: what is known of the robot itself.
    """

    dt: float = 0.1
    obeys: bool = False
    change: tuple[Literal, ...] = ()
    lost: tuple[Literal, ...] | None = ()
    reports: tuple[tuple[int, Any], ...] = ()
    commands: tuple[HumanCommand, ...] = ()
    moving: bool | None = False
    health: Health = READY


CHANGES = st.sampled_from(
    literals(
        str(ACKNOWLEDGED),
        str(DISMISSED),
        f"(not {ACKNOWLEDGED})",
        "(at tray dining-table)",
        "(at tray empty-trays)",
        "(at tray table)",
        "(robot-at home)",
        "(robot-at hall)",
        "(not (is-full tray))",
        "(holding cup)",
    )
)
COMMANDS = st.one_of(
    st.sampled_from([HumanCommand("pause"), HumanCommand("resume"), HumanCommand("resume")]),
    st.builds(lambda x: HumanCommand("happened", (x,)), st.sampled_from([ACKNOWLEDGED, DISMISSED])),
    st.just(HumanCommand("stop")),
)
KINDS = st.sampled_from(["accepted", "succeeded", "failed", "cancelled", "rejected"])
QUIET = st.builds(
    lambda number, change: [
        Moment(dt=0.4, obeys=True, change=change, reports=((0, "accepted"),)) for _ in range(number)
    ],
    st.integers(1, 30),
    st.sampled_from([(), (ACKNOWLEDGED,), (DISMISSED,)]),
)
GOING_ON = Moment(dt=0.4, obeys=True, change=(ACKNOWLEDGED,), reports=((0, "accepted"),))
MOVED = st.builds(
    lambda before, away: [
        *[GOING_ON] * before,
        Moment(change=literals("(at tray dining-table)")),
        *[GOING_ON] * away,
        Moment(change=literals("(at tray empty-trays)")),
    ],
    st.integers(6, 11),
    st.integers(1, 12),
)
UNQUIET = st.builds(
    Moment,
    dt=st.sampled_from([0.0, 0.1, 0.3, 1.0, 4.0, 9.0, 130.0]),
    obeys=st.booleans(),
    change=st.lists(CHANGES, max_size=1).map(tuple),
    lost=st.one_of(st.just(()), st.just((ACKNOWLEDGED,)), st.none()),
    reports=st.lists(st.tuples(st.sampled_from([0, 0, -1, 1]), KINDS), max_size=2).map(tuple),
    commands=st.one_of(st.just(()), st.lists(COMMANDS, max_size=2).map(tuple)),
    moving=st.sampled_from([False, False, True, None]),
    health=st.sampled_from([READY] * 19 + [Health("silent")]),
)
PARTS = st.lists(st.one_of(QUIET, UNQUIET.map(lambda m: [m])), max_size=14)
HISTORIES = st.builds(
    lambda first, parts: [*first, *(moment for part in parts for moment in part)],
    st.one_of(st.just([]), MOVED),
    PARTS,
)


@dataclass
class Surroundings:
    """Feeds the core and keeps all that went in and came out."""

    run: RunPlan
    planner: Planner
    state: ExecutorState = field(default_factory=ExecutorState)
    now: float = 0.0
    goal: SendGoal | None = None
    seen: list[tuple[float, Observation]] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.facts = self.run.world.initial

    def pass_by(self, moment: Moment) -> tuple[Inputs, tuple[Command, ...], tuple[Event, ...]]:
        self.now += moment.dt
        if moment.obeys and self.goal is not None:
            self.facts = self.facts.after_event(self.goal.literals, self.planner.mutexes)
        self.facts = self.facts.after_event(moment.change, self.planner.mutexes)
        everything = frozenset(self.run.world.domain.predicates)
        observation = Observation(
            self.facts,
            frozenset() if moment.lost is None else frozenset(moment.lost),
            everything if moment.lost is None else frozenset(),
            health=moment.health,
            moving=moment.moving,
        )
        self.seen.append((self.now, observation))
        reports = tuple(Report(self.state.goal + n, kind) for n, kind in moment.reports)
        inputs = Inputs(observation, reports, moment.commands, self._plans())
        self.state, commands, events = step(self.run, self.state, self.now, inputs)
        for command in commands:
            self.goal = command if isinstance(command, SendGoal) else None
        return inputs, commands, events

    def _plans(self) -> tuple[PlanAnswer, ...]:
        request = self.state.request
        if request is None:
            return ()
        found = self.planner.segment(request.state, request.goals)
        return (PlanAnswer(request.number, found.actions if found.status == "solved" else None),)

    def perceived_for(self, wanted: tuple[Literal, ...], seconds: float) -> bool:
        """Whether literals have been seen in every observation of the last seconds."""
        recent: list[Observation] = []
        for at, observation in reversed(self.seen):
            recent.append(observation)
            if at <= self.now - seconds + EPSILON:
                return all(o.holds(x) for o in recent for x in wanted)
        return False


def surroundings(case: Case, **patience: float | None) -> Surroundings:
    return Surroundings(case.run_plan(**patience), case.planner)


# What must hold, whatever happens


@dataclass
class Monitor:
    """Checks each step against the rules, from the outside."""

    around: Surroundings
    active: int | None = None
    sent: int = 0
    paused: bool = False
    segment_from: int = 0
    plan: list[Action] = field(default_factory=list)
    done: int = 0
    segment: str = ""
    told: frozenset[Literal] = frozenset()
    ending: bool = False
    outcome: str = ""

    def check(
        self,
        before: ExecutorState,
        inputs: Inputs,
        commands: tuple[Command, ...],
        events: tuple[Event, ...],
    ) -> None:
        if before.phase in TERMINAL:
            assert (self.around.state, commands, events) == (before, (), ())
            return
        stopped = self._hear(inputs)
        for event in events:
            if isinstance(event, GoalConfirmed):
                self._check_confirmed(event)
            elif isinstance(event, TransitionTaken):
                self._check_transition(event, inputs)
            elif isinstance(event, CheckpointReached):
                self._check_reached(event, inputs.observation)
            elif isinstance(event, GoalSent):
                self._check_sent(event, inputs.observation)
            elif isinstance(event, Skipped):
                self._check_skipped(event, inputs.observation)
            elif isinstance(event, Replanned):
                self._check_replanned(event, inputs.observation)
        for command in commands:
            if isinstance(command, SendGoal):
                assert self.active is None, "two goals at once"
                assert command.goal > self.sent, "a number used twice"
                assert not any((self.paused, stopped, self.ending))
                self.active = self.sent = command.goal
            elif isinstance(command, CancelGoal):
                assert command.goal == self.sent
                self.active = None
        assert len([e for e in events if isinstance(e, GoalSent)]) == len(
            [c for c in commands if isinstance(c, SendGoal)]
        )
        self._check_end(stopped, commands, events)

    def _hear(self, inputs: Inputs) -> bool:
        """Takes note of reports and commands; returns whether a stop is among them."""
        over = ("failed", "cancelled", "rejected")
        if any(r.goal == self.active and r.kind in over for r in inputs.reports):
            self.active = None
        for command in inputs.commands:
            if command.kind in ("pause", "resume"):
                self.paused = command.kind == "pause"
            if command.kind == "happened":
                negations = {x.negation for x in command.literals}
                self.told = self.told - negations | set(command.literals)
            if command.kind == "stop":
                return True
        return False

    def _check_confirmed(self, event: GoalConfirmed) -> None:
        run, around = self.around.run, self.around
        action = self.plan[self.done]
        assert str(action) == event.action, "out of order"
        operator = run.world.domain.operators[action.operator]
        made = effects(action, operator, around.facts, run.world)
        assert around.perceived_for(made, run.settings.confirm_s), "not perceived long enough"
        self.done += 1
        self.active = None

    def _check_skipped(self, event: Skipped, observation: Observation) -> None:
        world = self.around.run.world
        skipped = self.plan[self.done : self.done + len(event.actions)]
        assert event.actions == [str(a) for a in skipped]
        self.done += len(skipped)
        rest, state = self.plan[self.done :], observation.state
        if len(skipped) == 1:
            operator = world.domain.operators[skipped[0].operator]
            made = effects(skipped[0], operator, state, world)
            if self.around.perceived_for(made, self.around.run.settings.confirm_s):
                return
        for action in rest:
            operator = world.domain.operators[action.operator]
            assert applicable(action, operator, state, world), "it was needed after all"
            state = after(action, operator, state, world)
        missed = [
            g for g in self.around.run.plan.segments[self.segment].goals if not state.holds(g)
        ]
        since = [o for _, o in self.around.seen[self.segment_from :]]
        assert all(any(o.holds(g) for o in since) for g in missed), "it was needed after all"

    def _check_replanned(self, event: Replanned, observation: Observation) -> None:
        assert self.active is None
        assert event.before == [str(a) for a in self.plan[self.done :]]
        self.plan = self.plan[: self.done] + [parse_action(a) for a in event.after]
        state, world = observation.state, self.around.run.world
        for action in self.plan[self.done :]:
            operator = world.domain.operators[action.operator]
            assert applicable(action, operator, state, world)
            state = after(action, operator, state, world)

    def _check_transition(self, event: TransitionTaken, inputs: Inputs) -> None:
        told = self.told
        see = inputs.observation.holds
        taken = self.around.run.automaton.transitions[event.transition]
        if taken.when:
            assert all(see(x) or x in told for x in taken.when)
        for rival in self.around.run.automaton.outgoing(taken.source):
            if rival.when and not taken.when:
                # Known to be false; what is unknown just now is not.
                assert any(see(x.negation) and x not in told for x in rival.when)
        assert self.segment == ""
        self.segment, self.done = taken.target, 0
        self.plan = list(self.around.run.plan.segments[taken.target].actions)
        self.segment_from = len(self.around.seen) - 1
        self.told = frozenset()

    def _check_reached(self, event: CheckpointReached, observation: Observation) -> None:
        segment = self.around.run.plan.segments[event.checkpoint]
        assert event.checkpoint == self.segment
        assert self.done == len(self.plan)
        since = [o for _, o in self.around.seen[self.segment_from :]]
        for goal in segment.goals:
            assert any(o.holds(goal) for o in since), f"{goal} was never perceived"
            if not any(goal in self._made(action) for action in self.plan):
                assert observation.holds(goal), f"{goal} isn't brought about, and doesn't hold now"
        self.segment = ""

    def _made(self, action: Action) -> tuple[Literal, ...]:
        world = self.around.run.world
        operator = world.domain.operators[action.operator]
        return effects(action, operator, world.initial, world)

    def _check_sent(self, event: GoalSent, observation: Observation) -> None:
        run, action = self.around.run, self.plan[self.done]
        assert str(action) == event.action
        needed = needed_places(action, run.world.domain.operators[action.operator])
        assert all(map(observation.holds, needed))

    def _check_end(
        self, stopped: bool, commands: tuple[Command, ...], events: tuple[Event, ...]
    ) -> None:
        phase = self.around.state.phase
        ends = [e for e in events if isinstance(e, RunEnded)]
        assert len(ends) == (phase in TERMINAL)
        halts = any(isinstance(e, Halted) for e in events)
        if stopped or halts:
            assert phase == "halting" or self.ending
        if phase == "halting" and not self.ending:
            # What was asked of the robot is withdrawn in the very step in which the end is decided.
            assert commands[-2:] == (ZeroVelocity(), StopRobot())
            self.ending, self.outcome = True, "halted" if halts else "stopped"
        elif self.ending:
            assert not halts
            assert all(isinstance(c, ZeroVelocity | RunStop) for c in commands)
        if phase == "halted":
            assert ends[0].outcome == self.outcome
        if phase in TERMINAL:
            assert self.active is None


@pytest.mark.parametrize("name", PROGRAMS)
def test_the_rules_hold_whatever_happens(programs: dict[str, Case], name: str) -> None:
    met: Counter[str] = Counter()

    @settings(max_examples=400, deadline=None, derandomize=True, database=None)
    @given(HISTORIES)
    def hold(history: list[Moment]) -> None:
        around = surroundings(programs[name], wait_s=20.0)
        monitor = Monitor(around)
        for moment in history:
            before = around.state
            inputs, commands, events = around.pass_by(moment)
            monitor.check(before, inputs, commands, events)
            met.update(type(e).__name__ for e in events)
            met.update(e.outcome for e in events if isinstance(e, RunEnded))

    hold()
    # The histories lead into every corner.
    kinds = (
        GoalConfirmed,
        CheckpointReached,
        TransitionTaken,
        Deviated,
        Recovered,
        Halted,
        Skipped,
    )
    corners = {k.__name__ for k in (*kinds, CommandGiven, Replanned)} | {
        "done",
        "halted",
        "stopped",
    }
    corners |= {Waiting.__name__} if name == "labelled" else set()
    assert corners <= set(met)


@pytest.mark.parametrize("name", PROGRAMS)
def test_the_core_is_pure(programs: dict[str, Case], name: str) -> None:
    @settings(max_examples=100, deadline=None, derandomize=True, database=None)
    @given(HISTORIES)
    def pure(history: list[Moment]) -> None:
        around = surroundings(programs[name])
        for moment in history:
            before, kept = around.state, replace(around.state)
            inputs, commands, events = around.pass_by(moment)
            again = step(around.run, before, around.now, inputs)
            assert again == (around.state, commands, events)
            assert before == kept

    pure()


# Single cases

OBEYS = Moment(dt=0.4, obeys=True, reports=((0, "accepted"),))


def until_alerted(case: Case, **patience: float | None) -> Surroundings:
    """As far as the checkpoint where the ways part is one action away."""
    around = surroundings(case, **patience)
    while around.state.done_actions < 2:
        around.pass_by(OBEYS)
    around.pass_by(replace(OBEYS, dt=0.1))
    assert around.state.phase in ("pursuing", "confirming")
    return around


def branch(around: Surroundings, moment: Moment) -> list[Event]:
    """What comes of the step in which the checkpoint is reached, and of a second one after it."""
    events: list[Event] = []
    while not any(isinstance(e, CheckpointReached) for e in events):
        events += around.pass_by(moment)[2]
    return [*events, *around.pass_by(moment)[2]]


def taken(events: list[Event]) -> list[tuple[str, ...]]:
    return [tuple(e.when) for e in events if isinstance(e, TransitionTaken)]


def test_the_else_is_taken_at_once_where_no_condition_holds(programs: dict[str, Case]) -> None:
    around = until_alerted(programs["otherwise"])
    events = branch(around, replace(OBEYS, dt=0.1))
    assert taken(events) == [()]
    reached = next(e for e in events if isinstance(e, CheckpointReached))
    took = next(e for e in events if isinstance(e, TransitionTaken))
    assert took.time == reached.time
    assert not any(isinstance(e, Waiting) for e in events)


def test_a_condition_that_holds_goes_before_the_else(programs: dict[str, Case]) -> None:
    around = until_alerted(programs["otherwise"])
    events = branch(around, replace(OBEYS, dt=0.4, change=(ACKNOWLEDGED,)))
    assert taken(events) == [(str(ACKNOWLEDGED),)]


def test_a_condition_that_flickers_leaves_the_else(programs: dict[str, Case]) -> None:
    around = until_alerted(programs["otherwise"])
    events = []
    while not any(isinstance(e, CheckpointReached) for e in events):
        events += around.pass_by(replace(OBEYS, dt=0.1, change=(ACKNOWLEDGED,)))[2]
    assert taken(events) == []
    gone = Moment(change=(ACKNOWLEDGED.negation,))
    assert taken(list(around.pass_by(gone)[2])) == [()]


def test_what_is_unknown_is_not_false_so_the_else_waits_for_it(programs: dict[str, Case]) -> None:
    around = until_alerted(programs["otherwise"])
    events = branch(around, replace(OBEYS, dt=0.1, lost=(ACKNOWLEDGED,)))
    assert taken(events) == []
    known = around.pass_by(Moment(dt=5.0))[2]
    assert taken(list(known)) == [()]


def test_with_conditions_only_it_waits_however_long(programs: dict[str, Case]) -> None:
    around = until_alerted(programs["labelled"], wait_s=None)
    events = branch(around, replace(OBEYS, dt=0.1))
    assert taken(events) == []
    (waiting,) = (e for e in events if isinstance(e, Waiting))
    assert waiting.conditionals == [[str(ACKNOWLEDGED)], [str(DISMISSED)]]
    for _ in range(50):
        _, commands, later = around.pass_by(Moment(dt=1000.0))
        assert (commands, later) == ((), ())
    assert around.state.phase == "waiting"
    come = [
        *around.pass_by(Moment(change=(DISMISSED,)))[2],
        *around.pass_by(Moment(dt=RunSettings().condition_s))[2],
    ]
    assert taken(come) == [(str(DISMISSED),)]


def test_a_condition_must_hold_for_a_while(programs: dict[str, Case]) -> None:
    around = until_alerted(programs["labelled"])
    branch(around, replace(OBEYS, dt=0.1))
    for _ in range(20):
        flicker = [
            *around.pass_by(Moment(dt=0.2, change=(ACKNOWLEDGED,)))[2],
            *around.pass_by(Moment(dt=0.2, change=(ACKNOWLEDGED.negation,)))[2],
        ]
        assert taken(flicker) == []


def test_a_person_may_tell_that_a_condition_came_true(programs: dict[str, Case]) -> None:
    around = until_alerted(programs["labelled"])
    branch(around, replace(OBEYS, dt=0.1))
    said = HumanCommand("happened", (DISMISSED,))
    around.pass_by(Moment(commands=(said,)))
    assert taken(list(around.pass_by(Moment(dt=0.4))[2])) == [(str(DISMISSED),)]


def test_reports_alone_confirm_nothing(programs: dict[str, Case]) -> None:
    around = surroundings(programs["labelled"], report_s=1000.0)
    reported = Moment(dt=0.5, reports=((0, "accepted"), (0, "succeeded")))
    events = [e for _ in range(100) for e in around.pass_by(reported)[2]]
    assert not any(isinstance(e, GoalConfirmed) for e in events)
    assert around.state.phase == "pursuing"


def test_a_goal_that_is_seen_is_confirmed_without_a_word_of_success(
    programs: dict[str, Case],
) -> None:
    around = surroundings(programs["labelled"])
    around.pass_by(Moment())
    around.pass_by(OBEYS)
    (confirmed,) = (e for e in around.pass_by(Moment(dt=0.4))[2] if isinstance(e, GoalConfirmed))
    assert confirmed.reported == ""


def test_a_goal_that_flickers_for_ever_runs_into_the_limit(programs: dict[str, Case]) -> None:
    around = surroundings(programs["labelled"], goal_s=20.0)
    around.pass_by(Moment())
    (there, back) = literals("(robot-at hall)", "(robot-at home)")
    for n in range(1000):
        come_and_gone = there if n % 2 else back
        around.pass_by(Moment(change=(come_and_gone,), reports=((0, "accepted"),)))
        if around.state.phase in TERMINAL:
            break
    assert around.state.outcome == "halted"
    assert around.now == pytest.approx(20.0, abs=1.0)


def test_an_action_that_is_only_glimpsed_as_done_is_sent(programs: dict[str, Case]) -> None:
    around = surroundings(programs["labelled"])
    glimpse = Moment(change=(literal("(robot-at hall)"),))
    _, commands, _ = around.pass_by(glimpse)
    assert commands == ()
    _, commands, _ = around.pass_by(Moment(change=(literal("(robot-at home)"),)))
    assert [str(c.action) for c in commands if isinstance(c, SendGoal)] == ["(move home hall)"]


def test_a_success_whose_acceptance_was_lost_is_no_silence(programs: dict[str, Case]) -> None:
    around = surroundings(programs["labelled"])
    around.pass_by(Moment())
    around.pass_by(Moment(obeys=True, reports=((0, "succeeded"),)))
    events = around.pass_by(Moment(dt=2.5))[2]
    (confirmed,) = (e for e in events if isinstance(e, GoalConfirmed))
    assert confirmed.reported == "succeeded"


def test_a_robot_that_never_answers_halts_the_run(programs: dict[str, Case]) -> None:
    around = surroundings(programs["labelled"])
    around.pass_by(Moment())
    assert around.pass_by(Moment(dt=2.0))[1] == ()
    _, commands, events = around.pass_by(Moment(dt=0.1))
    assert commands == (CancelGoal(1), ZeroVelocity(), StopRobot())
    assert any(isinstance(e, Halted) for e in events)


def test_what_is_only_out_of_sight_is_waited_for_and_not_planned_around(
    programs: dict[str, Case],
) -> None:
    around = surroundings(programs["labelled"], grace_s=30.0)
    while str(around.state.action) != "(pick tray empty-trays)":
        around.pass_by(GOING_ON)
    unseen = Moment(dt=0.4, lost=literals("(at tray empty-trays)"))
    while around.state.phase != "deviating":
        around.pass_by(replace(unseen, reports=((0, "failed"),)))
    for _ in range(20):
        around.pass_by(unseen)
        assert around.state.request is None
    assert around.state.phase == "deviating"
    assert any(isinstance(e, Recovered) for e in around.pass_by(Moment())[2])
