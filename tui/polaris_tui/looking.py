"""The line mode's looks at things: the plan step by step, runs, logs."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from polaris_nl.render.timeline import branch_stops
from polaris_tui import offering, stepping
from polaris_tui.lines import Lines
from polaris_tui.menus import Ask, Note, Step
from polaris_tui.panels import expectation_rows, told_rows
from polaris_tui.reviewing import detail_rows, review_rows
from polaris_tui.scene import Reading
from polaris_tui.views import outline_rows, status, trouble_rows


class Looking(Lines):
    """Shows without changing anything."""

    def _program(self) -> None:
        self._scene = replace(self._scene, reading=None)
        now = self._now()
        self._say(f"{status(now)[0]}. You are at {self._desk().here.name}.")
        self._rows(outline_rows(now, self._width, True))
        self._rows(trouble_rows(now, self._width))

    # The plan

    def _plan(self) -> None:
        leaf = stepping.first_leaf(self._session.snapshot.automaton, self._picked)
        self._scene = replace(self._scene, steps=stepping.Steps(leaf, 0))
        self._step(0)

    def _step(self, by: int) -> None:
        steps, plan = self._scene.steps, self._session.snapshot.plan
        if plan is None:
            return
        stops = branch_stops(
            self._session.snapshot.automaton, plan, steps.leaf, self._session.wording
        )
        self._scene = replace(self._scene, steps=stepping.moved(steps, stops, by))
        self._rows(told_rows(self._now(), stops, self._scene.steps.at, self._width))

    def _way(self, by: int) -> None:
        stops = self._now().stops()
        automaton = self._session.snapshot.automaton
        steps = stepping.other_way(self._scene.steps, stops, automaton, by)
        self._scene = replace(self._scene, steps=steps)
        self._step(0)

    def _watch(self) -> None:
        now = self._now()
        self._say(status(now)[0])
        self._rows(expectation_rows(now, now.progress, self._width))

    # Logs

    def _log(self, about: str) -> None:
        if not about:
            self._follow(offering.log_menu(self._logs))
            return
        from polaris_tui.replay import open_replay

        replay = open_replay(Path(about).expanduser(), self._session.world)
        self._scene = replace(self._scene, reading=Reading(replay), world=replay.world)
        self._rows(review_rows(self._now(), self._width))
        self._say("Say :next-problem, :filter, :compare or :chain; :program goes back.")

    def _problem(self, step: int) -> None:
        reading = self._scene.reading
        found = reading.replay.problem(reading.number, step) if reading else None
        if reading is None or found is None:
            self._say("There is no further problem.")
            return
        self._scene = replace(self._scene, reading=replace(reading, number=found, below="event"))
        self._rows(detail_rows(self._now(), self._width))

    def _filter(self) -> None:
        def filtered(words: str) -> Step:
            reading = self._scene.reading
            if reading is not None:
                wanted = "" if words == "*" else words
                self._scene = replace(self._scene, reading=replace(reading, words=wanted))
                self._rows(review_rows(self._now(), self._width))
            return Note("")

        self._follow(Ask("Only events with these words (* for all)", filtered))

    def _below(self, what: str) -> None:
        if self._scene.reading is not None:
            self._scene = replace(self._scene, reading=replace(self._scene.reading, below=what))
            self._rows(detail_rows(self._now(), self._width))
