"""What actions do with the plan, runs and logs."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from polaris_nl.automaton.automaton import START
from polaris_nl.execution.state import HumanCommand
from polaris_nl.model.text import capital
from polaris_tui import offering, stepping
from polaris_tui.menus import Ask, Menu, Note, Option, Perform, Step
from polaris_tui.phrases import Order
from polaris_tui.reasons import View
from polaris_tui.screen import Screen
from polaris_tui.state import State
from polaris_tui.transcript import Entry


class Doing:
    """What the deeds share.

    Args:
        app: the application, for what only it can do.
        state: what it remembers.
    """

    def __init__(self, app: Screen, state: State) -> None:
        self._app = app
        self._state = state

    def follow(self, step: Step) -> None:
        """Goes on with what a menu or an action led to."""
        raise NotImplementedError

    def close(self) -> None:
        """Closes all menus."""
        raise NotImplementedError

    def show(self, view: View) -> None:
        """Shows something else in the largest pane; the same again goes back."""
        raise NotImplementedError


class Going(Doing):
    """Steps through plans, runs them, and goes through logs."""

    def _plan(self) -> None:
        state = self._state
        if state.view == "plan":
            state.view = "program"
            return
        main = self._app.board.main
        row = main.row if main.has_focus and state.view == "program" else None
        number = row.action if row is not None and not self._app.as_tree else None
        self.show("plan")
        if row is not None:
            self._at(state.picked, number)
        else:
            leaf = stepping.first_leaf(self._app.session.snapshot.automaton, state.picked)
            state.steps = stepping.Steps(leaf, 0)
            self._app.want_purpose()

    def _at(self, checkpoint: str, number: int | None) -> None:
        """Goes to a step of the plan."""
        automaton = self._app.session.snapshot.automaton
        leaf = stepping.first_leaf(automaton, checkpoint)
        stops = self._app.stops(leaf)
        self._state.steps = stepping.at_action(automaton, checkpoint, stops, number)
        if number is None and checkpoint == START:
            self._state.steps = stepping.Steps(leaf, 0)
        self._app.want_purpose()

    def _step(self, by: int) -> None:
        steps = self._state.steps
        self._state.steps = stepping.moved(steps, self._app.stops(steps.leaf), by)
        self._app.want_purpose()

    def _way(self, by: int) -> None:
        steps, automaton = self._state.steps, self._app.session.snapshot.automaton
        stops = self._app.stops(steps.leaf)
        found = stepping.other_way(steps, stops, automaton, by)
        if found == steps:
            self._state.note(Entry("The ways never part in this program."))
        self._state.steps = found
        self._app.want_purpose()

    def _run(self) -> None:
        self._state.asks_to_start = True
        self._app.say("run it")

    def confirm(self, read_out: str) -> None:
        """Asks for the yes, below what will happen."""
        robot = self._state.robot
        self.follow(
            Menu(
                f"{capital(robot)} will move. Shall I start?" if robot else "Shall I start?",
                (
                    Option("yes, start", Perform("say", "yes")),
                    Option("no", Perform("say", "no")),
                ),
                read_out,
            )
        )

    def order(self, order: Order) -> None:
        """Commands the run."""
        state = self._state
        if state.current is not None:
            state.current.command(HumanCommand(order))
            if order == "stop":
                state.progress = replace(state.progress, activity="stopping")
        elif order == "stop":
            self.close()
            state.stopped_at = state.transcript.tickets
            self._app.say("stop")  # The session forgets that it asked for a yes.

    def _pause(self) -> None:
        self.order("resume" if self._state.progress.activity == "paused" else "pause")

    def _tell(self, about: str) -> None:
        waiting, wording = self._state.progress.waiting, self._state.wording
        current = self._state.current
        if about and current is not None and 0 < int(about) <= len(waiting):
            when = waiting[int(about) - 1]
            self._state.note(said=wording.events(when))
            current.command(HumanCommand("happened", when))
            return
        self.follow(offering.tell_menu(waiting, wording))

    def _log(self, about: str) -> None:
        if about:
            self._app.open_log(Path(about).expanduser(), go_there=False)
            return
        self.follow(offering.log_menu(self._app.logs))

    def _problem(self, step: int) -> None:
        reading = self._state.reading
        if reading is None:
            return
        found = reading.replay.problem(reading.number, step)
        if found is None:
            where = "after" if step > 0 else "before"
            self._app.tell_briefly(f"There is no problem {where} this event.")
            return
        words = reading.words if found in reading.replay.shown(reading.words) else ""
        self._state.reading = replace(reading, number=found, words=words)
        self._app.follow_reading()

    def _filter(self) -> None:
        reading = self._state.reading
        if reading is None:
            return

        def filtered(words: str) -> Step:
            wanted = "" if words.strip() == "*" else words.strip()
            self._state.reading = replace(reading, words=wanted)
            self._app.follow_reading()
            return Note("All events again." if not wanted else f"Only events with: {wanted}")

        title = "Only events with these words (topic=goal, severity=warning; * shows all again)"
        self.follow(Ask(title, filtered, reading.words))

    def _below(self, what: str) -> None:
        reading = self._state.reading
        if reading is not None:
            below = "event" if reading.below == what else what
            self._state.reading = replace(reading, below=below)
