"""What actions are for: every chain of reasons holds link by link, on every branch."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from polaris_nl.automaton.automaton import Automaton
from polaris_nl.model.evaluate import after, applicable
from polaris_nl.model.formula import Literal
from polaris_nl.model.state import State
from polaris_nl.planning.planner import Planner
from polaris_nl.planning.reasons import Reasons, Step

from .conftest import LUNCH, program

LUNCH_PROGRAM = program(
    LUNCH,
    "alerted -> fetched [(acknowledged lunchtime)]: (at tray table) (is-full tray)",
    "fetched -> home: (robot-at home)",
    "alerted -> cancelled [(dismissed lunchtime)]: (robot-at office)",
)
TIDY = program(
    "start -> fetched: (at cup countertop) (at plate countertop)",
    "fetched -> stowed [(at cup drying-rack) (at plate drying-rack)]: "
    "(open cupboard) (in cup cupboard) (in plate cupboard)",
)
FORK = program(
    "start -> taken: (holding tray)",
    "taken -> served [(person-in resident room-1)]: (at tray table)",
    "taken -> left: (at tray desk)",
)


def steps(reasons: Reasons) -> Iterator[Step]:
    for checkpoint, segment in reasons.plan.segments.items():
        yield from (Step(checkpoint, at) for at in range(len(segment.actions)))


def reasons_of(planner: Planner, automaton: Automaton) -> Reasons:
    plan = planner.compile(automaton)
    assert plan.status == "ok"
    return Reasons(plan, automaton, planner.world)


def along(reasons: Reasons, checkpoint: str) -> list[tuple[Step | None, State]]:
    """Each action to a checkpoint with the state after it, and the states that conditionals make."""
    found: list[tuple[Step | None, State]] = []
    for transition in reasons.automaton.path(checkpoint):
        segment = reasons.plan.segments[transition.target]
        found.append((None, segment.before))
        state = segment.before
        for at, action in enumerate(segment.actions):
            operator = reasons.world.domain.operators[action.operator]
            state = after(action, operator, state, reasons.world)
            found.append((Step(transition.target, at), state))
    return found


def brings(reasons: Reasons, step: Step, fact: Literal, until: Step | None, end: str) -> bool:
    """Whether a fact comes about at a step and lasts until another one begins, or to the end."""
    trace = along(reasons, end)
    place = [s for s, _ in trace].index(step)
    if trace[place - 1][1].holds(fact):
        return False
    last = [s for s, _ in trace].index(until) if until else len(trace)
    return all(state.holds(fact) for _, state in trace[place:last])


@pytest.mark.parametrize(
    ("world", "automaton"),
    [("care_home", LUNCH_PROGRAM), ("care_home", FORK), ("dinner_party", TIDY)],
    ids=["lunch", "fork", "tidy"],
)
def test_every_action_of_a_shortest_plan_serves_a_goal(
    world: str, automaton: Automaton, request: pytest.FixtureRequest
) -> None:
    reasons = reasons_of(request.getfixturevalue(world), automaton)
    for step in steps(reasons):
        purposes = reasons.purposes(step)
        assert purposes, step
        for purpose in purposes:
            assert purpose.goal in reasons.plan.segments[purpose.checkpoint].goals
            here = step
            for link in purpose.chain:
                assert brings(reasons, here, link.fact, link.step, purpose.checkpoint)
                if link.step is None:
                    assert (link.fact, link.checkpoint) == (purpose.goal, purpose.checkpoint)
                    break
                needs(reasons, link.step, link.fact)
                here = link.step
            assert purpose.chain[-1].step is None


def needs(reasons: Reasons, step: Step, fact: Literal) -> None:
    state = reasons.states[step.checkpoint][step.at]
    action = reasons.plan.segments[step.checkpoint].actions[step.at]
    operator = reasons.world.domain.operators[action.operator]
    assert applicable(action, operator, state, reasons.world)
    without = state.change((fact.atom,), () if fact.positive else (fact.atom,))
    assert not applicable(action, operator, without, reasons.world)


def test_an_action_before_a_fork_serves_both_branches(care_home: Planner) -> None:
    reasons = reasons_of(care_home, FORK)
    pick = Step("c1", len(reasons.plan.segments["c1"].actions) - 1)
    assert {(p.checkpoint, str(p.goal)) for p in reasons.purposes(pick)} == {
        ("c1", "(holding tray)"),
        ("c2", "(at tray table)"),
        ("c3", "(at tray desk)"),
    }
    assert {str(r.needed_by) for r in reasons.links(pick) if r.needed_by} <= {
        "(place tray table)", "(place tray desk)",
    }  # fmt: skip


def test_a_way_there_does_not_serve_what_is_done_after_it_is_left(care_home: Planner) -> None:
    reasons = reasons_of(care_home, LUNCH_PROGRAM)
    for at in range(3):
        assert {p.checkpoint for p in reasons.purposes(Step("c1", at))} == {"c1"}
    last = len(reasons.plan.segments["c2"].actions) - 1
    assert {p.checkpoint for p in reasons.purposes(Step("c2", last))} == {"c2"}


def test_what_a_person_does_between_is_done_without_the_action_too(dinner_party: Planner) -> None:
    reasons = reasons_of(dinner_party, TIDY)
    names = [str(a) for a in reasons.plan.segments["c1"].actions]
    pick = Step("c1", names.index("(pick cup dining-table)"))
    # The host puts the cup on the rack wherever it is, so the cupboard doesn't need this.
    assert [str(p.goal) for p in reasons.purposes(pick)] == ["(at cup countertop)"]


def test_an_empty_hand_is_what_putting_down_is_for(dinner_party: Planner) -> None:
    automaton = program("start -> put: (at cup countertop)", "opened: (open cupboard)")
    reasons = reasons_of(dinner_party, automaton)
    place = Step("c1", len(reasons.plan.segments["c1"].actions) - 1)
    chains = {p.checkpoint: [str(x.fact) for x in p.chain] for p in reasons.purposes(place)}
    assert chains == {"c1": ["(at cup countertop)"], "c2": ["(hand-empty)", "(open cupboard)"]}


def test_a_fact_that_is_undone_can_be_a_reason(dinner_party: Planner) -> None:
    automaton = program("start -> opened: (open cupboard)", "closed: (not (open cupboard))")
    reasons = reasons_of(dinner_party, automaton)
    (close,) = (s for s in steps(reasons) if s.checkpoint == "c2")
    assert [str(p.goal) for p in reasons.purposes(close)] == ["(not (open cupboard))"]


def test_an_action_that_nothing_needs_has_no_purpose(care_home: Planner) -> None:
    automaton = program("start -> there: !(move home hall)", "kept: (at tray empty-trays)")
    reasons = reasons_of(care_home, automaton)
    assert reasons.purposes(Step("c1", 0)) == ()
