"""`say`: one utterance."""

from __future__ import annotations

import sys
from argparse import Namespace

from polaris_nl.commands.common import complain, print_json, print_text, session_of
from polaris_nl.language.tokens import LONGEST
from polaris_nl.snapshot import Answer, answer_json


def run(arguments: Namespace) -> int:
    """Interprets one utterance; 1 where it is refused or the program couldn't be saved."""
    utterance = arguments.utterance
    if utterance == "-":
        utterance = sys.stdin.read(LONGEST + 1)
    with session_of(arguments) as session:
        answer = session.say(utterance)
        show(answer, arguments.json and answer_json(answer, session.program))
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
