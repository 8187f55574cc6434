"""Starts the application: settings, the file that keeps a program without a name, screen or lines."""

from __future__ import annotations

import sys
from pathlib import Path

from polaris_nl.session import Session
from polaris_tui.keeping import keeping_path, leftovers, tidied
from polaris_tui.settings import Settings, read_settings, settings_path


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
        if plain:
            return _lines(session, settings, log)
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


def _lines(session: Session, settings: Settings, log: Path | None) -> int:
    """The line mode."""
    from polaris_nl.commands.common import width
    from polaris_nl.model.wording import PlainWording
    from polaris_tui.plain import Plain, typed_lines
    from polaris_tui.progress import Progress
    from polaris_tui.scene import Scene

    scene = Scene(
        session.world,
        session.path.name if session.path else "(no file)",
        session.snapshot,
        PlainWording(session.world),
        Progress(session.world.initial),
        settings.glyphs_for_terminal(),
        settings.keymap,
    )
    talk = Plain(session, lambda line: print(line, flush=True), scene, width())
    if log is not None:
        talk.open_log(log)
    talk.work(typed_lines())
    return 0
