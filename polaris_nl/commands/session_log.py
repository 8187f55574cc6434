"""The log of a session, for the commands that hold one: what was heard, understood, changed and planned."""

from __future__ import annotations

from argparse import Namespace
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from polaris_nl.commands.common import complain, session_of

if TYPE_CHECKING:  # Loaded where a log is asked for.
    from polaris_nl.execution.events import Event
    from polaris_nl.logs.writer import LogWriter
    from polaris_nl.session import Session


@contextmanager
def logged_session(arguments: Namespace) -> Iterator[tuple[Session, LogWriter | None]]:
    """The session of a command, and its log where one is asked for (`--log`, `--leave-out`).

    Raises:
        PolarisError: world or program can't be read, or the log can't be made.
    """
    with session_of(arguments) as session:
        path: Path | None = arguments.log
        if path is None:
            yield session, None
            return
        from polaris_nl.logs.privacy import privacy_of
        from polaris_nl.logs.writer import LogSettings, LogWriter
        from polaris_nl.run_logs import session_attachments

        settings = LogSettings(privacy=privacy_of(arguments.leave_out))
        with LogWriter(path, session_attachments(session.program, session.world), settings) as log:

            def sink(event: Event) -> None:
                log.write(event)  # A log says itself what it could not keep.

            session.report_to(sink)
            yield session, log
            session.wait()
        for text in (log.failure, log.lost):
            if text:
                complain(text)
