"""What makes sense, but hardly was said, is asked about: a wrong goal is worse than a question."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from polaris_nl.commands.transcribe import NOT_MEANT
from polaris_nl.commands.transcribe import take as transcribed
from polaris_nl.execution.events import Event, Heard
from polaris_nl.hands_free.conversation import Conversation, Reply
from polaris_nl.hands_free.weight import Sense, weight_of
from polaris_nl.language.interpretation import Interpretation
from polaris_nl.model.world_file import load_world
from polaris_nl.session import Session
from polaris_nl.speech.hearing import Utterance
from polaris_nl.speech.weight import Weight

MISHEARD = "silver tray and put it on the dining table"


@pytest.fixture
def session() -> Iterator[Session]:
    with Session(load_world("care-home")) as session:
        yield session


def take(conversation: Conversation, text: str, accepted: bool) -> Reply:
    said = Utterance(text, accepted, why_not="" if accepted else "not understood")
    heard = Heard(time=0.0, utterance=text, source="voice")
    return conversation.take(said, heard, True, lambda: [])


@pytest.mark.parametrize(
    ("text", "weight"),
    [
        (MISHEARD, None),
        ("like i go to the laundry room and open the basket", None),
        ("put the tray on the dining table", Weight.CHANGING),
        ("fill the tray and put it on the dining table", Weight.CHANGING),
        ("go to the laundry room and open the basket", Weight.CHANGING),
    ],
)
def test_words_that_ask_for_nothing_themselves_are_no_command(
    session: Session, text: str, weight: Weight | None
) -> None:
    assert session.understood(text).outcome == "applied"
    assert weight_of(session.understood(text)) is weight


def test_what_is_doubtful_is_asked_about_and_done_after_a_yes(session: Session) -> None:
    logged: list[Event] = []
    conversation = Conversation(session, logged.append)
    empty = session.snapshot.automaton
    reply = take(conversation, MISHEARD, accepted=False)
    assert reply.text == f"Did you mean: {MISHEARD}? Say yes or no."
    assert session.snapshot.automaton == empty
    assert [e.utterance for e in logged if isinstance(e, Heard)] == [MISHEARD]
    assert take(conversation, "yes", accepted=True).text.startswith("Bring the tray")
    assert session.snapshot.automaton != empty


def test_a_no_leaves_all_as_it_is(session: Session) -> None:
    conversation = Conversation(session)
    empty = session.snapshot.automaton
    take(conversation, MISHEARD, accepted=False)
    assert take(conversation, "no", accepted=True).text == "All right. Say it in other words."
    assert session.snapshot.automaton == empty


def test_another_sentence_is_taken_instead_of_an_answer(session: Session) -> None:
    conversation = Conversation(session)
    take(conversation, MISHEARD, accepted=False)
    take(conversation, "go to the kitchen", accepted=True)
    (goal,) = [g for c in session.snapshot.automaton.checkpoints.values() for g in c.goals]
    assert str(goal) == "(robot-at kitchen)"


def test_a_recording_that_is_doubtful_changes_nothing(session: Session) -> None:
    empty = session.snapshot.automaton
    _, answer = transcribed(Utterance(MISHEARD, False), "order.wav", session)
    assert answer.say == NOT_MEANT
    assert session.snapshot.automaton == empty
    _, answer = transcribed(Utterance("paint the elephant", False), "order.wav", session)
    assert "elephant" in answer.say
    transcribed(Utterance("go to the kitchen", True), "order.wav", session)
    assert session.snapshot.automaton != empty


def test_another_sentence_is_no_answer_though_it_may_have_sounded_like_one(
    session: Session,
) -> None:
    conversation = Conversation(session)
    take(conversation, MISHEARD, accepted=False)
    said = Utterance("go home", True, alternatives=("go home", "no"))
    heard = Heard(time=0.0, utterance="go home", source="voice")
    conversation.take(said, heard, True, lambda: [])
    (goal,) = [g for c in session.snapshot.automaton.checkpoints.values() for g in c.goals]
    assert str(goal) == "(robot-at home)"
    # What isn't accepted as anything else may be an answer by its next readings.
    take(conversation, MISHEARD, accepted=False)
    unsure = Utterance("i no", False, alternatives=("i no", "no"), why_not="not understood")
    reply = conversation.take(unsure, heard, True, lambda: [])
    assert reply.text == "All right. Say it in other words."


def test_of_two_readings_that_are_as_likely_the_user_chooses(session: Session) -> None:
    conversation = Conversation(session)
    empty = session.snapshot.automaton
    readings = ("put the cup on the desk", "put the tray on the desk")
    said = Utterance(readings[0], False, why_not="another reading is as likely", doubts=readings)
    heard = Heard(time=0.0, utterance=said.text, source="voice")
    reply = conversation.take(said, heard, called=False, near=lambda: [])
    assert reply.text == (
        "Did you mean one: put the cup on the desk; or two: put the tray on the desk? Say the number,"
        " or none."
    )
    assert session.snapshot.automaton == empty
    assert take(conversation, "the second one", accepted=True).text.startswith("Bring the tray")


def test_what_is_doubtful_is_understood_once_and_alike_where_it_does_the_same(
    session: Session, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[str] = []
    real = session.understood

    def understood(text: str) -> Interpretation:
        asked.append(text)
        return real(text)

    monkeypatch.setattr(session, "understood", understood)
    sense = Sense(session)
    assert sense.weigh("put the cup on the desk") is Weight.CHANGING
    assert sense.means("put the cup on the desk") == sense.means("place the cup on the desk")
    assert sense.means("put the cup on the desk") != sense.means("put the tray on the desk")
    assert sense.means("where is the cup") != sense.means("where is the tray")
    assert len(asked) == len(set(asked)) == 5


def test_a_recording_that_is_doubtful_changes_nothing_and_says_what_it_may_be(
    session: Session,
) -> None:
    empty = session.snapshot.automaton
    readings = ("put the cup on the desk", "put the tray on the desk")
    said = Utterance(readings[0], False, why_not="another reading is as likely", doubts=readings)
    _, answer = transcribed(said, "order.wav", session)
    assert answer.say == (
        "I may have misheard, so I left it alone."
        ' Say it again if it was "put the cup on the desk" or "put the tray on the desk".'
    )
    assert session.snapshot.automaton == empty


@pytest.mark.parametrize("yes", ["yes", "sure", "yeah please"])
def test_a_yes_to_several_readings_starts_no_run_that_was_asked_about_before(
    session: Session, yes: str
) -> None:
    conversation = Conversation(session)
    take(conversation, "go to the kitchen", accepted=True)
    take(conversation, "run it", accepted=True)
    assert session.awaits_yes
    readings = ("put the cup on the desk", "put the tray on the desk")
    said = Utterance(readings[0], False, why_not="another reading is as likely", doubts=readings)
    heard = Heard(time=0.0, utterance=said.text, source="voice")
    conversation.take(said, heard, called=False, near=lambda: [])
    reply = take(conversation, yes, accepted=True)
    assert not reply.starts
    assert reply.text == (
        "Which one? Did you mean one: put the cup on the desk; or two: put the tray on the desk? Say"
        " the number, or none."
    )
    assert take(conversation, "two", accepted=True).text.startswith("Bring the tray")


@pytest.mark.parametrize(
    ("answer", "done"), [("sure", True), ("that's right", True), ("no not that", False)]
)
def test_any_way_to_agree_or_not_is_an_answer(session: Session, answer: str, done: bool) -> None:
    conversation = Conversation(session)
    empty = session.snapshot.automaton
    take(conversation, MISHEARD, accepted=False)
    take(conversation, answer, accepted=True)
    assert (session.snapshot.automaton != empty) is done
