"""Schema versions of files: `polaris-world/1` is version 1 of the world format."""

from __future__ import annotations

import re

from polaris_nl.model.errors import FormatError

_SCHEMA = re.compile(r"(?P<name>[a-z-]+)/(?P<version>\d{1,6})\Z")


def check_schema(found: str, wanted: str, what: str) -> int:
    """The version of a file, for its reader to migrate where it is older than the current one.

    Args:
        found: what the file says; "" is taken for the current version.
        wanted: the current schema, such as `polaris-world/1`.
        what: the kind of file, for the sentence.

    Raises:
        FormatError: it is another kind of file, or newer than this program.
    """
    name, _, current = wanted.partition("/")
    if not found:
        return int(current)
    match = _SCHEMA.match(found)
    if match is None or match["name"] != name:
        raise FormatError(f"This is no {what} file: its schema is {found!r}, not {wanted}.", line=1)
    version = int(match["version"])
    if version > int(current):
        raise FormatError(
            f"This {what} file has schema {found}, newer than {wanted}, which this version reads;"
            " update Polaris NL.",
            line=1,
        )
    if version < 1:
        raise FormatError(f"There is no schema {found}; the current one is {wanted}.", line=1)
    return version
