"""Starts the application: settings, the file that keeps a program without a name, screen or lines."""

from __future__ import annotations

import contextlib
import os
import signal
import sys
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from polaris_nl.execution.ros.profile import Profile
from polaris_nl.model.errors import PolarisError
from polaris_nl.session import Session
from polaris_tui.keeping import keeping_path, leftovers, state_folder, tidied
from polaris_tui.lines import Places
from polaris_tui.messages import HungUp
from polaris_tui.remote import live_runs, runs_folder
from polaris_tui.settings import Settings, read_settings, settings_path
from polaris_tui.talking import Talking
from polaris_tui.terminal import alone_on_the_terminal

if TYPE_CHECKING:
    from polaris_nl.speech.modes import Mode
    from polaris_nl.speech.sources import Source
    from polaris_tui.app import PolarisApp

SWITCH_S = 0.001
"""How long planning may keep the interpreter from a key that was pressed; Python's own is five times that."""

MESSAGES = "messages.txt"
"""What libraries write to the error output meanwhile, in the state folder."""


def start(
    session: Session,
    *,
    log: Path | None = None,
    plain: bool = False,
    profile: Profile | None = None,
    mic: Source | None = None,
    mode: Mode = "talk",
) -> int:
    """Runs the application until the user quits; returns the exit code.

    Args:
        session: program, language and planner; it belongs to the caller.
        log: a log to be opened at once.
        plain: line by line instead of on the whole screen.
        profile: the robot that runs move; None for the simulated world.
        mic: where speech comes from; None for this machine's microphone, once it is asked for.
        mode: when speech is meant for the robot.

    Raises:
        FormatError: the settings aren't as they should be.
    """
    sys.setswitchinterval(SWITCH_S)
    settings = read_settings()
    kept = session.path is None
    if kept:
        session.path = keeping_path(session.world.name)
    kept_at = session.path
    left = leftovers(session.world.name)
    try:
        if plain:
            places = Places(tuple(left), tuple(_of_world(session.world.name)), runs_folder())
            return _lines(session, settings, log, profile, places)
        from polaris_tui.app import PolarisApp

        with alone_on_the_terminal(state_folder() / MESSAGES):
            app = PolarisApp(
                session,
                settings,
                logs=settings.logs_folder,
                kept=kept and kept_at is not None,
                leftovers=left,
                log=log,
                listens_at=runs_folder(),
                profile=profile,
                talk=partial(Talking, mic, mode),
                elsewhere=_of_world(session.world.name),
                settings_file=str(settings_path()),
            )
            code = _on_the_screen(app, settings.mouse)
    finally:
        if kept and kept_at is not None and tidied(kept_at) and session.path == kept_at:
            sys.stdout.write(f"The program is kept. Go on with: polaris-nl tui {kept_at}\n")
    return int(code or 0)


def _of_world(world: str) -> list[Path]:
    """Where runs of a world listen."""
    from polaris_tui.remote import RemoteRun

    found = []
    for path in live_runs():
        with contextlib.suppress(PolarisError):
            run = RemoteRun(path, lambda message: None)
            run.leave()
            if run.world == world:
                found.append(path)
    return found


def _on_the_screen(app: PolarisApp, mouse: bool) -> int | None:
    """Runs the application; where the terminal goes away, a run goes on until its end."""

    def hung_up(*_: object) -> None:
        _let_go()
        app.tell(HungUp())

    signal.signal(signal.SIGHUP, hung_up)
    code: int | None = 1
    try:
        code = app.run(mouse=mouse)
    except OSError:
        if sys.__stdin__ is not None and sys.__stdin__.isatty():
            raise
    if app.state.hung_up:
        _let_go()
        if app.state.current is not None and app.state.current.ours:
            app.state.current.wait(None)
    return code


def _let_go() -> None:
    """Takes nothing from the terminal that is gone, and gives it nothing: both would fail."""
    nothing = os.open(os.devnull, os.O_RDWR)
    screen = sys.__stderr__.fileno() if sys.__stderr__ is not None else 2
    for stream in (0, 1, 2, screen):
        os.dup2(nothing, stream)
    os.close(nothing)


def _lines(
    session: Session,
    settings: Settings,
    log: Path | None,
    profile: Profile | None,
    places: Places,
) -> int:
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
    talk = Plain(
        session,
        printed,
        scene,
        width(),
        logs=settings.logs_folder,
        profile=profile,
        places=places,
    )

    def hung_up(*_: object) -> None:
        talk.hung_up = True
        _let_go()  # Then there are no more lines to be read.

    signal.signal(signal.SIGHUP, hung_up)
    if log is not None:
        talk.open_log(log)
    talk.work(typed_lines())
    return 0


def printed(line: str) -> None:
    """Prints a line, or not: a terminal may be gone before its signal comes, and no run ends for that."""
    with contextlib.suppress(OSError):
        print(line, flush=True)
