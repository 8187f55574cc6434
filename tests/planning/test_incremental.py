"""Planning again only what changed, streaming it, sharing translations, and forgetting in time."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from polaris_nl.automaton.automaton import Automaton, Checkpoint
from polaris_nl.automaton.edits import apply_all
from polaris_nl.model.formula import Literal, parse_literal
from polaris_nl.model.state import State
from polaris_nl.model.world_file import load_world
from polaris_nl.planning import compile as compiling
from polaris_nl.planning import segments
from polaris_nl.planning.budget import never
from polaris_nl.planning.compile import Draft
from polaris_nl.planning.memory import Memory
from polaris_nl.planning.pddl_text import problem_text
from polaris_nl.planning.planner import Planner
from polaris_nl.planning.search import OPTIMAL, Found, search
from polaris_nl.planning.segments import Segments
from polaris_nl.planning.translate import translate
from polaris_nl.planning.up_model import is_valid

from .conftest import LUNCH, actions, program

LONG = program(
    "a: (at cup desk)",
    "b: (at red-cup table)",
    "c: (at cup worktop)",
    "d: (at tray nightstand)",
    "e: (robot-at home)",
)


@pytest.fixture(autouse=True)
def _patient(monkeypatch: pytest.MonkeyPatch) -> None:
    """A busy machine doesn't make a first plan one that may not be shortest."""
    monkeypatch.setattr(segments, "QUICK_S", 2.0)


@pytest.fixture
def fresh(care_home: Planner) -> Planner:
    return Planner(care_home.world)


