"""The session: utterances and edits in, snapshots, answers and events out."""

from __future__ import annotations

import json
import queue
import subprocess
import threading
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest
from jsonschema import Draft202012Validator

from polaris_nl.automaton.automaton import Automaton
from polaris_nl.automaton.edits import RenameCheckpoint
from polaris_nl.automaton.program import program_json, read_program
from polaris_nl.execution.events import (
    Edited,
    Event,
    Failed,
    Heard,
    Interpreted,
    Planned,
    Understood,
)
from polaris_nl.model.errors import EditError, PlanningError
from polaris_nl.model.world import World
from polaris_nl.planning import search
from polaris_nl.planning.planner import Planner
from polaris_nl.session import Session
from polaris_nl.snapshot import Snapshot, answer_json
from tests.session.conftest import LIMIT_S, GatedPlanner, Open, Watched, add

CUP = "Put the cup on the desk."
HOME = "Then go home."
TABLE = "(at cup desk)"


def goals(automaton: Automaton) -> list[list[str]]:
    return [[str(g) for g in c.goals] for c in automaton.checkpoints.values()][1:]


# Program and plan


def test_an_utterance_becomes_a_program_and_its_plan(session: Watched) -> None:
    answer = session.say(CUP)
    snapshot = answer.snapshot
    assert answer.interpretation.outcome == "applied"
    assert goals(snapshot.automaton) == [[TABLE]]
    assert (snapshot.revision, snapshot.planning, snapshot.failure) == (1, "planned", "")
    assert snapshot.plan is not None
    assert snapshot.plan.status == "ok"
    (segment,) = snapshot.plan.segments.values()
    assert [str(x) for x in segment.goals] == [TABLE]
    assert str(segment.actions[-1]) == "(place cup desk)"
    assert f"{len(segment.actions)} actions" in answer.say
    assert session.snapshot == snapshot
    assert session.program == session.program_of(snapshot.automaton)


def test_the_next_utterance_builds_on_it(session: Watched) -> None:
    session.say(CUP)
    snapshot = session.say(HOME).snapshot
    assert goals(snapshot.automaton) == [[TABLE], ["(robot-at home)"]]
    assert snapshot.revision == 2
    assert snapshot.plan is not None
    assert list(snapshot.plan.segments) == ["c1", "c2"]


def test_a_problem_is_told_with_the_edit_that_made_it(session: Watched) -> None:
    assert add(session, "(acknowledged lunchtime)") == ""
    plan = session.wait().plan
    assert plan is not None
    assert plan.omitted == ("c1",)
    text = session.say("status").say
    assert text == plan.problems[0].text


def test_without_waiting_the_plan_is_pending_and_comes_later(
    session: Watched, planner: Planner
) -> None:
    session.planner = gated = GatedPlanner(planner)
    answer = session.say(CUP, wait_s=0)
    assert (answer.snapshot.planning, answer.snapshot.plan) == ("planning", None)
    assert answer_json(answer, session.program)["plan"]["status"] == "pending"
    assert "still working out the plan" in answer.say
    gated.gate.set()
    assert session.wait(LIMIT_S).planning == "planned"


def test_everything_is_reported_as_events_in_order(session: Watched) -> None:
    session.say(CUP)
    assert session.kinds() == ["Heard", "Interpreted", "Edited", "Planned", "Understood"]
    heard, interpreted, edited, planned, understood = session.events
    assert isinstance(heard, Heard)
    assert isinstance(interpreted, Interpreted)
    assert isinstance(edited, Edited)
    assert isinstance(planned, Planned)
    assert isinstance(understood, Understood)
    assert {e.time for e in session.events} == {12.5}
    assert heard.utterance == interpreted.utterance == understood.utterance == CUP
    assert interpreted.readings[0]["text"]
    assert edited.program == program_json(session.program)
    assert (edited.revision, planned.revision, planned.status) == (1, 1, "ok")
    assert "program" not in understood.interpretation
    json.dumps([understood.interpretation, planned.plan, edited.edits])


# Undo and redo


