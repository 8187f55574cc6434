"""Completing the names of things and checkpoints in a sentence."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from polaris_nl.automaton.automaton import START, Automaton
from polaris_nl.model.world import World

SHORTEST = 2
"""Letters that a name has to begin with before it is completed."""


def names_of(world: World, automaton: Automaton) -> list[str]:
    """What can be completed: checkpoints, then entities with their other names."""
    checkpoints = [c.name for c in automaton.checkpoints.values() if c.id != START]
    entities = [n for e in world.entities.values() for n in (e.spoken, *e.synonyms)]
    return list(dict.fromkeys((*checkpoints, *entities)))


def completions(line: str, names: Iterable[str]) -> list[str]:
    """The lines that could be meant: the longest beginning of a name at the line's end, completed.

    "go to the din" becomes "go to the dining table"; a whole name can be the beginning of a longer one.
    """
    names = list(names)
    for start in _word_starts(line):
        begun = line[start:].lower()
        if len(begun.strip()) < SHORTEST:
            continue
        found = [n for n in names if n.lower().startswith(begun) and n.lower() != begun]
        if found:
            return [line[:start] + name for name in found]
    return []


def _word_starts(line: str) -> Iterator[int]:
    """The places where the last words of a line begin, the longest tail first; four words at most."""
    starts = [0, *(n + 1 for n, c in enumerate(line) if c == " ")]
    yield from starts[-4:]
