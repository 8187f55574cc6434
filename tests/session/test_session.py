"""The session: utterances and edits in, snapshots, answers and events out."""

from __future__ import annotations

import json

import pytest

from polaris_nl.automaton.automaton import Automaton
from polaris_nl.automaton.edits import RenameCheckpoint
from polaris_nl.automaton.program import program_json
from polaris_nl.execution.events import (
    Edited,
    Heard,
    Interpreted,
    Planned,
    Understood,
)
from polaris_nl.model.errors import EditError
from polaris_nl.planning.planner import Planner
from polaris_nl.snapshot import answer_json
from tests.session.conftest import (
    CUP,
    HOME,
    LIMIT_S,
    TABLE,
    GatedPlanner,
    Watched,
    add,
    goals,
)

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


def test_what_a_refusal_offers_is_done_after_a_yes_and_only_then(session: Watched) -> None:
    answer = session.say("do the hoovering would you and open the fridge")
    assert answer.interpretation.outcome == "refused"
    assert answer.say == 'I don\'t understand "hoovering". Did you mean only "open the fridge"?'
    assert session.understood("yes").outcome == "applied"
    assert len(session.snapshot.automaton.checkpoints) == 1
    assert session.say("yes").interpretation.outcome == "applied"
    assert len(session.snapshot.automaton.checkpoints) == 2


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