def test_undo_and_redo_by_word(session: Watched) -> None:
    session.say(CUP)
    cup = session.snapshot.automaton
    session.say(HOME)
    both = session.snapshot.automaton
    undone = session.say("undo that")
    assert undone.snapshot.automaton == cup
    assert undone.say.startswith("Undone: ")
    assert undone.snapshot.planning == "planned"
    assert undone.snapshot.plan is not None
    assert list(undone.snapshot.plan.segments) == ["c1"]
    assert session.say("undo").snapshot.automaton == Automaton()
    assert session.say("undo").say == "There is nothing to undo."
    assert session.say("redo").snapshot.automaton == cup
    assert session.say("redo").snapshot.automaton == both
    assert session.say("redo").say == "There is nothing to redo."


def test_undo_and_redo_by_key(session: Watched) -> None:
    assert (session.undo(), session.redo()) == (None, None)
    assert session.snapshot.revision == 0
    add(session, TABLE)
    add(session, "(robot-at home)")
    assert session.snapshot.undoable == ("add c1", "add c2")
    assert session.undo() == "add c2"
    snapshot = session.snapshot
    assert (snapshot.undoable, snapshot.redoable) == (("add c1",), ("add c2",))
    assert goals(snapshot.automaton) == [[TABLE]]
    assert session.redo() == "add c2"
    assert session.undo() == "add c2"
    add(session, "(robot-at hall)")
    assert session.redo() is None
    assert session.snapshot.revision == 6


def test_new_empties_the_program_and_can_be_undone(session: Watched) -> None:
    session.say(CUP)
    before = session.snapshot.automaton
    assert session.say("start over").snapshot.automaton == Automaton()
    assert session.say("new").say == "The program is empty already."
    assert session.say("undo").snapshot.automaton == before


# Refusals and questions


@pytest.mark.parametrize(
    "utterance", ["Bring the unicorn to the desk.", "", "colourless green ideas sleep", "load"]
)
def test_a_refusal_leaves_the_program_alone_and_gives_its_reason(
    session: Watched, utterance: str
) -> None:
    session.say(CUP)
    before = session.snapshot
    answer = session.say(utterance)
    assert answer.interpretation.outcome == "refused"
    assert answer.interpretation.refusal is not None
    assert answer.interpretation.refusal.reason
    assert answer.say
    assert session.snapshot == before
    assert [type(e) for e in session.events].count(Edited) == 1


def test_a_question_leaves_the_program_alone_until_it_is_answered(session: Watched) -> None:
    answer = session.say("Go to the room.")
    question = answer.interpretation.question
    assert answer.interpretation.outcome == "question"
    assert question is not None
    assert sorted(question.options) == ["room 1", "room 2"]
    assert session.snapshot.revision == 0
    answered = session.say("the second")
    assert answered.interpretation.outcome == "applied"
    second = question.options[1].replace(" ", "-")
    assert goals(answered.snapshot.automaton) == [[f"(robot-at {second})"]]


def test_an_edit_that_does_not_fit_changes_nothing(session: Watched) -> None:
    add(session, TABLE)
    before = session.wait(LIMIT_S)
    with pytest.raises(EditError):
        session.edit([RenameCheckpoint("c1", "cup"), RenameCheckpoint("c9", "x")], "rename")
    assert session.snapshot == before


# The run: said, read back, and a clear yes


def test_a_run_is_read_back_and_confirmed_by_yes_once(session: Watched) -> None:
    session.say(CUP)
    echo = session.say("run it")
    assert echo.interpretation.command == "run"
    assert not echo.confirmed
    assert "cup" in echo.say
    assert echo.say.endswith("Shall I start? Say yes or no.")
    yes = session.say("yes")
    assert (yes.confirmed, yes.say) == (True, "Starting.")
    again = session.say("yes")
    assert (again.confirmed, again.say) == (False, "There is nothing to say yes to.")


def test_a_no_ends_the_echo(session: Watched) -> None:
    session.say(CUP)
    session.say("run")
    no = session.say("no")
    assert (no.confirmed, no.say) == (False, "All right, I won't start.")
    assert not session.say("yes").confirmed


@pytest.mark.parametrize("word", ["yes", "no"])
def test_a_bare_yes_or_no_says_so(session: Watched, word: str) -> None:
    session.say(CUP)
    answer = session.say(word)
    assert answer.interpretation.command == word
    assert answer.say == f"There is nothing to say {word} to."
    assert not answer.confirmed


