"""The plan step by step, the run as it goes, and the map."""

from __future__ import annotations

from collections.abc import Sequence

from polaris_nl.model.formula import Literal
from polaris_nl.model.state import State
from polaris_nl.model.text import listed, sentence
from polaris_nl.render.forms import changes_in_words
from polaris_nl.render.glyphs import cells
from polaris_nl.render.layout import Row, cut, wrapped
from polaris_nl.render.map import map_lines
from polaris_nl.render.timeline import Stop, branch_stops, timeline_rows
from polaris_tui.progress import Progress
from polaris_tui.scene import Scene
from polaris_tui.stepping import first_leaf

MAP_ROOM = (24, 6)
"""Columns and rows that a map needs at least."""
MAP_BELOW = 10
"""Rows from which on a map below other things is worth its room."""
FEW = 3
"""Rows of a timeline that make room for a map."""


def map_rows(scene: Scene, width: int, height: int) -> list[Row]:
    """The map, or why there is none."""
    if width < MAP_ROOM[0] or height < MAP_ROOM[1]:
        return wrapped("The map needs a larger screen.", width, tone="faint")
    stops = scene.stops() if scene.stepping else ()
    after = stops[min(scene.steps.at, len(stops) - 1)].after if stops else None
    rows = _map(scene, after or scene.progress.state, width, height)
    if not rows:
        return wrapped(f"The world {scene.world.name} has no map.", width, tone="faint")
    return rows


def _map(scene: Scene, state: State, width: int, height: int) -> list[Row]:
    if width < MAP_ROOM[0] or height < MAP_ROOM[1]:
        return []
    return [Row(x) for x in map_lines(scene.world, state, scene.glyphs, width, height)]


# The plan step by step


def plan_rows(scene: Scene, width: int, height: int) -> list[Row]:
    """One branch as a timeline, the step that is picked in words, and the map after it."""
    stops = scene.stops()
    if not stops:
        return wrapped("There is no plan to step through yet.", width, tone="faint")
    at = min(scene.steps.at, len(stops) - 1)
    planned = frozenset(scene.snapshot.plan.segments if scene.snapshot.plan else ())
    timeline = timeline_rows(stops, at, scene.glyphs, width, planned)
    told = told_rows(scene, stops, at, width)
    return _with_map(scene, timeline, [Row(""), *told], stops[at].after, width, height)


def _with_map(
    scene: Scene, timeline: list[Row], told: list[Row], state: State | None, width: int, height: int
) -> list[Row]:
    """A timeline and what there is to say, with the map below: part of the timeline makes room for it."""
    room = height - len(told)
    if room - len(timeline) < MAP_BELOW <= room - FEW and state is not None:
        timeline = _window(timeline, FEW)
    rows = [*_window(timeline, max(room, FEW)), *told]
    if state is None or height - len(rows) < MAP_BELOW:
        return rows
    return rows + _map(scene, state, width, height - len(rows))


