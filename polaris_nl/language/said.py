"""How people say things: requests in which the names are left open, for a recogniser's phrases.

A grammar says what is understood; these say what is said most. A recogniser that knows both hears more
in noise, since it guesses rather what people say than what they could say.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

FOLDER, BESIDE_SAID = "said", "said.txt"
"""The shipped requests, a file a domain; and the file in the folder of a domain, which comes before it."""
_SLOT = re.compile(r"\{(the )?([a-z][a-z-]*)\}")


@dataclass(frozen=True, slots=True)
class Open:
    """A place in a request for the name of something.

    Attributes:
        type: what it may be, such as "object".
        whole: the article belongs to it, so that it may be a pronoun as well.
    """

    type: str
    whole: bool


Request = tuple[str | Open, ...]
"""Words and open places in the order in which they are said."""


def read_said(path: Path) -> tuple[Request, ...]:
    """The requests of a file, one a line: "could you take {the person} her {object}"; "#" begins a comment.

    Args:
        path: the file; there are no requests where it doesn't exist.
    """
    if not path.is_file():
        return ()
    lines = (line.strip() for line in path.read_text(encoding="utf-8").splitlines())
    return tuple(tuple(_parts(line)) for line in lines if line and not line.startswith("#"))


def _parts(line: str) -> Iterator[str | Open]:
    at = 0
    for slot in _SLOT.finditer(line):
        yield from line[at : slot.start()].split()
        yield Open(slot[2], whole=bool(slot[1]))
        at = slot.end()
    yield from line[at:].split()
