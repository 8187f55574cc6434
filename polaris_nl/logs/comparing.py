"""Two runs beside each other: what they did and decided otherwise, and where one took longer."""

from __future__ import annotations

import difflib
from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass

from polaris_nl.execution.events import Event
from polaris_nl.logs.review import story
from polaris_nl.logs.spans import Span, spans


@dataclass(frozen=True, slots=True)
class Slower:
    """Something that both runs did, and that one took clearly longer for; seconds."""

    label: str
    one: float
    other: float


@dataclass(frozen=True, slots=True)
class Comparison:
    """How two runs differ.

    Attributes:
        diff: what they did and decided, as a unified diff; empty where it is the same.
        slower: what took at least a second and a third longer in one of them.
        seconds: how long each took.
    """

    diff: tuple[str, ...]
    slower: tuple[Slower, ...]
    seconds: tuple[float, float]


def compare(one: Sequence[Event], other: Sequence[Event], names: tuple[str, str]) -> Comparison:
    """Compares the last runs of two logs.

    Args:
        one: the events of one of them.
        other: the events of the other.
        names: what the diff calls them.
    """
    lines = difflib.unified_diff(story(one), story(other), *names, lineterm="", n=2)
    first, second = spans(one), spans(other)
    slower = []
    for key, ours in _by_label(first).items():
        for a, b in zip(ours, _by_label(second).get(key, []), strict=False):
            short, long = sorted((a.seconds, b.seconds))
            if long - short >= 1.0 and long >= short * 4 / 3:
                slower.append(Slower(a.label, a.seconds, b.seconds))
    return Comparison(tuple(lines), tuple(slower), (_length(first), _length(second)))


def _by_label(some: Sequence[Span]) -> dict[str, list[Span]]:
    found: dict[str, list[Span]] = defaultdict(list)
    for span in some:
        if span.kind != "segment":
            found[span.action or span.label].append(span)
    return found


def _length(some: Sequence[Span]) -> float:
    return max((s.end for s in some), default=0.0)
