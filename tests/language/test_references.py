"""Which checkpoints are meant: by name, number, recency and description."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from polaris_nl.session import Session

from .dialogues_reader import world_of

STEPS = (
    "Tell the resident that lunch is ready.",
    "Tell Mr Brown that bingo is starting.",
    "Open the fridge.",
    "Give the newspaper to Mr Brown.",
    "Go home.",
)


@pytest.fixture
def session() -> Iterator[Session]:
    with Session(world_of("care-home")) as made:
        for step in STEPS:
            assert made.say(step, wait_s=0).interpretation.outcome == "applied"
        yield made


def names(session: Session) -> list[str]:
    return [c.name for c in session.snapshot.automaton.checkpoints.values()][1:]


@pytest.mark.parametrize(
    ("words", "gone"),
    [
        ("opened", "opened"),
        ("the opened step", "opened"),
        ("alerted 2", "alerted 2"),
        ("the first step", "alerted"),
        ("step three", "opened"),
        ("the last but one step", "handed over"),
        ("the step before last", "handed over"),
        ("the last one", "home"),
        ("the step before opened", "alerted 2"),
        ("the step after opened", "handed over"),
        ("the part where you open the fridge", "opened"),
        ("the step where you go home", "home"),
        ("the part with the newspaper", "handed over"),
        ("the newspaper step", "handed over"),
        ("the handover", "handed over"),
        ("the trip home", "home"),
        ("going home", "home"),
        ("the second alert", "alerted 2"),
        ("the alert about bingo", "alerted 2"),
        ("the one where you tell the gentleman", "alerted 2"),
    ],
)
def test_a_step_is_meant(session: Session, words: str, gone: str) -> None:
    before = names(session)
    answer = session.say(f"Skip {words}.", wait_s=0)
    assert answer.interpretation.outcome == "applied", answer.say
    assert set(before) - set(names(session)) == {gone}


@pytest.mark.parametrize(
    ("answer", "gone"),
    [
        ("the second one", "alerted 2"),
        ("2", "alerted 2"),
        ("alerted", "alerted"),
        ("the one where you tell Mr Brown", "alerted 2"),
        ("I meant the first", "alerted"),
    ],
)
def test_several_that_fit_are_asked_about(session: Session, answer: str, gone: str) -> None:
    before = names(session)
    asked = session.say("Remove the alert.", wait_s=0).interpretation
    assert asked.question is not None
    assert asked.question.options == ("alerted", "alerted 2")
    assert session.say(answer, wait_s=0).interpretation.outcome == "applied"
    assert set(before) - set(names(session)) == {gone}


def test_neither_leaves_all_and_another_sentence_drops_the_question(session: Session) -> None:
    before = session.snapshot.automaton
    session.say("Remove the alert.", wait_s=0)
    assert session.say("Neither.", wait_s=0).interpretation.outcome == "answer"
    assert session.snapshot.automaton == before
    session.say("Remove the alert.", wait_s=0)
    session.say("Go to the kitchen.", wait_s=0)
    assert session.say("The second one.", wait_s=0).interpretation.outcome == "refused"
    assert len(session.snapshot.automaton.checkpoints) == len(before.checkpoints) + 1


def test_a_branch_is_meant_by_its_condition() -> None:
    with Session(world_of("care-home")) as session:
        for sentence in (
            "Tell the resident that lunch is ready.",
            "If she acknowledges, bring the tray to her table.",
            "If she dismisses it, go to the office.",
            "Otherwise go home.",
        ):
            session.say(sentence, wait_s=0)
        session.say("Remove the part where she dismisses it.", wait_s=0)
        assert names(session) == ["alerted", "fetched", "home"]
        session.say("Remove the else branch.", wait_s=0)
        assert names(session) == ["alerted", "fetched"]


@pytest.mark.parametrize(
    ("said", "why"),
    [
        ("Remove start.", "can't be removed"),
        ("Rename the start to begin.", "can't be renamed"),
        ("Remove the party.", "no step"),
        ("Change the tray to the cup.", "in no step"),
    ],
)
def test_what_is_not_there_is_refused_with_a_reason(session: Session, said: str, why: str) -> None:
    before = session.snapshot.automaton
    answer = session.say(said, wait_s=0)
    assert answer.interpretation.outcome == "refused"
    assert why in answer.say
    assert session.snapshot.automaton == before