@pytest.mark.parametrize("between", ["where is the tray?", "Go to the moon.", HOME, "undo"])
def test_whatever_is_said_between_takes_the_echo_back(session: Watched, between: str) -> None:
    session.say(CUP)
    session.say("run")
    session.say(between)
    assert not session.say("yes").confirmed


@pytest.mark.parametrize("change", ["edit", "undo"])
def test_a_yes_is_no_yes_to_a_program_that_was_changed_by_key_since(
    session: Watched, change: str
) -> None:
    session.say(CUP)
    session.say("run")
    if change == "edit":
        add(session, "(robot-at home)")
    else:
        session.undo()
    assert not session.say("yes").confirmed


def test_there_is_no_yes_to_a_program_that_cannot_run(session: Watched) -> None:
    assert "nothing I can run" in session.say("run").say
    assert not session.say("yes").confirmed


def test_there_is_no_yes_to_a_plan_that_is_not_there_yet(
    session: Watched, planner: Planner
) -> None:
    session.say(CUP)
    session.planner = gated = GatedPlanner(planner)
    add(session, "(robot-at home)")
    # The plan that the snapshot still has is the older program's.
    assert session.snapshot.plan is not None
    echo = session.say("run", wait_s=0)
    assert "Shall I start" not in echo.say
    assert not session.say("yes").confirmed
    gated.gate.set()
    assert session.say("run").say.endswith("Shall I start? Say yes or no.")
    assert session.say("yes").confirmed


def test_repeat_says_the_last_answer_again(session: Watched) -> None:
    assert session.say("repeat").say == "I haven't said anything yet."
    said = session.say(CUP).say
    assert session.say("say that again").say == said
    assert session.say("say that again").say == said


# Files


def test_every_change_is_saved_and_can_be_loaded_elsewhere(
    open_session: Open, tmp_path: Path
) -> None:
    path = tmp_path / "a.polaris.json"
    first = open_session(path)
    first.say(CUP)
    assert read_program(path) == first.program
    first.say(HOME)
    assert read_program(path) == first.program
    first.say("undo")
    assert read_program(path) == first.program
    second = open_session(path)
    loaded = second.say("load")
    assert loaded.snapshot.automaton == first.snapshot.automaton
    assert loaded.snapshot.planning == "planned"
    assert path.name in loaded.say
    assert second.say("undo").snapshot.automaton == Automaton()
    assert read_program(path).automaton == Automaton()


def test_loading_brings_back_what_is_in_the_file(open_session: Open, tmp_path: Path) -> None:
    path = tmp_path / "a.polaris.json"
    session = open_session(path)
    session.say(CUP)
    saved = path.read_text(encoding="utf-8")
    session.say("new")
    path.write_text(saved, encoding="utf-8")
    assert goals(session.say("load").snapshot.automaton) == [[TABLE]]


@pytest.mark.parametrize("text", [None, "{", '{"schema": "polaris-program/99"}'])
def test_a_file_that_cannot_be_loaded_is_refused_and_nothing_lost(
    open_session: Open, tmp_path: Path, text: str | None
) -> None:
    path = tmp_path / "a.polaris.json"
    session = open_session(path)
    session.say(CUP)
    before = session.snapshot
    path.unlink()
    if text is not None:
        path.write_text(text, encoding="utf-8")
    answer = session.say("load")
    assert answer.interpretation.outcome == "refused"
    assert str(path) in answer.say
    assert session.snapshot == before


def test_save_and_load_without_a_file_are_refused(session: Watched) -> None:
    for command in ("save", "load"):
        answer = session.say(command)
        assert answer.interpretation.outcome == "refused"
        assert answer.interpretation.command is None
        assert "--program" in answer.say


