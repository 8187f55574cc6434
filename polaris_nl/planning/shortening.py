"""Takes shortcuts in a program's plan, and offers those that have a price."""

from __future__ import annotations

import time
from dataclasses import replace

from polaris_nl.automaton.automaton import START
from polaris_nl.model.world import World
from polaris_nl.planning.result import Segment
from polaris_nl.planning.shorter import Shortcut, Shortcuts
from polaris_nl.planning.walk import Errand, Walker, Work

BUDGET_S = 3.0
"""Seconds in which a whole program is looked through."""


class Shortening:
    """Looks through the plans of programs in one world."""

    def __init__(self, world: World, walker: Walker, shortcuts: Shortcuts) -> None:
        self._world = world
        self._walker = walker
        self._shortcuts = shortcuts

    def shortened(self, errand: Errand, work: Work) -> Work:
        """The work with every shortcut that costs nothing, and with the offers of others.

        In a hurry only what is known already is used.
        """
        automaton = errand.automaton
        deadline = time.monotonic() + BUDGET_S

        def over() -> bool:
            return errand.quick or errand.cancelled() or time.monotonic() > deadline

        if work.cancelled:
            return work
        for checkpoint in automaton.subtree(START)[1:]:
            segment = work.segments.get(checkpoint)
            onward = [
                (work.segments[t.target], bool(automaton.outgoing(t.target)))
                for t in automaton.outgoing(checkpoint)
                if t.target in work.segments
            ]
            if segment is None or not onward or checkpoint in work.ahead:
                continue
            shortcut = self._shortcuts.at(segment, onward, over)
            if shortcut is None:
                continue
            if shortcut.longer:
                offer = self._shortcuts.offered(automaton, segment, shortcut)
                work.notes.extend([offer] if offer is not None else [])
            else:
                work = self._taken(errand, segment, shortcut, work)
        return work

    def _taken(self, errand: Errand, segment: Segment, shortcut: Shortcut, work: Work) -> Work:
        automaton = errand.automaton
        source = work.segments.get(segment.source)
        state = source.after if source is not None else self._world.initial
        near = frozenset((segment.target, *automaton.children(segment.target)))
        errand = replace(errand, ways={segment.target: shortcut.actions}, only=near)
        trial = self._walker.again(errand, segment.target, state, work)
        if trial.cancelled or len(trial.segments) < len(work.segments):
            return work
        if trial.action_count() >= work.action_count():
            return work
        trial.notes.append(self._shortcuts.taken(automaton, segment, shortcut))
        return trial
