"""`say`: one utterance."""

from __future__ import annotations

import sys
from argparse import Namespace

from polaris_nl.commands.common import complain, print_json, print_text
from polaris_nl.commands.session_log import logged_session
from polaris_nl.language.tokens import LONGEST
from polaris_nl.snapshot import Answer, answer_json


def run(arguments: Namespace) -> int:
    """Interprets one utterance; 1 where it is refused or the program couldn't be saved."""
    utterance = arguments.utterance
    if utterance == "-":
        utterance = sys.stdin.read(LONGEST + 1)
    with logged_session(arguments) as (session, _):
        answer = session.say(utterance)
        value = answer_json(answer, session.program) if arguments.json else None
        if value is not None and arguments.explain:
            value["readings"] = [
                {"text": r.text, "cost": round(-r.score, 2), "parts": list(r.why)}
                for r in answer.interpretation.readings
            ]
        show(answer, value)
        if arguments.explain and not arguments.json:
            explain(answer)
    if answer.failure:
        complain(answer.failure)
    return 1 if answer.failure or answer.interpretation.outcome == "refused" else 0


def show(answer: Answer, value: object) -> None:
    """Prints an answer: as JSON where there is a value, as text otherwise; refusals as errors."""
    if value:
        print_json(value)
    elif answer.interpretation.outcome == "refused":
        complain(answer.say)
    else:
        print_text(answer.say)


def explain(answer: Answer) -> None:
    """Prints the readings that were found, the one that won first, and what each takes the words for."""
    readings = answer.interpretation.readings
    if not readings:
        print_text("It was taken for a command, a question or an edit, or for nothing that I know.")
    for number, reading in enumerate(readings):
        lead = "Taken" if number == 0 else "Not taken"
        print_text(f"{lead}, at a cost of {-reading.score:.2f}: {reading.text}")
        print_text("   " + " | ".join(reading.why))
