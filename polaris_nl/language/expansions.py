"""What wordings stand for, written out: `(put|lay) {o}` is "put {o}" and "lay {o}"."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator

from polaris_nl.language.template import Choice, Parts, Slot, Word

Said = tuple[str | Slot, ...]
"""One sequence of words and slots that a wording stands for."""


def expansions(template: Parts, most: int | None = None) -> Iterator[Said]:
    """What a wording stands for: all of it, or some spread evenly where it is more than `most`."""
    whole = expansion_count(template)
    if most is None or whole <= most:
        return _every(template)
    known: dict[int, int] = {}
    return (_expansion(template, number * whole // most, known) for number in range(most))


def _every(template: Parts) -> Iterator[Said]:
    ways: list[list[Said]] = []
    for part in template.parts:
        if isinstance(part, Word):
            ways.append([(part.text,)])
        elif isinstance(part, Slot):
            ways.append([(part,)])
        else:
            ways.append([said for option in part.options for said in _every(option)])
    for way in itertools.product(*ways):
        yield tuple(itertools.chain.from_iterable(way))


def expansion_count(template: Parts, known: dict[int, int] | None = None) -> int:
    """How much a wording stands for, the same said in two ways counted twice.

    Args:
        template: the wording.
        known: the counts of its inner parts by their ids, filled on the way.
    """
    known = {} if known is None else known
    if id(template) not in known:
        known[id(template)] = math.prod(
            sum(expansion_count(option, known) for option in part.options)
            for part in template.parts
            if isinstance(part, Choice)
        )
    return known[id(template)]


def _expansion(template: Parts, number: int, known: dict[int, int]) -> Said:
    """The one with a number below `expansion_count`."""
    found: list[str | Slot] = []
    for part in template.parts:
        if isinstance(part, Word):
            found.append(part.text)
        elif isinstance(part, Slot):
            found.append(part)
        else:
            counts = [expansion_count(option, known) for option in part.options]
            number, inner = divmod(number, sum(counts))
            for option, count in zip(part.options, counts, strict=True):
                if inner < count:
                    found.extend(_expansion(option, inner, known))
                    break
                inner -= count
    return tuple(found)
