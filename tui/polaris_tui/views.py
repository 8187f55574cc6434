"""What the panes show: pure functions from snapshots to rows."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal as OneOf

from rich.cells import cell_len

from polaris_nl.automaton.automaton import START, Automaton
from polaris_nl.model.wording import Wording
from polaris_nl.model.world import World
from polaris_nl.planning.result import BranchingPlan
from polaris_nl.render.explanation import problem_rows
from polaris_nl.render.glyphs import Glyphs, plain
from polaris_nl.render.layout import Row, Tone, cut, wrapped
from polaris_nl.render.map import map_lines
from polaris_nl.render.program import program_rows
from polaris_nl.snapshot import Snapshot
from polaris_tui.keys import KEYS
from polaris_tui.progress import Activity, Progress

View = OneOf["plan", "outline", "map", "answers", "help"]

MAP_ROOM = (24, 6)
"""Columns and rows that a map needs at least."""

HELP = (
    "Type what the robot should achieve and press Enter, for example:",
    "    Tell the resident that lunch is ready. Once she acknowledges, bring a full tray to her table.",
    "    If she dismisses it, go home.",
    "Change it the same way: no, I meant the desk / remove the last step / undo / start over.",
    "Ask: what will you do? / what if she dismisses it? / where is the tray?",
    "Answer a question with its words, with its number, or with: the second.",
    "In a run, type stop, pause, resume, or what has happened: she acknowledges.",
    "Where a key doesn't get through, type: show the map / plan / outline / answers / keys.",
)


@dataclass(frozen=True, slots=True)
class Scene:
    """All that the panes show, but the answers.

    Attributes:
        file: the program file's name, or what is to be known where there is none.
        snapshot: program and plan; in a run, those that are carried out.
        wording: words for goals and actions.
        progress: how far a run is.
    """

    world: World
    file: str
    snapshot: Snapshot
    wording: Wording
    progress: Progress
    glyphs: Glyphs


def heading(view: View, scene: Scene) -> str:
    """What stands above a view."""
    match view:
        case "plan" | "outline":
            what = "Program and plan" if view == "plan" else "Program"
            return f"{what}, being carried out" if scene.progress.activity in RUNS else what
        case "map" if scene.progress.started is None:
            return "Map, at the start"
        case "map":
            return "Map, now" if scene.progress.activity in RUNS else "Map, after the run"
        case "help":
            return "Help (PgDn: more; F1: back)"
    return "Answers"


def view_rows(view: View, scene: Scene, width: int, height: int) -> list[Row]:
    """The rows of a view, but of the answers."""
    match view:
        case "map":
            return map_rows(scene, width, height)
        case "help":
            return help_rows(width)
    return outline_rows(scene, width, actions=view == "plan")


def help_rows(width: int) -> list[Row]:
    """What can be said, and the keys."""
    rows = []
    for text in HELP:
        lead = " " * (len(text) - len(text.lstrip()))
        rows += wrapped(text.strip(), width, lead)
    rows.append(Row(""))
    for key in KEYS:
        rows += wrapped(key.does, width, f"{key.shown:<12}") if key.shown else []
    return rows


def outline_rows(scene: Scene, width: int, actions: bool) -> list[Row]:
    """Program and plan; while a plan is being made, the older one where it still holds."""
    snapshot = scene.snapshot

    def drawn(plan: BranchingPlan | None) -> list[Row]:
        return program_rows(
            snapshot.automaton,
            plan,
            scene.wording,
            scene.glyphs,
            width,
            actions and plan is not None,
        )

    if snapshot.planning == "planned" or snapshot.plan is None:
        return drawn(snapshot.plan if snapshot.planning == "planned" else None)
    older: dict[str | None, list[Row]] = {}
    for row in drawn(snapshot.plan):
        older.setdefault(row.checkpoint, []).append(row)
    kept = still_planned(snapshot.automaton, snapshot.plan)
    rows: list[Row] = []
    for row in drawn(None):
        rows += older.pop(row.checkpoint, []) if row.checkpoint in kept else [row]
    return rows


def still_planned(automaton: Automaton, plan: BranchingPlan) -> set[str]:
    """The checkpoints whose way from the start is in an older plan just as it is in the program."""
    kept = {START}
    for target, segment in plan.segments.items():  # parents come before children
        checkpoint, arrow = automaton.checkpoints.get(target), automaton.incoming(target)
        if (
            checkpoint is not None
            and arrow is not None
            and arrow.source in kept
            and (arrow.source, arrow.when) == (segment.source, segment.when)
            and checkpoint.goals == segment.goals
        ):
            kept.add(target)
    return kept


def map_rows(scene: Scene, width: int, height: int) -> list[Row]:
    """The map, or why there is none."""
    if width < MAP_ROOM[0] or height < MAP_ROOM[1]:
        return wrapped("The map needs a larger screen.", width, tone="faint")
    lines = map_lines(scene.world, scene.progress.state, scene.glyphs, width, height)
    if not lines:
        return wrapped(f"The world {scene.world.name} has no map.", width, tone="faint")
    return [Row(line) for line in lines]


def trouble_rows(scene: Scene, width: int) -> list[Row]:
    """Problems with their ways out; nothing where there are none."""
    snapshot = scene.snapshot
    if snapshot.planning == "failed":
        return wrapped(snapshot.failure, width, tone="bad")
    if snapshot.planning != "planned" or snapshot.plan is None:
        return []
    return problem_rows(snapshot.plan, snapshot.automaton, width)


def trouble_heading(scene: Scene) -> str:
    """How many problems and notes there are."""
    plan = scene.snapshot.plan
    if scene.snapshot.planning == "failed" or plan is None:
        return f"{scene.glyphs.bad} No plan"
    counts = []
    if plan.problems:
        counts.append(f"{scene.glyphs.bad} {_count(len(plan.problems), 'problem')}")
    if plan.warnings:
        counts.append(_count(len(plan.warnings), "note"))
    return ", ".join(counts)


def title_row(scene: Scene, width: int) -> Row:
    """World and program file, and what undo would take back."""
    left = f"Polaris NL  {plain(scene.world.name)}  {plain(scene.file)}"
    undoable = scene.snapshot.undoable
    right = f"F7 undoes: {plain(undoable[-1])}" if undoable else ""
    return Row(_apart(left, right, width, scene.glyphs), "strong")


def status_row(scene: Scene, width: int) -> Row:
    """How program and plan are, by sign and word, and the first keys to know."""
    text, tone = status(scene)
    running = scene.progress.activity in RUNS
    run = "F9 stop  F6 pause" if running else "F5 run"
    keys = (
        f"F1 help  F2 outline  F3 map  {run}  ctrl+q quit",
        f"F1 help  {run}  ctrl+q quit",
        f"F1 help  {run}",
    )
    room = width - cell_len(text) - 2
    shown = next((k for k in keys if len(k) <= room), run)
    return Row(_apart(text, shown, width, scene.glyphs), tone)


RUNS: tuple[Activity, ...] = ("running", "waiting", "paused", "deviating", "stopping")


def status(scene: Scene) -> tuple[str, Tone]:
    """How program and plan are: sign, word and number of actions."""
    glyphs, snapshot, activity = scene.glyphs, scene.snapshot, scene.progress.activity
    if activity:
        sign = glyphs.open if activity in ("loading", "stopping", "waiting") else ">"
        return f"{sign} {activity}", "strong"
    if snapshot.planning == "failed":
        return f"{glyphs.bad} planning failed", "bad"
    if snapshot.planning == "planning" or snapshot.plan is None:
        return f"{glyphs.open} planning", "strong"
    if len(snapshot.automaton.checkpoints) == 1:
        return f"{glyphs.start} empty program", ""
    plan = snapshot.plan
    actions = _count(plan.action_count, "action")
    if plan.status == "ok":
        return f"{glyphs.good} ok, {actions}", "good"
    problems = _count(len(plan.problems), "problem")
    if plan.segments:
        return f"{glyphs.bad} {plan.status}: {problems}, {actions}", "bad"
    return f"{glyphs.bad} {plan.status}: {problems}", "bad"


def _count(number: int, what: str) -> str:
    return f"1 {what}" if number == 1 else f"{number} {what}s"


def _apart(left: str, right: str, width: int, glyphs: Glyphs) -> str:
    """Two texts at the two ends of a row; the right one gives way."""
    left = cut(left, width, glyphs.more)
    room = width - cell_len(left) - 2
    if room < 12:
        return left
    right = cut(right, room, glyphs.more)
    return left + " " * (width - cell_len(left) - cell_len(right)) + right