@pytest.fixture
def searched(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """A line for every search that is made."""
    found: list[str] = []
    real = segments.search

    def watched(sas: str, engine: str, *rest: Any) -> Found:
        found.append(engine)
        return real(sas, engine, *rest)

    monkeypatch.setattr(segments, "search", watched)
    return found


def with_goals(automaton: Automaton, checkpoint: str, *goals: str) -> Automaton:
    changed = replace(automaton.checkpoints[checkpoint], goals=tuple(map(parse_literal, goals)))
    return automaton.with_checkpoint(changed)


def whole(drafts: list[Draft]) -> list[Draft]:
    return [d for d in drafts if d.whole]


# Only what changed


def test_an_edit_plans_only_its_segment_where_what_follows_starts_as_before(
    fresh: Planner, searched: list[str]
) -> None:
    list(fresh.drafts(LONG))
    searched.clear()
    # The other cup has no part in what comes after, and the robot ends where it did.
    edited = with_goals(LONG, "c2", "(at glasses table)")
    next(d for d in fresh.drafts(edited) if d.whole)
    assert len(searched) == 1
    searched.clear()
    next(d for d in fresh.drafts(LONG) if d.whole)
    assert searched == []


def test_a_leaf_is_planned_alone_and_an_undo_not_at_all(
    fresh: Planner, searched: list[str]
) -> None:
    list(fresh.drafts(LONG))
    searched.clear()
    list(fresh.drafts(with_goals(LONG, "c5", "(robot-at kitchen)")))
    assert len(searched) == 1
    searched.clear()
    (draft,) = fresh.drafts(LONG)
    assert searched == []
    assert draft.plan == Planner(fresh.world).compile(LONG)


# Streaming


def test_drafts_grow_with_what_was_edited_first(
    fresh: Planner, monkeypatch: pytest.MonkeyPatch
) -> None:
    forked = program(
        "start -> a [(open fridge)]: (at cup desk)",
        "a -> b: (at plate table)",
        "start -> c [(open cupboard)]: (at red-cup desk)",
        "c -> d: (at tray nightstand)",
        "start -> e: (at tray desk)",
    )
    monkeypatch.setattr(compiling, "STREAM_S", 0.0)
    list(fresh.drafts(forked))
    # The root of one branch is edited last of all, and shown first with all that hangs on it.
    edited = with_goals(with_goals(forked, "c1", "(holding cup)"), "c4", "(at cup nightstand)")
    other = Planner(fresh.world)
    list(other.drafts(with_goals(edited, "c4", "(at cup table)")))
    other._segments = other._compiler._walker._segments = Segments(other.world, other.mutexes)
    other._compiler._walker._known = Memory(10**6)
    found = list(other.drafts(edited))
    grown = [list(d.plan.segments) for d in found]
    assert [d.whole for d in found] == [False] * (len(found) - 1) + [True]
    assert all(set(a) < set(b) for a, b in itertools.pairwise(grown[:-1]))
    assert set(grown[0]) == {"c3"}
    assert set(grown[1]) == {"c3", "c4"}
    assert grown[-1] == ["c1", "c2", "c3", "c4", "c5"]
    assert {d.plan.status for d in found[:-1]} == {"undecided"}


def test_a_quick_plan_comes_first_and_a_shortest_one_after(
    fresh: Planner, monkeypatch: pytest.MonkeyPatch
) -> None:
    real = segments.search
    quick_plan = ("(move home hall)", "(move hall home)", "(move home hall)")

    def slow(sas: str, engine: str, seconds: float, cancelled: Callable[[], bool]) -> Found:
        if engine == OPTIMAL and seconds <= segments.QUICK_S:
            return Found("undecided")
        if engine == segments.QUICK:
            return Found("solved", quick_plan)
        return real(sas, engine, seconds, cancelled)

    monkeypatch.setattr(segments, "search", slow)
    automaton = program("x: (robot-at hall)")
    first, second = fresh.drafts(automaton)
    assert (actions(first.plan.segments["c1"]), first.plan.segments["c1"].optimal) == (
        list(quick_plan),
        False,
    )
    assert (actions(second.plan.segments["c1"]), second.plan.segments["c1"].optimal) == (
        ["(move home hall)"],
        True,
    )
    assert [d.plan for d in fresh.drafts(automaton)] == [second.plan]


def test_a_plan_that_is_as_short_stays_when_a_shortest_one_is_proven(
    fresh: Planner, monkeypatch: pytest.MonkeyPatch
) -> None:
    real = segments.search
    turned: list[tuple[str, ...]] = []

    def search_two_ways(sas: str, engine: str, seconds: float, stop: Callable[[], bool]) -> Found:
        if engine == OPTIMAL and seconds <= segments.QUICK_S:
            return Found("undecided")
        found = real(sas, OPTIMAL, seconds, stop)
        if engine == segments.QUICK:  # As short, in another order.
            turned.append((found.plan[1], found.plan[0], *found.plan[2:]))
            return Found("solved", turned[-1])
        return found

    monkeypatch.setattr(segments, "search", search_two_ways)
    # In the kitchen already: opening two doors goes either way round.
    automaton = program("there: (robot-at kitchen)", "x: (open fridge) (open cupboard)")
    fresh.compile(program("there: (robot-at kitchen)"))
    drafts = list(fresh.drafts(automaton))
    found = [actions(d.plan.segments["c2"]) for d in drafts]
    assert found == [list(turned[0])] * len(found)
    assert drafts[-1].plan.segments["c2"].optimal


def test_what_is_shown_is_kept_where_it_is_as_good(fresh: Planner) -> None:
    doors = program("there: (robot-at kitchen)", "x: (open fridge) (open cupboard)")
    (draft,) = fresh.drafts(doors)
    shown = draft.shown["c2"]
    turned = replace(shown, actions=shown.actions[::-1])
    fresh._shown = {**draft.shown, "c2": turned}
    # Another state before it, so that it is planned anew.
    drafts = list(fresh.drafts(with_goals(doors, "c1", "(robot-at kitchen)", "(open wardrobe)")))
    assert drafts[-1].plan.segments["c2"].actions == turned.actions
    pure = fresh.compile(with_goals(doors, "c1", "(robot-at kitchen)", "(open wardrobe)"))
    assert pure == Planner(fresh.world).compile(
        with_goals(doors, "c1", "(robot-at kitchen)", "(open wardrobe)")
    )


def test_drafts_end_when_they_are_stale(fresh: Planner) -> None:
    asked = iter(range(2))
    assert whole(list(fresh.drafts(LONG, lambda: next(asked, None) is None))) == []
    assert whole(list(fresh.drafts(LONG)))[-1].plan.status == "ok"


# Shorter together


TOGETHER = program("there: (robot-at room-1)", "cup: (at cup table)")


def test_a_shorter_joint_plan_is_offered_and_can_be_taken_up(care_home: Planner) -> None:
    plan = care_home.compile(TOGETHER)
    assert plan.action_count == 8
    (warning,) = plan.warnings
    assert warning.transition == "t1"
    assert warning.text.endswith("would save 2 actions.")
    (repair,) = warning.repairs
    changed = apply_all(TOGETHER, repair.edits)
    assert changed.checkpoints["c1"].goals == tuple(
        map(parse_literal, ("(robot-at room-1)", "(holding cup)"))
    )
    better = care_home.compile(changed)
    assert (better.status, better.action_count, better.warnings) == ("ok", 6, ())


def test_an_offer_is_looked_for_after_the_plan_and_comes_with_the_next(fresh: Planner) -> None:
    assert [len(d.plan.warnings) for d in fresh.drafts(TOGETHER)] == [0]
    assert [len(d.plan.warnings) for d in fresh.drafts(TOGETHER)] == [1]


def test_nothing_is_offered_where_nothing_is_saved(care_home: Planner) -> None:
    served = "served [(acknowledged lunchtime)]: (at tray table)"
    plan = care_home.compile(program(LUNCH, served, "home: (robot-at home)"))
    assert plan.warnings == ()


# Shared translations


WORLDS = {name: load_world(name) for name in ("care-home", "dinner-party")}
PLANNERS = {name: Planner(world) for name, world in WORLDS.items()}


@settings(max_examples=40)
@given(st.data())
def test_a_shared_translation_is_as_good_as_an_own_one(data: st.DataObject) -> None:
    name = data.draw(st.sampled_from(sorted(WORLDS)))
    world, planner = WORLDS[name], PLANNERS[name]

    def one(kind: str) -> str:
        return data.draw(st.sampled_from([e.name for e in world.of_type(kind)]))

    def fact() -> Literal:
        thing = one("object")
        return data.draw(
            st.sampled_from(
                [
                    Literal("at", (thing, one("surface"))),
                    Literal("in", (thing, one("container"))),
                    Literal("has", (one("person"), thing)),
                    Literal("holding", (thing,)),
                    Literal("robot-at", (one("region"),)),
                    Literal("person-in", (one("person"), one("region"))),
                    Literal("open", (one("container"),)),
                    Literal("open", (one("container"),), False),
                    Literal("hand-empty"),
                ]
            )
        )

    state: State = world.initial
    for _ in range(data.draw(st.integers(0, 3))):
        state = state.after_event((fact(),), planner.mutexes)
    goals = tuple({fact() for _ in range(data.draw(st.integers(1, 2)))})
    small, start = planner._segments._projection.of(state, goals)
    tasks = planner._segments._tasks
    aimed = tasks._of_shared(small, start, never).aim(start, goals)
    if aimed is None:
        return
    own = translate(tasks._domain, problem_text(small, start, goals))
    one_way, other = (
        search(t.sas, OPTIMAL, 30.0, never) if t.sas else Found("unsolvable") for t in (aimed, own)
    )
    assert (one_way.status, len(one_way.plan)) == (other.status, len(other.plan))


def test_most_segments_share_a_translation(fresh: Planner, monkeypatch: pytest.MonkeyPatch) -> None:
    def own(*_: object) -> None:
        raise AssertionError("translated for itself")

    monkeypatch.setattr("polaris_nl.planning.tasks.translate", own)
    assert fresh.compile(LONG).status == "ok"


# Crowds and memory


def test_eight_threads_with_two_hundred_goals_get_plans_for_the_right_problems(
    care_home: Planner,
) -> None:
    world = care_home.world
    things = [e.name for e in world.of_type("object")]
    places = [e.name for e in world.of_type("surface")]
    asked = [Literal("at", pair) for pair in itertools.product(things, places)]
    asked += [Literal("has", (p.name, t)) for p in world.of_type("person") for t in things]
    asked += [Literal("in", (t, c.name)) for t in things for c in world.of_type("container")]
    goals = [(g,) for g in asked if g not in world.facts]
    goals += [(*g, parse_literal("(robot-at hall)")) for g in goals]
    goals = goals[:200]
    assert len(set(goals)) == 200
    shared = Segments(world, care_home.mutexes)
    with ThreadPoolExecutor(8) as pool:
        found = list(pool.map(lambda some: shared.solve(world.initial, some), goals))
    lengths = set()
    for some, result in zip(goals, found, strict=True):
        assert (result.status, result.optimal) == ("solved", True), some
        assert is_valid(world, world.initial, some, result.actions)
        # Any shorter, and it would be another problem's.
        assert not any(all(map(step.state.holds, some)) for step in result.steps[:-1])
        lengths.add(len(result.actions))
    assert len(lengths) > 3


def test_a_memory_keeps_what_was_used_last_within_its_bound() -> None:
    memory: Memory[str, int] = Memory(10, lambda key, value: value)
    for key, value in (("a", 4), ("b", 4)):
        memory.put(key, value)
    assert memory.get("a") == 4
    memory.put("c", 4)
    assert (memory.get("a"), memory.get("b"), memory.get("c")) == (4, None, 4)
    memory.put("a", 1)
    assert memory.weight == 5
    memory.put("huge", 11)
    assert (len(memory), memory.weight) == (0, 0)


def test_forgetting_changes_no_plan(care_home: Planner, monkeypatch: pytest.MonkeyPatch) -> None:
    forgetful = Planner(care_home.world)
    for memory in (
        forgetful._segments._known,
        forgetful._segments._small,
        forgetful._segments._tasks._shared,
        forgetful._compiler._walker._known,
    ):
        monkeypatch.setattr(memory, "_limit", 300)
    assert forgetful.compile(LONG) == care_home.compile(LONG)
    assert forgetful._segments._known.weight <= 300


def test_a_checkpoint_without_goals_is_known_at_once(fresh: Planner) -> None:
    empty = Automaton().with_checkpoint(Checkpoint("c1", "x"))
    assert fresh.compile(empty).status == "invalid"