def test_a_file_that_cannot_be_written_is_reported_and_nothing_lost(
    open_session: Open, tmp_path: Path
) -> None:
    path = tmp_path / "gone" / "a.polaris.json"
    session = open_session(path)
    answer = session.say(CUP)
    assert answer.interpretation.outcome == "applied"
    assert goals(answer.snapshot.automaton) == [[TABLE]]
    assert answer.snapshot.planning == "planned"
    assert str(path) in answer.failure
    (failed,) = (e for e in session.events if isinstance(e, Failed))
    assert (failed.what, failed.text) == ("save", answer.failure)
    assert str(path) in add(session, "(robot-at home)")
    for command in ("undo", "redo", "new", "undo"):
        assert str(path) in session.say(command).failure, command
    refused = session.say("save")
    assert refused.interpretation.outcome == "refused"
    assert str(path) in refused.say
    path.parent.mkdir()
    assert session.say("save").interpretation.outcome == "command"
    assert read_program(path) == session.program
    assert goals(session.program.automaton) == [[TABLE], ["(robot-at home)"]]


# Subscribers and planning in the background


def test_subscribers_get_every_revision_first_planning_then_planned(session: Watched) -> None:
    for n, text in enumerate((TABLE, "(robot-at home)"), 1):
        add(session, text)
        session.until_told(n)
    session.undo()
    session.until_told(3)
    assert [(s.revision, s.planning) for s in session.told] == [
        (1, "planning"),
        (1, "planned"),
        (2, "planning"),
        (2, "planned"),
        (3, "planning"),
        (3, "planned"),
    ]
    # Until the new plan is there, the old one is shown.
    assert session.told[2].plan is session.told[1].plan


def test_a_subscription_ends(session: Watched) -> None:
    seen: list[Snapshot] = []
    end = session.subscribe(seen.append)
    add(session, TABLE)
    session.until_told(1)
    end()
    add(session, "(robot-at home)")
    session.until_told(2)
    assert {s.revision for s in seen} == {1}
    assert {s.revision for s in session.told} == {1, 2}


def test_an_older_plan_never_comes_after_a_newer_program(world: World) -> None:
    planned, go_on = threading.Event(), threading.Event()

    def slow_disk(event: Event) -> None:
        """Holds the planning thread between making a plan and telling it."""
        if isinstance(event, Planned) and event.revision == 1:
            planned.set()
            assert go_on.wait(LIMIT_S)

    told: list[tuple[int, str]] = []
    over = threading.Event()

    def hear(snapshot: Snapshot) -> None:
        told.append((snapshot.revision, snapshot.planning))
        if told[-1] == (2, "planned"):
            over.set()

    with Session(world, sink=slow_disk) as session:
        session.subscribe(hear)
        add(session, TABLE)
        assert planned.wait(LIMIT_S)
        add(session, "(robot-at home)")
        go_on.set()
        assert over.wait(LIMIT_S)
    first_told = [*dict.fromkeys(told)]
    assert first_told == [(1, "planning"), (1, "planned"), (2, "planning"), (2, "planned")]


def test_a_subscriber_may_edit_and_all_hear_it_in_order(session: Watched) -> None:
    def go_home_too(snapshot: Snapshot) -> None:
        if snapshot.revision == 1 and snapshot.planning == "planning":
            add(session, "(robot-at home)")

    last: list[tuple[int, str]] = []
    session.subscribe(go_home_too)
    session.subscribe(lambda s: last.append((s.revision, s.planning)))
    add(session, TABLE)
    session.until_told(2)
    session.close()
    assert last == sorted(last, key=lambda told: told[0])
    # A plan that takes longer is told in part, too, which is planning still.
    assert [n for n, planning in dict.fromkeys(last) if planning == "planning"] == [1, 2]
    assert last == [(s.revision, s.planning) for s in session.told]


def test_edits_quicker_than_planning_cancel_the_older_work(
    session: Watched, planner: Planner
) -> None:
    session.planner = gated = GatedPlanner(planner)
    add(session, TABLE)
    assert gated.entered.acquire(timeout=LIMIT_S)
    for text in ("(robot-at home)", "(robot-at hall)", "(at tray desk)"):
        add(session, text)
    gated.gate.set()
    last = session.until_told(4)
    # The first was stale when it was done; those between were never begun.
    assert gated.stale == [True, False]
    assert [len(a.checkpoints) for a in gated.asked] == [2, 5]
    assert last.planning == "planned"
    assert last.plan == planner.compile(last.automaton)
    assert [s.revision for s in session.told] == [1, 2, 3, 4, 4]
    assert [e.revision for e in session.events if isinstance(e, Planned)] == [4]


