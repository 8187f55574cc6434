"""What the panes show: pure functions from a scene to rows."""

from __future__ import annotations

from dataclasses import replace

from polaris_nl.automaton.automaton import START, Automaton
from polaris_nl.planning.result import BranchingPlan
from polaris_nl.render.explanation import problem_rows
from polaris_nl.render.glyphs import Glyphs, cells, plain
from polaris_nl.render.layout import Row, Tone, cut, wrapped
from polaris_nl.render.program import program_rows
from polaris_nl.render.tree import tree_of
from polaris_tui.footer import footer
from polaris_tui.panels import map_rows, plan_rows, run_rows
from polaris_tui.reasons import View
from polaris_tui.reviewing import review_heading, review_rows
from polaris_tui.scene import Scene

HELP = (
    "Type what the robot should achieve and press Enter, for example:",
    "    Tell the resident that lunch is ready. Once she acknowledges, bring a full tray to her table.",
    "    If she dismisses it, go home.",
    "Change it the same way: no, I meant the desk / remove the last step / undo / start over.",
    "Ask: what will you do? / what if she dismisses it? / where is the tray?",
    "Answer a question with its words, with its number, or with: the second.",
    "In a run, type stop, pause, resume, or what has happened: she acknowledges.",
    "By keys: Tab goes to the program; there, letters change it. a adds a checkpoint, Enter opens what "
    "can be done with the one that is picked, Esc goes back to the input line.",
    "Where a key doesn't get through, type a colon and the action: :map, :plan, :rename; : alone lists all.",
)


def heading(view: View, scene: Scene) -> str:
    """What stands above a view."""
    running = scene.running
    match view:
        case "program":
            what = "Program and plan" if scene.actions and not scene.tree else "Program"
            return f"{what}{_making(scene)}" + (", being carried out" if running else "")
        case "plan":
            return f"Plan, step by step{_making(scene)}"
        case "run":
            return run_heading(scene)
        case "map":
            if scene.reading is not None:
                return f"Map, after event {scene.reading.number}"
            if scene.stepping:
                return f"Map, after step {scene.steps.at + 1}"
            if scene.progress.started is None:
                return "Map, at the start"
            return "Map, now" if running else "Map, after the run"
        case "review":
            return review_heading(scene)
        case "help":
            return f"Help ({_paging(scene)})"
    return "Answers"


def run_heading(scene: Scene) -> str:
    """What stands above a run: whose it is stays to be read, however much is answered meanwhile."""
    ended = not scene.running and scene.progress.started is not None
    robot = f" on {plain(scene.robot)}" if scene.robot else ""
    return f"Run{robot}" + ", begun in another terminal" * scene.attached + ", as it ended" * ended


def _paging(scene: Scene) -> str:
    keymap = scene.keymap
    return f"{keymap.first('page-down')}: more; {keymap.first('help')}: back"


def _making(scene: Scene) -> str:
    """The sign that the plan of this revision is still being made."""
    snapshot = scene.snapshot
    if snapshot.planning == "planning" and scene.slow:
        return f", planning{scene.glyphs.more} r{snapshot.revision}"
    return ""


def view_rows(view: View, scene: Scene, width: int, height: int) -> list[Row]:
    """The rows of a view, but of the answers."""
    match view:
        case "map":
            return map_rows(scene, width, height)
        case "plan":
            return plan_rows(scene, width, height)
        case "run":
            return run_rows(scene, width, height)
        case "review":
            return review_rows(scene, width)
        case "help":
            return help_rows(scene, width)
    if scene.tree:
        snapshot = scene.snapshot
        planned = snapshot.plan if snapshot.planning == "planned" else None
        drawing = tree_of(snapshot.automaton, planned, scene.wording, scene.glyphs, width)
        return drawing.shown(scene.picked)
    return outline_rows(scene, width, scene.actions)


