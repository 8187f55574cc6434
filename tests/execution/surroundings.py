"""Made-up surroundings of the executor's core: what is perceived, reported and commanded, moment by moment."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from hypothesis import strategies as st

from polaris_nl.execution.backend import (
    READY,
    Command,
    Health,
    Observation,
    Report,
    SendGoal,
)
from polaris_nl.execution.events import (
    Event,
)
from polaris_nl.execution.executor import step
from polaris_nl.execution.state import (
    ExecutorState,
    HumanCommand,
    Inputs,
    PlanAnswer,
    RunPlan,
)
from polaris_nl.model.formula import Literal
from polaris_nl.planning.planner import Planner
from tests.execution.programs import (
    ACKNOWLEDGED,
    DISMISSED,
)
from tests.execution.story import Case, literals

EPSILON = 1e-6


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
