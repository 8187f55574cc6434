"""`tui`: the terminal application, imported only here."""

from __future__ import annotations

import sys
from argparse import Namespace
from pathlib import Path

from polaris_nl.commands.common import session_of
from polaris_nl.execution.ros.profile import profile_for
from polaris_nl.model.errors import UsageError

WORLD = "world"


def run(arguments: Namespace) -> int:
    """Opens the terminal application on a program, or on the log of a run."""
    if arguments.json:
        raise UsageError(
            "The terminal application prints no JSON; use dialogue --json for other programs."
        )
    if not arguments.plain and not all(
        stream.isatty() for stream in (sys.stdin, sys.stdout, sys.stderr)
    ):
        raise UsageError(
            "The terminal application needs a terminal; elsewhere use: polaris-nl dialogue"
        )
    profile = None if arguments.robot == WORLD else profile_for(arguments.robot)
    mic = None
    if arguments.mic is not None:
        if arguments.plain:
            raise UsageError("Line by line nothing listens; polaris-nl listen takes speech.")
        from polaris_nl.speech.sources import source_for

        mic = source_for(arguments.mic, arguments.allow_remote)
    log: Path | None = None
    if arguments.program is not None and arguments.program.suffix == ".mcap":
        log, arguments.program = arguments.program, None
    if arguments.program is None and arguments.world is None:
        arguments.world = "care-home"
    from polaris_tui.start import start

    with session_of(arguments) as session:
        return start(
            session,
            log=log,
            plain=arguments.plain,
            profile=profile,
            mic=mic,
            mode=arguments.mode,
        )
