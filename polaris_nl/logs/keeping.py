"""How logs are kept: settings, what raw messages are, what is attached."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from polaris_nl.logs.privacy import KEEP_ALL, Privacy

ABOUT, CUT_OFF = "polaris", "cut_off"
"""The metadata record of what a log says about itself, and its entry of why the log has no end."""
PROGRAM_TEXT = "program.txt"
"""The attachment that tells a run's program in words."""


@dataclass(frozen=True, slots=True)
class RawKind:
    """What raw messages are: the type's name and definition, and how both are written."""

    name: str
    definition: str
    encoding: str = "ros2msg"
    message_encoding: str = "cdr"


@dataclass(frozen=True, slots=True)
class LogSettings:
    """How a log is kept.

    Attributes:
        part_bytes: when a log goes on in another file, in bytes; it does so at midnight, too.
        patience_s: how long a caller waits for another one to have written, in seconds.
        slow_s: how long the disk may take before it is spared by queueing, in seconds.
        queue: how many messages may wait in memory; robot messages and inputs get half of it.
        privacy: what isn't kept.
    """

    part_bytes: int = 256 << 20
    patience_s: float = 0.0005
    slow_s: float = 0.05
    queue: int = 20_000
    privacy: Privacy = KEEP_ALL


def attachments_of(
    program: Mapping[str, Any],
    domain: str,
    world: str,
    settings: Mapping[str, Any] | None = None,
) -> dict[str, str]:
    """The attachments that make a log explain itself: program, domain, world and settings as text."""
    texts = {
        "program.polaris.json": json.dumps(program, indent=2, ensure_ascii=False),
        "domain.pddl": domain,
        "world.yaml": world,
    }
    if settings is not None:
        texts["settings.json"] = json.dumps(settings, indent=2, ensure_ascii=False)
    return texts
