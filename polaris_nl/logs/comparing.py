"""Two runs beside each other: what they did and decided otherwise, and where one took longer."""

from __future__ import annotations

import difflib
from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from polaris_nl.execution.events import Event
from polaris_nl.logs.filters import start_of
from polaris_nl.logs.review import story
from polaris_nl.logs.spans import Span, spans

AROUND = 2
"""Steps that are the same and shown before and after others."""


@dataclass(frozen=True, slots=True)
class Slower:
    """Something that both runs did, and that one took clearly longer for; seconds."""

    label: str
    one: float
    other: float


@dataclass(frozen=True, slots=True)
class Step:
    """Something that was done or decided in one of two runs, or in both.

    Attributes:
        sign: `-` in the first alone, `+` in the other alone, ` ` in both, `@` where some that are the
            same are left out before it.
        line: what, for programs; event: what, for people: the first run's where both have it.
        at: seconds since that run's start.
    """

    sign: str
    line: str
    event: Event
    at: float


@dataclass(frozen=True, slots=True)
class Comparison:
    """How two runs differ.

    Attributes:
        steps: what they did and decided otherwise, with two steps around it; empty where all is the same.
        slower: what took at least a second and a third longer in one of them.
        seconds: how long each took.
    """

    steps: tuple[Step, ...]
    slower: tuple[Slower, ...]
    seconds: tuple[float, float]


def compare(one: Sequence[Event], other: Sequence[Event]) -> Comparison:
    """Compares what two logs tell of runs: what was done and decided, and how long it took."""
    first, second = spans(one), spans(other)
    slower = []
    for key, ours in _by_label(first).items():
        for a, b in zip(ours, _by_label(second).get(key, []), strict=False):
            short, long = sorted((a.seconds, b.seconds))
            if long - short >= 1.0 and long >= short * 4 / 3:
                slower.append(Slower(a.label, a.seconds, b.seconds))
    return Comparison(tuple(_steps(one, other)), tuple(slower), (_length(first), _length(second)))


def _steps(one: Sequence[Event], other: Sequence[Event]) -> Iterator[Step]:
    ours, theirs = story(one), story(other)
    matcher = difflib.SequenceMatcher(None, [x for x, _ in ours], [x for x, _ in theirs], False)
    for number, group in enumerate(matcher.get_grouped_opcodes(AROUND)):
        if number or group[0][1]:
            yield Step("@", "", one[0], 0.0)
        for kind, a, b, c, d in group:
            if kind == "equal":
                yield from _signed(" ", ours[a:b], one)
            else:
                yield from _signed("-", ours[a:b], one)
                yield from _signed("+", theirs[c:d], other)


def _signed(
    sign: str, some: Sequence[tuple[str, Event]], events: Sequence[Event]
) -> Iterator[Step]:
    start = start_of(events)
    for line, event in some:
        yield Step(sign, line, event, event.time - start)


def _by_label(some: Sequence[Span]) -> dict[str, list[Span]]:
    found: dict[str, list[Span]] = defaultdict(list)
    for span in some:
        if span.kind != "segment":
            found[span.action or span.label].append(span)
    return found


def _length(some: Sequence[Span]) -> float:
    return max((s.end for s in some), default=0.0)