def test_a_plan_that_is_made_just_too_late_is_thrown_away(
    session: Watched, planner: Planner, monkeypatch: pytest.MonkeyPatch
) -> None:
    session.planner = gated = GatedPlanner(planner)
    # The edit falls between the planning thread's look at the time and its publishing.
    monkeypatch.setattr(session._replanner, "_stale", lambda revision: False)
    add(session, TABLE)
    assert gated.entered.acquire(timeout=LIMIT_S)
    add(session, "(robot-at home)")
    gated.gate.set()
    session.until_told(2)
    assert [(s.revision, s.planning) for s in session.told] == [
        (1, "planning"),
        (2, "planning"),
        (2, "planned"),
    ]
    assert [e.revision for e in session.events if isinstance(e, Planned)] == [2]


def test_the_final_plan_belongs_to_the_final_revision(session: Watched, planner: Planner) -> None:
    places = ("(robot-at hall)", "(at cup desk)", "(robot-at home)", "(open fridge)")
    for n in range(24):
        add(session, places[n % 4])
        if n % 5 == 4:
            session.undo()
    final = session.wait(LIMIT_S)
    session.until_told(final.revision)
    assert final.revision == 28
    assert final.planning == "planned"
    assert final.plan == planner.compile(final.automaton)
    revisions = [s.revision for s in session.told]
    assert revisions == sorted(revisions)
    assert set(revisions) == set(range(1, 29))
    for snapshot in session.told:
        if snapshot.planning == "planned":
            assert snapshot.plan == planner.compile(snapshot.automaton)


@pytest.mark.parametrize("error", [PlanningError("The planner is gone."), ValueError("no")])
def test_a_planner_that_fails_is_told_and_the_next_edit_is_planned(
    session: Watched, planner: Planner, error: Exception
) -> None:
    class Broken:
        def drafts(self, *_: object) -> None:
            raise error

    session.planner = Broken()
    answer = session.say(CUP)
    assert answer.snapshot.planning == "failed"
    assert str(error) in answer.snapshot.failure
    assert answer.snapshot.failure in answer.say
    assert [e.what for e in session.events if isinstance(e, Failed)] == ["planning"]
    assert answer_json(answer, session.program)["plan"]["status"] == "pending"
    assert answer.snapshot.failure in session.say("run").say
    assert not session.say("yes").confirmed
    session.planner = planner
    assert session.say(HOME).snapshot.planning == "planned"


# The JSON contract (DESIGN section 6)

TEXTS = {"type": "array", "items": {"type": "string"}}


def exactly(optional: tuple[str, ...] = (), **properties: Any) -> dict[str, Any]:
    return {
        "type": "object",
        "properties": properties,
        "required": [k for k in properties if k not in optional],
        "additionalProperties": False,
    }


TEXT = {"type": "string"}
LITERAL = {"type": "string", "pattern": r"^\((not \()?[a-z][a-z0-9-]*( [a-z][a-z0-9-]*)*\)?\)$"}
LITERALS = {"type": "array", "items": LITERAL}
COMMANDS = (
    "new", "undo", "redo", "run", "stop", "pause", "resume", "yes", "no", "help", "read-program",
    "read-plan", "status", "repeat", "quit", "save", "load",
)  # fmt: skip
CONTRACT = exactly(
    ("partial",),
    utterance=TEXT,
    outcome={"enum": ["applied", "question", "answer", "command", "refused"]},
    edits={"type": "array", "items": {"type": "object"}},
    say=TEXT,
    command={"enum": [None, *COMMANDS]},
    question={"anyOf": [{"type": "null"}, exactly(about=TEXT, options=TEXTS)]},
    refusal={"anyOf": [{"type": "null"}, exactly(reason=TEXT, unknown=TEXTS)]},
    program=exactly(
        schema={"const": "polaris-program/1"},
        domain={"const": "caregiving"},
        world={"const": "care-home"},
        checkpoints={"type": "array", "items": exactly(id=TEXT, name=TEXT, goals=LITERALS)},
        transitions={
            "type": "array",
            "items": exactly(id=TEXT, **{"from": TEXT, "to": TEXT, "when": LITERALS}),
        },
    ),
    plan=exactly(
        status={"enum": ["ok", "partial", "underspecified", "invalid", "pending"]},
        omitted=TEXTS,
        actions={"type": "integer", "minimum": 0},
    ),
    partial={"const": True},
    ms={"type": "integer", "minimum": 0},
)
UTTERANCES = {
    "Tell the resident that lunch is ready.": "applied",
    "Once she acknowledges, bring a full tray to her table and then go home.": "applied",
    "Go to the room.": "question",
    "the first": "applied",
    "where is the tray?": "answer",
    "Go to the moon.": "refused",
    "save": "refused",
    "undo": "command",
    "run": "command",
    "yes": "command",
    "yes please": "command",
    "status": "command",
    "help": "command",
    "quit": "command",
}