def _window(rows: list[Row], height: int) -> list[Row]:
    """The rows around the one that is picked out."""
    here = next((n for n, row in enumerate(rows) if row.span), 0)
    top = max(0, min(here - height // 2, len(rows) - height))
    return rows[top : top + height]


def told_rows(scene: Scene, stops: Sequence[Stop], at: int, width: int) -> list[Row]:
    """What the picked stop is, what it changes, and why it is there."""
    stop = stops[at]
    place = f"Step {at + 1} of {len(stops)}"
    if stop.kind == "condition":
        several = len(stop.ways) > 1
        keys = f"{scene.keymap.first('next-way')}: the next way"
        which = (
            f", way {stop.ways.index(stop.checkpoint) + 1} of {len(stop.ways)}" if several else ""
        )
        rows = wrapped(
            f"{place}{which}: {stop.text}" + (f" ({keys})" if several else ""), width, tone="strong"
        )
    elif stop.kind == "action":
        rows = wrapped(f"{place}, action {stop.number}: {stop.text}", width, tone="strong")
    else:
        rows = wrapped(f"{place}, checkpoint {stop.text}", width, tone="strong")
    rows += _changes(scene, stop, width)
    if scene.purpose and stop.kind == "action":
        rows += wrapped(scene.purpose, width, "Why: ")
    return rows


def _changes(scene: Scene, stop: Stop, width: int) -> list[Row]:
    if stop.kind == "checkpoint":
        here = scene.snapshot.automaton.checkpoints.get(stop.checkpoint)
        problem = scene.snapshot.plan.problem_at(stop.checkpoint) if scene.snapshot.plan else None
        if stop.after is None:
            return wrapped(
                problem.text if problem else "There is no plan for it.", width, tone="bad"
            )
        if here is None or not here.goals:
            return wrapped("It has no goal of its own.", width)
        facts = [scene.wording.fact(goal) for goal in here.goals]
        return wrapped(sentence(listed(facts)), width, "Reached: ")
    if stop.before is None or stop.after is None:
        return []
    changes = changes_in_words(stop.before, stop.after, scene.wording, scene.mutexes)
    return wrapped(sentence(listed(changes)) or "Nothing changes.", width, "Then: ")


# The run


def run_rows(scene: Scene, width: int, height: int) -> list[Row]:
    """What is done and to come, what is waited for, expected beside perceived, and the map."""
    now = scene.progress
    if now.started is None and now.activity:
        text = f"I'm looking for {scene.robot}. Nothing has been told to move."
        return wrapped(text if scene.robot else "The run begins.", width)
    if now.started is None:
        key = scene.keymap.first("run")
        return wrapped(f"Nothing was run yet. {key} reads out what will happen, and asks.", width)
    told = [*_standing(scene, now, width), *expectation_rows(scene, now, width)]
    return _with_map(scene, way_rows(scene, now, width), told, now.state, width, height)


def way_rows(scene: Scene, now: Progress, width: int) -> list[Row]:
    """The branch that the robot is on, with what is done ticked off."""
    plan, automaton = scene.snapshot.plan, scene.snapshot.automaton
    if plan is None or now.reached not in automaton.checkpoints:
        return []
    toward = now.heading if now.heading in automaton.checkpoints else now.reached
    leaf = first_leaf(automaton, toward)
    if now.waiting:  # which way it goes on isn't known yet
        leaf = now.reached
    stops = branch_stops(automaton, plan, leaf, scene.wording)
    done = _done(stops, now)
    going_on = now.activity or not now.outcome.startswith("done")
    picked = done if going_on and done < len(stops) else None
    return timeline_rows(stops, picked, scene.glyphs, width, frozenset(plan.segments), done)


def _done(stops: Sequence[Stop], now: Progress) -> int:
    """How many stops the robot has behind it."""
    passed = 0
    for at, stop in enumerate(stops, 1):
        here = stop.kind == "checkpoint" and stop.checkpoint == now.reached
        if here or (stop.checkpoint == now.heading and _behind(stop, now)):
            passed = at
    return passed


def _behind(stop: Stop, now: Progress) -> bool:
    """Whether the robot is past a stop on the way that it is on."""
    number = now.last[1] if now.last else None
    earlier = number is not None and stop.number is not None and stop.number < number
    return stop.kind == "condition" or earlier


def _standing(scene: Scene, now: Progress, width: int) -> list[Row]:
    """In a sentence, how the run is; with the ways that are waited for."""
    if now.outcome:
        outcome, _, reason = now.outcome.partition(": ")
        return wrapped(f"The run is over: {outcome}. {reason}", width, tone="strong")
    if not now.waiting:
        return []
    key = scene.keymap.first("tell")
    rows = wrapped(
        f"I wait. Say what has happened, or press {key} and choose:", width, tone="strong"
    )
    for number, when in enumerate(now.waiting, 1):
        told = all(x in now.told for x in when)
        sign = f"  {scene.glyphs.good} you told me" if told else ""
        rows += wrapped(f"{scene.wording.events(when)}{sign}", width, f"  {number}. ")
    return rows


def expectation_rows(scene: Scene, now: Progress, width: int) -> list[Row]:
    """What is expected beside what is perceived."""
    expected = tuple(dict.fromkeys((*now.expected, *now.missed)))
    if not expected:
        return []
    left = min(max(cells(scene.wording.fact(x)) for x in expected) + 2, max(width // 2, 20))
    head = "Expected"
    rows = [Row(f"{head}{' ' * (left - len(head))}Perceived", "strong")]
    for literal in expected:
        text = cut(scene.wording.fact(literal), left - 2, scene.glyphs.more)
        sign, tone = perceived(scene, now, literal)
        sign = cut(sign, max(width - left, 4), scene.glyphs.more)
        rows.append(Row(f"{text}{' ' * (left - cells(text))}{sign}", "bad" if tone else ""))
    return rows


def perceived(scene: Scene, now: Progress, literal: Literal) -> tuple[str, bool]:
    """Whether a fact is perceived, by sign and word; and whether it is missed."""
    if now.state.holds(literal):
        return f"{scene.glyphs.good} yes", False
    if literal in now.missed:
        return f"{scene.glyphs.bad} no: {scene.wording.fact(literal.negation)}", True
    return f"{scene.glyphs.open} not yet", False