def help_rows(scene: Scene, width: int) -> list[Row]:
    """What can be said, and the keys."""
    rows: list[Row] = []
    for text in HELP:
        lead = " " * (len(text) - len(text.lstrip()))
        rows += wrapped(text.strip(), width, lead)
    group = ""
    for here, keys, does in scene.keymap.help():
        if here != group:
            group = here
            rows += [Row(""), Row(here, "strong")]
        rows += wrapped(does, width, f"{keys:<16} ")
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

    if len(snapshot.automaton.checkpoints) == 1:
        return [*drawn(None), *_first_steps(scene, width)]
    if snapshot.planning == "planned" or snapshot.plan is None:
        return drawn(snapshot.plan if snapshot.planning == "planned" else None)
    older: dict[str | None, list[Row]] = {}
    for row in drawn(snapshot.plan):
        dimmed = replace(row, tone="faint") if scene.slow and row.action else row
        older.setdefault(row.checkpoint, []).append(dimmed)
    kept = still_planned(snapshot.automaton, snapshot.plan)
    rows: list[Row] = []
    for row in drawn(None):
        rows += older.pop(row.checkpoint, []) if row.checkpoint in kept else [row]
    return rows


def _first_steps(scene: Scene, width: int) -> list[Row]:
    """What to do with an empty program."""
    keymap = scene.keymap
    example = next(iter(scene.world.of_type("region")), None)
    say = f"Such as: go to {scene.wording.entity(example.name)}. " if example else ""
    keys = f"{keymap.first('next-pane')}, then {keymap.first('add')}: a menu of what can be so"
    return wrapped(
        f"{say}Or by keys, {keys}. {keymap.first('help')}: help.", width, "  ", tone="faint"
    )


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
    """World and program file, the revision, and what undo would take back."""
    left = f"Polaris NL  {plain(scene.world.name)}  {plain(scene.file)}"
    if scene.snapshot.revision:
        left += f"  r{scene.snapshot.revision}"
    if scene.robot and not scene.reading:
        left += f"  robot: {plain(scene.robot)}"
    undoable = scene.snapshot.undoable
    key = scene.keymap.first("undo")
    right = f"{key} undoes: {plain(undoable[-1])}" if undoable and not scene.reading else ""
    return Row(_apart(left, right, width, scene.glyphs), "strong")


def status_row(scene: Scene, width: int, place: str) -> Row:
    """How program and plan are, by sign and word, and the first keys to know."""
    text, tone = status(scene)
    if scene.voice:
        heard = cut(plain(scene.voice), max(width // 3, 12), scene.glyphs.more)
        text = f"{text}  ({heard})"
    shown = footer(place, scene.keymap, scene.now, width - cells(text) - 2)
    return Row(_apart(text, shown, width, scene.glyphs), tone)


def status(scene: Scene) -> tuple[str, Tone]:
    """How program and plan are: sign, word and number of actions."""
    if scene.reading is not None:
        return _read(scene)
    glyphs, snapshot, activity = scene.glyphs, scene.snapshot, scene.progress.activity
    if activity:
        sign = glyphs.open if activity in ("loading", "connecting", "stopping", "waiting") else ">"
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


def _read(scene: Scene) -> tuple[str, Tone]:
    """How the run of a log was at an event."""
    assert scene.reading is not None
    number, events = scene.reading.number, scene.reading.replay.events
    now = scene.progress.outcome.split(":")[0] or scene.progress.activity or "before the run"
    return f"event {number} of {len(events)}, {now}", "strong"


def _count(number: int, what: str) -> str:
    return f"1 {what}" if number == 1 else f"{number} {what}s"


def _apart(left: str, right: str, width: int, glyphs: Glyphs) -> str:
    """Two texts at the two ends of a row; the right one gives way."""
    left = cut(left, width, glyphs.more)
    room = width - cells(left) - 2
    if room < 12:
        return left
    right = cut(right, room, glyphs.more)
    return left + " " * (width - cells(left) - cells(right)) + right
