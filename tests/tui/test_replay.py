"""Logs gone through: any moment of a run, what led to it, what went wrong."""

from __future__ import annotations

from pathlib import Path

import pytest

from polaris_nl.automaton.automaton import Automaton
from polaris_nl.execution.events import GoalSent, Halted, Heard, Planned, RunStarted
from polaris_nl.logs.reader import read_log
from polaris_nl.logs.writer import LogWriter
from polaris_nl.model.errors import LogError
from polaris_nl.model.world import World
from polaris_tui.progress import Progress, advanced
from polaris_tui.replay import open_replay
from tests.tui.conftest import LUNCH, Play, Stage


def test_any_moment_is_what_the_events_before_it_make(log: Path, care_home: World) -> None:
    replay = open_replay(log, care_home)
    now = Progress(replay.world.initial)
    expected = [now]
    for event in replay.events:
        now = advanced(now, event, replay.plan)
        expected.append(now)
    numbers = [*range(0, len(replay.events) + 1, 7), len(replay.events), 3, 101, 100, 99]
    for number in numbers:
        assert replay.progress(number) == expected[number]
    assert replay.progress(len(replay.events)).outcome.startswith("done")
    assert replay.complete


def test_a_log_brings_its_world_program_and_plan(log: Path, care_home: World) -> None:
    replay = open_replay(log, care_home)
    assert replay.world.name == "care-home"
    assert [c.name for c in replay.automaton.checkpoints.values()][:2] == ["start", "alerted"]
    assert replay.plan.action_count == 14
    assert len(replay.shown("topic=goal-sent")) == 12
    assert replay.shown("no such words") == []
    assert replay.problem(0, 1) is None


def test_what_led_to_an_event(log: Path, care_home: World) -> None:
    replay = open_replay(log, care_home)
    (decided,) = [
        n for n, e in enumerate(replay.events, 1) if "Lunch is acknowledged: on to" in e.text
    ]
    texts = [replay.events[n - 1].text for n in replay.chain(decided)]
    assert texts[-1] == "Lunch is acknowledged: on to fetched."
    assert any(text.startswith("I wait until") for text in texts)
    assert any("acknowledge" in text and "simulated" in text for text in texts)
    last = replay.chain(len(replay.events))
    assert decided not in last  # another decision came after it
    assert last == sorted(last)


def test_a_log_says_what_the_program_came_from(play: Play, tmp_path: Path) -> None:
    async def script(stage: Stage) -> None:
        await stage.say(LUNCH)
        await stage.say("what will you do?")
        await stage.say("run it")
        await stage.say("yes")
        await stage.see("Objectives: 3 of 3")

    session = play(script)
    (path,) = (tmp_path / "logs").glob("*.mcap")
    replay = open_replay(path, session.world)
    events = [replay.events[n - 1] for n in replay.chain(len(replay.events))]
    assert [e.utterance for e in events if isinstance(e, Heard)] == [LUNCH, "yes"]
    assert [type(e) for e in replay.events].count(Planned) == 1

    async def reviewed(stage: Stage) -> None:
        stage.app.open_log(path)
        await stage.see("Typed: Tell the resident that lunch is ready.", "0.0 s   The run starts.")
        await stage.press("end", "c")
        await stage.see("What led to event", "Typed: yes")

    play(reviewed, size=(100, 60))


def halted(log: Path, folder: Path) -> Path:
    """The log, cut short by a halt."""
    made = read_log(log)
    path = folder / "halted.mcap"
    at = next(n for n, e in enumerate(made.events) if isinstance(e, GoalSent))
    goal = made.events[at]
    assert isinstance(goal, GoalSent)
    with LogWriter(path, made.attachments) as writer:
        for event in made.events[: at + 1]:
            writer.write(event)
        writer.write(
            Halted(
                time=goal.time + 9,
                text="I halt: the door is shut.",
                reason="The door is shut.",
                expected=[goal.literals[0]],
            )
        )
    return path


def test_a_problem_is_found_and_compared(
    play: Play, log: Path, tmp_path: Path, care_home: World
) -> None:
    path = halted(log, tmp_path)
    replay = open_replay(path, care_home)
    number = len(replay.events)
    assert replay.problem(0, 1) == number
    assert replay.problem(number, -1) is None
    found = replay.differences(number)
    assert found
    assert not all(holds for _, holds in found)

    async def script(stage: Stage) -> None:
        stage.app.open_log(path)
        await stage.see("Log halted.mcap", "event 2 of")
        await stage.press("n")
        await stage.see(f"event {number} of {number}", "I halt: the door is shut.")
        await stage.press("n")
        await stage.see("There is no problem after this event.")
        await stage.press("d")
        await stage.see("Expected", "Perceived", "✗ no")
        await stage.press("home")
        await stage.see("event 2 of")
        await stage.press("slash")
        await stage.until(lambda: stage.app.state.choosing.last is not None)
        await stage.press(*"topic=halt", "enter")
        await stage.see("only: topic=halt")
        await stage.press("slash", "ctrl+u", "asterisk", "enter")
        await stage.see("The run starts.")
        await stage.press("r")
        await stage.see('"r" means nothing here.')
        await stage.press("f3")
        await stage.see("Map, after event")
        await stage.press("f3", "escape", "escape")
        await stage.see("Program and plan")

    play(script, size=(120, 40))


def test_a_log_without_its_world_is_read_with_this_one(tmp_path: Path, care_home: World) -> None:
    path = tmp_path / "bare.mcap"
    with LogWriter(path) as writer:
        writer.write(RunStarted(time=1.0, robot="world", text="The run starts."))
    replay = open_replay(path, care_home)
    assert replay.world is care_home
    assert replay.automaton == Automaton()
    with LogWriter(tmp_path / "bad.mcap", {"program.polaris.json": "{"}) as writer:
        writer.write(RunStarted(time=1.0, robot="world"))
    with pytest.raises(LogError, match=r"The program in .*bad\.mcap can't be read"):
        open_replay(tmp_path / "bad.mcap", care_home)


def test_letters_in_a_log_change_no_program(play: Play, log: Path) -> None:
    async def script(stage: Stage) -> None:
        await stage.say("Open the fridge.")
        program = stage.session.snapshot.automaton
        stage.app.open_log(log)
        await stage.see("> Log lunch.mcap")
        await stage.press("u", "a", "d")  # Not "U", too: it would hide an undo.
        await stage.say("what will you do?")  # Answered after all that was asked for before.
        assert stage.session.snapshot.automaton == program

    play(script)


def test_a_log_asked_for_by_a_sentence_leaves_the_input_line_the_focus(
    play: Play, log: Path
) -> None:
    async def script(stage: Stage) -> None:
        stage.app.logs = log.parent
        await stage.enter(":log")
        await stage.see("Which log?")
        await stage.press(*"lunch", "enter")
        await stage.see("Log lunch.mcap")
        assert stage.prompt.has_focus

    play(script)
