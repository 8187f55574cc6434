"""Every error that Polaris NL raises on purpose.

    PolarisError
    ├── UsageError            the command was called wrongly (exit code 2)
    ├── FileError             a file can't be read or written
    │   └── FormatError       a file is readable, but not what it should be; knows its line
    │       ├── DomainError   a PDDL domain
    │       ├── WorldError    a world file
    │       ├── GrammarError  a grammar file
    │       └── ProgramError  a program file
    ├── EditError             an edit doesn't fit the program it is applied to
    ├── PlanningError         the planner itself failed (a missing plan is a value, never an error)
    ├── SpeechError           a model, a microphone or a recording can't be used
    ├── RunError              a run can't start or go on
    └── LogError              a log can't be written or read

The text of each is one sentence for a person: what is wrong, by name, and a way out.
"""

from __future__ import annotations

import difflib
from collections.abc import Iterable
from pathlib import Path


class PolarisError(Exception):
    """Base of all errors a user can mend. `exit_code` is what the command line ends with."""

    exit_code = 1


class UsageError(PolarisError):
    """The command line was called in a way it doesn't understand."""

    exit_code = 2


class FileError(PolarisError):
    """A file can't be read or written."""


class FormatError(FileError):
    """A file doesn't have the format it should.

    Attributes:
        path: the file, or None for text that came from elsewhere.
        line: the line, counted from 1, or None where no one line is to blame.
        reason: the sentence without the place.
    """

    def __init__(self, reason: str, path: Path | None = None, line: int | None = None) -> None:
        self.reason = reason
        self.path = path
        self.line = line
        place = "" if path is None else f"{path}"
        if line is not None:
            place = f"{place}, line {line}" if place else f"line {line}"
        super().__init__(f"{place}: {reason}" if place else reason)


class DomainError(FormatError):
    """A PDDL domain file can't be understood."""


class WorldError(FormatError):
    """A world file can't be understood or doesn't fit its domain."""


class GrammarError(FormatError):
    """A grammar file can't be understood or doesn't fit its domain."""


class ProgramError(FormatError):
    """A program file can't be understood."""


class EditError(PolarisError):
    """An edit doesn't fit the program it is applied to."""


class PlanningError(PolarisError):
    """The planner could not do its work (crashed, was killed, has no space to write)."""


class SpeechError(PolarisError):
    """A speech model, a microphone or a recording can't be used."""


class RunError(PolarisError):
    """A run can't start, or can't go on."""


class LogError(PolarisError):
    """A log can't be written or read."""


def did_you_mean(word: str, known: Iterable[str]) -> str:
    """The tail of an error sentence: the nearest known names, or all of them where there are few.

    Returns:
        Text that starts with a space, or "" where nothing is near and too much is known to list.
    """
    names = sorted(set(known))
    near = difflib.get_close_matches(word, names, n=3, cutoff=0.6)
    if near:
        return f" Did you mean {' or '.join(near)}?"
    if 0 < len(names) <= 8:
        return f" Known here: {', '.join(names)}."
    return ""
