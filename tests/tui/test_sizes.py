"""Every view at two sizes, dark and light, as a person has read it and found good."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from polaris_nl.automaton.automaton import Automaton, Checkpoint, Transition
from polaris_nl.automaton.edits import AddCheckpoint, ReplaceProgram, apply
from polaris_nl.execution.events import (
    CheckpointReached,
    Deviated,
    Event,
    GoalSent,
    Halted,
    Observed,
    RunEnded,
    RunStarted,
    StateChanged,
    TransitionTaken,
    Waiting,
)
from polaris_nl.model.formula import parse_formula
from polaris_nl.session import Session
from polaris_tui.progress import Progress, advanced
from polaris_tui.settings import Settings
from polaris_tui.styles import LOOKS
from tests.golden.files import check_golden
from tests.tui.conftest import LUNCH, Play, Stage

SIZES = ((80, 24, "dark"), (160, 45, "light"), (60, 20, "terminal"))
PLACES = ("hall", "kitchen", "office", "laundry", "cafeteria", "room-1", "room-2", "home")


def thirty() -> Automaton:
    """Thirty checkpoints: three ways of ten."""
    program = Automaton()
    for number in range(1, 31):
        goal = parse_formula(f"(robot-at {PLACES[number % len(PLACES)]})")
        way, step = divmod(number - 1, 10)
        source = "c0" if step == 0 else f"c{number - 1}"
        when = (
            parse_formula("(acknowledged lunchtime)"),
            parse_formula("(dismissed lunchtime)"),
        )
        new = Checkpoint(f"c{number}", f"stop {number}", (goal,))
        arrow = Transition(f"t{number}", source, new.id, when[way : way + 1] if step == 0 else ())
        program = apply(program, AddCheckpoint(new, arrow))
    return program


def run_so_far(session: Session) -> list[Event]:
    """The events of a run that waits, goes on, and then misses the tray."""
    beliefs = [str(fact) for fact in sorted(session.world.initial.facts)]
    plan = session.snapshot.plan
    assert plan is not None
    moves = plan.segments["c2"].actions
    return [
        RunStarted(time=0.0, robot="world", beliefs=beliefs, text="The run starts."),
        CheckpointReached(time=9.0, checkpoint="c1", name="alerted"),
        Waiting(
            time=9.0,
            checkpoint="c1",
            conditionals=[["(acknowledged lunchtime)"], ["(dismissed lunchtime)"]],
        ),
        StateChanged(time=9.0, before="pursuing", after="waiting"),
        TransitionTaken(time=12.0, transition="t2", source="c1", target="c2"),
        StateChanged(time=12.0, before="waiting", after="pursuing"),
        Observed(time=14.0, added=["(robot-at cafeteria)"], removed=["(robot-at home)"]),
        GoalSent(
            time=20.0,
            goal=3,
            action=str(moves[2]),
            literals=["(holding tray)", "(not (hand-empty))"],
            checkpoint="c2",
        ),
        Deviated(time=26.0, expected=["(holding tray)"], observed=["(hand-empty)"]),
        StateChanged(time=26.0, before="pursuing", after="deviating"),
        Halted(time=40.0, reason="The tray is not there.", expected=["(holding tray)"]),
        RunEnded(time=40.0, outcome="halted", reason="The tray is not there."),
    ]


@pytest.mark.parametrize("size", SIZES, ids=lambda s: f"{s[0]}x{s[1]}")
def test_screens(
    play: Play, size: tuple[int, int, str], log: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    width, height, look = size
    # A busy machine must not change what is said, nor show parts of plans on the way to them.
    monkeypatch.setattr("polaris_tui.conversation.ANSWER_WAIT_S", 60.0)
    monkeypatch.setattr("polaris_tui.app.PATIENCE_S", 60.0)
    monkeypatch.setattr("polaris_nl.planning.compile.STREAM_S", 60.0)
    if look != "terminal":
        monkeypatch.delenv("NO_COLOR")
    pictures: list[str] = []

    async def script(stage: Stage) -> None:
        app, state = stage.app, stage.app.state

        async def keep(title: str) -> None:
            await stage.pilot.pause()
            lines = stage.screen().split("\n")
            assert len(lines) == height
            assert max(map(len, lines)) <= width
            pictures.append(f"== {title}\n{stage.screen()}")
            if look != "terminal":
                name = title.replace(" ", "-").replace(",", "")
                svg = app.export_screenshot(title="Polaris NL")
                check_golden(f"../snapshots/{width}x{height}-{look}/{name}.svg", svg)

        await keep("the start")
        await stage.say(LUNCH)
        await keep("a program")
        await stage.press("tab", "a")
        await keep("a menu")
        await stage.press("escape", "home", "down")
        await keep("the program by keys")
        await stage.press("escape")
        await stage.say("hold the cup and the plate")
        await keep("a problem")
        await stage.press("f1")
        await keep("help")
        await stage.press("f1", "f7")
        await stage.answered()
        await stage.press("f4", "home", *["right"] * 3)
        await stage.until(lambda: bool(state.purposes))
        await keep("the plan, step by step")
        await stage.press("right")
        await keep("the plan, where ways part")
        await stage.press("f3")
        await keep("the map after a step")
        await stage.press("escape", "escape", "escape", "f5")
        await stage.see("Shall I start?")
        await keep("asked to start")
        await stage.press("escape")
        events = run_so_far(stage.session)
        plan = stage.session.snapshot.plan
        assert plan is not None
        state.view = "run"
        shown = {3: "a run that waits", 9: "a run that misses something", 11: "a halted run"}
        progress = Progress(stage.session.world.initial)
        for number, event in enumerate(events):
            progress = state.progress = advanced(progress, event, plan)
            if number in shown:
                app.draw()
                await keep(shown[number])
        state.progress = Progress(stage.session.world.initial, activity="connecting")
        state.robot = state.ran_on = "the simulated Stretch"
        app.draw()
        await keep("a robot that is looked for")
        state.attached = True
        state.voice = "heard: go home"
        for event in events[:3]:
            state.progress = advanced(state.progress, event, plan)
        app.draw()
        await keep("a robot run that was begun elsewhere")
        state.robot = state.voice = ""
        state.attached = False
        state.progress = Progress(stage.session.world.initial)
        app.open_log(log)
        await stage.see("Log lunch.mcap")
        await stage.press(*["down"] * 8)
        await keep("a log")
        await stage.press("d")
        await keep("a log, compared")
        await stage.press("c")
        await keep("a log, chained")
        await stage.press("f2")
        stage.session.edit([ReplaceProgram(thirty())], "thirty checkpoints")
        await stage.until(stage.planned)
        await stage.press("escape")
        await keep("thirty checkpoints")
        check_golden(f"tui/{width}x{height}.txt", "\n".join(pictures))

    play(script, size=(width, height), settings=Settings(theme=look))


@pytest.mark.parametrize("look", sorted(LOOKS))
def test_every_theme_can_be_read(play: Play, look: str) -> None:
    """Text and background differ enough (WCAG 2.2: 4.5 to 1), and no tone is shown by colour alone."""

    async def script(stage: Stage) -> None:
        await stage.say("hold the cup and the plate")
        await stage.press("f10")
        await stage.see("Actions")
        await stage.press("escape")
        stage.app.dress(LOOKS[look])
        await stage.pilot.pause()
        await stage.see("✗ partial", "✗ 1 problem")
        if LOOKS[look].theme.startswith("polaris"):
            background = stage.app.board.main.background_colors[1]
            tones = LOOKS[look].tones.values()
            colours = [style.color.triplet for style in tones if style.color is not None]
            for colour in filter(None, colours):
                assert contrast(tuple(colour), background.rgb) >= 4.5
            text = stage.app.board.main.rich_style.color
            assert text is not None
            assert text.triplet is not None
            assert contrast(tuple(text.triplet), background.rgb) >= 4.5

    play(script)


def contrast(one: tuple[int, int, int], other: tuple[int, int, int]) -> float:
    """The contrast of two colours, by WCAG 2.2."""

    def light(colour: tuple[int, int, int]) -> float:
        parts = [c / 255 for c in colour]
        linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in parts]
        return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]

    low, high = sorted((light(one), light(other)))
    return (high + 0.05) / (low + 0.05)


def test_the_screen_follows_its_terminal(play: Play) -> None:
    async def script(stage: Stage) -> None:
        await stage.say(LUNCH)
        for view in ("f2", "f4", "f3", "f1"):
            await stage.press(view)
            for width, height in ((160, 45), (40, 10), (20, 5), (1, 1), (80, 24)):
                await stage.pilot.resize_terminal(width, height)
                await stage.pilot.pause()
        await stage.press("escape", "escape", "f2")
        await stage.see("ok, 14 actions", "takes 14 actions.")

    play(script)


def test_ascii(play: Play, monkeypatch: pytest.MonkeyPatch, log: Path) -> None:
    monkeypatch.setenv("POLARIS_NL_ASCII", "1")

    async def script(stage: Stage) -> None:
        await stage.say(LUNCH)
        await stage.say("hold the cup and the plate")
        await stage.see("! partial")
        for key in ("f3", "f1", "ctrl+l", "f4", "right", "f3", "f10", "escape", "escape", "f2"):
            await stage.press(key)
            assert stage.screen().isascii()
        await stage.press("escape", "tab", "g")
        assert stage.screen().isascii()
        stage.app.open_log(log)
        await stage.see("Log lunch.mcap")
        assert stage.screen().isascii()

    play(script)


def test_the_screens_in_the_documentation_are_these() -> None:
    root = Path(__file__).parents[2]
    golden = "\n".join(p.read_text() for p in sorted((root / "tests/golden/tui").glob("*.txt")))
    rows = {row.rstrip() for row in golden.splitlines()}
    rows |= {row[:97].rstrip() for row in rows}  # the left half of a wide screen
    blocks = re.findall(r"```text\n(.*?)\n```", (root / "docs/tui.md").read_text(), re.DOTALL)
    assert len(blocks) > 5
    for block in blocks:
        assert [row for row in block.splitlines() if row not in rows] == []