def test_the_answers_json_is_what_the_contract_says(session: Watched) -> None:
    outcomes = {}
    for utterance in UTTERANCES:
        answer = session.say(utterance)
        value = json.loads(json.dumps(answer_json(answer, session.program)))
        Draft202012Validator(CONTRACT).validate(value)
        assert value["utterance"] == utterance
        assert value["say"] == answer.say != ""
        outcomes[utterance] = value["outcome"]
        assert (value["command"] is not None) == (value["outcome"] == "command")
        assert (value["question"] is not None) == (value["outcome"] == "question")
        assert (value["refusal"] is not None) == (value["outcome"] == "refused")
        assert bool(value["edits"]) == (value["outcome"] == "applied")
        assert value["program"] == program_json(session.program)
    assert outcomes == UTTERANCES


def test_the_json_tells_the_plans_status(session: Watched) -> None:
    def plan(utterance: str) -> dict[str, Any]:
        value: dict[str, Any] = answer_json(session.say(utterance), session.program)["plan"]
        return value

    assert plan("status") == {"status": "ok", "omitted": [], "actions": 0}
    assert plan(CUP)["actions"] > 0
    add(session, "(acknowledged lunchtime)")
    partial = plan("status")
    assert (partial["status"], partial["omitted"]) == ("partial", ["c2"])
    session.undo()
    add(session, "(at home desk)")
    assert plan("status") == {"status": "invalid", "omitted": ["c2"], "actions": 0}


# The end


def children() -> set[str]:
    found: set[str] = set()
    for task in Path("/proc/self/task").iterdir():
        with suppress(FileNotFoundError):  # A thread that has just ended.
            found.update((task / "children").read_text().split())
    return found


def test_close_leaves_no_thread_and_no_process(world: World) -> None:
    threads, processes = set(threading.enumerate()), children()
    with Session(world) as session:
        add(session, TABLE)
        session.wait(LIMIT_S)
        assert set(threading.enumerate()) > threads
    assert set(threading.enumerate()) == threads
    assert children() == processes
    session.close()
    Session(world).close()


def test_an_edit_and_the_end_kill_the_search_that_is_under_way(
    world: World, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    endless = tmp_path / "search"
    endless.write_text("#!/bin/sh\nexec sleep 1000\n", encoding="utf-8")
    endless.chmod(0o755)
    started: queue.Queue[Any] = queue.Queue()

    class Child(subprocess.Popen[str]):
        def __init__(self, *args: Any, **kwargs: Any) -> None:
            super().__init__(*args, **kwargs)
            started.put(self)

    monkeypatch.setattr(search, "binary", lambda: endless)
    monkeypatch.setattr(search.subprocess, "Popen", Child)
    threads, processes = set(threading.enumerate()), children()
    with Session(world) as session:
        add(session, TABLE)
        first = started.get(timeout=LIMIT_S)
        assert first.poll() is None
        add(session, "(robot-at home)")
        second = started.get(timeout=LIMIT_S)
        assert first.returncode is not None
        assert second.poll() is None
        told: list[Snapshot] = []
        session.subscribe(told.append)
    assert second.returncode is not None
    assert told == []
    assert started.empty()
    assert set(threading.enumerate()) == threads
    assert children() == processes
