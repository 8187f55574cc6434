"""`dialogue`: one utterance a line."""

from __future__ import annotations

import sys
from argparse import Namespace
from collections.abc import Iterator

from polaris_nl.commands.common import (
    complain,
    print_json,
    print_rows,
    print_text,
    width,
)
from polaris_nl.commands.session_log import logged_session
from polaris_nl.language.tokens import LONGEST
from polaris_nl.render.glyphs import glyphs_for
from polaris_nl.render.program import program_rows
from polaris_nl.session import Session
from polaris_nl.snapshot import answer_json

PROMPT = "> "


def run(arguments: Namespace) -> int:
    """Answers each line at once, until the end of the input or "quit"; 1 where something couldn't be saved."""
    code = 0
    talking = sys.stdin.isatty() and not arguments.json
    with logged_session(arguments) as (session, _):
        if talking:
            print_text(
                f'World: {session.world.name}. Say what the robot should achieve; "help" tells more, '
                '"quit" ends.'
            )
        for line in lines(talking):
            answer = session.say(line)
            if arguments.json:
                print_json(answer_json(answer, session.program))
            else:
                print_text(answer.say)
                if answer.interpretation.edits and talking:
                    _outline(session)
            if answer.confirmed and not arguments.json:
                print_text(
                    "A dialogue moves nothing. Carry the program out with: polaris-nl run FILE"
                )
            if answer.failure:
                complain(answer.failure)
                code = 1
            if answer.interpretation.command == "quit" and talking:
                break
    return code


def lines(talking: bool) -> Iterator[str]:
    """The lines of the standard input that aren't blank; endless ones are cut."""
    for line in _typed() if talking else _piped():
        if line.strip():
            yield line


def _typed() -> Iterator[str]:
    import readline  # noqa: F401 - makes `input` a line editor with a history

    while True:
        try:
            yield input(PROMPT)
        except EOFError:
            print()
            return


def _piped() -> Iterator[str]:
    while line := sys.stdin.readline(LONGEST + 2):
        rest = line
        while rest and not rest.endswith("\n"):
            rest = sys.stdin.readline(1 << 20)
        yield line.rstrip("\r\n")


def _outline(session: Session) -> None:
    snapshot = session.snapshot
    print_rows(
        program_rows(snapshot.automaton, snapshot.plan, session.wording, glyphs_for(), width())
    )
