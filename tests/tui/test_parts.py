"""The pure parts: shares of the screen, phrases, progress, what of an older plan still holds."""

from __future__ import annotations

from dataclasses import replace

import pytest

from polaris_nl.automaton.automaton import Automaton
from polaris_nl.execution.events import (
    CheckpointReached,
    GoalSent,
    Observed,
    RunEnded,
    RunStarted,
    StateChanged,
)
from polaris_nl.model.formula import parse_literal
from polaris_nl.model.state import State
from polaris_nl.model.wording import PlainWording
from polaris_nl.model.world import World
from polaris_nl.planning.planner import Planner
from polaris_nl.render.glyphs import UNICODE
from polaris_nl.snapshot import Snapshot
from polaris_tui.layout import FIXED, heights
from polaris_tui.phrases import order_in, view_asked
from polaris_tui.progress import Progress, advanced
from polaris_tui.scene import Scene
from polaris_tui.transcript import MOST, Entry, Exchange, Transcript
from polaris_tui.views import outline_rows, still_planned
from tests.planning.conftest import program

STEPS = ("open: (open fridge)", "hall: (robot-at hall)")


@pytest.mark.parametrize("trouble", [0, 1, 4, 100])
def test_the_program_always_has_room(trouble: int) -> None:
    for height in range(1, 60):
        share = heights(height, trouble)
        room = height - FIXED
        assert share.trouble <= trouble + 1
        assert (share.trouble > 0) == (trouble > 0)
        assert height < 20 or room - share.trouble - share.answers >= room // 3


@pytest.mark.parametrize(
    ("line", "order"),
    [
        ("stop", "stop"),
        ("STOP!!", "stop"),
        ("please stop the robot now", "stop"),
        ("freeze.", "stop"),
        ("pause", "pause"),
        ("go on", "resume"),
        ("stop the oven when it is hot", None),
        ("go on to the kitchen", None),
        ("", None),
    ],
)
def test_orders(line: str, order: str | None) -> None:
    assert order_in(line) == order


def test_views_are_asked_by_name() -> None:
    assert view_asked(" Show me the map. ") == "map"
    assert view_asked("show the keys") == "help"
    assert view_asked("show the tray") is None


def test_what_still_holds_of_an_older_plan(care_home: World) -> None:
    before = program(*STEPS, "home: (robot-at home)")
    plan = Planner(care_home).compile(before)
    assert still_planned(before, plan) == {"c0", "c1", "c2", "c3"}
    changed = program(STEPS[0], "kitchen: (robot-at kitchen)", "home: (robot-at home)")
    assert still_planned(changed, plan) == {"c0", "c1"}
    assert still_planned(program(STEPS[0]), plan) == {"c0", "c1"}
    assert still_planned(program("open [(open cupboard)]: (open fridge)"), plan) == {"c0"}
    assert still_planned(Automaton(), plan) == {"c0"}


def test_an_older_plan_is_kept_on_the_screen(care_home: World) -> None:
    plan = Planner(care_home).compile(program(STEPS[0]))
    snapshot = Snapshot(1, program(*STEPS), plan, "planning")
    scene = Scene(
        care_home, "x", snapshot, PlainWording(care_home), Progress(care_home.initial), UNICODE
    )
    texts = [row.text for row in outline_rows(scene, 80, actions=True)]
    assert sum("✓ 3 actions" in text for text in texts) == 1
    assert sum("… planning" in text for text in texts) == 1
    assert len(texts) == 6
    unplanned = replace(scene, snapshot=replace(snapshot, plan=None))
    assert sum("… planning" in row.text for row in outline_rows(unplanned, 80, True)) == 2


def test_progress_follows_the_events(care_home: World) -> None:
    automaton = program(*STEPS)
    plan = Planner(care_home).compile(automaton)
    action = str(plan.segments["c2"].actions[0])
    at, number = Progress(care_home.initial), len(plan.segments["c1"].actions) + 1
    at = advanced(at, RunStarted(time=5.0, robot="world", beliefs=["(robot-at home)"]), plan)
    assert (at.started, at.activity) == (5.0, "running")
    at = advanced(at, GoalSent(time=6, goal=1, action=action, literals=[], checkpoint="c2"), plan)
    assert at.at == ("c2", number)
    at = advanced(at, GoalSent(time=6, goal=2, action="(wave)", literals=[], checkpoint="c2"), plan)
    assert at.at == ("c2", None)
    at = advanced(
        at, Observed(time=7, added=["(robot-at hall)"], removed=["(robot-at home)"]), plan
    )
    assert at.state == State(frozenset({parse_literal("(robot-at hall)")}))
    at = advanced(at, CheckpointReached(time=8, checkpoint="c2", name="hall"), plan)
    assert at.at == ("c2", None)
    at = advanced(at, StateChanged(time=8, before="pursuing", after="waiting"), plan)
    assert at.activity == "waiting"
    stopping = replace(at, activity="stopping")
    assert advanced(stopping, StateChanged(time=8, before="x", after="paused"), plan) == stopping
    at = advanced(at, RunEnded(time=9, outcome="done"), plan)
    assert (at.activity, at.at) == ("", None)


def test_a_transcript_forgets_the_oldest() -> None:
    transcript = Transcript()
    for number in range(MOST + 5):
        transcript = transcript.add(Exchange(f"line {number}"))
    assert len(transcript.exchanges) == MOST
    assert transcript.rows(40)[0].text == "> line 5"
    late = transcript.answer(1, [Entry("late")])
    assert late.rows(40)[-1].text == "  late"
    assert late.rows(40)[0].text == "> line 6"
