"""Starts the application: settings, the file that keeps a program without a name, screen or lines."""

from __future__ import annotations

import sys
from pathlib import Path

from polaris_nl.session import Session
from polaris_tui.keeping import keeping_path, leftovers, tidied
from polaris_tui.settings import read_settings, settings_path


def start(session: Session, *, log: Path | None = None, plain: bool = False) -> int:
    """Runs the application until the user quits; returns the exit code.

    Args:
        session: program, language and planner; it belongs to the caller.
        log: a log to be opened at once.
        plain: line by line instead of on the whole screen.

    Raises:
        FormatError: the settings aren't as they should be.
    """
    settings = read_settings()
    kept = session.path is None
    if kept:
        session.path = keeping_path(session.world.name)
    kept_at = session.path
    left = leftovers(session.world.name)
    try:
        from polaris_tui.app import PolarisApp

        app = PolarisApp(
            session,
            settings,
            kept=kept and kept_at is not None,
            leftovers=left,
            log=log,
            settings_file=str(settings_path()),
        )
        code = app.run(mouse=settings.mouse)
    finally:
        if kept and kept_at is not None and tidied(kept_at) and session.path == kept_at:
            sys.stdout.write(f"The program is kept. Go on with: polaris-nl tui {kept_at}\n")
    return int(code or 0)
