"""Between a run and its log: what is kept beside the events, and what follows when the disk is full."""

from __future__ import annotations

import hashlib
import platform
from collections.abc import Iterable, Mapping
from dataclasses import asdict, replace
from importlib import metadata
from pathlib import Path

from polaris_nl import __version__
from polaris_nl.automaton.program import Program, program_json
from polaris_nl.execution.backend import Health, Observation, Robot
from polaris_nl.execution.events import Edited, Event
from polaris_nl.execution.settings import RunSettings
from polaris_nl.language.generate import read_back
from polaris_nl.language.grammar import grammar_folder, grammar_path
from polaris_nl.language.wording import GrammarWording
from polaris_nl.logs.keeping import PROGRAM_TEXT
from polaris_nl.logs.reader import read_log
from polaris_nl.logs.writer import LogWriter, attachments_of
from polaris_nl.model.domain import Domain
from polaris_nl.model.errors import LogError
from polaris_nl.model.wording import Wording
from polaris_nl.model.world import World
from polaris_nl.past import authored


def run_attachments(
    program: Program, world: World, wording: Wording, settings: RunSettings
) -> Mapping[str, str]:
    """The texts that make a run's log explain itself: program, world, domain, settings and versions."""
    kept = {"run": asdict(settings), "versions": versions(world.domain)}
    texts = attachments_of(program_json(program), world.domain.source, world.source, kept)
    if isinstance(
        wording, GrammarWording
    ):  # Whoever reads the log need not load a language for it.
        texts[PROGRAM_TEXT] = read_back(program.automaton, wording)
    return texts


def session_attachments(program: Program, world: World) -> Mapping[str, str]:
    """The texts that make a session's log explain itself: as those of a run, with no run's settings."""
    kept = {"versions": versions(world.domain)}
    return attachments_of(program_json(program), world.domain.source, world.source, kept)


def authored_in(log: Path, program: Program) -> tuple[Event, ...]:
    """What was said and changed in a session, read from its log, for the log of a run that follows.

    Args:
        log: of the session, or of an earlier run that begins with it.
        program: what is to be run.

    Raises:
        LogError: the file can't be read, holds no words, or ended with another program.
    """
    found = authored(read_log(log).events)
    edits = [e for e in found if isinstance(e, Edited)]
    if not edits:
        raise LogError(f"In {log} nothing was said; name the log of the session, or leave it out.")
    if edits[-1].program != program_json(program):
        raise LogError(
            f"What was said in {log} led to another program than this one; name the log of its own"
            " session, or leave it out."
        )
    return found


def versions(domain: Domain) -> dict[str, str]:
    """What a run depends on besides its program: of programs the versions, of grammars a hash."""
    files = sorted(grammar_folder().rglob("*.yaml"))
    own = grammar_path(domain)
    digest = hashlib.sha256()
    for path in (*files, *([own] if own is not None and own not in files else [])):
        digest.update(path.read_bytes())
    return {
        "polaris-nl": __version__,
        "python": platform.python_version(),
        "planner": metadata.version("up-fast-downward"),
        "grammar": digest.hexdigest()[:16],
    }


class LogWatch:
    """Tells when a log can't be kept, and halts the run then where that is wanted."""

    def __init__(self, log: LogWriter, halts: bool) -> None:
        self._log = log
        self._halts = halts
        self._told: set[str] = set()

    def news(self) -> Iterable[str]:
        """What hasn't been told yet, in sentences."""
        then = "The run halts." if self._halts else "The run goes on without it."
        for text, more in ((self._log.failure, then), (self._log.lost, "")):
            if text and text not in self._told:
                self._told.add(text)
                yield f"{text} {more}".strip()

    def over(self, robot: Robot) -> Robot:
        """The robot, at fault from the moment when its log can't be written, where that is wanted."""
        return _Logged(robot, self._log) if self._halts else robot


class _Logged:
    """A robot that counts as at fault when its log can't be written."""

    def __init__(self, robot: Robot, log: LogWriter) -> None:
        self._robot = robot
        self._log = log
        self.name = robot.name
        self.missing, self.advance, self.command = robot.missing, robot.advance, robot.command
        self.reports, self.close = robot.reports, robot.close

    def observe(self) -> Observation:
        """What the robot perceives."""
        found = self._robot.observe()
        if not self._log.failure or not found.health.ready:
            return found
        why = "the log can't be written any more; make room on the disk first"
        return replace(found, health=Health("fault", why))
