"""Questions that hold the plan against another one, asked as a person would ask them.

The answers are golden files; what they promise and claim is tried out.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

import pytest

from polaris_nl.answers.contrast import never_in_words
from polaris_nl.automaton.automaton import Automaton
from polaris_nl.execution.settings import RunSettings
from polaris_nl.model.world_file import load_world
from polaris_nl.planning.result import BranchingPlan
from polaris_nl.session import Session
from tests.golden.files import check_golden

PROGRAMS = {
    "care-home": (
        "Tell the resident that lunch is ready. Once she acknowledges, bring a full tray to her table "
        "and then go home. If she dismisses it, just go to the office."
    ),
    "dinner-party": (
        "Put the cup and the plate on the countertop. Once they are on the drying rack, open the "
        "cupboard and put the cup and the plate in the cupboard."
    ),
}
ONCE = "Tell the resident that lunch is ready. Once she acknowledges, go home."
QUESTIONS = {
    "care-home": (
        "Why do you go to the cafeteria first?",
        "Why do you pick up the tray?",
        "Why do you go to her room?",
        "Why are you going home?",
        "Why don't you go to the cafeteria first?",
        "Why don't you start by going to the hall?",
        "Why don't you fill the tray before you tell the resident?",
        "Why do you go to the cafeteria before you go to her room?",
        "Why do you pick up the tray before you fill it?",
        "Why not take the cup before the plate?",
        "Why do you go to the cafeteria instead of the kitchen?",
        "Why don't you put the tray on the desk instead of her table?",
        "What if she never acknowledges?",
        "What if nobody answers?",
        "What if the cup is never on the desk?",
    ),
    "dinner-party": (
        "Why do you open the cupboard?",
        "Why do you take the cup?",
        "Why don't you open the cupboard first?",
        "Why do you take the cup before the plate?",
        "Why don't you take the plate before you open the cupboard?",
        "Why do you open the cupboard before putting the cup in it?",
        "Why do you take the cup before you open the cupboard?",
        "Why don't you put the plate on the countertop first?",
        "Why don't you wash the cup first?",
        "Why not put the plate on the sideboard instead of on the countertop?",
        "What if the host never puts them on the drying rack?",
        "What if nobody answers?",
    ),
}
SOLVER_WORDS = re.compile(
    r"\b(pddl|solver|planner|search|heuristic|mutex|unsolvable|literal|predicate|operator|segment|foil|"
    r"precondition|effect|None)\b|[(](not|and|at|in|holding|open|robot-at|move|pick|place)\b|_",
    re.IGNORECASE,
)


def opened(world: str, *said: str) -> Session:
    session = Session(load_world(world))
    for utterance in said or (PROGRAMS[world],):
        assert session.say(utterance).interpretation.outcome == "applied", utterance
    return session


@pytest.mark.parametrize("world", PROGRAMS)
def test_answers_read_as_a_person_would_say_them(world: str) -> None:
    with opened(world) as session:
        program = session.snapshot.automaton
        lines = []
        for question in QUESTIONS[world]:
            answer = session.say(question)
            assert answer.interpretation.outcome == "answer", question
            assert not SOLVER_WORDS.search(answer.say), answer.say
            lines += [f"> {question}", f"  {answer.say}", ""]
        assert session.snapshot.automaton == program  # Asking changes nothing.
    check_golden(f"answers/why-{world}.txt", "\n".join(lines[:-1]))


def quoted(text: str) -> Iterator[str]:
    yield from re.findall(r'say "([^"]+)"', text)


@pytest.mark.parametrize(
    ("question", "first", "then"),
    [
        ("why don't you take the plate before the cup", "(pick plate", "(pick cup"),
        ("why don't you put the plate on the countertop first", "(place plate", "(pick cup"),
    ],
)
def test_what_is_offered_to_say_has_it_so(question: str, first: str, then: str) -> None:
    with opened("dinner-party") as session:
        before = session.wait().plan
        (offer,) = quoted(session.say(question).say)
        answer = session.say(offer)
        assert answer.interpretation.outcome == "applied", answer.say
        after = session.wait().plan
        assert before is not None
        assert after is not None
        assert after.action_count == before.action_count
        actions = [str(a) for s in after.segments.values() for a in s.actions]
        order = [next(n for n, a in enumerate(actions) if a.startswith(x)) for x in (first, then)]
        assert order == sorted(order)


def test_the_price_that_is_named_is_the_price_that_is_paid() -> None:
    with opened("care-home", "Go to the cafeteria.", "Go to the kitchen.") as session:
        before = session.wait().plan
        answer = session.say("Why don't you go to the laundry first?").say
        assert "it would take 2 more actions" in answer
        session.say("Before anything else, go to the laundry.")
        after = session.wait().plan
        assert before is not None
        assert after is not None
        assert after.action_count - before.action_count == 2


@pytest.mark.parametrize(
    ("program", "expected"),
    [
        (
            ONCE,
            "I wait for 10 minutes. Then I stop where I am",
        ),
        (
            f"{ONCE} If she dismisses it, go to the office.",
            "I wait for 10 minutes, in case lunch is dismissed.",
        ),
        (
            f"{ONCE} Otherwise go to the office.",
            "I don't wait: unless lunch is acknowledged by then, I go to the hall and go to the "
            "caregiver's office at once.",
        ),
        (
            "Tell the resident that lunch is ready. Then go home.",
            "That changes nothing: the program doesn't wait until lunch is acknowledged.",
        ),
    ],
)  # fmt: skip
def test_what_if_she_never_acknowledges(program: str, expected: str) -> None:
    with opened("care-home", program) as session:
        assert expected in session.say("What if she never acknowledges?").say


def test_the_way_out_of_waiting_works() -> None:
    with opened("care-home", ONCE) as session:
        assert 'Say "otherwise"' in session.say("What if nobody answers?").say
        session.say("Otherwise go to the office.")
        assert "I don't wait" in session.say("What if nobody answers?").say


@pytest.mark.parametrize(
    ("wait_s", "expected"),
    [
        (
            None,
            "I wait for as long as it takes, until lunch is acknowledged or lunch is dismissed.",
        ),
        (60.0, "I wait for one minute."),
        (90.0, "I wait for 90 seconds."),
        (RunSettings().wait_s, "I wait for 10 minutes."),
    ],
)
def test_the_patience_is_that_of_the_run(wait_s: float | None, expected: str) -> None:
    with opened("care-home") as session:
        plan: BranchingPlan | None = session.wait().plan
        automaton: Automaton = session.snapshot.automaton
        assert plan is not None
        assert expected in never_in_words((), automaton, plan, session.wording, wait_s)


def test_there_is_an_answer_before_there_is_a_plan() -> None:
    with Session(load_world("care-home")) as session:
        assert "no plan yet" in session.say("What if nobody answers?").say
        assert "no plan yet" in session.say("Why don't you go to the cafeteria first?").say
