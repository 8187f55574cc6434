"""`tui`: the terminal application, imported only here."""

from __future__ import annotations

import sys
from argparse import Namespace

from polaris_nl.commands.common import session_of
from polaris_nl.model.errors import UsageError


def run(arguments: Namespace) -> int:
    """Opens the terminal application on a program."""
    if arguments.json:
        raise UsageError(
            "The terminal application prints no JSON; use dialogue --json for other programs."
        )
    if not all(stream.isatty() for stream in (sys.stdin, sys.stdout, sys.stderr)):
        raise UsageError(
            "The terminal application needs a terminal; elsewhere use: polaris-nl dialogue"
        )
    if arguments.program is None and arguments.world is None:
        arguments.world = "care-home"
    from polaris_tui.app import PolarisApp

    with session_of(arguments) as session:
        code = PolarisApp(session).run(mouse=False)  # the terminal keeps its own way to copy
    return int(code or 0)
